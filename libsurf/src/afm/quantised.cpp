// SPDX-License-Identifier: GPL-3.0-or-later
#include "quantised.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "surf/core/error.h"

namespace surf::max_plus {
namespace {

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

template <class Known>
Range range_of(const Grid<double>& z, const Known& known) {
  Range r;
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (!known(i)) continue;
    r.low = std::min(r.low, z.data()[i]);
    r.high = std::max(r.high, z.data()[i]);
  }
  return r;
}

Range range_of(const HeightField& field) {
  const auto& valid = field.valid.data();
  return valid.empty() ? range_of(field.z_nm, [](std::size_t) { return true; })
                       : range_of(field.z_nm, [&](std::size_t i) { return valid[i] != 0; });
}

double depth_of(const Tip& tip) {
  return -range_of(tip.z_nm, [&](std::size_t i) { return std::isfinite(tip.z_nm.data()[i]); }).low;
}

/// The nearest whole number, for |v| < 2^51. Unlike std::round it becomes vector instructions.
inline double nearest(double v) {
  constexpr double shift = 0x1.8p52;
  return v + shift - shift;
}

}  // namespace

void check_pair(const HeightField& field, const Tip& tip, const char* subject) {
  validate(field, subject);
  validate(tip);
  const auto differ = [](double a, double b) { return std::abs(a - b) > 1e-6 * std::max(a, b); };
  if (differ(field.pitch_x_nm, tip.pitch_x_nm) || differ(field.pitch_y_nm, tip.pitch_y_nm))
    throw InvalidInput(
        "tip",
        fmt::format("its pitch is {:g} x {:g} nm, that of the {} {:g} x {:g} nm", tip.pitch_x_nm,
                    tip.pitch_y_nm, subject, field.pitch_x_nm, field.pitch_y_nm),
        "Resample it to the other's");
  const auto& valid = field.valid.data();
  if (!valid.empty() &&
      std::none_of(valid.begin(), valid.end(), [](unsigned char v) { return v != 0; }))
    throw InvalidInput(subject, "it has no valid height", "Use another channel or scan");
}

double choose_quantum(const HeightField& surface, const Tip& tip,
                      const MorphologyOptions& options) {
  const Range r = range_of(surface);
  const double range = r.high - r.low, depth = depth_of(tip), needed = range + 2 * depth;
  const double magnitude = std::max({std::abs(r.low), std::abs(r.high), depth});
  if (!(magnitude < 1e150))
    throw InvalidInput("morphology",
                       fmt::format("heights of {:g} nm are out of all bounds", magnitude),
                       "Mark such samples as holes");
  // Rounding adds a few quanta to the range. Whole numbers of quanta must be exact in a double, and
  // below 2^51 for `nearest`.
  const double floor = std::max(std::ldexp(needed * 1.000001, -28), std::ldexp(magnitude, -50));
  const double finest = std::max(std::exp2(std::ceil(std::log2(floor) - 1)), 1e-150);
  if (options.quantum_nm == 0) return floor > 0 ? finest : 1;
  if (options.quantum_nm > 0 && std::isfinite(options.quantum_nm) &&
      needed * 1.000001 <= 0x1p29 * options.quantum_nm && magnitude <= 0x1p50 * options.quantum_nm)
    return options.quantum_nm;
  throw InvalidInput(
      "quantum",
      fmt::format("{:g} nm is not possible for heights over {:g} nm and a tip {:g} nm deep",
                  options.quantum_nm, range, depth),
      fmt::format("Give {:g} nm or more, or 0", finest));
}

Heights quantise(const HeightField& surface, double sign, double quantum_nm) {
  const Range r = range_of(surface);
  Heights out{Grid<Quanta>(surface.z_nm.width(), surface.z_nm.height()),
              nearest((sign > 0 ? r.high : -r.low) / quantum_nm)};
  const double* const z = surface.z_nm.data().data();
  const unsigned char* const valid = surface.valid.empty() ? nullptr : surface.valid.data().data();
  Quanta* const q = out.z.data().data();
  for (std::size_t i = 0; i < out.z.size(); ++i)
    q[i] = valid && !valid[i] ? unknown
                              : static_cast<Quanta>(nearest(sign * z[i] / quantum_nm) - out.top);
  return out;
}

TipQuanta quantise(const Tip& tip, double quantum_nm, int width, int height) {
  const int x0 = std::max(0, tip.apex_x - width + 1), y0 = std::max(0, tip.apex_y - height + 1);
  const int x1 = std::min(tip.z_nm.width(), tip.apex_x + width);
  const int y1 = std::min(tip.z_nm.height(), tip.apex_y + height);
  TipQuanta out{Grid<Quanta>(x1 - x0, y1 - y0), tip.apex_x - x0, tip.apex_y - y0};
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const double z = tip.z_nm(x, y);
      out.z(x - x0, y - y0) =
          std::isfinite(z) ? static_cast<Quanta>(nearest(z / quantum_nm)) : unknown;
    }
  return out;
}

HeightField to_field(const Heights& heights, double sign, double quantum_nm,
                     const HeightField& like) {
  const int w = heights.z.width(), h = heights.z.height();
  HeightField out{like.placement(), Grid<double>(w, h)};
  const Quanta* const q = heights.z.data().data();
  double* const z = out.z_nm.data().data();
  std::size_t holes = 0;
  for (std::size_t i = 0; i < out.z_nm.size(); ++i) {
    const bool known = q[i] >= lowest;
    z[i] = known ? sign * ((heights.top + q[i]) * quantum_nm) + 0.0 : 0.0;
    holes += !known;
  }
  if (holes == 0) return out;
  out.valid = Mask(w, h, 1);
  for (std::size_t i = 0; i < out.z_nm.size(); ++i) out.valid.data()[i] = q[i] >= lowest;
  return out;
}

}  // namespace surf::max_plus
