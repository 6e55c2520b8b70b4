// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/morphology.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "quantised.h"
#include "surf/afm/resample.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"

namespace surf {
namespace {

using max_plus::choose_quantum;
using max_plus::Heights;
using max_plus::Quanta;
using max_plus::quantise;
using max_plus::TipQuanta;

/// The positions of the maxima, in samples of the first operand; both empty if not wanted.
struct Contacts {
  Grid<std::int32_t> x, y;
};

/// Shifts the known values so that the highest is 0.
void rebase(Heights& h) {
  const Quanta top = *std::max_element(h.z.data().begin(), h.z.data().end());
  if (top < max_plus::lowest) return;  // nothing is known
  for (Quanta& z : h.z.data())
    if (z >= max_plus::lowest) z -= top;
  h.top += top;
}

/// Erosion is the dilation of the negative surface by the reflected tip.
enum class Operation { dilation, erosion };

double sign_of(Operation o) { return o == Operation::dilation ? 1.0 : -1.0; }
Tip tip_of(Operation o, const Tip& tip) { return o == Operation::dilation ? tip : reflected(tip); }

Heights convolve(const Heights& a, const TipQuanta& b, int threads, Contacts* contacts,
                 const Watch& watch) {
  Heights out{{}, a.top};
  Grid<std::int32_t> index;
  max_plus::convolve(a.z, b.z, b.apex_x, b.apex_y, threads, out.z, contacts ? &index : nullptr,
                     watch);
  if (!contacts) return out;
  const int w = a.z.width(), h = a.z.height();
  *contacts = {Grid<std::int32_t>(w, h, -1), Grid<std::int32_t>(w, h, -1)};
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (index(x, y) < 0) continue;
      contacts->x(x, y) = x + b.apex_x - index(x, y) % b.z.width();
      contacts->y(x, y) = y + b.apex_y - index(x, y) / b.z.width();
    }
  return out;
}

void check_factor(int upsample) {
  if (upsample < 1 || upsample > 32)
    throw InvalidInput("upsample", fmt::format("{} is not in 1 to 32", upsample),
                       "2 or 3 is usual");
}

/// Makes one operation. Between samples, surface and tip are bilinear. So their sum is bilinear in
/// u in every cell and largest at a corner, and a finer grid would give the same samples (thesis,
/// C.3).
HeightField apply(Operation operation, const HeightField& field, const Tip& tip,
                  const char* subject, const MorphologyOptions& o, Contacts* contacts = nullptr) {
  max_plus::check_pair(field, tip, subject);
  check_factor(o.upsample);
  const double quantum = choose_quantum(field, tip, o), sign = sign_of(operation);
  const int w = field.z_nm.width(), h = field.z_nm.height();
  const Tip used = tip_of(operation, tip);
  const Heights out = convolve(quantise(field, sign, quantum), quantise(used, quantum, w, h),
                               o.threads, contacts, o.watch);
  return to_field(out, sign, quantum, field);
}

/// Calls `work` on field and tip interpolated to `upsample` samples per pitch, and samples the
/// result back.
template <class Work>
HeightField on_fine_grid(const HeightField& field, const Tip& tip, MorphologyOptions o,
                         const Work& work) {
  const int f = o.upsample;
  o.upsample = 1;
  const HeightField fine =
      work(upsampled(field, f), resampled(tip, tip.pitch_x_nm / f, tip.pitch_y_nm / f), o);
  HeightField out = field;
  out.valid = {};
  if (!fine.valid.empty()) out.valid = Mask(field.z_nm.width(), field.z_nm.height());
  for (int y = 0; y < field.z_nm.height(); ++y)
    for (int x = 0; x < field.z_nm.width(); ++x) {
      out.z_nm(x, y) = fine.z_nm(x * f, y * f);
      if (!out.valid.empty()) out.valid(x, y) = fine.valid(x * f, y * f);
    }
  return out;
}

MorphologyOptions part_of(MorphologyOptions o, double from, double to) {
  o.watch = o.watch.part(from, to);
  return o;
}

/// Makes two operations with the same quantum, so that nothing is rounded in between.
HeightField apply_both(Operation first, const HeightField& field, const Tip& tip,
                       const char* subject, const MorphologyOptions& o) {
  max_plus::check_pair(field, tip, subject);
  if (o.upsample != 1)
    return on_fine_grid(field, tip, o,
                        [&](const HeightField& f, const Tip& t, const MorphologyOptions& plain) {
                          return apply_both(first, f, t, subject, plain);
                        });
  const double quantum = choose_quantum(field, tip, o);
  const int w = field.z_nm.width(), h = field.z_nm.height();
  const Operation second = first == Operation::dilation ? Operation::erosion : Operation::dilation;
  Heights half = convolve(quantise(field, sign_of(first), quantum),
                          quantise(tip_of(first, tip), quantum, w, h), o.threads, nullptr,
                          o.watch.part(0, 0.5));
  // Negates the intermediate heights and shifts them below 0 again.
  for (Quanta& z : half.z.data())
    if (z >= max_plus::lowest) z = -z;
  half.top = -half.top;
  rebase(half);
  const Heights out = convolve(half, quantise(tip_of(second, tip), quantum, w, h), o.threads,
                               nullptr, o.watch.part(0.5, 1));
  return to_field(out, sign_of(second), quantum, field);
}

Tip hemisphere_for(const HeightField& field, double distance_nm) {
  if (!(distance_nm >= 0 && std::isfinite(distance_nm)))
    throw InvalidInput("distance", fmt::format("{:g} nm is not possible", distance_nm),
                       "Give 0 or more");
  return hemisphere_tip(distance_nm, field.pitch_x_nm, field.pitch_y_nm, field.z_nm.width(),
                        field.z_nm.height());
}

void lift(HeightField& field, double by_nm) {
  for (std::size_t i = 0; i < field.z_nm.size(); ++i)
    if (field.valid.includes(i)) field.z_nm.data()[i] += by_nm;
}

}  // namespace

HeightField dilate(const HeightField& surface, const Tip& tip, const MorphologyOptions& options) {
  return apply(Operation::dilation, surface, tip, "surface", options);
}

HeightField erode(const HeightField& image, const Tip& tip, const MorphologyOptions& options) {
  return apply(Operation::erosion, image, tip, "image", options);
}

HeightField opening(const HeightField& image, const Tip& tip, const MorphologyOptions& options) {
  return apply_both(Operation::erosion, image, tip, "image", options);
}

HeightField closing(const HeightField& surface, const Tip& tip, const MorphologyOptions& options) {
  return apply_both(Operation::dilation, surface, tip, "surface", options);
}

Dilation dilate_with_contacts(const HeightField& surface, const Tip& tip,
                              const MorphologyOptions& options) {
  Contacts contacts;
  Dilation out{apply(Operation::dilation, surface, tip, "surface", options, &contacts), {}, {}};
  for (Grid<std::int32_t>* grid : {&contacts.x, &contacts.y})
    for (std::int32_t& sample : grid->data())
      if (sample >= 0) sample *= options.upsample;
  out.contact_x = std::move(contacts.x);
  out.contact_y = std::move(contacts.y);
  return out;
}

HeightField dilate_noncontact(const HeightField& surface, const Tip& tip, double distance_nm,
                              const MorphologyOptions& options) {
  max_plus::check_pair(surface, tip, "surface");
  if (options.upsample != 1)
    return on_fine_grid(surface, tip, options,
                        [&](const HeightField& f, const Tip& t, const MorphologyOptions& o) {
                          return dilate_noncontact(f, t, distance_nm, o);
                        });
  HeightField image =
      dilate(dilate(surface, hemisphere_for(surface, distance_nm), part_of(options, 0, 0.5)), tip,
             part_of(options, 0.5, 1));
  lift(image, distance_nm);
  return image;
}

HeightField erode_noncontact(const HeightField& image, const Tip& tip, double distance_nm,
                             const MorphologyOptions& options) {
  max_plus::check_pair(image, tip, "image");
  if (options.upsample != 1)
    return on_fine_grid(image, tip, options,
                        [&](const HeightField& f, const Tip& t, const MorphologyOptions& o) {
                          return erode_noncontact(f, t, distance_nm, o);
                        });
  HeightField surface = erode(erode(image, tip, part_of(options, 0, 0.5)),
                              hemisphere_for(image, distance_nm), part_of(options, 0.5, 1));
  lift(surface, -distance_nm);
  return surface;
}

}  // namespace surf
