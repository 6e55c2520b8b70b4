// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/row_level.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "afm/median.h"
#include "afm/samples.h"

namespace surf {
namespace {

using Offsets = std::vector<std::optional<double>>;

Offsets medians(const HeightField& field, const Mask& use) {
  Offsets out(static_cast<std::size_t>(field.z_nm.height()));
  std::vector<double> row;
  for (int y = 0; y < field.z_nm.height(); ++y) {
    row.clear();
    for (int x = 0; x < field.z_nm.width(); ++x)
      if (is_used(field, use, x, y)) row.push_back(field.z_nm(x, y));
    if (!row.empty()) out[static_cast<std::size_t>(y)] = median_of(row);
  }
  return out;
}

/// Sums the steps from the first row with samples. Steps are measured between successive rows with
/// samples.
Offsets sums_of_differences(const HeightField& field, const Mask& use) {
  Offsets out(static_cast<std::size_t>(field.z_nm.height()));
  std::vector<double> steps;
  int last = -1;
  for (int y = 0; y < field.z_nm.height(); ++y) {
    steps.clear();
    bool any = false;
    for (int x = 0; x < field.z_nm.width(); ++x) {
      if (!is_used(field, use, x, y)) continue;
      any = true;
      if (last >= 0 && is_used(field, use, x, last))
        steps.push_back(field.z_nm(x, y) - field.z_nm(x, last));
    }
    if (!any || (last >= 0 && steps.empty())) continue;
    out[static_cast<std::size_t>(y)] =
        last < 0 ? 0 : *out[static_cast<std::size_t>(last)] + median_of(steps);
    last = y;
  }
  return out;
}

/// The offset of the nearest row that has one; of two, that of the lower row.
double nearest(const Offsets& offsets, int y) {
  const int height = static_cast<int>(offsets.size());
  for (int distance = 0; distance < height; ++distance) {
    const int below = y - distance, above = y + distance;
    if (below >= 0 && offsets[static_cast<std::size_t>(below)])
      return *offsets[static_cast<std::size_t>(below)];
    if (above < height && offsets[static_cast<std::size_t>(above)])
      return *offsets[static_cast<std::size_t>(above)];
  }
  return 0;
}

}  // namespace

RowLevel level_rows(HeightField& field, RowMethod method, const Mask& use) {
  require_field(field, use);
  const Offsets known =
      method == RowMethod::median ? medians(field, use) : sums_of_differences(field, use);
  RowLevel out;
  std::vector<double> present;
  for (const auto& offset : known)
    if (offset) present.push_back(*offset);
  if (present.empty()) throw InvalidInput("rows", "no sample takes part", "Use more of the image");
  const double level = median_of(present);
  for (int y = 0; y < field.z_nm.height(); ++y) {
    out.rows_without_samples += !known[static_cast<std::size_t>(y)];
    out.offsets_nm.push_back(nearest(known, y) - level);
    for (int x = 0; x < field.z_nm.width(); ++x)
      if (field.is_valid(x, y)) field.z_nm(x, y) -= out.offsets_nm.back();
  }
  return out;
}

}  // namespace surf
