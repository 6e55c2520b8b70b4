// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the reconstruction's posterior is right: the deviations of heights, map, gains, offset
// and tip, all fitted at once.
//   bench_posterior MODEL.json --fits 200 [SEED]   simulation-based calibration
//   bench_posterior MODEL.json --sampler [SEED]    against a sampler, on a small case
//
// The generator. An SEM image of 64 x 48 pixels of 10 nm shows a plateau (sides 100 to 180 nm), a
// line (60 to 160 nm wide) that crosses it, and what reaches into it of up to six mesas (sides 40
// to 120 nm) on the ground around. Each is 15 to 60 nm high, turned a little, and its walls are
// normal distribution functions with a deviation of 8 to 25 nm: slopes of 13 to 71 degrees at their
// steepest. All stand on a sum of eight waves 150 to 500 nm long, 1.2 nm rms in all. The ground is
// 440 nm wider than the image on every side, and the scan 200 nm, so that all of the scan is made
// of known ground, and the image's border is that of an image of a larger specimen.
// The scan has pixels of 10 nm. The given tip is a cone of half angle 20 degrees that ends in a
// sphere of 20 nm; the true one is that tip with a change drawn from the fit's prior, 35 numbers of
// N(0, 1/9). The dilation is computed as in the fit, with three samples per pixel. Its noise is
// AR(1), alpha 0.825, innovation 0.201 nm^2.
// The true map is the given one, a rotation of up to 0.2, but for normal errors of 0.004 in
// rotation, 0.006 in both pixel sizes and the shear, and 4 nm in both shifts. The image is the
// model's, 900 SE + 300 of each other channel, times a factor of deviation 0.05, plus an offset
// of 120 with deviation 20. A discrepancy is drawn from `usual_discrepancy` of this image at 5 %;
// the fit uses the one of the image with its noise. Noise is normal with variance 6 (image - 120).
// The fit begins at the given tip, map, gains and offset. A second fit begins its last scale at the
// truth, so that a wrong optimum can be told from wrong deviations. Heights are not drawn from the
// prior of the fit, which has no scale that a scene could be drawn from: whether its deviations
// hold on such scenes is the question.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>

#include "compare_truth.h"
#include "posterior/sampler.h"
#include "posterior/scalars.h"
#include "posterior/scaled_errors.h"
#include "reconstruction/gaussian_basis.h"
#include "reconstruction/height_intervals.h"
#include "reconstruction/posterior.h"
#include "surf/core/parallel.h"
#include "surf/io/model/model_file.h"

namespace {

using namespace surf;
using namespace surf::bench;
using namespace surf::reconstruction;

const char* const no_bias = ", no bias";
const char* const as_stated = ", as stated";
/// What walls may be displaced by, in pixels: deviations with other values are counted beside.
constexpr std::array edge_doubts_px{0.0, 0.15, 0.25, 0.3};

struct Errors {
  std::vector<std::pair<std::string, std::vector<OneError>>> of;
  /// `bias` is the prior's, a part of the deviation.
  void add(const std::string& quantity, double off, double deviation, double bias = 0) {
    of.emplace_back(quantity, std::vector{OneError{off, deviation}});
    of.emplace_back(quantity + no_bias,
                    std::vector{OneError{off, std::sqrt(deviation * deviation - bias * bias)}});
  }
  bool converged = true;
};

const char* const map_names[affine_numbers] = {"rotation", "pixel size x", "pixel size y",
                                               "shear",    "shift x",      "shift y"};

/// The variances that `reconstruct` adds for the places of walls.
Grid<double> variances_by_walls(const Fitted& f) {
  const Grid<double> soft = f.inner(GaussianBasis(1, 1).sum(f.at.z_nm));
  Grid<double> out(soft.width(), soft.height());
  for (int y = 1; y + 1 < out.height(); ++y)
    for (int x = 1; x + 1 < out.width(); ++x)
      out(x, y) = 0.25 * edge_doubt_px * edge_doubt_px *
                  (std::pow(soft(x + 1, y) - soft(x - 1, y), 2) +
                   std::pow(soft(x, y + 1) - soft(x, y - 1), 2));
  return out;
}

std::string with_edges(std::size_t k) { return fmt::format(", walls {} px", edge_doubts_px[k]); }

void add_heights(const DrawnScene& scene, const Fitted& f, Errors& errors) {
  const Grid<double> walls = variances_by_walls(f);
  for (const workflow::PixelRegion& region :
       workflow::pixel_regions(scene.truth, f.result.data_support)) {
    std::vector<OneError> stated, interval;
    std::array<std::vector<OneError>, edge_doubts_px.size()> others;
    for (std::size_t i = 0; i < walls.size(); ++i) {
      if (!region.pixels.data()[i]) continue;
      const double off = f.result.surface.z_nm.data()[i] - scene.truth.z_nm.data()[i];
      const double deviation = f.result.deviation_nm.data()[i];
      stated.push_back({off, deviation});
      const double truth = scene.truth.z_nm.data()[i];
      const bool inside =
          truth >= f.result.lower_nm.data()[i] && truth <= f.result.upper_nm.data()[i];
      interval.push_back({inside ? 0.0 : 3.0, 1});
      for (std::size_t k = 0; k < others.size(); ++k)
        others[k].push_back(
            {off,
             std::sqrt(deviation * deviation +
                       walls.data()[i] * (std::pow(edge_doubts_px[k] / edge_doubt_px, 2) - 1))});
    }
    errors.of.emplace_back(fmt::format("heights, {}", region.name), stated);
    errors.of.emplace_back(fmt::format("heights, {}, in the interval", region.name), interval);
    for (std::size_t k = 0; k < others.size(); ++k)
      errors.of.emplace_back(fmt::format("heights, {}{}", region.name, with_edges(k)), others[k]);
  }
}

MapChange numbers_of(const AffineParts& p) {
  return {p.rotation_rad, p.scale_x, p.scale_y, p.shear, p.shift_x_nm, p.shift_y_nm};
}

/// Of map, gain, offset, tip and scalars, with deviations by solutions of the linear system.
void add_functions(const DrawnScene& scene, const Fitted& f, Errors& errors) {
  const Curvature a =
      expected_curvature(f.objective, f.at, 1, 1, Precision::single_where_it_holds, {});
  const Step bias = prior_bias(f.objective, f.at, a, {}, {});
  std::vector<Step> functions = few_functions(f.objective, f.at);
  std::vector<std::pair<std::string, double>> off;
  // The middle of the image is at 0, so that its shift is that of the map.
  const MapChange is = numbers_of(parts_of(f.result.sem_to_afm)),
                  should = numbers_of(parts_of(scene.true_map));
  for (std::size_t k = 0; k < affine_numbers; ++k)
    off.emplace_back(map_names[k], is[k] - should[k]);
  if (const auto& known = f.result.map_deviation) {
    const std::array stated{known->rotation_rad, known->scale_x,     known->scale_y,
                            known->shear,        known->middle_x_nm, known->middle_y_nm};
    for (std::size_t k = 0; k < affine_numbers; ++k)
      errors.of.emplace_back(std::string(map_names[k]) + as_stated,
                             std::vector{OneError{off[k].second, stated[k]}});
  }
  off.emplace_back("gain",
                   std::log(f.result.gains[0] / scene.sem.gains[0] / scene.true_gain_factor));
  off.emplace_back("offset", f.result.offset - scene.true_offset);
  for (std::size_t k = 0; k < tip_numbers; ++k)
    off.emplace_back(fmt::format("tip, place {}", k / tip_waves + 1),
                     f.at.tip[k] - scene.true_tip[k]);
  off.emplace_back("tip, radius of the apex", apex_radius(f.at.tip) - apex_radius(scene.true_tip));
  functions.push_back(f.objective.zero());
  functions.back().tip = apex_radius_by_tip();
  const auto add_scalar = [&](const char* name, const Scalar& found, double truth) {
    off.emplace_back(name, found.value - truth);
    functions.push_back(f.objective.zero());
    for (int y = 0; y < found.by_height.height(); ++y)
      for (int x = 0; x < found.by_height.width(); ++x)
        functions.back().z_nm(x + f.margin_px, y + f.margin_px) = found.by_height(x, y);
  };
  add_scalar("mean height of the plateau", plateau_height(f.result.surface, scene.plateau),
             plateau_height(scene.truth, scene.plateau).value);
  const auto width = line_width(f.result.surface, scene.line),
             true_width = line_width(scene.truth, scene.line);
  if (width && true_width) add_scalar("width of the line", *width, true_width->value);
  const std::vector<double> d = deviations_of(f.objective, f.at, a, bias, functions, {});
  for (std::size_t k = 0; k < off.size(); ++k) {
    const double by_bias = dot(functions[k], bias);
    errors.add(off[k].first, off[k].second, d[k], by_bias);
    if (off[k].first.starts_with("tip, place"))
      errors.add("tip, all", off[k].second, d[k], by_bias);
  }
}

/// The fit of a scene, and its errors.
double fit_errors(const DrawnScene& scene, Start start, Errors& errors) {
  const Fitted f = fit_scene(scene, start, true);
  errors.converged = f.result.converged;
  add_heights(scene, f, errors);
  add_functions(scene, f, errors);
  return f.objective.evaluate(f.at).value();
}

void print_tables(const std::vector<Errors>& found) {
  const auto fits = static_cast<double>(found.size());
  ScaledErrors all;
  int ended = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    ended += found[i].converged;
    for (const auto& [quantity, errors] : found[i].of)
      all.add(quantity, static_cast<int>(i), errors);
  }
  fmt::print("  {:32} {:>13}   {:>13}   {:>14}   {:>13}   {:>8} {:>8}\n", "", "within one, %",
             "within two, %", "mean", "rms", "error", "stated");
  std::vector<std::string> kinds{"", ", in the interval"};
  for (std::size_t k = 0; k < edge_doubts_px.size(); ++k) kinds.push_back(with_edges(k));
  for (const std::string& also : kinds)
    for (const char* const region : {"all", "flat", "wall", "foot", "untouched"})
      all.print_coverage(fmt::format("heights, {}{}", region, also));
  std::vector<std::string> few(std::begin(map_names), std::end(map_names));
  few.insert(few.end(), {"gain", "offset", "tip, all"});
  for (int place = 1; place <= tip_places; ++place)
    few.push_back(fmt::format("tip, place {}", place));
  const std::array scalars{"mean height of the plateau", "width of the line",
                           "tip, radius of the apex", "gain"};
  few.insert(few.end(), scalars.begin(), scalars.end() - 1);
  for (const std::string& name : few) all.print_coverage(name);
  for (const char* const name : map_names) all.print_coverage(std::string(name) + as_stated);
  for (const std::string& name : few)
    if (!name.starts_with("tip, place")) all.print_coverage(name + no_bias);
  fmt::print(
      "\n  Fits whose truth is in each tenth of the posterior; expected: {} in each, chi-squared\n"
      "  9, p above 0.01\n",
      fits / 10);
  for (const char* const name : scalars) all.print_places(name);
  for (const char* const name : map_names) all.print_places(name);
  fmt::print("\n  {} fits converged.\n\n", ended);
}

int calibrate(const std::shared_ptr<const ImageModel>& model, int fits, std::uint64_t first) {
  const auto begin = std::chrono::steady_clock::now();
  std::vector<Errors> found(static_cast<std::size_t>(fits)), from_truth = found;
  std::vector<double> above(found.size());
  parallel_for(found.size(), 0, [&](std::size_t i, int) {
    const DrawnScene scene = draw_scene(model, first + i);
    above[i] =
        fit_errors(scene, Start::given, found[i]) - fit_errors(scene, Start::truth, from_truth[i]);
    if (i % 10 == 9) fmt::print(stderr, "{} fits\n", i + 1);
  });
  fmt::print(
      "{} fits, seeds {} to {}, each twice, in {:.1f} minutes\n\n"
      "Errors over posterior deviations. Expected: 68.3 % within one, 95.4 % within two, mean 0,\n"
      "root mean square 1. Sampling errors are of the scatter of fits. Last: root mean squares of\n"
      "errors and of deviations, in nm, radians, parts of 1 or grey levels. Of intervals of\n"
      "95 % only \"within\" counts. \"Walls ... px\": deviations as if walls might be displaced "
      "by\n"
      "so many pixels. Without bias: the bias by the prior is taken off.\n\n"
      "Fits that begin at the given values\n",
      fits, first, first + found.size() - 1,
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / 60);
  print_tables(found);
  fmt::print("Fits whose last scale begins at the truth\n");
  print_tables(from_truth);
  std::ranges::sort(above);
  fmt::print(
      "The objective ends {:.0f} nats (median; {:.0f} to {:.0f} for 10 to 90 % of fits) higher "
      "from\n"
      "the given values than from the truth, and by more than 10 in {} of {} fits: there the "
      "first\n"
      "table is of another optimum\n",
      above[above.size() / 2], above[above.size() / 10], above[above.size() * 9 / 10],
      std::ranges::count_if(above, [](double nats) { return nats > 10; }), fits);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string command = argc > 2 ? argv[2] : "";
  if (command == "--fits" && argc > 3)
    return calibrate(make_model(io::read_model(argv[1])), std::stoi(argv[3]),
                     argc > 4 ? std::stoull(argv[4]) : 1);
  if (command == "--sampler")
    return compare_with_sampler(make_model(io::read_model(argv[1])),
                                argc > 3 ? std::stoull(argv[3]) : 1);
  fmt::print(stderr,
             "bench_posterior MODEL.json --fits FITS [SEED]\n"
             "bench_posterior MODEL.json --sampler [SEED]\n");
  return 2;
}
