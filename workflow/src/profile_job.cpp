// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/profile_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "chain_steps.h"
#include "job_libraries.h"
#include "profile_output.h"
#include "profile_signals.h"
#include "profile_surface.h"
#include "shading_doubt.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/plot.h"
#include "surf/workflow/signal_detectors.h"

namespace surf::workflow {
namespace {

constexpr double least_height_nm = 1;
constexpr double largest_discrepancy = 3;  // over the allowed one
constexpr double most_unexplained = 0.6;   // of the variation of mean profiles
constexpr double pitch_of_scans = 0.005;   // what scans' heights are calibrated to
// Of what images are uncertain by: from a height known so well they would take a tenth of its
// error.
constexpr double told_no_better = 0.5;
constexpr double far_off = 2.5;    // standard errors of what was said
constexpr int more_rounds = 3;     // where a number lies far from the middle of its box
constexpr std::int64_t finer = 4;  // electrons of the last box over those of the others

/// A quadrant as it lies in an image whose x and y are exchanged.
std::string transposed(const std::string& signal) {
  for (const auto& [from, to] : {std::pair("BSE-right", "BSE-top"),
                                 {"BSE-left", "BSE-bottom"},
                                 {"BSE-top", "BSE-right"},
                                 {"BSE-bottom", "BSE-left"}})
    if (signal == from) return to;
  if (signal != "SE" && signal != "BSE")
    throw UsageError("`profile.along_x`",
                     fmt::format("'{}' has sides, which lines along y are asked for", signal),
                     "Turn the image, or use the quadrants BSE-right, BSE-top and so on");
  return signal;
}

/// How each image looks at walls that run along y, the first included.
std::vector<ProfileView> views_of(const ProfileJob& job) {
  const std::vector<std::string> signals =
      signals_of(job.view_settings, job.views.size(), job.signal);
  for (const std::string& signal : signals) detectors_of(signal, "`reconstruction.view_signal`");
  std::vector<ProfileView> out{{job.sem.image.pitch_x_nm, 0, 0, job.energy_ev, job.signal}};
  const std::vector<ViewAngles> angles =
      angles_of(job.view_settings, job.views.size(), job.energy_ev);
  for (std::size_t k = 0; k < angles.size(); ++k)
    out.push_back({job.views[k].image.pitch_x_nm, angles[k].tilt_deg, angles[k].azimuth_deg,
                   angles[k].energy_ev, signals[k]});
  if (job.kind == FeatureKind::hole)
    for (ProfileView& view : out) view.cut_deg = std::exchange(view.azimuth_deg, 0);
  else if (job.along_x)
    for (ProfileView& view : out) {
      view.azimuth_deg = 90 - view.azimuth_deg;
      view.signal = transposed(view.signal);
    }
  return out;
}

void check(const ProfileJob& job) {
  if (job.material.name.empty())
    throw UsageError("`specimen.material`", "it is missing",
                     "Say what the specimen is made of, as `specimen.material=Si`");
  if (!(job.height_nm >= least_height_nm) && !job.scan)
    throw UsageError("`profile.height`", "no upright view shows how high walls are",
                     "Say it, as `profile.height=100nm`, or give a scan, as `reconstruction.afm`; "
                     "with tilted views a guess and `profile.height_error` do");
  detectors_of(job.signal, "`profile.signal`");
  const std::vector<ProfileView> views = views_of(job);
  if (!job.views.empty() && job.kind == FeatureKind::hole &&
      std::ranges::any_of(views, &ProfileView::by_side_detector))
    throw UsageError("`profile.kind`", "holes are measured by all of SE or BSE",
                     "Leave out one-sided signals");
  check_results(job.folder, job.picture);
  for (std::size_t k = 0; k <= job.views.size(); ++k) {
    const PlacedImage& image = k == 0 ? job.sem.image : job.views[k - 1].image;
    validate(image, "SEM image");
    if (std::abs(image.pitch_x_nm / image.pitch_y_nm - 1) > 1e-3)
      throw InvalidInput("SEM image", "its pixels are not square", "Resample it");
  }
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

double largest_tilt_deg(const ProfileJob& job) {
  double out = 0;
  for (const ViewAngles& view : angles_of(job.view_settings, job.views.size(), 0))
    out = std::max(out, view.tilt_deg);
  return out;
}

/// Why images tell the depth of a hole badly: its rim hides the bottom from a tilted beam, or
/// hardly leaves it in sight, or it is so deep that tiers of physics differ in how dark it is.
/// Empty: they do not, or it is told.
std::string bottom_badly_seen(const ProfileJob& job, double depth_nm, double width_nm) {
  constexpr double hardly = 0.75, well = 0.6;  // of the width; holes 11 and 25 of bench_profile
  constexpr double deep = 1.2;                 // hole 25, 1.6 deep, is found 1.2 deep
  if (job.kind != FeatureKind::hole || job.height_error_nm == 0) return {};
  const std::string size =
      fmt::format("{} deep and {} wide", format_length(depth_nm), format_length(width_nm));
  if (depth_nm > deep * width_nm)
    return fmt::format(
        "a hole {} is deeper than {:g} times its width: the darkness of such holes hangs on the "
        "physics, and one was found a quarter too shallow. Measure the depth by other means and "
        "give it as `profile.height`",
        size, deep);
  const double tilt_deg = largest_tilt_deg(job);
  const double share = depth_nm * std::tan(tilt_deg * degrees_to_radians) / width_nm;
  if (share < hardly) return {};
  return fmt::format(
      "the bottom of a hole {} is hardly in sight of a beam tilted by {:g} degrees, which runs "
      "{:.0f} % of the width to the side: tilt it to {:.0f} degrees",
      size, tilt_deg, 100 * share, std::atan(well * width_nm / depth_nm) / degrees_to_radians);
}

std::vector<std::string> reasons_of(const ProfileJob& job, const ProfileSummary& s) {
  std::vector<std::string> reasons;
  if (!s.fit.converged)
    reasons.push_back("the fit had not settled: look at the edges that were found, in panel.png");
  if (s.fit.at_border)
    reasons.push_back(
        "width or angle lie at the border of what was simulated: say `profile.angle` nearer to "
        "it, or a wider `profile.angle_range`");
  for (const std::size_t k : s.other_side)
    reasons.push_back(fmt::format(
        "image {} looks as from the other side: left walls are where right ones should be. {}",
        k + 1,
        s.fit.sights[k].tilt_deg.value > 0
            ? "Is `beam.azimuth` off by 180 degrees?"
            : "Is it the image of the detector opposite, or are two images exchanged?"));
  if (const std::string why =
          bottom_badly_seen(job, s.fit.left[profile_height].value, s.fit.left[profile_width].value);
      !why.empty())
    reasons.push_back(why);
  const double height_off = std::abs(s.fit.left[profile_height].value - job.height_nm);
  if (job.height_error_nm > 0 && height_off > far_off * job.height_error_nm)
    reasons.push_back(fmt::format(
        "the walls seem {} high, {:.1f} standard errors from what was said: check "
        "`profile.height`, "
        "and the tilts and azimuths of further images",
        format_length(s.fit.left[profile_height].value), height_off / job.height_error_nm));
  for (std::size_t k = 1; k < s.fit.sights.size(); ++k) {
    const double told = angles_of(job.view_settings, job.views.size(), 0)[k - 1].tilt_deg,
                 off = std::abs(s.fit.sights[k].tilt_deg.value - told);
    if (off > far_off * job.view_settings.tilt_error_deg)
      reasons.push_back(fmt::format(
          "view {} seems tilted by {:.2f} degrees, not {:g}: check `beam.tilt` and, where it is of "
          "the other side, `beam.azimuth`",
          k + 1, s.fit.sights[k].tilt_deg.value, told));
  }
  for (std::size_t k = 0; k < s.fit.sights.size(); ++k) {
    const double off = s.fit.sights[k].discrepancy_share;
    if (s.fit.sights[k].unexplained_share > most_unexplained)
      reasons.push_back(fmt::format(
          "the simulated signal explains next to nothing of image {}: is it of the signal and the "
          "kind of feature that were told?",
          k + 1));
    else if (job.model_error > 0 && off > largest_discrepancy * job.model_error)
      reasons.push_back(fmt::format(
          "no simulated profile is like the measured one{}: {:.0f} % of the contrast stay "
          "unexplained. Check material, energy, signal, height and kind of the feature{}",
          k == 0 ? "" : fmt::format(" of view {}", k + 1), 100 * off,
          k == 0 ? "" : ", tilt and azimuth"));
  }
  return reasons;
}

/// What is fitted of an image without a hole.
ProfileSight sight_of(const ProfileJob& job, const PlacedImage& image, const ProfileView& view,
                      const std::vector<ImageEdge>& edges) {
  ProfileSight sight{profile_data(image, edges), nullptr, nullptr, view.tilt_deg, view.azimuth_deg};
  if (view.tilt_deg > 0) sight.tilt_error_deg = job.view_settings.tilt_error_deg;
  return sight;
}

PlacedImage along_y(const ProfileJob& job, const PlacedImage& image) {
  return job.along_x && job.kind != FeatureKind::hole ? transposed(image) : image;
}

/// A hole and its rim by the threshold method: of several rims the one that the search for the hole
/// found.
struct HoleRim {
  Circle hole;
  ThresholdEdges threshold;
};
HoleRim rim_of_hole(const PlacedImage& image, double threshold) {
  HoleRim out{find_hole(image), {}};
  out.threshold = find_edges(unrolled(image, out.hole), FeatureKind::hole, threshold);
  auto& [edges, places, rows, cut_off, pitch] = out.threshold;
  const auto nearest = std::ranges::min_element(
      edges, {}, [&](const ImageEdge& e) { return std::abs(e.place_nm - out.hole.radius_nm); });
  places = {places[static_cast<std::size_t>(nearest - edges.begin())]};
  cut_off.clear();
  edges = {*nearest};
  out.hole.radius_nm = edges.front().place_nm;
  return out;
}

/// What a tilted image shows of a hole: where its rim's brightest places lie tells the middle to
/// some nanometres, because the beam sees more of the wall beyond.
ProfileSight sight_of_cut(const ProfileJob& job, const PlacedImage& image, const ProfileView& view,
                          double radius_nm) {
  constexpr double middle_off_nm = 8;
  const double tilt = view.tilt_deg * degrees_to_radians;
  Circle hole = find_hole(image);
  hole.radius_nm = radius_nm;
  ProfileSight sight{profile_data(image, HoleCut{hole, view.cut_deg, std::cos(tilt)}), nullptr,
                     nullptr, view.tilt_deg};
  sight.tilt_error_deg = job.view_settings.tilt_error_deg;
  sight.search_nm = middle_off_nm + 0.5 * (job.height_nm + job.height_error_nm) * std::sin(tilt);
  return sight;
}

/// The height and its standard error, as told or by the scan.
void find_height(ProfileJob& job, ProfileSummary& s, const Reporter& reporter) {
  if (job.height_nm > 0 || !job.scan) return;
  const Measured height = wall_height(*job.scan);
  s.scan_height_nm = {height.value,
                      std::hypot(height.standard_error, pitch_of_scans * height.value)};
  if (!(height.value >= least_height_nm))
    throw InvalidInput("AFM scan",
                       fmt::format("its levels are {} apart", format_length(height.value)),
                       "Say `profile.height`, or give a scan of these features");
  job.height_nm = height.value;
  job.height_error_nm = s.scan_height_nm->standard_error;
  reporter.note(
      fmt::format("height by the scan: {:.2f} ± {:.2f} nm", job.height_nm, job.height_error_nm));
}

}  // namespace

ProfileSummary run(const ProfileJob& given, const Reporter& reporter) {
  check(given);
  ProfileJob job = given;
  ProfileSummary s;
  find_height(job, s, reporter);
  const PlacedImage image = along_y(job, job.sem.image);
  const std::vector<ProfileView> views = views_of(job);
  std::vector<ProfileSight> sights;
  if (job.kind == FeatureKind::hole) {
    HoleRim rim = rim_of_hole(image, job.threshold);
    s.hole = rim.hole;
    s.threshold = std::move(rim.threshold);
    sights.push_back({profile_data(image, *s.hole, s.threshold.edges.front().to_nm)});
  } else {
    s.threshold = find_edges(image, job.kind, job.threshold);
    sights.push_back(sight_of(job, image, views[0], s.threshold.edges));
  }
  for (std::size_t k = 0; k < job.views.size(); ++k) {
    const PlacedImage view = along_y(job, job.views[k].image);
    if (job.kind == FeatureKind::hole && views[k + 1].tilt_deg > 0) {
      sights.push_back(sight_of_cut(job, view, views[k + 1], s.hole->radius_nm));
    } else if (job.kind == FeatureKind::hole) {
      const HoleRim rim = rim_of_hole(view, job.threshold);
      sights.push_back({profile_data(view, rim.hole, rim.threshold.edges.front().to_nm)});
    } else {
      // Another detector's image of the same scan shows the same edges, if fewer of them.
      const bool same_scan = views[k + 1].tilt_deg == 0 && view.placement() == image.placement() &&
                             view.values.width() == image.values.width() &&
                             view.values.height() == image.values.height();
      sights.push_back(sight_of(
          job, view, views[k + 1],
          same_scan ? s.threshold.edges : find_edges(view, job.kind, job.threshold).edges));
    }
  }
  for (std::size_t k = 0; k < sights.size(); ++k) {
    sights[k].shows_shading_alone = views[k].tilt_deg == 0 && views[k].by_side_detector();
    sights[k].signal = static_cast<int>(
        std::ranges::find_if(views, [&](const ProfileView& v) { return v.shows_as(views[k]); }) -
        views.begin());
  }
  s.threshold_widths_nm = threshold_widths(s.threshold, job.kind);
  double width = 100;
  if (job.kind != FeatureKind::edge) {
    width = 0;
    for (const Measured& w : s.threshold_widths_nm)
      width += w.value / static_cast<double>(s.threshold_widths_nm.size());
  }
  if (const std::string why = bottom_badly_seen(job, job.height_nm, width); !why.empty())
    reporter.note(why);
  s.pitch_nm = job.pitch_nm.value_or(s.threshold.pitch_nm);
  if (job.kind == FeatureKind::edge || job.kind == FeatureKind::hole) s.pitch_nm = 0;

  JobLibraries kept(job.cache, reporter.counting("cascades"), reporter.on_note);
  SharedLibraries libraries(kept, job.threads);
  const ProfileBox first = first_box(job, width);
  ProfileFitOptions options;
  options.walls_alike = !job.walls_apart || job.kind == FeatureKind::hole;
  options.one_feature = job.kind == FeatureKind::hole;
  options.model_error = job.model_error;
  options.prior_mean = first.middle;
  constexpr double unknown = std::numeric_limits<double>::infinity();
  options.prior_deviation = {unknown, job.height_error_nm, unknown, first.half[profile_top],
                             first.half[profile_foot]};
  const double doubt_nm = height_doubt_nm({job.kind, job.height_nm, largest_tilt_deg(job)});
  options.hold_height = job.height_error_nm > 0 && job.height_error_nm <= told_no_better * doubt_nm;
  if (const double shading_nm = shading_doubt_nm(job.height_nm); doubt_nm < shading_nm)
    options.shading_doubt_nm = shading_nm;
  ProfileBox box = first;
  int left = job.rounds, more = more_rounds;
  for (int round = 0; left > 0; ++round) {
    begin(reporter, "simulation");
    const bool last = left == 1;
    std::vector<WallSignals> signals;
    std::vector<std::size_t> like;  // the first image that sees walls as each does
    for (std::size_t k = 0; k < views.size(); ++k) {
      const auto part = [&](std::size_t i) {
        return static_cast<double>(i) / static_cast<double>(views.size());
      };
      like.push_back(static_cast<std::size_t>(
          std::ranges::find_if(views, [&](const ProfileView& v) { return v.sees_as(views[k]); }) -
          views.begin()));
      if (like[k] < k) {
        signals.push_back(signals[like[k]]);
        continue;
      }
      signals.push_back(
          simulate_signals(job, views[k], box, s.pitch_nm, (last ? finer : 1) * job.electrons,
                           job.seed + static_cast<std::uint64_t>(round) * 1000, round == 0 && !last,
                           libraries, reporter.watch().part(part(k), part(k + 1))));
      s.simulated += static_cast<std::int64_t>(signals.back().left.shapes.size() +
                                               signals.back().right.shapes.size());
    }
    begin(reporter, "fit");
    if (round == 0 && !last) {
      const MatchedShape match = matched_shape(job, sights, signals, options, reporter.watch());
      box = match.box;
      s.other_side = match.other_side;
      --left;
      continue;
    }
    std::vector<ProfileLibrary> walls;
    walls.reserve(2 * signals.size());
    for (std::size_t k = 0; k < signals.size(); ++k) {
      if (like[k] < k) {
        sights[k].left = sights[like[k]].left, sights[k].right = sights[like[k]].right;
        continue;
      }
      walls.push_back(signals[k].left.library());
      sights[k].left = sights[k].right = &walls.back();
      if (signals[k].right.shapes.empty()) continue;
      walls.push_back(signals[k].right.library());
      sights[k].right = &walls.back();
    }
    options.watch = reporter.watch();
    s.fit = fit_profile(sights, options);
    for (std::size_t k = 0; k < sights.size(); ++k)
      for (std::size_t e = 0; e < sights[k].data.edges.size(); ++e)
        sights[k].data.edges[e].place_nm = s.fit.sights[k].edges[e].place_nm.value;
    const bool far = s.fit.at_border || leaves(s.fit, box, first, last ? 0.8 : 0.5);
    if (far && more > 0) --more;
    else --left;
    box = next_box(box, first, s.fit);
  }
  for (const SightFit& fit : s.fit.sights)
    s.discrepancy_share = std::max(s.discrepancy_share, fit.discrepancy_share);
  for (auto* wall : {&s.fit.left, &s.fit.right})
    if (!options.hold_height)
      *wall = doubted_height(*wall, {job.height_nm, job.height_error_nm}, doubt_nm);
  std::vector<double> errors;
  for (const FittedEdge& e : s.fit.edges()) errors.push_back(e.place_nm.standard_error);
  s.measured_pitch_nm = pitch_of(sights.front().data.edges, errors);
  add_surface(image, s);
  if (job.along_x && job.kind != FeatureKind::hole) turn_surface(s);
  // The wall at the left of a gap has its ground at the right.
  if (job.kind == FeatureKind::trench) std::swap(s.fit.left, s.fit.right);
  s.reasons = reasons_of(job, s);
  if (!job.folder.empty()) s.written = write_profile(job, s);
  return s;
}

}  // namespace surf::workflow
