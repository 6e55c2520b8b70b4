// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/registration/register_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "registration/candidate.h"
#include "registration/mutual_information.h"
#include "registration/pose_search.h"
#include "registration/repeats.h"
#include "registration/uncertainty.h"
#include "registration/verdict.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf {
namespace {

// The numbers of candidates that are followed in each phase. The true one is nearly always among
// the first ten of the search.
constexpr std::size_t places_searched = 120, places_coarse = 24, places_fine = 8, places_sharp = 3,
                      places_repeated = 6;
constexpr Effort coarse_effort{3, 8, 0}, fine_effort{6, 12, 0};
constexpr Effort sharp_effort{1, 4, 10};  // the slopes are noisy: see class Newton
constexpr double sharp_blur_px = 2;       // below it every pixel is sampled, which takes time
constexpr double probe_blur_px = 3, widest_result_px = 2, slip_blur_px = 2;
constexpr double probes_px[] = {-8, -4, 4, 8};
constexpr double rival_apart_px = 1;  // closer maps are the same
constexpr double chance_odds = 1000;
constexpr double sure_correlation = 0.5;  // for images that overlap by at least a third
constexpr double unit_score_error_of_information = 2;

void require(bool good, const char* subject, const std::string& value, const char* remedy) {
  if (!good) throw UsageError(subject, fmt::format("{} is out of range", value), remedy);
}

void validate(const RegistrationOptions& o) {
  require(!o.blurs_px.empty() && o.blurs_px.size() <= 100, "blurs",
          fmt::format("a number of {}", o.blurs_px.size()), "Give 1 to 100");
  for (const double blur : o.blurs_px)
    require(blur >= 0 && blur <= 1000, "blur", format_exact(blur) + " px", "Give 0 to 1000 pixels");
  require(o.least_scale > 0 && o.least_scale <= o.largest_scale && std::isfinite(o.largest_scale) &&
              o.largest_scale <= 10 * o.least_scale,
          "scales",
          fmt::format("{} to {}", format_exact(o.least_scale), format_exact(o.largest_scale)),
          "Give numbers above 0, the largest at most ten times the least");
  require(o.largest_shear >= 0 && o.largest_shear <= 1, "largest shear",
          format_exact(o.largest_shear), "Give 0 to 1");
  require(o.least_overlap > 0 && o.least_overlap <= 1, "least overlap",
          format_exact(o.least_overlap), "Give a share above 0, at most 1");
  require(o.rival_sigmas >= 0 && std::isfinite(o.rival_sigmas), "rival sigmas",
          format_exact(o.rival_sigmas), "Give 0 or more");
  require(o.largest_stderr_px > 0, "largest standard error",
          format_exact(o.largest_stderr_px) + " px", "Give more than 0 pixels");
  if (!o.start) return;
  const Affine& m = *o.start;
  for (const double v : {m.xx, m.xy, m.x0, m.yx, m.yy, m.y0})
    require(std::isfinite(v), "start", format_exact(v), "Give six finite numbers");
  require(m.determinant() != 0, "start", "a map of the plane onto a line",
          "Give one that can be turned back");
}

void require_colours(const PlacedImage& image, const char* subject) {
  double least = 0, largest = 0;
  std::size_t count = 0;
  for (int y = 0; y < image.values.height(); ++y)
    for (int x = 0; x < image.values.width(); ++x) {
      if (!image.is_valid(x, y)) continue;
      const double v = image.values(x, y);
      least = count == 0 ? v : std::min(least, v);
      largest = count == 0 ? v : std::max(largest, v);
      ++count;
    }
  if (count == 0)
    throw InvalidInput(subject, "no pixel of it is valid", "Give an image with valid pixels");
  if (!(largest - least > 1e-12 * std::max(std::abs(least), std::abs(largest))))
    throw InvalidInput(subject, "it is of one colour", "Give an image that shows something");
}

/// The magnitude of the gradient, whose location does not depend on the meaning of the intensities.
PlacedImage edges_of(const PlacedImage& image, double blur_px, double pixel_nm) {
  PlacedImage edges = image;
  const SmoothImage smooth(image, image.pitch_x_nm / pixel_nm, image.pitch_y_nm / pixel_nm,
                           blur_px);
  for (int y = 0; y < image.values.height(); ++y)
    for (int x = 0; x < image.values.width(); ++x) {
      const SmoothImage::Value v =
          smooth.at(x * image.pitch_x_nm / pixel_nm - smooth.half_width(),
                    y * image.pitch_y_nm / pixel_nm - smooth.half_height());
      edges.values(x, y) = std::hypot(v.dx, v.dy);
    }
  return edges;
}

const Effort& effort_at(double blur_px) {
  return blur_px < sharp_blur_px ? sharp_effort : fine_effort;
}

class Registrar {
 public:
  Registrar(const PlacedImage& sem, const PlacedImage& afm, const RegistrationOptions& options)
      : sem_(sem), afm_(afm), options_(options), frame_(sem, afm) {}

  Registration run() {
    std::vector<MapCandidate> candidates = options_.start ? from_start() : from_search();
    const bool searched = !options_.start;
    std::size_t done = 0;
    const Watch fine = options_.watch.part(searched ? 0.7 : 0, 0.95);
    const std::vector<double> blurs = blurs_to_use();
    for (const double blur : blurs) {
      const Watch of_blur =
          fine.part(double(done) / double(blurs.size()), double(done + 1) / double(blurs.size()));
      refine(candidates, level(blur), options_.objective, effort_at(blur), options_, of_blur);
      ++done;
      if (!searched) continue;
      prune(candidates, level(blur), frame_, options_, std::max(rival_apart_px, 0.5 * blur),
            blur <= sharp_blur_px ? places_sharp : places_fine);
      hold(candidates, blur);
      if (blur <= probe_blur_px && candidates.size() > 1)
        drop_hopeless(candidates, level(blur), candidates.front().corners);
    }
    return conclude(std::move(candidates));
  }

 private:
  const BlurLevel& level(double blur) {
    std::unique_ptr<BlurLevel>& made = levels_[blur];
    if (!made) made = std::make_unique<BlurLevel>(sem_, afm_, frame_, blur);
    return *made;
  }

  std::vector<MapCandidate> from_start() {
    MapCandidate candidate;
    candidate.corners = frame_.three_points(*options_.start);
    return {candidate};
  }

  std::vector<MapCandidate> from_search() {
    pitch_ = search_pitch_px(sem_);
    // For arbitrary relations of intensities, the magnitude of the gradient is used instead of the
    // intensity.
    const bool steep = options_.objective == RegistrationObjective::mutual_information;
    const PlacedImage sem = steep ? edges_of(sem_, 0.7 * pitch_, frame_.pixel_nm()) : PlacedImage{};
    const PlacedImage afm = steep ? edges_of(afm_, 0.7 * pitch_, frame_.pixel_nm()) : PlacedImage{};
    const auto blurred_by = [&](double blur) {
      return BlurLevel(steep ? sem : sem_, steep ? afm : afm_, frame_, blur);
    };
    const BlurLevel coarse = blurred_by(pitch_);
    const PoseSearch search =
        search_poses(coarse, pitch_, options_, places_searched, options_.watch.part(0, 0.5));
    chance_evidence_ = chance_bound(search.best_of_pose, chance_odds);
    std::vector<MapCandidate> candidates;
    for (const PoseSearch::Candidate& candidate : search.candidates) {
      candidates.emplace_back();
      candidates.back().corners = candidate.corners;
      candidates.back().score = agreement_of(coarse, candidate.corners).correlation;
      best_coarse_evidence_ = std::max(best_coarse_evidence_, candidate.evidence);
    }
    hold(candidates, pitch_);
    refine(candidates, coarse, RegistrationObjective::correlation, coarse_effort, options_,
           options_.watch.part(0.5, 0.65));
    prune(candidates, coarse, frame_, options_, pitch_, places_coarse);
    hold(candidates, pitch_);
    for (const MapCandidate& candidate : candidates) {
      coarse_.push_back(candidate);
      best_coarse_evidence_ =
          std::max(best_coarse_evidence_, candidate.evidence * samples_ratio(candidate));
    }
    const BlurLevel finer = blurred_by(0.5 * pitch_);
    refine(candidates, finer, RegistrationObjective::correlation, coarse_effort, options_,
           options_.watch.part(0.65, 0.7));
    prune(candidates, finer, frame_, options_, 0.5 * pitch_, places_fine);
    hold(candidates, 0.5 * pitch_);
    for (MapCandidate& candidate : candidates) candidate.steps.clear(), candidate.places.clear();
    return candidates;
  }

  /// Keeps the best candidates that were last within the limits, in case all of them leave the
  /// limits. Candidates much worse than the kept ones do not replace them.
  void hold(const std::vector<MapCandidate>& candidates, double blur) {
    if (candidates.empty()) return;
    std::vector<MapCandidate> best = candidates;
    std::stable_sort(best.begin(), best.end(), [](const MapCandidate& a, const MapCandidate& b) {
      return a.score > b.score;
    });
    best.resize(std::min(places_sharp, best.size()));
    if (!held_.empty() && best.front().score < 0.5 * held_.front().score) return;
    held_ = std::move(best);
    held_blur_ = blur;
    if (blur == pitch_ || !by_correlation()) return;
    for (const MapCandidate& candidate : held_)
      best_correlation_ = std::max(best_correlation_, candidate.score);
  }

  /// Whether some map agreed more than chance allows at the coarse blur, or so well at a finer blur
  /// that chance is impossible. A fine pattern is invisible at the coarse blur.
  bool are_related() const {
    return best_coarse_evidence_ >= chance_evidence_ || best_correlation_ > sure_correlation;
  }

  /// Leaves out blurs that are wider than that of the search, because they would worsen its result.
  std::vector<double> blurs_to_use() const {
    if (options_.start) return options_.blurs_px;
    std::vector<double> blurs;
    for (const double blur : options_.blurs_px)
      if (blur <= pitch_ || blur == options_.blurs_px.back()) blurs.push_back(blur);
    return blurs;
  }

  bool by_correlation() const { return options_.objective == RegistrationObjective::correlation; }

  double error_of(const Place& candidate) {
    const BlurLevel& last = level(blur_);
    if (by_correlation()) return score_error(last, candidate.corners);
    // 2 N I is noncentral chi-squared, of variance 8 N I.
    const double n =
        static_cast<double>(candidate.samples) * independent_share(last, candidate.corners);
    return n > 0 ? std::sqrt(unit_score_error_of_information * std::max(candidate.score, 1 / n) / n)
                 : 1;
  }

  Uncertainty known(const Place& candidate) {
    const BlurLevel& last = level(blur_);
    if (by_correlation()) {
      const EdgeSlip slip = edge_slip(level(std::max(blur_, slip_blur_px)), candidate.corners);
      return uncertainty_of(last, candidate.corners, slip);
    }
    Uncertainty u = uncertainty_from(
        information_covariance(last, options_.mutual_information, candidate.corners,
                               independent_share(last, candidate.corners)),
        last, candidate.corners);
    u.score = error_of(candidate);
    return u;
  }

  /// Chooses the blur at which the map is known best. Sharp images are least affected by the tip,
  /// blurred ones have less noise. All candidates return to their maps at this blur.
  Uncertainty choose_blur(std::vector<MapCandidate>& candidates) {
    const MapCandidate best = candidates.front();
    std::optional<Uncertainty> least;
    std::size_t chosen = best.steps.size() - 1;
    for (std::size_t i = 0; i < best.steps.size(); ++i) {
      const bool last = i + 1 == best.steps.size();
      if (!last && (best.steps[i].blur_px > widest_result_px || !best.places[i].settled)) continue;
      if (last && least && !best.places[i].settled) continue;
      blur_ = best.steps[i].blur_px;
      const Uncertainty u = known(static_cast<const Place&>(best.places[i]));
      if (least && u.place_px >= least->place_px) continue;
      least = u;
      chosen = i;
    }
    blur_ = best.steps[chosen].blur_px;
    for (MapCandidate& candidate : candidates)
      static_cast<Place&>(candidate) = Place(candidate.places[chosen]);
    return *least;
  }

  /// The distance to the nearest place where the scan resembles itself, in SEM pixels; 0: there is
  /// none.
  double repeat_px(const MapCandidate& best, const Moments& moments) {
    double nearest = 0;
    for (const ThreePointMap& c :
         repeats_of(level(std::max(blur_, slip_blur_px)), best.corners, places_repeated)) {
      const double distance = distance_px(c, best.corners, moments);
      if (nearest == 0 || distance < nearest) nearest = distance;
    }
    return nearest;
  }

  /// Drops candidates that are clearly worse than the best: they are no rivals and need not be
  /// followed.
  void drop_hopeless(std::vector<MapCandidate>& candidates, const BlurLevel& at,
                     const ThreePointMap& best) const {
    if (!by_correlation()) return;
    const double here = agreement_of(at, best).correlation;
    const double error = score_error(at, best);
    std::erase_if(candidates, [&](const MapCandidate& t) {
      return here - t.score > 2 * options_.rival_sigmas * error;
    });
  }

  /// Maps displaced to either side along the least known motions.
  static std::vector<MapCandidate> displaced(const MapCandidate& best, const Uncertainty& u) {
    std::vector<MapCandidate> moved;
    for (const ThreePointMap& motion : u.loosest)
      for (const double far : probes_px) {
        moved.emplace_back();
        for (std::size_t i = 0; i < 6; ++i)
          moved.back().corners[i] = best.corners[i] + far * motion[i];
      }
    return moved;
  }

  /// Searches for other optima along these motions, and where the scan resembles itself: patterns
  /// that slide or repeat fit as well there. If an initial map was given, it says which place of a
  /// lattice is meant.
  std::vector<MapCandidate> probe(const MapCandidate& best, const Uncertainty& u) {
    std::vector<MapCandidate> probes = displaced(best, u);
    if (!options_.start) {
      const BlurLevel& smooth = level(std::max(blur_, slip_blur_px));
      for (const ThreePointMap& corners : repeats_of(smooth, best.corners, places_repeated)) {
        probes.emplace_back();
        probes.back().corners = corners;
      }
    }
    const auto drop_same = [&](const BlurLevel& at, double apart) {
      const Moments moments = moments_of(at, overlap_of(at, best.corners));
      std::erase_if(probes, [&](const MapCandidate& t) {
        return distance_px(t.corners, best.corners, moments) < apart;
      });
      prune(probes, at, frame_, options_, rival_apart_px, places_sharp);
    };
    std::vector<double> blurs;
    for (const RegistrationStep& step : best.steps)
      if (step.blur_px <= std::max(probe_blur_px, blur_) && step.blur_px >= blur_)
        blurs.push_back(step.blur_px);
    for (const double blur : blurs) {
      refine(probes, level(blur), options_.objective, effort_at(blur), options_,
             {{}, options_.watch.cancel});
      drop_same(level(blur), rival_apart_px);
      if (blur == blurs.front() && !probes.empty())
        drop_hopeless(probes, level(blur), best.corners);
    }
    return probes;
  }

  /// The result if every map left the limits of the search: the images slide on each other, and the
  /// maps from which they slid are all equally good.
  Registration slid_off(Evidence evidence) {
    blur_ = held_blur_;
    Registration r;
    const MapCandidate& best = held_.front();
    const Uncertainty u = known(best);
    r.sem_to_afm = frame_.affine(best.corners);
    r.score = best.score;
    r.blur_px = blur_;
    r.covariance = affine_covariance(frame_, u.covariance);
    r.stderr_px = u.place_px;
    r.overlap = overlap_at(best.corners);
    const Moments moments = moments_of(level(blur_), overlap_of(level(blur_), best.corners));
    const auto add_rival = [&](const ThreePointMap& corners, double score) {
      r.rivals.push_back(
          {frame_.affine(corners), score, distance_px(corners, best.corners, moments)});
    };
    for (std::size_t i = 1; i < held_.size(); ++i) add_rival(held_[i].corners, held_[i].score);
    if (by_correlation())
      for (const MapCandidate& moved : displaced(best, u)) {
        const double score = agreement_of(level(blur_), moved.corners).correlation;
        if (best.score - score <= options_.rival_sigmas * u.score) add_rival(moved.corners, score);
      }
    std::stable_sort(
        r.rivals.begin(), r.rivals.end(),
        [](const RegistrationRival& a, const RegistrationRival& b) { return a.score > b.score; });
    evidence.slid_off = true;
    judge(r, evidence);
    return r;
  }

  double overlap_at(const ThreePointMap& corners) {
    const BlurLevel& all = level(0);
    return static_cast<double>(overlap_of(all, corners).size()) /
           static_cast<double>(all.samples.size());
  }

  Registration conclude(std::vector<MapCandidate> candidates) {
    Registration r;
    Evidence evidence;
    evidence.searched = !options_.start;
    evidence.rival_sigmas = options_.rival_sigmas;
    evidence.chance_evidence = chance_evidence_;
    evidence.best_coarse_evidence = best_coarse_evidence_;
    evidence.related = are_related();
    if (candidates.empty() && evidence.related && !held_.empty()) return slid_off(evidence);
    if (candidates.empty() || candidates.front().samples == 0 ||
        !(candidates.front().evidence > 0)) {
      evidence.any_place = false;
      if (options_.start) r.sem_to_afm = *options_.start;
      judge(r, evidence);
      return r;
    }
    const Uncertainty u = choose_blur(candidates);
    const MapCandidate best = candidates.front();
    r.sem_to_afm = frame_.affine(best.corners);
    r.score = best.score;
    r.blur_px = blur_;
    const BlurLevel& last = level(blur_);
    r.covariance = affine_covariance(frame_, u.covariance);
    r.stderr_px = u.place_px;
    r.overlap = overlap_at(best.corners);
    r.steps = best.steps;

    std::vector<MapCandidate> others(candidates.begin() + 1, candidates.end());
    const std::vector<MapCandidate> probes = probe(best, u);
    others.insert(others.end(), probes.begin(), probes.end());
    const Moments moments = moments_of(last, overlap_of(last, best.corners));
    std::stable_sort(
        others.begin(), others.end(),
        [](const MapCandidate& a, const MapCandidate& b) { return a.score > b.score; });
    std::vector<ThreePointMap> known_rivals;
    for (const MapCandidate& other : others) {
      const double distance = distance_px(other.corners, best.corners, moments);
      if (distance < rival_apart_px) continue;
      if (std::any_of(known_rivals.begin(), known_rivals.end(), [&](const ThreePointMap& c) {
            return distance_px(c, other.corners, moments) < rival_apart_px;
          }))
        continue;
      if (best.score - other.score > options_.rival_sigmas * std::hypot(u.score, error_of(other)))
        continue;
      known_rivals.push_back(other.corners);
      r.rivals.push_back({frame_.affine(other.corners), other.score, distance});
    }

    evidence.settled = best.settled;
    evidence.within_limits =
        options_.start ? true : within_limits(best.corners, last, frame_, options_);
    evidence.score = best.score;
    evidence.score_error = u.score;
    evidence.loosest_px = u.loosest_px;
    evidence.largest_stderr_px = options_.largest_stderr_px;
    // The best map may not be the one that was best at the coarse blur.
    for (const MapCandidate& candidate : coarse_)
      if (distance_px(candidate.corners, best.corners, moments) < 2 * pitch_)
        evidence.coarse_evidence =
            std::max(evidence.coarse_evidence, candidate.evidence * samples_ratio(candidate));
    if (options_.start) evidence.repeat_px = repeat_px(best, moments);
    judge(r, evidence);
    options_.watch.report(1, 1);
    return r;
  }

  /// The ratio of two numbers of samples: the search counts samples of the AFM's frame at its
  /// pitch, a refined map counts samples of the SEM's image.
  double samples_ratio(const MapCandidate& candidate) const {
    const ThreePointMap& c = candidate.corners;
    const double area = std::abs((c[2] - c[0]) * (c[5] - c[1]) - (c[3] - c[1]) * (c[4] - c[0]));
    const double nodes = area / (pitch_ * pitch_);
    const int stride = std::max(1, static_cast<int>(std::lround(pitch_)));
    const double samples =
        double(sem_.values.width()) * sem_.values.height() / (double(stride) * stride);
    return nodes / samples;
  }

  const PlacedImage& sem_;
  const PlacedImage& afm_;
  const RegistrationOptions& options_;
  ThreePointFrame frame_;
  std::map<double, std::unique_ptr<BlurLevel>> levels_;
  double pitch_ = 0, chance_evidence_ = 0, best_coarse_evidence_ = 0, best_correlation_ = 0;
  double blur_ = 0;  // blur of the result
  std::vector<MapCandidate> coarse_, held_;
  double held_blur_ = 0;
};

}  // namespace

Registration register_images(const PlacedImage& sem, const PlacedImage& simulated,
                             const RegistrationOptions& options) {
  validate(sem, "SEM image");
  validate(simulated, "simulated image");
  validate(options);
  require_colours(sem, "SEM image");
  require_colours(simulated, "simulated image");
  options.watch.check();
  return Registrar(sem, simulated, options).run();
}

}  // namespace surf
