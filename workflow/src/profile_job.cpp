// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/profile_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>

#include "chain_steps.h"
#include "job_libraries.h"
#include "profile_output.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/core/units.h"
#include "surf/io/plot.h"
#include "surf/mc/geometry/field_in_reach.h"
#include "surf/mc/physics/medium.h"
#include "wall_signal.h"

namespace surf::workflow {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double width_range = 0.08;    // half of the box, of the width
constexpr double most_beside_nm = 250;  // of ground and top that is simulated
constexpr double least_height_nm = 1;
constexpr double largest_corner = 0.35;    // of the height
constexpr double largest_discrepancy = 3;  // over the allowed one
constexpr std::size_t cascades = 40960;
constexpr int more_rounds = 2;     // where a number lies at the border of the last box
constexpr double matched = 0.5;    // the box about the best match, over the first
constexpr double narrower = 0.35;  // a box over the one before
constexpr std::int64_t finer = 4;  // electrons of the last box over those of the others

void check(const ProfileJob& job) {
  if (job.material.name.empty())
    throw UsageError("`specimen.material`", "it is missing",
                     "Say what the specimen is made of, as `specimen.material=Si`");
  if (!(job.height_nm >= least_height_nm))
    throw UsageError("`profile.height`", "no upright view shows how high walls are",
                     "Say it, as `profile.height=100nm`");
  if (job.signal != "SE" && job.signal != "BSE")
    throw UsageError("`profile.signal`", fmt::format("'{}' is not simulated", job.signal),
                     "Give SE or BSE");
  std::error_code ignored;
  if (std::filesystem::exists(job.folder, ignored) &&
      !std::filesystem::is_directory(job.folder, ignored))
    throw UsageError("`output`", fmt::format("{} is no folder", job.folder.string()),
                     "Name a folder for all results, as `output=result`");
  validate(job.sem.image, "SEM image");
  if (std::abs(job.sem.image.pitch_x_nm / job.sem.image.pitch_y_nm - 1) > 1e-3)
    throw InvalidInput("SEM image", "its pixels are not square", "Resample it");
  if (job.picture && !job.folder.empty()) io::check_plot_target(job.folder / "panel.png");
}

PlacedImage transposed(const PlacedImage& image) {
  PlacedImage out = image;
  const int w = image.values.width(), h = image.values.height();
  out.values = Grid<double>(h, w);
  out.valid = Mask(h, w, 1);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      out.values(y, x) = image.values(x, y);
      out.valid(y, x) = image.is_valid(x, y);
    }
  std::swap(out.origin_x_nm, out.origin_y_nm);
  std::swap(out.pitch_x_nm, out.pitch_y_nm);
  return out;
}

Measured mean_of(const std::vector<double>& values) {
  double n = 0, sum = 0, squares = 0;
  for (const double v : values)
    if (std::isfinite(v)) ++n, sum += v, squares += v * v;
  if (n == 0) return {std::nan(""), std::nan("")};
  const double mean = sum / n, variance = std::max(0.0, squares / n - mean * mean);
  return {mean, std::sqrt(variance / n)};
}

/// Widths of all features, by the threshold method.
std::vector<Measured> threshold_widths(const ThresholdEdges& t, FeatureKind kind) {
  std::vector<Measured> out;
  if (kind == FeatureKind::hole) {
    std::vector<double> widths = t.places_nm.front();
    for (double& w : widths) w *= 2;
    return {mean_of(widths)};
  }
  for (std::size_t e = 0; e + 1 < t.edges.size(); ++e) {
    if (t.edges[e].feature != t.edges[e + 1].feature) continue;
    std::vector<double> widths = t.places_nm[e + 1];
    for (std::size_t r = 0; r < widths.size(); ++r) widths[r] -= t.places_nm[e][r];
    out.push_back(mean_of(widths));
  }
  return out;
}

/// The mean distance of the features' middles.
std::optional<Measured> pitch_of(const std::vector<ImageEdge>& edges,
                                 const std::vector<double>& errors_nm) {
  std::vector<double> middles, variances;
  for (std::size_t e = 0; e + 1 < edges.size(); ++e)
    if (edges[e].feature == edges[e + 1].feature) {
      middles.push_back(0.5 * (edges[e].place_nm + edges[e + 1].place_nm));
      if (!errors_nm.empty())
        variances.push_back(0.25 *
                            (errors_nm[e] * errors_nm[e] + errors_nm[e + 1] * errors_nm[e + 1]));
    }
  if (middles.size() < 2) return std::nullopt;
  const double gaps = static_cast<double>(middles.size() - 1);
  Measured pitch{(middles.back() - middles.front()) / gaps, 0};
  if (!variances.empty())
    pitch.standard_error = std::sqrt(variances.front() + variances.back()) / gaps;
  return pitch;
}

/// The box of the first library, about the widths that thresholds give.
ProfileBox first_box(const ProfileJob& job, double width_nm) {
  const double corner = largest_corner * job.height_nm;
  const auto radius = [&](double usual) { return std::min(usual, 0.5 * corner); };
  ProfileBox box;
  box.middle = {width_nm, job.height_nm, job.angle_deg, radius(job.top_radius_nm),
                radius(job.foot_radius_nm)};
  box.half = {job.kind == FeatureKind::edge ? 0 : width_range * width_nm, 2 * job.height_error_nm,
              job.angle_range_deg, radius(job.top_radius_nm), radius(job.foot_radius_nm)};
  return box;
}

/// A smaller box about what was found.
ProfileBox next_box(const ProfileBox& before, const ProfileBox& first, const ProfileFit& fit) {
  ProfileBox box = before;
  for (std::size_t k = 0; k < profile_numbers; ++k) {
    if (!(box.half[k] > 0)) continue;
    const double apart = 0.5 * std::abs(fit.left[k].value - fit.right[k].value);
    box.middle[k] = 0.5 * (fit.left[k].value + fit.right[k].value);
    const double error = std::max(fit.left[k].standard_error, fit.right[k].standard_error);
    // A number at the border, or one that the image hardly tells, needs more room.
    box.half[k] = std::max({fit.at_border ? before.half[k] : narrower * before.half[k],
                            apart + 0.2 * first.half[k], std::min(2 * error, first.half[k])});
    if (k == profile_top || k == profile_foot) box.middle[k] = std::max(box.middle[k], box.half[k]);
  }
  return box;
}

FeatureShape shape_of(FeatureKind kind, double pitch_nm, const ProfileNumbers& n) {
  return {kind,
          n[profile_width],
          pitch_nm,
          {n[profile_height], n[profile_angle], n[profile_top], n[profile_foot]}};
}

bool is_possible(FeatureKind kind, double pitch_nm, const ProfileNumbers& n) {
  if (!(n[profile_height] > 0)) return false;
  try {
    feature_mesh(shape_of(kind, pitch_nm, n), 1);
    return true;
  } catch (const InvalidInput&) {
    return false;
  }
}

/// The box's shapes; those that no feature can have are drawn towards the middle until one can.
std::vector<ProfileNumbers> shapes_of(const ProfileJob& job, const ProfileBox& box,
                                      double pitch_nm) {
  std::vector<ProfileNumbers> shapes = profile_design(box);
  if (!is_possible(job.kind, pitch_nm, box.middle))
    throw UsageError(
        "`profile.angle`",
        fmt::format("walls of {} at {:g} degrees, {} high, would meet in a {} {} wide{}",
                    job.material.name, box.middle[profile_angle],
                    format_length(box.middle[profile_height]), name(job.kind),
                    format_length(box.middle[profile_width]),
                    pitch_nm > 0 ? fmt::format(" at a pitch of {}", format_length(pitch_nm)) : ""),
        "Check `profile.height`, `profile.pitch` and the radii, or say steeper walls, as "
        "`profile.angle=89deg`");
  constexpr double nearer = 0.7;
  for (ProfileNumbers& shape : shapes)
    while (!is_possible(job.kind, pitch_nm, shape))
      for (std::size_t k = 0; k < profile_numbers; ++k)
        shape[k] = box.middle[k] + nearer * (shape[k] - box.middle[k]);
  return shapes;
}

/// How far beside the wall signals are simulated: to the middle of what is narrow, or as far as the
/// wall is felt.
WallSimulation simulation_of(const ProfileJob& job, const ProfileBox& box, double pitch_nm) {
  WallSimulation how{job.material, job.physics, job.energy_ev, job.spot_nm, job.signal};
  mc::Beam beam;
  beam.energy_ev = job.energy_ev;
  beam.spot_nm = job.spot_nm;
  const double reach = mc::reach_nm(mc::make_medium(job.material, job.physics), beam);
  double wall = 0;  // as far as the box's flattest goes from its middle
  for (const ProfileNumbers& n : profile_design(box))
    wall = std::max(wall, 0.5 * n[profile_height] / std::tan(n[profile_angle] * degree));
  const double felt = wall + std::min(most_beside_nm, 30 + job.height_nm + reach + 4 * job.spot_nm);
  const double smallest = box.middle[profile_width] - box.half[profile_width],
               widest = box.middle[profile_width] + box.half[profile_width];
  double inner = std::min(felt, 0.5 * smallest),
         outer = pitch_nm > 0 ? std::min(felt, 0.5 * (pitch_nm - widest)) : felt;
  if (job.kind == FeatureKind::edge) inner = outer = felt;
  const bool line = job.kind == FeatureKind::line;
  how.first_u_nm = line ? -outer : -inner;
  const double last = line ? inner : outer;
  how.step_nm = std::clamp(0.4 * job.sem.image.pitch_x_nm, 0.5, 2.0);
  how.places = std::max(8, static_cast<int>((last - how.first_u_nm) / how.step_nm) + 1);
  how.electrons = job.electrons;
  return how;
}

/// One library of cascades for all profiles, whoever asks.
class OneLibrary : public mc::LibrarySource {
 public:
  OneLibrary(mc::LibrarySource& source, int threads) : source_(&source), threads_(threads) {}
  std::shared_ptr<const mc::CascadeLibrary> library(const mc::CascadeSettings& settings,
                                                    std::size_t wanted, int,
                                                    const Watch& watch) override {
    const std::lock_guard lock(mutex_);
    if (!kept_ || wanted > size_) {
      size_ = std::max(wanted, cascades);
      kept_ = source_->library(settings, size_, threads_, watch);
    }
    return kept_;
  }

 private:
  mc::LibrarySource* source_;
  int threads_;
  std::size_t size_ = 0;
  std::shared_ptr<const mc::CascadeLibrary> kept_;
  std::mutex mutex_;
};

/// Simulated signals of a box's shapes, the middle one first.
struct Signals {
  ProfileBox box;
  double first_u_nm = 0, step_nm = 1;
  std::vector<ProfileNumbers> shapes;
  std::vector<std::vector<double>> signals;
  FinerMiddle middle;
};

/// By the same random numbers, so that they differ by their shapes alone, on the level of the
/// middle one's by many more.
Signals simulate_signals(const ProfileJob& job, const ProfileBox& box, double pitch_nm,
                         std::int64_t electrons, std::uint64_t seed, mc::LibrarySource& libraries,
                         const Watch& watch) {
  WallSimulation how = simulation_of(job, box, pitch_nm);
  how.electrons = electrons;
  how.threads = 1;
  how.seed = seed;
  Signals out{box, how.first_u_nm, how.step_nm, shapes_of(job, box, pitch_nm), {}, {}};
  out.signals.resize(out.shapes.size());
  Watch quiet;
  quiet.cancel = watch.cancel;
  // The middle one first, which brings the library of cascades.
  WallSimulation fine = how;
  fine.electrons = std::max(electrons, job.middle_electrons);
  fine.threads = job.threads;
  fine.seed = seed + 1;
  WallSignal middle =
      simulate_wall(shape_of(job.kind, pitch_nm, box.middle), fine, libraries, quiet);
  parallel_for(
      out.shapes.size(), job.threads,
      [&](std::size_t i, int) {
        out.signals[i] =
            simulate_wall(shape_of(job.kind, pitch_nm, out.shapes[i]), how, libraries, quiet).mean;
      },
      watch);
  for (double& e : middle.standard_error) e *= e;
  out.middle = {std::move(middle.mean), std::move(middle.standard_error)};
  return out;
}

ProfileLibrary library_of(const Signals& s) {
  return {s.box, s.first_u_nm, s.step_nm, s.shapes, s.signals, s.middle};
}

/// The box about the shape whose signal alone is most like the image, gain, offset and places
/// fitted: over a wide box no quadratic function holds.
ProfileBox matched_box(const ProfileJob& job, const ProfileData& data, const Signals& s,
                       const ProfileFitOptions& options, const Watch& watch) {
  std::vector<double> unlike(s.shapes.size());
  parallel_for(
      s.shapes.size(), job.threads,
      [&](std::size_t i, int) {
        ProfileFitOptions o = options;
        o.watch = {{}, watch.cancel};
        o.prior_mean = s.shapes[i];
        FinerMiddle own = s.middle;
        for (std::size_t u = 0; u < own.signal.size(); ++u)
          own.signal[u] += s.signals[i][u] - s.signals[0][u];
        const ProfileLibrary alone({s.shapes[i], {}}, s.first_u_nm, s.step_nm, {s.shapes[i]},
                                   {s.signals[i]}, own);
        unlike[i] = fit_profile(data, alone, o).discrepancy_share;
      },
      watch);
  ProfileBox box = s.box;
  const ProfileNumbers& best =
      s.shapes[static_cast<std::size_t>(std::ranges::min_element(unlike) - unlike.begin())];
  for (std::size_t k = 0; k < profile_numbers; ++k) {
    box.half[k] *= matched;
    if (k != profile_width) box.middle[k] = best[k];
    if (k == profile_top || k == profile_foot) box.middle[k] = std::max(box.middle[k], box.half[k]);
  }
  return box;
}

std::vector<std::string> reasons_of(const ProfileJob& job, const ProfileSummary& s) {
  std::vector<std::string> reasons;
  if (!s.fit.converged)
    reasons.push_back("the fit had not settled: look at the edges that were found, in panel.png");
  if (s.fit.at_border)
    reasons.push_back(
        "width or angle lie at the border of what was simulated: say `profile.angle` nearer to "
        "it, or a wider `profile.angle_range`");
  if (job.model_error > 0 && s.discrepancy_share > largest_discrepancy * job.model_error)
    reasons.push_back(
        fmt::format("no simulated profile is like the measured one: {:.0f} % of the contrast stay "
                    "unexplained. Check material, energy, signal, height and kind of the feature",
                    100 * s.discrepancy_share));
  return reasons;
}

}  // namespace

ProfileSummary run(const ProfileJob& job, const Reporter& reporter) {
  check(job);
  ProfileSummary s;
  const PlacedImage image =
      job.along_x && job.kind != FeatureKind::hole ? transposed(job.sem.image) : job.sem.image;
  ProfileData data;
  if (job.kind == FeatureKind::hole) {
    s.hole = find_hole(image);
    const PlacedImage around = unrolled(image, *s.hole);
    s.threshold = find_edges(around, FeatureKind::hole, job.threshold);
    // Of several rims the one that the search for the hole found.
    const auto nearest = std::ranges::min_element(s.threshold.edges, {}, [&](const ImageEdge& e) {
      return std::abs(e.place_nm - s.hole->radius_nm);
    });
    s.threshold.places_nm = {
        s.threshold.places_nm[static_cast<std::size_t>(nearest - s.threshold.edges.begin())]};
    s.threshold.edges = {*nearest};
    s.hole->radius_nm = nearest->place_nm;
    data = profile_data(image, *s.hole, nearest->to_nm);
  } else {
    s.threshold = find_edges(image, job.kind, job.threshold);
    data = profile_data(image, s.threshold.edges);
  }
  s.threshold_widths_nm = threshold_widths(s.threshold, job.kind);
  double width = 100;
  if (job.kind != FeatureKind::edge) {
    width = 0;
    for (const Measured& w : s.threshold_widths_nm)
      width += w.value / static_cast<double>(s.threshold_widths_nm.size());
  }
  s.pitch_nm = job.pitch_nm.value_or(s.threshold.pitch_nm);
  if (job.kind == FeatureKind::edge || job.kind == FeatureKind::hole) s.pitch_nm = 0;

  JobLibraries kept(job.cache, reporter.counting("cascades"), reporter.on_note);
  OneLibrary libraries(kept, job.threads);
  const ProfileBox first = first_box(job, width);
  ProfileFitOptions options;
  options.walls_alike = !job.walls_apart;
  options.model_error = job.model_error;
  options.prior_mean = first.middle;
  constexpr double unknown = std::numeric_limits<double>::infinity();
  options.prior_deviation = {unknown, job.height_error_nm, unknown, first.half[profile_top],
                             first.half[profile_foot]};
  ProfileBox box = first;
  for (int round = 0; round < job.rounds || (round < job.rounds + more_rounds && s.fit.at_border);
       ++round) {
    begin(reporter, "simulation");
    const bool last = round + 1 >= job.rounds;
    const Signals signals = simulate_signals(
        job, box, s.pitch_nm, (last ? finer : 1) * job.electrons,
        job.seed + static_cast<std::uint64_t>(round) * 1000, libraries, reporter.watch());
    s.simulated += static_cast<std::int64_t>(signals.shapes.size());
    begin(reporter, "fit");
    if (round == 0 && !last) {
      box = matched_box(job, data, signals, options, reporter.watch());
      continue;
    }
    options.watch = reporter.watch();
    s.fit = fit_profile(data, library_of(signals), options);
    s.discrepancy_share = s.fit.discrepancy_share;
    for (std::size_t e = 0; e < data.edges.size(); ++e)
      data.edges[e].place_nm = s.fit.edges[e].place_nm.value;
    box = next_box(box, first, s.fit);
  }
  // The wall at the left of a gap has its ground at the right.
  if (job.kind == FeatureKind::trench) std::swap(s.fit.left, s.fit.right);
  std::vector<double> errors;
  for (const FittedEdge& e : s.fit.edges) errors.push_back(e.place_nm.standard_error);
  s.measured_pitch_nm = pitch_of(data.edges, errors);
  s.reasons = reasons_of(job, s);
  if (!job.folder.empty()) s.written = write_profile(job, s, image);
  return s;
}

}  // namespace surf::workflow
