// SPDX-License-Identifier: GPL-3.0-or-later
// How fast scans are levelled, cleaned and their noise estimated, as JSON, on one thread;
// Gwyddion's library on the same array beside it where it is installed. 512 x 512 samples, 30 % of
// them a tilted substrate.
//   bench_level [output.json]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#ifdef SEMSURF_GWYDDION
#include <libprocess/filters.h>
#include <libprocess/gwyprocess.h>
#include <libprocess/level.h>
#endif

#include "surf/afm/clean.h"
#include "surf/afm/hough_plane.h"
#include "surf/afm/noise_check.h"
#include "surf/afm/noise_estimate.h"
#include "surf/core/random.h"

namespace {

using namespace surf;
using nlohmann::json;

constexpr int size = 512;
constexpr double slope_x = 0.05, slope_y = -0.02;

/// The median of five runs.
template <class Work>
double seconds(const Work& work) {
  std::vector<double> times;
  for (int i = 0; i < 5; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    times.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(times.begin(), times.end());
  return times[2];
}

HeightField scan() {
  HeightField f;
  f.z_nm = simulate_noise({0.8, 0.0036}, size, size, 1);
  RandomStream random(1, 0, 0);
  for (int j = 0; j < size; j += 16) {
    for (int i = 0; i < size; i += 16) {
      const double top = random.uniform() < 0.3 ? 0 : 5 + 55 * random.uniform();
      const double tilt = top > 0 ? random.uniform() - 0.5 : 0;
      for (int y = j; y < j + 16; ++y)
        for (int x = i; x < i + 16; ++x)
          f.z_nm(x, y) += slope_x * x + slope_y * y + top + tilt * (x - i);
    }
  }
  return f;
}

/// How far a plane tilts from the substrate across the image.
double off_nm(double along_x, double along_y) {
  return size * std::max(std::fabs(along_x - slope_x), std::fabs(along_y - slope_y));
}

#ifdef SEMSURF_GWYDDION
GwyDataField* to_gwyddion(const HeightField& f) {
  GwyDataField* g = gwy_data_field_new(size, size, size, size, FALSE);
  std::copy(f.z_nm.data().begin(), f.z_nm.data().end(), gwy_data_field_get_data(g));
  return g;
}

void compare(const HeightField& f, const HeightField& median_of_ours, json& out) {
  gwy_process_type_init();
  GwyDataField* const g = to_gwyddion(f);
  json& s = out["gwyddion_seconds"];
  double c = 0, bx = 0, by = 0;
  s["mean_plane"] = seconds([&] { gwy_data_field_fit_plane(g, &c, &bx, &by); });
  out["gwyddion_mean_plane"] = {{"slope_x", bx}, {"slope_y", by}};
  s["facet_plane"] =
      seconds([&] { gwy_data_field_fit_facet_plane(g, nullptr, GWY_MASK_IGNORE, &c, &bx, &by); });
  out["gwyddion_facet_plane_off_nm"] = off_nm(bx, by);
  for (const int width : {3, 11, 41}) {
    GwyDataField* copy = nullptr;
    s[fmt::format("median_{}", width)] = seconds([&] {
      if (copy) g_object_unref(copy);
      copy = gwy_data_field_duplicate(g);
      gwy_data_field_filter_median(copy, width);
    });
    if (width == 11) {
      const auto [disc, unused] =
          median_filter(f, {.radius = 5, .neighbourhood = Neighbourhood::disc, .threads = 1});
      for (const auto& [shape, ours] :
           {std::pair{"square", &median_of_ours}, std::pair{"disc", &disc}}) {
        double largest = 0;
        std::size_t others = 0;
        for (int y = 6; y < size - 6; ++y) {
          for (int x = 6; x < size - 6; ++x) {
            const double off = std::fabs(gwy_data_field_get_val(copy, x, y) - ours->z_nm(x, y));
            largest = std::max(largest, off);
            others += off > 0;
          }
        }
        out["median_11_differences_inside"][shape] = {{"largest_nm", largest}, {"samples", others}};
      }
    }
    g_object_unref(copy);
  }
  g_object_unref(g);
}
#endif

}  // namespace

int main(int argc, char** argv) {
  const HeightField f = scan();
  json out;
  json& s = out["seconds"];
  Plane mean;
  s["mean_plane"] = seconds([&] { mean = fit_plane(f); });
  out["mean_plane"] = {{"slope_x", mean.slope_x}, {"slope_y", mean.slope_y}};
  HoughSummary hough;
  s["hough_plane"] = seconds([&] { hough = find_plane(f); });
  out["hough_plane_off_nm"] = off_nm(hough.plane.slope_x, hough.plane.slope_y);
  out["hough"] = {{"inliers", hough.inlier_share},
                  {"runner_up", hough.runner_up_share},
                  {"planes_counted", hough.evaluated},
                  {"tolerance_nm", hough.tolerance_nm}};
  CleanSummary summary;
  HeightField median;
  for (const int radius : {20, 1, 5})
    s[fmt::format("median_{}", 2 * radius + 1)] =
        seconds([&] { median = median_filter(f, {.radius = radius, .threads = 1}).field; });
  for (const int width : {3, 41})
    s[fmt::format("closing_{}", width)] =
        seconds([&] { summary = flat_closing(f, {.width = width, .threads = 1}).summary; });
  s["noise_differences"] = seconds([&] { estimate_noise(f); });
  s["noise_flat"] = seconds([&] { estimate_flat_noise(f); });
  Grid<double> gradient;
  s["log_likelihood_and_gradient"] = seconds([&] {
    log_likelihood(f.z_nm, {0.8, 1}, {}, &gradient);
  });
#ifdef SEMSURF_GWYDDION
  compare(f, median, out);
#else
  out["gwyddion"] = "its library is not installed: nothing to compare with";
#endif
  const std::string text = out.dump(2);
  if (argc < 2) fmt::print("{}\n", text);
  else std::ofstream(argv[1]) << text << "\n";
}
