// SPDX-License-Identifier: GPL-3.0-or-later
#include "follow_rows.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surf/profile/edge_roughness.h"

namespace surf {
namespace {

double mean_square(const RowPlaces& errors_nm) {
  double squares = 0, count = 0;
  for (const auto& rows : errors_nm)
    for (const double e : rows)
      if (std::isfinite(e)) squares += e * e, ++count;
  return count > 0 ? squares / count : squares;
}

/// Keeps so much of each frequency.
std::vector<double> filtered(const std::vector<double>& rows, const std::vector<double>& keep) {
  const std::size_t n = rows.size();
  std::vector<double> cosine(n), sine(n), out(n, 0);
  for (std::size_t k = 0; k < n; ++k) {
    const double a = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
    cosine[k] = std::cos(a), sine[k] = std::sin(a);
  }
  for (std::size_t k = 0; k <= n / 2; ++k) {
    if (!(keep[k] > 1e-6)) continue;
    double re = 0, im = 0;
    for (std::size_t i = 0; i < n; ++i)
      re += rows[i] * cosine[i * k % n], im -= rows[i] * sine[i * k % n];
    const double twice = k == 0 || 2 * k == n ? 1 : 2,
                 factor = twice * keep[k] / static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i)
      out[i] += factor * (re * cosine[i * k % n] - im * sine[i * k % n]);
  }
  return out;
}

}  // namespace

RowPlaces without_middle(RowPlaces places_nm, bool closed) {
  if (!closed) return places_nm;
  for (auto& rows : places_nm) {
    const auto n = static_cast<double>(rows.size());
    double cosine = 0, sine = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const double a = 2 * std::numbers::pi * static_cast<double>(r) / n;
      cosine += 2 / n * rows[r] * std::cos(a), sine += 2 / n * rows[r] * std::sin(a);
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const double a = 2 * std::numbers::pi * static_cast<double>(r) / n;
      rows[r] -= cosine * std::cos(a) + sine * std::sin(a);
    }
  }
  return places_nm;
}

FollowedRows follow_rows(const RowPlaces& found_nm, const RowPlaces& errors_nm, bool closed,
                         double distance_nm) {
  const std::size_t n = found_nm.front().size();
  const double noise = mean_square(errors_nm) * distance_nm,
               length_nm = static_cast<double>(n) * distance_nm;
  FollowedRows out;
  std::vector<double> keep(n, 0);  // of each frequency, 0 to n - 1
  keep[0] = 1;
  if (closed && n > 2) keep[1] = keep[n - 1] = 1;  // the hole's middle may be off
  if (n >= fewest_rows_with_spectrum) {
    EdgeRoughness r = fit_roughness(edge_spectrum(without_middle(found_nm, closed), distance_nm),
                                    static_cast<int>(found_nm.size()), distance_nm);
    r.noise_nm = 0;
    for (std::size_t k = 1; r.found && k < n; ++k) {
      if (keep[k] == 1) continue;
      const double f = static_cast<double>(std::min(k, n - k)) / length_nm;
      const double signal = roughness_density(r, f, distance_nm);
      keep[k] = signal / (signal + noise);
      out.blur_nm2 += keep[k] * noise / length_nm;
    }
  }
  for (const auto& rows : found_nm) out.places_nm.push_back(filtered(rows, keep));
  return out;
}

}  // namespace surf
