// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/refine_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "chain_steps.h"
#include "job_libraries.h"
#include "refine_images.h"
#include "refine_output.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/plot.h"
#include "surf/mesh/open_sheet.h"
#include "surf/mesh/remesh.h"
#include "surf/mesh/self_intersections.h"
#include "surf/mesh/triangle_tree.h"
#include "surf/mesh/vertex_normals.h"
#include "surf/reconstruction/view.h"
#include "surf/registration/find_shift.h"
#include "surf/sem/estimate_sem_noise.h"
#include "surf/workflow/signal_detectors.h"
#include "surf/workflow/view_settings.h"

namespace surf::workflow {
namespace {

constexpr double unrelated = 0.3;        // correlation of images that show different things
constexpr double largest_step = 2;       // of an amplitude, over its prior deviation
constexpr double settled = 0.03;         // likewise: nothing moves any more
constexpr double free_shift_nm = 1000;   // prior of images' places
constexpr double correlation_nm = 4;     // of what simulations are off by
constexpr double edges_per_spacing = 3;  // triangles between bumps
constexpr double most_unexplained = 0.5;
constexpr double blur_nm = 10;  // of the first round: walls may be off by as much
constexpr double fade_heights = 1.5, least_fade_nm = 40;  // beside what images show
constexpr int halvings = 6;                               // of steps that make a mesh cut itself

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
  std::error_code ignored;
  if (std::filesystem::exists(job.folder, ignored) &&
      !std::filesystem::is_directory(job.folder, ignored))
    throw UsageError("`output`", fmt::format("{} is no folder", job.folder.string()),
                     "Name a folder for all results, as `output=result`");
  if (job.picture && !job.folder.empty()) io::check_plot_target(job.folder / "panel.png");
}

/// Noise of an image, by its flat places, or by what a simulated image leaves.
SemNoise noise_of(const PlacedImage& image, const Grid<double>& simulated,
                  const RefinedViewState& s) {
  try {
    return estimate_sem_noise(image).noise;
  } catch (const InvalidInput&) {
    Grid<double> mean = simulated;
    for (double& v : mean.data()) v = s.gain * v + s.offset;
    return fit_sem_noise(image.values, mean, image.valid).noise;
  }
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double correlation(const RefinedView& v) {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t p = 0; p < v.measured.size(); ++p) {
    if (!v.used.includes(p)) continue;
    const double x = v.measured.data()[p], y = v.simulated.data()[p];
    ++n, a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
  }
  const double va = aa - a * a / n, vb = bb - b * b / n;
  return va > 0 && vb > 0 ? (ab - a * b / n) / std::sqrt(va * vb) : 0;
}

/// Rms of what gain and offset leave, less what noise makes of it, over the signal's deviation.
double unexplained_share(const RefinedView& v, const RefinedViewState& s, const SemNoise& noise) {
  double n = 0, left = 0, sum = 0, squares = 0, chance = 0;
  for (std::size_t p = 0; p < v.measured.size(); ++p) {
    if (!v.used.includes(p)) continue;
    const double mean = s.gain * v.simulated.data()[p] + s.offset,
                 off = v.measured.data()[p] - mean;
    ++n, left += off * off, chance += noise.variance(mean);
    sum += mean, squares += mean * mean;
  }
  const double contrast = squares / n - sum * sum / (n * n);
  return contrast > 0 ? std::sqrt(std::max(0.0, (left - chance) / n) / contrast) : 1;
}

class Refinement {
 public:
  Refinement(const RefineJob& job, const Reporter& reporter)
      : job_(job), told_(reporter),
        kept_(job.cache, reporter.counting("cascades"), reporter.on_note),
        libraries_(kept_, job.threads), images_(job, libraries_), states_(job.images.size()),
        noise_(job.images.size()) {
    for (const SemInput& input : job.images) {
      RefinedView view;
      view.placement = input.image.placement();
      view.measured = input.image.values;
      view.used = input.image.valid;
      view.tilt_error_deg = job.tilt_error_deg;
      view.shift_error_nm = free_shift_nm;
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
    // Where modes fade away, too: coarse triangles would cut each other there.
    Box region = box;
    region.lower_nm -= Vec3{fade_nm(), fade_nm(), 0},
        region.upper_nm += Vec3{fade_nm(), fade_nm(), 0};
    base_ = remesh(base_, {.edge_nm = edge_nm_, .region_nm = region, .watch = {{}, told_.cancel}});
    summary_.before = base_;
    const ModePrior prior{job_.start_error_nm, job_.bump_error_nm, job_.bump_length_nm};
    begin(told_, "whole shape");
    modes_ = smooth_modes(base_, inner_box(box), fade_nm());
    rounds(job_.smooth_rounds, prior, 0, true);
    // The result so far is what bumps stand on.
    const TriangleMesh shaped = moved(base_, modes_, amplitudes_);
    if (job_.bump_rounds > 0) {
      begin(told_, "bumps");
      base_ = shaped;
      modes_ = smooth_modes(base_, inner_box(seen_box()), fade_nm());
      std::vector<MeshMode> bumps = bump_modes(base_, in_view(), spacing);
      modes_.insert(modes_.end(), bumps.begin(), bumps.end());
      rounds(job_.bump_rounds, prior, 100'000, false);
    }
    finish();
    return std::move(summary_);
  }

 private:
  double smallest_pixel() const {
    double out = HUGE_VAL;
    for (const RefinedView& v : views_) out = std::min(out, v.placement.pitch_x_nm);
    return out;
  }

  /// Over how far beside the images what smooth modes do fades away.
  double fade_nm() const { return fade_heights * bounds(base_).size_nm().z + least_fade_nm; }

  /// A sheet gets a rim that nothing moves.
  void extend_start() {
    base_ = job_.start;
    std::string reason;
    if (std::optional<TriangleMesh> wide = extend_open_sheet(base_, 2 * fade_nm(), reason))
      base_ = std::move(*wide);
  }

  void render(const TriangleMesh& mesh, std::size_t v, std::uint64_t seed) {
    RefineImage image =
        images_.render(mesh, v, states_[v], job_.electrons, seed, job_.threads, {{}, told_.cancel});
    views_[v].simulated = std::move(image.mean);
    views_[v].variance = std::move(image.variance);
    summary_.primaries += job_.electrons * static_cast<std::int64_t>(views_[v].simulated.size());
  }

  /// Gains and offsets; what pixels may be off by: noise, the simulation's chance, and what
  /// simulations are off by, which is alike in neighbours, so that each tells less.
  void weigh(std::size_t v) {
    RefinedView& view = views_[v];
    const Grid<double> chance = view.variance;
    std::ranges::fill(view.variance.data(), 1.0);
    fit_gain(view, states_[v]);
    const RefinedViewState& s = states_[v];
    noise_[v] = noise_of(job_.images[v].image, view.simulated, s);
    std::vector<double> levels;
    for (const double y : view.simulated.data()) levels.push_back(s.gain * y + s.offset);
    const double middle = median(levels);
    const double alike = std::max(1.0, 2 * M_PI * correlation_nm * correlation_nm /
                                           (view.placement.pitch_x_nm * view.placement.pitch_y_nm));
    for (std::size_t p = 0; p < levels.size(); ++p) {
      const double off = job_.model_error * (levels[p] - middle);
      view.variance.data()[p] =
          noise_[v].variance(levels[p]) + s.gain * s.gain * chance.data()[p] + off * off * alike;
    }
    fit_gain(view, states_[v]);
  }

  /// Where each image looks: the best shift of it over what the start looks like.
  void find_places() {
    for (std::size_t v = 0; v < views_.size(); ++v) {
      render(base_, v, job_.seed);
      const PlacedImage simulated{views_[v].placement, views_[v].simulated, {}};
      const std::vector<ImageShift> shifts = find_shifts(simulated, job_.images[v].image);
      if (!shifts.empty() && (shifts.front().x_nm != 0 || shifts.front().y_nm != 0)) {
        // The nearest of those that agree about as well, as on gratings.
        const ImageShift* best = &shifts.front();
        for (const ImageShift& s : shifts)
          if (s.correlation > shifts.front().correlation - 0.05 &&
              std::hypot(s.x_nm, s.y_nm) < std::hypot(best->x_nm, best->y_nm))
            best = &s;
        states_[v].shift_x_nm = best->x_nm, states_[v].shift_y_nm = best->y_nm;
        render(base_, v, job_.seed);
      }
      if (const double agreement = correlation(views_[v]); !(agreement >= unrelated))
        throw InvalidInput(
            job_.images[v].file.filename().string(),
            fmt::format("it does not show this specimen from this side: its correlation with the "
                        "start's image is {:.2f}",
                        agreement),
            "Check `beam.tilt` and `beam.azimuth` of this image, its pixel size, and the start");
      weigh(v);
      summary_.images.push_back({});
      summary_.images[v].unexplained_before = unexplained_share(views_[v], states_[v], noise_[v]);
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

  /// The box that polynomials are of: as high as the relief within what is seen.
  Box inner_box(const Box& seen) const {
    Box out;
    for (const Vec3& p : base_.vertices_nm)
      if (p.x >= seen.lower_nm.x && p.x <= seen.upper_nm.x && p.y >= seen.lower_nm.y &&
          p.y <= seen.upper_nm.y)
        out.extend(p);
    return out.empty() ? seen : out;
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

  /// `coarse`: with images that are blurred less from round to round, and not in the last.
  void rounds(int count, const ModePrior& prior, std::uint64_t seed, bool coarse) {
    amplitudes_.assign(modes_.size(), 0);
    const std::vector<double> covariance = prior_covariance(modes_, prior);
    for (int round = 0; round < count; ++round) {
      const Watch watch = told_.watch(double(round) / count, double(round + 1) / count);
      const std::uint64_t own = job_.seed + seed + 1000 * static_cast<std::uint64_t>(round + 1);
      const TriangleMesh now = moved(base_, modes_, amplitudes_);
      for (std::size_t v = 0; v < views_.size(); ++v) render(now, v, own), weigh(v);
      images_.add_effects(base_, modes_, amplitudes_, states_, own + 1, watch, views_,
                          summary_.primaries);
      const double blur_px =
          coarse ? blur_nm * (count - 1 - round) / (std::max(1, count - 1) * smallest_pixel()) : 0;
      std::vector<RefinedView> seen;
      for (const RefinedView& view : views_) seen.push_back(blurred(view, blur_px));
      ModeFit fit = fit_modes(seen, states_, amplitudes_, covariance);
      const double share = std::min(1.0, largest_step / std::max(fit.step, 1e-9));
      take(fit, share);
      summary_.covariance = fit.covariance;
      information_ = fit.information;
      converged_ = fit.step < 0.5;
      if (fit.step < settled && blur_px == 0) break;
    }
  }

  /// Takes a step, or so much of it that the mesh does not cut itself.
  void take(const ModeFit& fit, double share) {
    const std::vector<double> before = amplitudes_;
    for (int k = 0; k <= halvings; ++k, share *= 0.5) {
      for (std::size_t m = 0; m < before.size(); ++m)
        amplitudes_[m] = before[m] + share * (fit.amplitudes_nm[m] - before[m]);
      if (find_self_intersections(moved(base_, modes_, amplitudes_),
                                  {.limit = 1, .threads = job_.threads})
              .pairs.empty()) {
        states_ = fit.views;
        return;
      }
    }
    amplitudes_ = before;
    held_ = true;
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
    out.unexplained = unexplained_share(views_[v], states_[v], noise_[v]);
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
    if (!converged_)
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
  std::vector<SemNoise> noise_;
  TriangleMesh base_;
  double edge_nm_ = 0;
  std::vector<MeshMode> modes_;
  std::vector<double> amplitudes_;
  std::vector<std::vector<double>> information_;
  bool converged_ = false, held_ = false;
  RefineSummary summary_;
};

}  // namespace

RefineSummary run(const RefineJob& job, const Reporter& reporter) {
  check(job);
  return Refinement(job, reporter).run();
}

}  // namespace surf::workflow
