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

/// Where the maximum was found, in samples of the first operand; both empty if nobody asks.
struct Contacts {
  Grid<std::int32_t> x, y;
};

/// Known values become <= 0 again, the highest 0.
void rebase(Heights& h) {
  const Quanta top = *std::max_element(h.z.data().begin(), h.z.data().end());
  if (top < max_plus::lowest) return;   // nothing is known
  for (Quanta& z : h.z.data())
    if (z >= max_plus::lowest) z -= top;
  h.top += top;
}

/// Erosion is the dilation of what is upside down by the tip seen from the other side.
enum class Operation { dilation, erosion };

double sign_of(Operation o) { return o == Operation::dilation ? 1.0 : -1.0; }
Tip tip_of(Operation o, const Tip& tip) { return o == Operation::dilation ? tip : reflected(tip); }

Heights convolve(const Heights& a, const TipQuanta& b, int threads, Contacts* contacts) {
  Heights out{{}, a.top};
  Grid<std::int32_t> index;
  max_plus::convolve(a.z, b.z, b.apex_x, b.apex_y, threads, out.z, contacts ? &index : nullptr);
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

/// Samples f x - p, f y - q of a fine grid, for each x and y of the coarse one.
Heights phase(const Heights& fine, int f, int p, int q, int width, int height) {
  Heights out{Grid<Quanta>(width, height, max_plus::unknown), fine.top};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (f * x >= p && f * y >= q) out.z(x, y) = fine.z(f * x - p, f * y - q);
  return out;
}

/// Samples apex + f u + p of a fine tip.
TipQuanta phase(const TipQuanta& fine, int f, int p, int q) {
  const int before_x = fine.apex_x / f, before_y = fine.apex_y / f;
  const int w = before_x + (fine.z.width() - 1 - fine.apex_x) / f + 1;
  const int h = before_y + (fine.z.height() - 1 - fine.apex_y) / f + 1;
  TipQuanta out{Grid<Quanta>(w + 1, h + 1, max_plus::unknown), before_x + 1, before_y + 1};
  for (int y = 0; y < h + 1; ++y)
    for (int x = 0; x < w + 1; ++x) {
      const int X = fine.apex_x + f * (x - out.apex_x) + p, Y = fine.apex_y + f * (y - out.apex_y) + q;
      if (X >= 0 && Y >= 0 && X < fine.z.width() && Y < fine.z.height()) out.z(x, y) = fine.z(X, Y);
    }
  return out;
}

/// Fine convolution at the coarse samples alone: each offset of the fine tip modulo f meets its own
/// samples of the fine surface only, so that it is f x f coarse convolutions.
Heights convolve_fine(const Heights& a, const TipQuanta& b, int f, int width, int height, int threads,
                      Contacts* contacts) {
  Heights best{Grid<Quanta>(width, height, max_plus::unknown), a.top};
  if (contacts) *contacts = {Grid<std::int32_t>(width, height, -1), Grid<std::int32_t>(width, height, -1)};
  for (int q = 0; q < f; ++q)
    for (int p = 0; p < f; ++p) {
      Contacts here;
      const Heights part = convolve(phase(a, f, p, q, width, height), phase(b, f, p, q), threads,
                                    contacts ? &here : nullptr);
      for (std::size_t i = 0; i < part.z.size(); ++i) {
        if (part.z.data()[i] <= best.z.data()[i]) continue;
        best.z.data()[i] = part.z.data()[i];
        if (!contacts) continue;
        contacts->x.data()[i] = here.x.data()[i] * f - p;
        contacts->y.data()[i] = here.y.data()[i] * f - q;
      }
    }
  return best;
}

HeightField apply(Operation operation, const HeightField& field, const Tip& tip, const char* subject,
                  const MorphologyOptions& o, Contacts* contacts = nullptr) {
  max_plus::check_pair(field, tip, subject);
  const double quantum = choose_quantum(field, tip, o), sign = sign_of(operation);
  const int w = field.z_nm.width(), h = field.z_nm.height();
  const Tip used = tip_of(operation, tip);
  Heights out;
  if (o.upsample == 1) {
    out = convolve(quantise(field, sign, quantum), quantise(used, quantum, w, h), o.threads, contacts);
  } else {
    const HeightField fine = upsampled(field, o.upsample);
    const Tip fine_tip = resampled(used, tip.pitch_x_nm / o.upsample, tip.pitch_y_nm / o.upsample);
    const TipQuanta fine_quanta = quantise(fine_tip, quantum, fine.z_nm.width(), fine.z_nm.height());
    out = convolve_fine(quantise(fine, sign, quantum), fine_quanta, o.upsample, w, h, o.threads, contacts);
  }
  return to_field(out, sign, quantum, field);
}

/// Two operations with one quantum, so that nothing is rounded in between.
HeightField apply_both(Operation first, const HeightField& field, const Tip& tip, const char* subject,
                       const MorphologyOptions& o) {
  max_plus::check_pair(field, tip, subject);
  if (o.upsample != 1) {
    const HeightField fine = upsampled(field, o.upsample);
    const Tip fine_tip = resampled(tip, tip.pitch_x_nm / o.upsample, tip.pitch_y_nm / o.upsample);
    MorphologyOptions plain = o;
    plain.upsample = 1;
    const HeightField both = apply_both(first, fine, fine_tip, subject, plain);
    HeightField out = field;
    out.valid = {};
    if (!both.valid.empty()) out.valid = Grid<unsigned char>(field.z_nm.width(), field.z_nm.height());
    for (int y = 0; y < field.z_nm.height(); ++y)
      for (int x = 0; x < field.z_nm.width(); ++x) {
        out.z_nm(x, y) = both.z_nm(x * o.upsample, y * o.upsample);
        if (!out.valid.empty()) out.valid(x, y) = both.valid(x * o.upsample, y * o.upsample);
      }
    return out;
  }
  const double quantum = choose_quantum(field, tip, o);
  const int w = field.z_nm.width(), h = field.z_nm.height();
  const Operation second = first == Operation::dilation ? Operation::erosion : Operation::dilation;
  Heights half = convolve(quantise(field, sign_of(first), quantum), quantise(tip_of(first, tip), quantum, w, h),
                          o.threads, nullptr);
  // The other way up, and below 0 again.
  for (Quanta& z : half.z.data())
    if (z >= max_plus::lowest) z = -z;
  half.top = -half.top;
  rebase(half);
  const Heights out = convolve(half, quantise(tip_of(second, tip), quantum, w, h), o.threads, nullptr);
  return to_field(out, sign_of(second), quantum, field);
}

Tip hemisphere_for(const HeightField& field, double distance_nm) {
  if (!(distance_nm >= 0 && std::isfinite(distance_nm)))
    throw InvalidInput("distance", fmt::format("{:g} nm is not possible", distance_nm), "Give 0 or more");
  return hemisphere_tip(distance_nm, field.pitch_x_nm, field.pitch_y_nm, field.z_nm.width(), field.z_nm.height());
}

void lift(HeightField& field, double by_nm) {
  for (std::size_t i = 0; i < field.z_nm.size(); ++i)
    if (field.valid.empty() || field.valid.data()[i]) field.z_nm.data()[i] += by_nm;
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

Dilation dilate_with_contacts(const HeightField& surface, const Tip& tip, const MorphologyOptions& options) {
  Contacts contacts;
  Dilation out{apply(Operation::dilation, surface, tip, "surface", options, &contacts), {}, {}};
  out.contact_x = std::move(contacts.x);
  out.contact_y = std::move(contacts.y);
  return out;
}

HeightField dilate_noncontact(const HeightField& surface, const Tip& tip, double distance_nm,
                              const MorphologyOptions& options) {
  max_plus::check_pair(surface, tip, "surface");
  HeightField image = dilate(dilate(surface, hemisphere_for(surface, distance_nm), options), tip, options);
  lift(image, distance_nm);
  return image;
}

HeightField erode_noncontact(const HeightField& image, const Tip& tip, double distance_nm,
                             const MorphologyOptions& options) {
  max_plus::check_pair(image, tip, "image");
  HeightField surface = erode(erode(image, tip, options), hemisphere_for(image, distance_nm), options);
  lift(surface, -distance_nm);
  return surface;
}

}  // namespace surf
