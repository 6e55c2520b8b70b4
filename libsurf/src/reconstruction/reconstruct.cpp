// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/reconstruction/reconstruct.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "check_inputs.h"
#include "depth_doubt.h"
#include "descent.h"
#include "gauss_newton.h"
#include "gaussian_basis.h"
#include "height_intervals.h"
#include "image_guides.h"
#include "initial_surface.h"
#include "map_deviation.h"
#include "posterior.h"
#include "residual_report.h"
#include "surf/core/error.h"

namespace surf {
namespace {

using namespace reconstruction;

constexpr int least_pixels = 256;         // 16 x 16
constexpr double share_of_scales = 0.75;  // share of the time; the uncertainty takes the rest
// Factor of the tolerance while the prior may still change.
constexpr double coarsely = 20;
// Factor of the likely curvature on rough ground: features that neither image determines are not
// white.
constexpr double rough_looseness = 3;
constexpr double worth_loosening = 1.3;
constexpr double soft_px = 1;
constexpr int margin_px = 12;  // of the surface around the SEM image, and of a view's heights

/// The state of a running reconstruction.
class Work {
 public:
  Work(const AfmData* afm, const SemData* sem, const std::vector<SemView>& views,
       const ReconstructionOptions& options)
      : afm_(afm), sem_(sem), options_(options),
        margin_(sem && (afm || !views.empty()) ? margin_px : 0),
        objective_{.prior = CurvaturePrior(1, 1), .frame = frame_of(afm, sem, margin_)} {
    const SurfaceFrame& frame = objective_.frame;
    at_.surface_to_afm = sem ? sem->sem_to_afm : Affine{};
    at_.z_nm = Grid<double>(frame.width, frame.height);
    if (afm) {
      const HeightField outside = eroded(*afm, options.threads);
      at_.z_nm = on_frame(outside, frame, at_.surface_to_afm);
      objective_.afm.emplace(*afm, outside, frame, at_.surface_to_afm, options.threads);
      if (objective_.afm->used_pixels() < least_pixels)
        throw InvalidInput(
            "registration",
            fmt::format("{} AFM pixels lie in the SEM image", objective_.afm->used_pixels()),
            "The images must overlap by 256 pixels at least: check the transform and the pixel "
            "sizes");
    } else {
      objective_.anchor_per_nm2 = 1e-6;
      objective_.start = at_.z_nm;
    }
    start_ = at_.z_nm;
    if (sem) {
      objective_.sem.emplace(*sem, frame, margin_, margin_, options.threads);
      at_.mixture = {sem->gains, sem->offset, 0, sem->film ? usual_film_nm : 0};
      objective_.fit_film = sem->film.has_value();
    }
    for (const SemView& view : views) {
      objective_.views.emplace_back(view, frame, at_.z_nm, margin_px, options.threads);
      at_.views.push_back({{}, {view.sem.gains, view.sem.offset, 0, 0}});
    }
    objective_.fit_map = afm && sem && options.refine_transform;
    objective_.fit_drift = objective_.fit_map && options.refine_drift;
    objective_.fit_mixture = sem && options.refine_calibration;
    objective_.fit_tip = afm && sem && options.refine_tip &&
                         options.method == ReconstructionMethod::gauss_newton &&
                         objective_.afm->tip_can_change();
    rough_ = options.rough_ground;
    curvature_ = options.curvature_prior_per_nm > 0 ? options.curvature_prior_per_nm : 1e-3;
    set_prior(curvature_);
  }

  Reconstruction run(ReconstructionJournal* journal) {
    const std::vector<double> scales =
        options_.scales_px.empty()
            ? default_scales_px(options_.method, objective_.frame.width, objective_.frame.height)
            : options_.scales_px;
    if (journal)
      if (const auto found = journal->found()) take(*found);
    for (std::size_t i = reports_.size(); i < scales.size(); ++i) {
      const double share =
          (options_.uncertainty ? share_of_scales : 1) / static_cast<double>(scales.size());
      const auto done = static_cast<double>(i);
      scale(scales[i], i == 0, i + 1 == scales.size(),
            options_.watch.part(done * share, (done + 1) * share));
      if (journal) journal->keep(state());
    }
    return result();
  }

 private:
  void take(const ReconstructionState& s) {
    at_.z_nm = s.surface.z_nm;
    at_.surface_to_afm = s.sem_to_afm;
    at_.drift_px = s.scan_drift_px;
    std::copy_n(s.tip_change.begin(), std::min(s.tip_change.size(), at_.tip.size()),
                at_.tip.begin());
    erode_again();
    if (sem_) {
      at_.mixture = {s.gains, s.offset, s.blur_px2, s.film_nm};
    }
    for (std::size_t v = 0; v < at_.views.size() && v < s.views.size(); ++v) {
      std::copy_n(s.views[v].pose_change.begin(),
                  std::min<std::size_t>(s.views[v].pose_change.size(), pose_numbers),
                  at_.views[v].pose.begin());
      at_.views[v].mixture = {s.views[v].gains, s.views[v].offset, 0, 0};
    }
    reports_ = s.scales;
    if (!reports_.empty()) set_prior(reports_.back().curvature_prior_per_nm);
    converged_ = reports_.empty() || reports_.back().ended == "converged";
  }

  ReconstructionState state() const {
    ReconstructionState s;
    s.surface = objective_.frame.field(at_.z_nm);
    s.sem_to_afm = at_.surface_to_afm;
    s.scan_drift_px = at_.drift_px;
    s.scales = reports_;
    if (sem_) {
      s.gains = at_.mixture.gains;
      s.offset = at_.mixture.offset;
      s.blur_px2 = at_.mixture.blur_px2;
      s.film_nm = at_.mixture.film_nm;
    }
    for (const ViewUnknowns& v : at_.views)
      s.views.push_back({{v.pose.begin(), v.pose.end()}, v.mixture.gains, v.mixture.offset});
    if (objective_.fit_tip) s.tip_change.assign(at_.tip.begin(), at_.tip.end());
    return s;
  }

  /// Renews the heights beyond the surface: the scan eroded by the current tip. A scan eroded by a
  /// blunter tip would hold the fitted tip back, because its dilation by a sharper tip lies below
  /// the scan.
  void erode_again() {
    if (!objective_.fit_tip) return;
    AfmData now = *afm_;
    now.tip = objective_.afm->tip(at_.tip);
    objective_.afm->set_outside(eroded(now, options_.threads));
  }

  void scale(double sigma_px, bool first, bool last, const Watch& watch) {
    watch.report(0, 1);
    DescentOptions o;
    // A surface that is still too smooth would make the spot seem too sharp.
    objective_.fit_blur = sem_ && options_.refine_spot && last;
    const bool newton = options_.method == ReconstructionMethod::gauss_newton;
    o.iterations = options_.iterations > 0 ? options_.iterations : newton ? 60 : 200;
    o.tolerance = (options_.tolerance > 0 ? options_.tolerance
                   : newton               ? 5e-4
                                          : 5e-5) *
                  static_cast<double>(pixels());
    o.threads = options_.threads;
    o.precision = precision();
    o.watch = watch;
    DescentReport d;
    if (newton) {
      if (first) at_.z_nm = GaussianBasis(1.5, options_.threads).sum(at_.z_nm);
      set_prior(curvature_ * sigma_px * sigma_px);
      if (last) look_around();
      fit_few(objective_, at_, watch);
      const double settled = o.tolerance;
      const int most = o.iterations;
      const auto go_on = [&](double from, double to) {
        o.iterations = most - d.iterations;
        o.watch = watch.part(from, to);
        continue_with(d, gauss_newton(objective_, at_, o));
      };
      o.tolerance *= coarsely;
      go_on(0, last ? 0.5 : 1);
      if (last) {
        while (d.iterations < most && options_.curvature_prior_per_nm == 0 && loosen_prior())
          go_on(0.5, 0.5);
        look_around();
        o.tolerance = settled;
        go_on(0.5, 1);
      }
    } else {
      d = descend(objective_, at_, sigma_px, first, options_.method, o, options_.threads);
      fit_few(objective_, at_, watch);
    }
    erode_again();
    const Objective::State s = objective_.evaluate(at_);
    ScaleReport r{sigma_px,
                  objective_.prior.curvature_per_nm(),
                  s.afm_value,
                  s.sem_value,
                  s.prior_value,
                  d.gradient_norm,
                  d.iterations,
                  d.evaluations,
                  d.products,
                  d.factors,
                  d.double_factors,
                  d.ended,
                  {},
                  {}};
    if (s.afm) r.afm_residual = judge(afm_white(s), objective_.afm->used());
    if (s.sem) r.sem_residual = judge(sem_white(*objective_.sem, *s.sem), objective_.sem->used());
    converged_ = d.ended == "converged";
    reports_.push_back(r);
  }

  /// Renews what the discrepancy follows, at the current surface.
  void look_around() {
    if (!afm_ || !sem_ || !(sem_->guided_deviation > 0)) return;
    const Grid<double> simulated = objective_.sem->evaluate(at_.z_nm, at_.mixture).simulated;
    std::vector<Grid<double>> guides = image_guides(at_.z_nm, objective_.frame.pitch_nm, simulated,
                                                    objective_.sem->used(), options_.threads);
    const double each =
        sem_->guided_deviation / std::sqrt(std::max<double>(1, static_cast<double>(guides.size())));
    objective_.sem->follow(std::move(guides), each);
  }

  void set_prior(double curvature_per_nm) {
    objective_.prior = CurvaturePrior(objective_.frame.pitch_nm, curvature_per_nm);
  }

  /// Rough ground is curved everywhere, and a prior for plateaus and edges would flatten it. If at
  /// least half of the samples are more curved than the prior expects, the prior is replaced by a
  /// weaker one, which only determines what the images do not. Returns false if the prior stays.
  /// Under a prior that is too stiff, a surface is never more curved than the true one, so a
  /// specimen of plateaus is not mistaken for rough ground.
  bool loosen_prior() {
    const double likely = objective_.prior.likely_curvature_per_nm(at_.z_nm),
                 now = objective_.prior.curvature_per_nm();
    rough_ = rough_ || likely > now;
    if (!rough_ || rough_looseness * likely < worth_loosening * now) return false;
    set_prior(rough_looseness * likely);
    return true;
  }

  static void continue_with(DescentReport& d, const DescentReport& next) {
    d.iterations += next.iterations;
    d.evaluations += next.evaluations;
    d.products += next.products;
    d.factors += next.factors;
    d.double_factors += next.double_factors;
    d.gradient_norm = next.gradient_norm;
    d.ended = next.ended;
  }

  Precision precision() const {
    return options_.double_precision ? Precision::double_always : Precision::single_where_it_holds;
  }

  std::int64_t pixels() const {
    return (objective_.afm ? objective_.afm->used_pixels() : 0) +
           (objective_.sem ? objective_.sem->used_pixels() : 0) + pixels_of_views();
  }
  std::int64_t pixels_of_views() const {
    std::int64_t sum = 0;
    for (const ViewTerm& v : objective_.views) sum += v.sem().used_pixels();
    return sum;
  }

  Grid<double> afm_white(const Objective::State& s) const {
    return whiten(s.afm->residual, afm_->noise, objective_.afm->used());
  }
  static Grid<double> sem_white(const SemTerm& term, const SemTerm::State& s) {
    Grid<double> explained = term.image();
    for (std::size_t i = 0; i < s.discrepancy.size(); ++i)
      explained.data()[i] -= s.discrepancy.data()[i];
    return whiten(explained, s.simulated, term.noise(), term.used());
  }

  ViewResult view_result(const ViewTerm& term, const ViewTerm::State& s,
                         const ViewUnknowns& at) const {
    const SurfaceFrame& f = term.frame();
    const int m = term.margin();
    const auto own = [&](const auto& grid) {
      return cut_out(grid, m, m, f.width - 2 * m, f.height - 2 * m);
    };
    const Grid<double> white = sem_white(term.sem(), s.sem);
    ViewResult out{term.pose(at),
                   at.mixture.gains,
                   at.mixture.offset,
                   own(s.sem.simulated),
                   own(white),
                   own(term.sem().used()),
                   judge(white, term.sem().used()),
                   0};
    if (!s.sem.discrepancy.empty())
      out.discrepancy_share = share_of(s.sem.discrepancy, s.sem.simulated, term.sem().used());
    return out;
  }

  void add_warnings(Reconstruction& out) const {
    if (!converged_)
      out.warnings.push_back("the last scale ended before it settled: give more iterations");
    if (reports_.empty()) return;
    const auto judge_image = [&](const ResidualReport& r, const char* image) {
      if (r.pixels == 0 || r.like_noise) return;
      out.warnings.push_back(fmt::format(
          "the residual of the {} image does not look like its noise (deviation {:.2f} of 1, "
          "neighbours' correlation {:.2f} "
          "along and {:.2f} across rows): look at its residual for what no surface explains",
          image, r.deviation, r.along, r.across));
    };
    judge_image(reports_.back().afm_residual, "AFM");
    judge_image(reports_.back().sem_residual, "SEM");
  }

  template <class T>
  Grid<T> cut(const Grid<T>& grid) const {
    const SurfaceFrame& f = objective_.frame;
    return cut_out(grid, margin_, margin_, f.width - 2 * margin_, f.height - 2 * margin_);
  }
  HeightField cut_field(const Grid<double>& z) const {
    const SurfaceFrame& f = objective_.frame;
    return {{f.pitch_nm, f.pitch_nm, f.origin_x_nm + margin_ * f.pitch_nm,
             f.origin_y_nm + margin_ * f.pitch_nm},
            cut(z)};
  }

  CommonDoubts common_doubts() const {
    CommonDoubts doubts;
    if (afm_) {
      const HeightField& scan = afm_->image;
      doubts.level = afm_->level_doubt;
      doubts.middle = {scan.x_nm(scan.z_nm.width() / 2), scan.y_nm(scan.z_nm.height() / 2)};
    }
    if (sem_) doubts.edge_px = edge_doubt_px, doubts.place = options_.place_doubt;
    return doubts;
  }

  Reconstruction result() {
    Reconstruction out;
    out.surface = cut_field(at_.z_nm);
    out.start = cut_field(start_);
    out.sem_to_afm = at_.surface_to_afm;
    out.scales = reports_;
    out.converged = converged_;
    add_warnings(out);
    const ReconstructionState last = state();
    out.gains = last.gains;
    out.offset = last.offset;
    out.blur_px2 = last.blur_px2;
    out.film_nm = last.film_nm;
    out.scan_drift_px = at_.drift_px;
    // So that a result follows from its state alone.
    if (options_.method == ReconstructionMethod::gauss_newton) look_around();
    const Objective::State s = objective_.evaluate(at_);
    if (s.afm) {
      out.tip = objective_.afm->tip(at_.tip);
      out.simulated_afm = afm_->image;
      out.simulated_afm.z_nm = s.afm->simulated;
      out.simulated_afm.valid = objective_.afm->used();
      out.afm_used = objective_.afm->used();
      out.afm_residual = afm_white(s);
    }
    if (s.sem) {
      out.simulated_sem = cut(s.sem->simulated);
      out.sem_residual = cut(sem_white(*objective_.sem, *s.sem));
      if (!s.sem->discrepancy.empty()) {
        out.sem_discrepancy = cut(s.sem->discrepancy);
        if (!s.sem->row_jitter.empty())
          out.sem_row_jitter.assign(s.sem->row_jitter.begin() + margin_,
                                    s.sem->row_jitter.end() - margin_);
        out.sem_discrepancy_share =
            share_of(s.sem->discrepancy, s.sem->simulated, objective_.sem->used());
      }
    }
    for (std::size_t v = 0; v < objective_.views.size(); ++v)
      out.views.push_back(view_result(objective_.views[v], s.views[v], at_.views[v]));
    if (options_.uncertainty) {
      // No image states its spot: it is unknown to the posterior also where the fit takes the
      // model's.
      const bool fitted_spot = objective_.fit_blur;
      objective_.fit_blur = sem_ != nullptr;
      const Posterior p =
          posterior(objective_, at_, {.spot = !fitted_spot}, options_.probes, options_.seed,
                    options_.threads, precision(), options_.watch.part(share_of_scales, 1));
      Grid<double> linear = cut(p.deviation_nm);
      const Grid<double> deeper = cut(depth_doubt(objective_, at_, s, options_.threads));
      for (std::size_t i = 0; i < deeper.size(); ++i)
        linear.data()[i] = std::hypot(linear.data()[i], deeper.data()[i]);
      const HeightField soft = cut_field(GaussianBasis(soft_px, options_.threads).sum(at_.z_nm));
      HeightIntervals intervals = height_intervals(common_doubts(), out.surface, soft.z_nm,
                                                   at_.surface_to_afm, linear, options_.threads);
      if (objective_.fit_map)
        out.map_deviation = map_deviation(soft, linear, common_doubts(), at_.surface_to_afm);
      out.deviation_nm = std::move(intervals.deviation_nm);
      out.lower_nm = std::move(intervals.lower_nm);
      out.upper_nm = std::move(intervals.upper_nm);
      out.data_support = cut(p.data_support);
    }
    return out;
  }

 public:
  double noise_floor_nm(const HeightField& truth, int draws) {
    const SurfaceFrame& f = objective_.frame;
    const int w = f.width - 2 * margin_, h = f.height - 2 * margin_;
    if (truth.z_nm.width() != w || truth.z_nm.height() != h)
      throw InvalidInput("truth",
                         fmt::format("it has {} x {} samples, the surface {} x {}",
                                     truth.z_nm.width(), truth.z_nm.height(), w, h),
                         "Give it on the surface's samples");
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) at_.z_nm(x + margin_, y + margin_) = truth.z_nm(x, y);
    if (options_.method == ReconstructionMethod::gauss_newton) {
      const double scale = options_.scales_px.empty()
                               ? default_scales_px(options_.method, f.width, f.height).back()
                               : options_.scales_px.back();
      set_prior(curvature_ * scale * scale);
    }
    if (options_.curvature_prior_per_nm == 0) loosen_prior();
    const Objective::State s = objective_.evaluate(at_);
    Preconditioner m(Preconditioner::usual_tile_px, options_.threads, precision());
    m.factor(objective_, at_, s);
    double sum = 0;
    for (int d = 0; d < draws; ++d) {
      const Grid<double> e = cut(linear_error(
          objective_, at_, s, m, options_.seed + static_cast<std::uint64_t>(d), options_.watch));
      for (const double v : e.data()) sum += v * v / (static_cast<double>(e.size()) * draws);
    }
    return std::sqrt(sum);
  }

 private:
  const AfmData* afm_;
  const SemData* sem_;
  const ReconstructionOptions& options_;
  int margin_;
  Objective objective_;
  Unknowns at_;
  Grid<double> start_;
  double curvature_ = 1e-3;
  bool converged_ = true, rough_ = false;
  std::vector<ScaleReport> reports_;
};

}  // namespace

std::vector<double> default_scales_px(ReconstructionMethod method, int width, int height) {
  if (method == ReconstructionMethod::gauss_newton) return {5, 1.4};
  std::vector<double> scales;
  // Jones's schedule, beginning at the scale from which descents succeed: from 60 pixels they stall
  // far from the optimum (docs/explanation/reconstruction.md).
  const double widest = std::min(10.0, std::min(width, height) / 3.0);
  for (double s = 60; s > 0.38; s /= 1.875)
    if (s <= widest) scales.push_back(s);
  return scales;
}

Reconstruction reconstruct(const AfmData* afm, const SemData* sem,
                           const ReconstructionOptions& options, ReconstructionJournal* journal) {
  return reconstruct(afm, sem, {}, options, journal);
}

Reconstruction reconstruct(const AfmData* afm, const SemData* sem,
                           const std::vector<SemView>& views, const ReconstructionOptions& options,
                           ReconstructionJournal* journal) {
  check_inputs(afm, sem, views, options);
  return Work(afm, sem, views, options).run(journal);
}

double noise_floor_nm(const AfmData* afm, const SemData* sem, const HeightField& truth,
                      const ReconstructionOptions& options, int draws) {
  check_inputs(afm, sem, {}, options);
  return Work(afm, sem, {}, options).noise_floor_nm(truth, draws);
}

}  // namespace surf
