// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/refine_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "chain_steps.h"
#include "job_libraries.h"
#include "refine_agreement.h"
#include "refine_images.h"
#include "refine_output.h"
#include "relief_box.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/open_sheet.h"
#include "surf/mesh/remesh.h"
#include "surf/mesh/self_intersections.h"
#include "surf/mesh/triangle_tree.h"
#include "surf/mesh/vertex_normals.h"
#include "surf/reconstruction/view.h"
#include "surf/registration/find_shift.h"
#include "surf/workflow/compare_job.h"
#include "surf/workflow/signal_detectors.h"
#include "surf/workflow/view_settings.h"

namespace surf::workflow {
namespace {

constexpr double unrelated = 0.3;   // correlation of images that show different things
constexpr double largest_step = 2;  // of an amplitude, over its prior deviation
constexpr double settled = 0.7;     // over its deviation: nothing moves any more
constexpr double settled_of_prior = 0.02;
constexpr double settled_by_chance = 2;       // likewise
constexpr double shift_pixels = 3;            // what images' places may be off by
constexpr double as_good = 0.03;              // correlations that differ by less
constexpr double correlation_nm = 4;          // of what simulations are off by
constexpr double wide_correlations = 10;      // they are off as much over wide parts
constexpr double edges_per_spacing = 3;       // triangles between bumps
constexpr double bend_errors = 1;             // at a deviation from the mean, as much again
constexpr double blur_error_nm2 = 4;          // secondaries escape from within 2 nm more or less
constexpr std::uint64_t half_seed = 500'000;  // the random numbers of images' other halves
constexpr double most_unexplained = 0.3;
constexpr double beside_nm = 40;                          // what images show, the mesh is fine, too
constexpr double sheet_heights = 3, least_sheet_nm = 80;  // how far a sheet goes on
constexpr int few_modes = 4;            // times as many electrons for the effects of a few modes
constexpr double pixels_of_few = 1024;  // of larger images each pixel tells less of these
constexpr std::int64_t electrons_that_tell_places = 50;
// Levenberg's and Marquardt's damping, in units of the prior's weight, by what a step gives of what
// it promised.
constexpr double first_damping = 4, more_damping = 5, good_step = 0.25, very_good_step = 0.7;
constexpr int trials = 6;

void check(const RefineJob& job) {
  if (job.material.name.empty())
    throw UsageError("`specimen.material`", "it is missing",
                     "Say what the specimen is made of, as `specimen.material=Si`");
  if (job.images.empty())
    throw UsageError("`reconstruction.sem`", "no image is given",
                     "Name the SEM images, as `reconstruction.sem=left.tif`");
  const auto one_or_all = [&](std::size_t size, const char* subject) {
    if (size > 1 && size != job.images.size())
      throw UsageError(subject,
                       fmt::format("{} values are given for {} images", size, job.images.size()),
                       "Give one for each image in turn, or one for all");
  };
  one_or_all(job.tilts_deg.size(), "`beam.tilt`");
  one_or_all(job.azimuths_deg.size(), "`beam.azimuth`");
  one_or_all(job.signals.size(), "`reconstruction.view_signal`");
  for (const std::string& signal : job.signals)
    detectors_of(signal, "`reconstruction.view_signal`");
  for (const double tilt : job.tilts_deg)
    if (!(tilt >= 0 && tilt <= largest_view_tilt_deg))
      throw UsageError("`beam.tilt`", fmt::format("{:g} degrees are out of range", tilt),
                       fmt::format("Give 0 to {:g}deg; `beam.azimuth` says to which side",
                                   largest_view_tilt_deg));
  for (const SemInput& input : job.images) {
    validate(input.image, input.file.filename().string().c_str());
    const double pixels =
        static_cast<double>(input.image.values.width()) * input.image.values.height();
    constexpr double most_pixels = 512.0 * 512.0;
    if (pixels > most_pixels)
      throw InvalidInput(input.file.filename().string(),
                         "it has more than 512 x 512 pixels: every change is simulated in it",
                         "Cut out the feature, or take larger pixels");
  }
  check_results(job.folder, job.picture);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class Refinement {
 public:
  Refinement(const RefineJob& job, const Reporter& reporter)
      : job_(job), told_(reporter),
        kept_(job.cache, reporter.counting("cascades"), reporter.on_note),
        libraries_(kept_, job.threads), images_(job, libraries_), states_(job.images.size()),
        noise_(job.images.size()), chance_(job.images.size()) {
    for (const SemInput& input : job.images) {
      RefinedView view;
      view.placement = input.image.placement();
      view.measured = input.image.values;
      view.used = input.image.valid;
      view.tilt_error_deg = job.tilt_error_deg;
      flat_noise_.push_back(noise_of_flats(input.image));
      view.shift_error_nm = shift_pixels * view.placement.pitch_x_nm;
      views_.push_back(std::move(view));
    }
  }

  RefineSummary run() {
    begin(told_, "start");
    extend_start();
    find_places();
    const Box box = seen_box();
    const double pixel = smallest_pixel();
    edge_nm_ = job_.edge_nm > 0 ? job_.edge_nm : 2 * pixel;
    const double spacing = job_.spacing_nm > 0 ? job_.spacing_nm : edges_per_spacing * edge_nm_;
    Box region = box;
    region.lower_nm -= Vec3{beside_nm, beside_nm, 0};
    region.upper_nm += Vec3{beside_nm, beside_nm, 0};
    base_ = remesh(base_, {.edge_nm = edge_nm_, .region_nm = region, .watch = {{}, told_.cancel}});
    summary_.before = base_;
    const ModePrior prior{job_.start_error_nm, job_.height_error_nm, job_.bump_error_nm,
                          job_.bump_length_nm};
    begin(told_, "whole shape");
    const double blur_px = job_.start_error_nm / pixel;
    take_modes(smooth_modes(base_, relief_box(base_, box), SmoothKind::walls));
    for (const double share : {1.0, 0.0})
      rounds(job_.smooth_rounds, prior, 1000, share * blur_px, electrons_of_few());
    // The result so far is what bumps stand on.
    if (job_.bump_rounds > 0) {
      begin(told_, "bumps");
      base_ = moved(base_, modes_, amplitudes_);
      std::vector<MeshMode> all = smooth_modes(base_, relief_box(base_, seen_box()));
      std::vector<MeshMode> bumps = bump_modes(base_, in_view(), spacing);
      all.insert(all.end(), bumps.begin(), bumps.end());
      take_modes(std::move(all));
      rounds(job_.bump_rounds, prior, 100'000, 0, job_.effect_electrons);
    }
    take_errors_from_images(prior);
    finish();
    return std::move(summary_);
  }

 private:
  double smallest_pixel() const {
    double out = HUGE_VAL;
    for (const RefinedView& v : views_) out = std::min(out, v.placement.pitch_x_nm);
    return out;
  }

  /// Per pixel, for the effects of a few modes of the whole shape.
  std::int64_t electrons_of_few() const {
    double pixels = 0;
    for (const RefinedView& v : views_)
      pixels = std::max(pixels, static_cast<double>(v.measured.size()));
    const double times = few_modes * std::min(1.0, pixels_of_few / pixels);
    return std::llround(std::max(1.0, times) * static_cast<double>(job_.effect_electrons));
  }

  /// A sheet goes on beside what images show, where simulations can still take it as a half-space:
  /// the rim of an undercut line's end folds back, and does so more the wider it is.
  void extend_start() {
    base_ = job_.start;
    std::string reason;
    const double by_nm = sheet_heights * bounds(base_).size_nm().z + least_sheet_nm;
    std::optional<TriangleMesh> wide = extend_open_sheet(base_, by_nm, reason);
    if (wide && extend_open_sheet(*wide, by_nm, reason)) base_ = std::move(*wide);
  }

  void render(const TriangleMesh& mesh, std::size_t v, std::uint64_t seed) {
    render(mesh, v, seed, job_.electrons);
  }

  void render(const TriangleMesh& mesh, std::size_t v, std::uint64_t seed, std::int64_t electrons) {
    RefinedView& view = views_[v];
    const std::int64_t half = std::max<std::int64_t>(1, electrons / 2);
    const auto simulate = [&](std::uint64_t own) {
      return images_.render(mesh, v, states_[v], half, own, job_.threads, {{}, told_.cancel});
    };
    RefineImage first = simulate(seed), second = simulate(seed + half_seed);
    view.simulated = first.mean, chance_[v] = first.variance;
    for (std::size_t p = 0; p < view.simulated.size(); ++p) {
      view.simulated.data()[p] = 0.5 * (first.mean.data()[p] + second.mean.data()[p]);
      chance_[v].data()[p] = 0.25 * (first.variance.data()[p] + second.variance.data()[p]);
    }
    view.first_half = std::move(first.mean), view.second_half = std::move(second.mean);
    summary_.primaries += 2 * half * static_cast<std::int64_t>(view.simulated.size());
  }

  /// Gains and offsets; what pixels may be off by: noise, the simulation's chance, and what
  /// simulations are off by, which is alike in neighbours, so that each tells less.
  void weigh(std::size_t v) { weigh(v, job_.model_error); }

  void weigh(std::size_t v, double model_error) {
    RefinedView& view = views_[v];
    view.variance = Grid<double>(view.measured.width(), view.measured.height(), 1);
    fit_gain(view, states_[v]);
    const RefinedViewState& s = states_[v];
    noise_[v] =
        flat_noise_[v] ? *flat_noise_[v] : noise_of_rest(job_.images[v].image, view.simulated, s);
    std::vector<double> levels;
    for (const double y : view.simulated.data()) levels.push_back(s.gain * y + s.offset);
    const double middle = median(levels);
    const double alike = std::max(1.0, 2 * M_PI * correlation_nm * correlation_nm /
                                           (view.placement.pitch_x_nm * view.placement.pitch_y_nm));
    for (std::size_t p = 0; p < levels.size(); ++p) {
      const double off = model_error * (levels[p] - middle);
      view.variance.data()[p] = noise_[v].variance(levels[p]) + off * off * alike +
                                (flat_noise_[v] ? s.gain * s.gain * chance_[v].data()[p] : 0);
    }
    double squares = 0;
    for (const double level : levels) squares += (level - middle) * (level - middle);
    view.wide_error =
        model_error *
        std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, levels.size())));
    view.wide_nm = wide_correlations * correlation_nm;
    view.bend_error = bend_errors * model_error;
    view.blur_error_nm2 = model_error > 0 ? blur_error_nm2 : 0;
    fit_gain(view, states_[v]);
  }

  /// Noise by what simulations leave has their chance in it.
  double unexplained_of(std::size_t v, bool less_known_errors = false) const {
    return unexplained_share(views_[v], states_[v], noise_[v],
                             flat_noise_[v] ? Grid<double>{} : chance_[v], less_known_errors);
  }

  /// Errors of the shape by what simulations turn out to be off by, where that is more than was
  /// expected of them.
  void take_errors_from_images(const ModePrior& prior) {
    bool more = false;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      const double found = unexplained_of(v, true);
      if (found > job_.model_error) weigh(v, found), more = true;
    }
    if (!more) return;
    const ModeFit fit = fit_modes(views_, states_, amplitudes_, prior_covariance(modes_, prior));
    summary_.covariance = fit.covariance;
    information_ = fit.information;
  }

  /// Where each image looks: the best shift of it over what the start looks like.
  void find_places() {
    const std::int64_t few = std::min(job_.electrons, electrons_that_tell_places);
    for (std::size_t v = 0; v < views_.size(); ++v) {
      render(base_, v, job_.seed, few);
      const PlacedImage simulated{views_[v].placement, views_[v].simulated, {}};
      const std::vector<ImageShift> shifts = find_shifts(simulated, job_.images[v].image);
      if (!shifts.empty()) {
        const auto look_at = [&](double x_nm, double y_nm) {
          states_[v].shift_x_nm = x_nm, states_[v].shift_y_nm = y_nm;
          render(base_, v, job_.seed, few);
          return correlation(views_[v]);
        };
        const ImageShift& best = shifts.front();
        const double agreement = look_at(best.x_nm, best.y_nm);
        // What hardly tells, as a shift along a line, is left where it was.
        if (look_at(0, 0) < agreement - as_good && look_at(best.x_nm, 0) < agreement - as_good &&
            look_at(0, best.y_nm) < agreement - as_good)
          look_at(best.x_nm, best.y_nm);
        views_[v].shift_x_nm = states_[v].shift_x_nm;
        views_[v].shift_y_nm = states_[v].shift_y_nm;
      }
      if (const double agreement = correlation(views_[v]); !(agreement >= unrelated))
        throw InvalidInput(
            job_.images[v].file.filename().string(),
            fmt::format("it does not show this specimen from this side: its correlation with the "
                        "start's image is {:.2f}",
                        agreement),
            "Check `beam.tilt` and `beam.azimuth` of this image, its pixel size, and the start");
      render(base_, v, job_.seed);
      weigh(v);
      summary_.images.push_back({});
      summary_.images[v].unexplained_before = unexplained_of(v);
    }
  }

  /// The box of what images see.
  Box seen_box() const {
    const TriangleMesh now = amplitudes_.empty() ? base_ : moved(base_, modes_, amplitudes_);
    Box box;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      const Grid<Vec3> seen = images_.seen(now, v, states_[v]);
      for (const Vec3& p : seen.data())
        if (std::isfinite(p.x)) box.extend(p);
    }
    const Box all = bounds(now);
    box.lower_nm.z = all.lower_nm.z, box.upper_nm.z = all.upper_nm.z;
    return box;
  }

  void take_modes(std::vector<MeshMode> modes) {
    modes_ = std::move(modes);
    amplitudes_.assign(modes_.size(), 0);
  }

  /// Vertices that may move by themselves: those near what is seen.
  std::vector<bool> in_view() const {
    const Box box = seen_box();
    std::vector<bool> out;
    for (const Vec3& p : base_.vertices_nm)
      out.push_back(p.x > box.lower_nm.x && p.x < box.upper_nm.x && p.y > box.lower_nm.y &&
                    p.y < box.upper_nm.y);
    return out;
  }

  /// Images are compared as they are, or blurred, in rounds until nothing moves any more.
  void rounds(int count, const ModePrior& prior, std::uint64_t seed, double blur_px,
              std::int64_t electrons) {
    const std::vector<double> covariance = prior_covariance(modes_, prior);
    const std::uint64_t own = job_.seed + seed;
    damping_ = 0;
    look(own);
    for (int round = 0; round < count; ++round) {
      const Watch watch = told_.watch(double(round) / count, double(round + 1) / count);
      // Each round has random numbers of its own, so that one whose step failed is not repeated.
      const std::uint64_t of_round = own + 1 + 4 * static_cast<std::uint64_t>(round);
      images_.add_effects(base_, modes_, amplitudes_, states_, electrons, of_round, watch, views_,
                          summary_.primaries);
      const std::vector<RefinedView> seen = blurred_views(blur_px);
      const ModeFit fit = fit_modes(seen, states_, amplitudes_, covariance);
      summary_.covariance = fit.covariance;
      information_ = fit.information;
      // A step that was not to be had has not arrived, unless chance alone can have stopped it.
      const bool taken = take(fit, covariance, own, blur_px) && damping_ == 0;
      settled_ = fit.move < (taken ? settled : settled_by_chance) || fit.step < settled_of_prior;
      if (settled_) break;
    }
  }

  /// Renders all views of the present surface; gains and weights.
  void look(std::uint64_t seed) {
    const TriangleMesh now = moved(base_, modes_, amplitudes_);
    for (std::size_t v = 0; v < views_.size(); ++v) render(now, v, seed), weigh(v);
  }

  std::vector<RefinedView> blurred_views(double sigma_px) const {
    std::vector<RefinedView> out;
    for (const RefinedView& view : views_) out.push_back(blurred(view, sigma_px));
    return out;
  }

  /// Takes a step, damped until the images agree better and the mesh does not cut itself; whether
  /// one was taken.
  bool take(const ModeFit& undamped, const std::vector<double>& prior, std::uint64_t seed,
            double blur_px) {
    const std::vector<double> before = amplitudes_;
    const std::vector<RefinedViewState> states = states_;
    const std::vector<RefinedView> views = views_, seen = blurred_views(blur_px);
    const double misfit_before = misfit(seen, states_, amplitudes_, prior);
    for (int trial = 0; trial < trials; ++trial) {
      const ModeFit fit =
          damping_ > 0 ? fit_modes(seen, states, before, prior, damping_) : undamped;
      const double share = std::min(1.0, largest_step / std::max(fit.step, 1e-9));
      for (std::size_t m = 0; m < before.size(); ++m)
        amplitudes_[m] = before[m] + share * (fit.amplitudes_nm[m] - before[m]);
      const TriangleMesh now = moved(base_, modes_, amplitudes_);
      held_ = !find_self_intersections(now, {.limit = 1, .threads = job_.threads}).pairs.empty();
      double more = HUGE_VAL;
      if (!held_) {
        for (std::size_t v = 0; v < views_.size(); ++v) {
          states_[v] = part_way(states[v], fit.views[v], share);
          render(now, v, seed);  // the weights stay as before
          fit_gain(views_[v], states_[v]);
        }
        more = misfit(blurred_views(blur_px), states_, amplitudes_, prior) - misfit_before;
      }
      if (more > good_step * fit.promised)
        damping_ = std::max(first_damping, damping_ * more_damping);
      else if (more < very_good_step * fit.promised)
        damping_ = damping_ > first_damping ? damping_ / more_damping : 0;
      if (more < 0) {
        for (std::size_t v = 0; v < views_.size(); ++v) weigh(v);
        return true;
      }
    }
    amplitudes_ = before, states_ = states, views_ = views;
    return false;
  }

  static RefinedViewState part_way(RefinedViewState a, const RefinedViewState& b, double share) {
    a.shift_x_nm += share * (b.shift_x_nm - a.shift_x_nm);
    a.shift_y_nm += share * (b.shift_y_nm - a.shift_y_nm);
    a.tilt_x_deg += share * (b.tilt_x_deg - a.tilt_x_deg);
    a.tilt_y_deg += share * (b.tilt_y_deg - a.tilt_y_deg);
    a.bend += share * (b.bend - a.bend);
    a.blur_nm2 += share * (b.blur_nm2 - a.blur_nm2);
    a.wide.resize(b.wide.size(), 0);
    for (std::size_t k = 0; k < b.wide.size(); ++k) a.wide[k] += share * (b.wide[k] - a.wide[k]);
    return a;
  }

  void finish() {
    begin(told_, "result");
    summary_.mesh = moved(base_, modes_, amplitudes_);
    summary_.modes = modes_;
    summary_.deviation_nm = vertex_deviations(summary_.mesh, modes_, summary_.covariance);
    const std::vector<Vec3> normals = vertex_normals(summary_.mesh);
    for (std::size_t v = 0; v < summary_.mesh.vertices_nm.size(); ++v)
      summary_.displacement_nm.push_back(
          dot(summary_.mesh.vertices_nm[v] - summary_.before.vertices_nm[v], normals[v]));
    for (std::size_t k = 0; k < views_.size(); ++k) add_sensitivity(k);
    for (std::size_t v = 0; v < views_.size(); ++v) add_image(v);
    summary_.self_intersections =
        find_self_intersections(summary_.mesh, {.threads = job_.threads}).pairs.size();
    add_reasons();
    if (!job_.folder.empty()) summary_.written = write_refined(job_, summary_);
  }

  void add_sensitivity(std::size_t view) {
    std::vector<double> at(summary_.mesh.vertices_nm.size(), 0);
    for (std::size_t k = 0; k < modes_.size(); ++k) {
      if (!modes_[k].is_bump()) continue;
      const double told = std::sqrt(information_[view][k]);
      for (const MeshMode::Move& move : modes_[k].moves) at[move.vertex] += told * length(move.by);
    }
    // A bump reaches round corners; what it shows there is not of what is hidden.
    const std::vector<bool> in_sight =
        vertices_in_sight(summary_.mesh, images_.seen(summary_.mesh, view, states_[view]));
    for (std::size_t p = 0; p < at.size(); ++p)
      if (!in_sight[p]) at[p] = 0;
    summary_.sensitivity.push_back(std::move(at));
  }

  void add_image(std::size_t v) {
    render(summary_.mesh, v, job_.seed + 999'983);
    weigh(v);
    RefinedImage& out = summary_.images[v];
    out.state = states_[v];
    out.tilt_deg = images_.tilt_deg(v, states_[v]);
    out.azimuth_deg = images_.azimuth_deg(v, states_[v]);
    out.simulated = views_[v].simulated;
    out.residual = views_[v].measured;
    for (std::size_t p = 0; p < out.simulated.size(); ++p) {
      double& s = out.simulated.data()[p];
      s = states_[v].gain * s + states_[v].offset;
      out.residual.data()[p] =
          (out.residual.data()[p] - s) / std::sqrt(views_[v].variance.data()[p]);
    }
    out.unexplained = unexplained_of(v);
    const Grid<Vec3> seen = images_.seen(summary_.mesh, v, states_[v]);
    const TriangleTree tree(summary_.mesh);
    out.sensitivity_per_nm = Grid<double>(seen.width(), seen.height(), 0);
    for (std::size_t p = 0; p < seen.size(); ++p) {
      const Vec3& place = seen.data()[p];
      if (!std::isfinite(place.x)) continue;
      const Triangle& t = summary_.mesh.triangles[tree.closest(place).triangle];
      const auto apart = [&](std::uint32_t corner) {
        return length(summary_.mesh.vertices_nm[corner] - place);
      };
      out.sensitivity_per_nm.data()[p] =
          summary_.sensitivity[v][*std::ranges::min_element(t, {}, apart)];
    }
  }

  void add_reasons() {
    if (!settled_)
      summary_.reasons.push_back(
          "the shape had not settled: begin with a shape that is nearer, or give more rounds");
    if (held_)
      summary_.reasons.push_back("the surface would have cut itself: it was held where it did not");
    for (std::size_t v = 0; v < views_.size(); ++v)
      if (summary_.images[v].unexplained > most_unexplained)
        summary_.reasons.push_back(fmt::format(
            "image {} stays unexplained: {:.0f} % of its contrast. Check its signal, tilt, azimuth "
            "and the start",
            v + 1, 100 * summary_.images[v].unexplained));
  }

  const RefineJob& job_;
  const Reporter& told_;
  JobLibraries kept_;
  SharedLibraries libraries_;
  RefineImages images_;
  std::vector<RefinedView> views_;
  std::vector<RefinedViewState> states_;
  std::vector<std::optional<SemNoise>> flat_noise_;
  std::vector<SemNoise> noise_;
  std::vector<Grid<double>> chance_;  // of the simulated images: variances of yields
  TriangleMesh base_;
  double edge_nm_ = 0;
  std::vector<MeshMode> modes_;
  std::vector<double> amplitudes_;
  std::vector<std::vector<double>> information_;
  bool settled_ = false, held_ = false;
  double damping_ = 0;
  RefineSummary summary_;
};

}  // namespace

TriangleMesh read_refined_start(const std::filesystem::path& file, const io::MeshUnit& unit,
                                std::vector<std::string>& notes) {
  ComparedSurface surface = read_compared_surface(file, {}, unit, notes);
  if (auto* mesh = std::get_if<TriangleMesh>(&surface)) return std::move(*mesh);
  return height_field_sheet(std::get<MeasuredSurface>(surface).field);
}

RefineSummary run(const RefineJob& job, const Reporter& reporter) {
  check(job);
  return Refinement(job, reporter).run();
}

}  // namespace surf::workflow
