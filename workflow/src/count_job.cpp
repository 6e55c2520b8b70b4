// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/count_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "common_parameters.h"
#include "surf/core/error.h"
#include "surf/core/some_parameters.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/simulate.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {
namespace {

constexpr double degrees = 180 / std::numbers::pi;
/// All trials are pixels of one scan. The scan is so narrow that its pixels do not differ.
constexpr double scan_width_nm = 1e-6;
constexpr double above_nm = 1e7;

constexpr Limits electrons_of_a_trial = within(1, 1'000'000);

void check(const CountJob& job) {
  check_parameters(job);
  if (job.electrons.empty())
    throw UsageError("`counts.electrons`", "no number is given", "Give one or more, as 1,20,100");
  for (const std::int64_t n : job.electrons)
    if (!electrons_of_a_trial.holds(static_cast<double>(n)))
      throw UsageError("`counts.electrons`", fmt::format("{} in a trial are out of range", n),
                       "Give 1 to 1e6");
}

/// The beam and the scan at a fixed point of the scan plane.
std::pair<mc::Beam, mc::Scan> aim(const CountJob& job) {
  mc::Beam beam = job.scene.beam;
  const mc::Scan scene_scan = resolve_scan(job.scene.scan, mc::extent(job.scene.specimen), beam);
  const Vec3 centre{scene_scan.center_x_nm, scene_scan.center_y_nm, scene_scan.center_z_nm};
  Vec3 point = centre;
  if (job.at_nm) {
    // The axes of the scan: x and y rotated with the beam, by the smallest rotation from -z.
    const Vec3 d = mc::direction(beam);
    const double k = 1 / (1 - d.z), dx = job.at_nm->first - centre.x,
                 dy = job.at_nm->second - centre.y;
    point = centre + Vec3{1 - d.x * d.x * k, -d.x * d.y * k, d.x} * dx +
            Vec3{-d.x * d.y * k, 1 - d.y * d.y * k, d.y} * dy;
    if (beam.working_distance_nm > 0) {
      const Vec3 lens = centre - d * beam.working_distance_nm, ray = normalized(point - lens);
      beam.tilt_deg = std::acos(std::clamp(-ray.z, -1.0, 1.0)) * degrees;
      beam.azimuth_deg = std::atan2(ray.y, ray.x) * degrees;
      beam.working_distance_nm = length(point - lens);
    }
  }
  mc::Scan scan;
  scan.width = static_cast<int>(job.trials);
  scan.height = 1;
  scan.pixel_x_nm = scan.pixel_y_nm = scan_width_nm / static_cast<double>(job.trials);
  scan.center_x_nm = point.x, scan.center_y_nm = point.y, scan.center_z_nm = point.z;
  return {beam, scan};
}

}  // namespace

void describe(ParameterVisitor& visit, CountJob& job) {
  describe_point(visit, job.at_nm,
                 {.name = "counts.at",
                  .help = "Point of the image that the beam stands on",
                  .otherwise = "its middle"});
  const Parameter electrons{.name = "counts.electrons",
                            .help = "Primaries in a trial",
                            .limits = electrons_of_a_trial,
                            .form = "N,N,..."};
  visit.form(
      electrons, [&] { return fmt::format("{}", fmt::join(job.electrons, ",")); },
      [&](std::string_view text, const std::string& subject) {
        const std::vector<int> numbers = parse_whole_numbers(text, electrons, subject);
        job.electrons.assign(numbers.begin(), numbers.end());
      });
  visit(job.trials, {.name = "counts.trials",
                     .help = "Trials with each number of primaries",
                     .limits = within(100, 10'000'000)});
  visit(job.seed, {.name = "counts.seed",
                   .help = "Seed of the random numbers",
                   .otherwise = "the scene's, or 1"});
  describe_threads(visit, job.threads);
}

CountSummary run(const CountJob& job, const Reporter& reporter) {
  check(job);
  const auto [beam, scan] = aim(job);
  const mc::Scene scene(job.scene.specimen, beam, scan, job.scene.physics,
                        {.watch = {{}, reporter.cancel}});
  CountSummary summary;
  const Vec3 point{scan.center_x_nm, scan.center_y_nm, scan.center_z_nm}, d = mc::direction(beam);
  if (!scene.first_surface(point - d * above_nm, d, summary.hit_nm))
    throw InvalidInput(
        "specimen",
        fmt::format("the beam at ({:.6g}, {:.6g}) nm does not meet it", point.x, point.y),
        "Choose another point");
  mc::SimulationOptions options;
  options.threads = job.threads;
  options.tally_memory = std::numeric_limits<std::size_t>::max();
  for (const mc::Detector& detector : job.scene.detectors) options.detectors.push_back(detector);
  mc::validate(options.detectors);
  const double total = static_cast<double>(job.trials) *
                       static_cast<double>(std::accumulate(job.electrons.begin(),
                                                           job.electrons.end(), std::int64_t{0}));
  double before = 0;
  for (std::size_t i = 0; i < job.electrons.size(); ++i) {
    options.budget = mc::ElectronsPerPixel{job.electrons[i]};
    options.seed = job.seed + 0x9e3779b97f4a7c15u * i;  // sets share no random numbers
    const mc::SimulationResult result = mc::simulate(
        scene, options,
        {.watch = {
             [&](double done, double) { reporter.progress(before + done, total, "primaries"); },
             reporter.cancel}});
    if (!result.complete) throw Interrupted();
    before += static_cast<double>(job.trials) * static_cast<double>(job.electrons[i]);
    for (std::size_t k = 0; k < result.detectors.size(); ++k) {
      DetectorCounts set{result.detectors[k].name, job.electrons[i], {}};
      for (int x = 0; x < scan.width; ++x) {
        const auto count = static_cast<std::size_t>(result.counts[k](x, 0).sum);
        if (set.counts.size() <= count) set.counts.resize(count + 1);
        ++set.counts[count];
      }
      summary.sets.push_back(std::move(set));
    }
  }
  return summary;
}

}  // namespace surf::workflow
