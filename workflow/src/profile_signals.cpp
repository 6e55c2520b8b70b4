// SPDX-License-Identifier: GPL-3.0-or-later
#include "profile_signals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/core/units.h"
#include "surf/mc/geometry/field_in_reach.h"
#include "surf/mc/physics/medium.h"
#include "wall_signal.h"

namespace surf::workflow {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double width_range = 0.08;     // half of the box, of the width
constexpr double most_beside_nm = 250;   // of ground and top that is simulated
constexpr double largest_corner = 0.35;  // of the height
constexpr std::size_t cascades = 40960;
constexpr double matched = 0.5;       // the box about the best match, over the first
constexpr double clearly_less = 0.7;  // of the squares of what shapes leave unexplained
constexpr double narrower = 0.35;     // a box over the one before

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
WallSimulation simulation_of(const ProfileJob& job, const ProfileView& view, const ProfileBox& box,
                             double pitch_nm, bool coarse) {
  WallSimulation how{job.material, job.physics, view.energy_ev, job.spot_nm};
  how.signal = view.signal;
  how.tilt_deg = view.tilt_deg, how.azimuth_deg = view.azimuth_deg;
  mc::Beam beam;
  beam.energy_ev = view.energy_ev;
  beam.spot_nm = job.spot_nm;
  const double reach = mc::reach_nm(mc::make_medium(job.material, job.physics), beam);
  const double aside =
      std::sin(view.tilt_deg * degree) * std::abs(std::cos(view.azimuth_deg * degree));
  double wall = 0;  // as far as the box's flattest goes from its middle
  for (const ProfileNumbers& n : profile_design(box))
    wall = std::max(wall, 0.5 * n[profile_height] / std::tan(n[profile_angle] * degree) +
                              0.5 * n[profile_height] * aside);
  // Ground is shaded by walls, top is not.
  const double felt = 30 + reach + 4 * job.spot_nm;
  double top = wall + std::min(most_beside_nm, felt),
         ground = wall + std::min(most_beside_nm, job.height_nm + felt);
  const double smallest = box.middle[profile_width] - box.half[profile_width],
               widest = box.middle[profile_width] + box.half[profile_width];
  const bool line = job.kind == FeatureKind::line;
  if (job.kind != FeatureKind::edge) {
    double &inside = line ? top : ground, &outside = line ? ground : top;
    inside = std::min(inside, 0.5 * smallest);
    if (pitch_nm > 0) outside = std::min(outside, 0.5 * (pitch_nm - widest));
  }
  how.first_u_nm = -ground;
  how.step_nm = std::clamp(0.4 * view.pixel_nm, 0.5, 2.0) * (coarse ? 2 : 1);
  how.places = std::max(8, static_cast<int>((top - how.first_u_nm) / how.step_nm) + 1);
  how.electrons = job.electrons;
  return how;
}

/// Across one wall.
Signals simulate_wall_signals(const ProfileJob& job, WallSimulation how, const ProfileBox& box,
                              double pitch_nm, std::int64_t electrons, std::uint64_t seed,
                              mc::LibrarySource& libraries, const Watch& watch) {
  how.electrons = electrons;
  how.threads = 1;
  how.seed = seed;
  Signals out{
      box, how.first_u_nm, how.step_nm, blurred_by_nm(how), shapes_of(job, box, pitch_nm), {}, {}};
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

}  // namespace

bool ProfileView::one_sided() const {
  constexpr double least = 1e-9;
  return (tilt_deg > 0 && std::abs(std::cos(azimuth_deg * degree)) > least) || by_side_detector();
}

bool ProfileView::sees_as(ProfileView other) const {
  other.cut_deg = cut_deg;
  return *this == other;
}

std::shared_ptr<const mc::CascadeLibrary> SharedLibraries::library(
    const mc::CascadeSettings& settings, std::size_t wanted, int, const Watch& watch) {
  const std::lock_guard lock(mutex_);
  auto kept = std::ranges::find(kept_, settings.start_energy_ev, &Kept::energy_ev);
  if (kept == kept_.end()) kept = kept_.insert(kept_.end(), {settings.start_energy_ev, 0, nullptr});
  if (!kept->library || wanted > kept->size) {
    kept->size = std::max(wanted, cascades);
    kept->library = source_->library(settings, kept->size, threads_, watch);
  }
  return kept->library;
}

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

ProfileBox next_box(const ProfileBox& before, const ProfileBox& first, const ProfileFit& fit) {
  ProfileBox box = before;
  for (std::size_t k = 0; k < profile_numbers; ++k) {
    if (!(box.half[k] > 0)) continue;
    const double apart = 0.5 * std::abs(fit.left[k].value - fit.right[k].value);
    box.middle[k] = 0.5 * (fit.left[k].value + fit.right[k].value);
    const double error = std::max(fit.left[k].standard_error, fit.right[k].standard_error);
    // A number at the border, or one that the image hardly tells, needs more room.
    const bool outside = std::abs(box.middle[k] - before.middle[k]) > before.half[k];
    box.half[k] = std::max({fit.at_border || outside ? before.half[k] : narrower * before.half[k],
                            apart + 0.2 * first.half[k], std::min(2 * error, first.half[k])});
    if (k == profile_top || k == profile_foot) box.middle[k] = std::max(box.middle[k], box.half[k]);
  }
  return box;
}

bool leaves(const ProfileFit& fit, const ProfileBox& box, const ProfileBox& first, double share) {
  for (const auto* wall : {&fit.left, &fit.right})
    for (std::size_t k = 0; k < profile_numbers; ++k) {
      const double off = (*wall)[k].value - box.middle[k],
                   end = box.middle[k] + std::copysign(box.half[k], off);
      if (std::abs(off) > std::max(share * box.half[k], (*wall)[k].standard_error) &&
          std::abs(end - first.middle[k]) < first.half[k])
        return true;
    }
  return false;
}

ProfileLibrary Signals::library() const {
  return {box, first_u_nm, step_nm, shapes, signals, middle, blurred_by_nm};
}

ProfileLibrary Signals::alone(std::size_t shape) const {
  FinerMiddle own = middle;
  for (std::size_t u = 0; u < own.signal.size(); ++u)
    own.signal[u] += signals[shape][u] - signals[0][u];
  return {{shapes[shape], {}}, first_u_nm, step_nm,      {shapes[shape]},
          {signals[shape]},    own,        blurred_by_nm};
}

WallSignals simulate_signals(const ProfileJob& job, const ProfileView& view, const ProfileBox& box,
                             double pitch_nm, std::int64_t electrons, std::uint64_t seed,
                             bool coarse, mc::LibrarySource& libraries, const Watch& watch) {
  WallSimulation how = simulation_of(job, view, box, pitch_nm, coarse);
  // A line's left wall has the ground at its left, a gap's right one.
  const bool both = view.one_sided() && job.kind != FeatureKind::edge;
  how.left = both && job.kind == FeatureKind::line;
  WallSignals out;
  out.left = simulate_wall_signals(job, how, box, pitch_nm, electrons, seed, libraries, watch);
  if (!both) return out;
  how.left = !how.left;
  out.right = simulate_wall_signals(job, how, box, pitch_nm, electrons, seed, libraries, watch);
  return out;
}

namespace {

/// Groups of images whose left and right walls may be the other way round: all tilted ones, all
/// others of detectors at a side, and each alone.
std::vector<std::vector<std::size_t>> swappable(const std::vector<ProfileSight>& sights,
                                                const std::vector<WallSignals>& signals) {
  std::vector<std::size_t> tilted, sided;
  std::vector<std::vector<std::size_t>> out;
  for (std::size_t k = 0; k < sights.size(); ++k)
    if (!signals[k].right.signals.empty()) (sights[k].tilt_deg > 0 ? tilted : sided).push_back(k);
  for (const auto& all : {tilted, sided}) {
    if (!all.empty()) out.push_back(all);
    if (all.size() > 1)
      for (const std::size_t k : all) out.push_back({k});
  }
  return out;
}

}  // namespace

MatchedShape matched_shape(const ProfileJob& job, const std::vector<ProfileSight>& sights,
                           const std::vector<WallSignals>& signals,
                           const ProfileFitOptions& options, const Watch& watch) {
  const Signals& first = signals.front().left;
  const auto unlike_by = [&](std::size_t shape, const std::vector<std::size_t>& swapped) {
    ProfileFitOptions o = options;
    o.watch = {{}, watch.cancel};
    o.prior_mean = first.shapes[shape];
    std::vector<ProfileLibrary> walls;
    walls.reserve(2 * signals.size());
    std::vector<ProfileSight> seen = sights;
    for (std::size_t k = 0; k < seen.size(); ++k) {
      walls.push_back(signals[k].left.alone(shape));
      seen[k].left = seen[k].right = &walls.back();
      if (signals[k].right.signals.empty()) continue;
      walls.push_back(signals[k].right.alone(shape));
      seen[k].right = &walls.back();
    }
    for (const std::size_t k : swapped) std::swap(seen[k].left, seen[k].right);
    double squares = 0;
    for (const SightFit& fit : fit_profile(seen, o).sights)
      squares += fit.unexplained_share * fit.unexplained_share;
    return squares;
  };
  const auto all = [&](const std::vector<std::size_t>& swapped) {
    std::vector<double> unlike(first.shapes.size());
    parallel_for(
        unlike.size(), job.threads, [&](std::size_t i, int) { unlike[i] = unlike_by(i, swapped); },
        watch);
    return unlike;
  };
  const std::vector<double> unlike = all({});
  MatchedShape out;
  out.box = first.box;
  const auto best = std::ranges::min_element(unlike);
  const ProfileNumbers& shape = first.shapes[static_cast<std::size_t>(best - unlike.begin())];
  // Corners matter too little for the best match to tell them.
  for (const std::size_t k : {profile_width, profile_height, profile_angle}) {
    out.box.half[k] *= matched;
    if (k != profile_width) out.box.middle[k] = shape[k];
  }
  double least = clearly_less * *best;
  for (const std::vector<std::size_t>& group : swappable(sights, signals))
    if (const double swapped = std::ranges::min(all(group)); swapped < least) {
      least = swapped;
      out.other_side = group;
    }
  return out;
}

}  // namespace surf::workflow
