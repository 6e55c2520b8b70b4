// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/hough_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "afm/samples.h"
#include "afm/slope_search.h"
#include "core/argument.h"
#include "surf/afm/noise_estimate.h"
#include "surf/core/random.h"

namespace surf {
namespace {

constexpr int blocks = 64;  // per axis; one vote from each block
// Every plane with at least this share of the samples has a slope within the searched range.
constexpr double least_share = 0.2;
constexpr double noise_deviations = 2.5;
constexpr double clear_factor = 1.5;
constexpr double weak_share = 0.1;
constexpr std::size_t planes_per_search = 12000;
constexpr double slack = 0.01, slack_of_runner_up = 0.1;
constexpr int most_turns = 50;

/// Maps samples to places in [-1, 1] across the image.
struct Frame {
  double centre_x, centre_y, half_x, half_y;
  explicit Frame(const HeightField& f)
      : centre_x(0.5 * (f.z_nm.width() - 1)), centre_y(0.5 * (f.z_nm.height() - 1)),
        half_x(centre_x), half_y(centre_y) {}
  double u(int x) const { return (x - centre_x) / half_x; }
  double v(int y) const { return (y - centre_y) / half_y; }
};

Plane to_plane(const SlopedPlane& p, const Plane& rough, const HeightField& field,
               const Frame& frame) {
  Plane out = rough;
  out.height_nm += p.offset;
  out.slope_x += p.a / (frame.half_x * field.pitch_x_nm);
  out.slope_y += p.b / (frame.half_y * field.pitch_y_nm);
  return out;
}

/// Draws one usable sample from each block, at a random rank that depends only on the block.
Votes draw_votes(const HeightField& field, const Mask& use, const Plane& rough) {
  const Frame frame(field);
  const int width = field.z_nm.width(), height = field.z_nm.height();
  const int across = std::min(blocks, width), up = std::min(blocks, height);
  Votes votes;
  std::vector<std::pair<int, int>> usable;
  for (int j = 0; j < up; ++j) {
    for (int i = 0; i < across; ++i) {
      usable.clear();
      for (int y = j * height / up; y < (j + 1) * height / up; ++y)
        for (int x = i * width / across; x < (i + 1) * width / across; ++x)
          if (is_used(field, use, x, y)) usable.emplace_back(x, y);
      if (usable.empty()) continue;
      const auto word = random_block({0x486f7567, 0x68}, {static_cast<std::uint32_t>(i),
                                                          static_cast<std::uint32_t>(j), 0, 0})[0];
      const auto [x, y] = usable[word % usable.size()];
      votes.u.push_back(static_cast<float>(frame.u(x)));
      votes.v.push_back(static_cast<float>(frame.v(y)));
      votes.z.push_back(
          static_cast<float>(field.z_nm(x, y) - rough.at(field.x_nm(x), field.y_nm(y))));
    }
  }
  return votes;
}

/// The binary Kullback-Leibler divergence of a share from the share expected by chance; 0 if it is
/// not larger.
double surprise(double share, double chance) {
  if (share <= chance) return 0;
  const double rest = share < 1 ? (1 - share) * std::log((1 - share) / (1 - chance)) : 0;
  return share * std::log(share / chance) + rest;
}

/// The range without the highest and the lowest 0.5 %, so that a spike does not set the scale.
double height_range(const Votes& votes) {
  std::vector<float> z = votes.z;
  std::sort(z.begin(), z.end());
  const std::size_t cut = z.size() / 200;
  return static_cast<double>(z[z.size() - 1 - cut]) - z[cut];
}

double largest_height(const HeightField& field, const Mask& use) {
  double largest = 0;
  for (int y = 0; y < field.z_nm.height(); ++y)
    for (int x = 0; x < field.z_nm.width(); ++x)
      if (is_used(field, use, x, y)) largest = std::max(largest, std::fabs(field.z_nm(x, y)));
  return largest;
}

struct Choice {
  SlopedPlane plane;
  double tolerance;
};

double least_tolerance(const HeightField& field, double range) {
  double sigma = 0;
  try {
    sigma = std::sqrt(estimate_noise(field).noise.innovation_nm2);
  } catch (const InvalidInput&) {  // the image is too small or has too many holes
  }
  return std::max(noise_deviations * sigma, range * 1e-3);
}

/// Tries tolerances from coarse to fine. Each search starts from the best planes of the searches
/// before.
Choice choose_tolerance(const Votes& votes, SlopeSearch search, double least, double range,
                        HoughSummary& s) {
  Choice best{{}, std::max(least, range / 16)};
  double most = -1;
  std::vector<SlopedPlane> known;
  for (double tolerance = best.tolerance; tolerance >= least * 0.999; tolerance /= 2) {
    search.tolerance = tolerance;
    search.watch.report(static_cast<double>(known.size()), static_cast<double>(known.size() + 2));
    bool complete = true;
    const SlopedPlane found = search_slopes(votes, search, known, s.evaluated, complete);
    known.push_back(found);
    const double share = static_cast<double>(found.votes) / static_cast<double>(votes.size());
    const double here = surprise(share, std::min(0.99, 2 * tolerance / range));
    if (here > most) most = here, best = {found, tolerance}, s.search_complete = complete;
    if (here < 0.5 * most)
      break;  // finer than the flatness of the substrate: votes only decrease from here
  }
  return best;
}

struct Residuals {
  std::size_t inliers = 0, samples = 0;
  double squares = 0;
};

Residuals mark_inliers(const HeightField& field, const Mask& use, const Plane& plane,
                       double tolerance, Mask& mask) {
  Residuals r;
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      mask(x, y) = 0;
      if (!is_used(field, use, x, y)) continue;
      ++r.samples;
      const double off = field.z_nm(x, y) - plane.at(field.x_nm(x), field.y_nm(y));
      if (!(std::fabs(off) <= tolerance)) continue;
      mask(x, y) = 1;
      ++r.inliers;
      r.squares += off * off;
    }
  }
  return r;
}

/// Alternates least-squares fits and selection of inliers, as long as the inliers determine a plane
/// and their number grows.
void refine(const HeightField& field, const Mask& use, const Watch& watch, HoughSummary& s) {
  Mask mask(field.z_nm.width(), field.z_nm.height());
  Residuals best = mark_inliers(field, use, s.plane, s.tolerance_nm, mask);
  s.inliers = mask;
  for (int turn = 0; turn < most_turns; ++turn) {
    watch.report(turn, turn + 4);
    Plane plane;
    try {
      plane = fit_plane(field, s.inliers);
    } catch (const InvalidInput&) {
      break;
    }
    const Residuals here = mark_inliers(field, use, plane, s.tolerance_nm, mask);
    if (here.inliers < best.inliers && turn > 0) break;
    const bool same = mask == s.inliers;
    best = here;
    s.plane = plane;
    std::swap(s.inliers, mask);
    if (same) break;
  }
  s.inlier_share = static_cast<double>(best.inliers) / static_cast<double>(best.samples);
  s.inlier_rms_nm =
      std::sqrt(best.squares / static_cast<double>(std::max<std::size_t>(best.inliers, 1)));
}

Votes away_from(const Votes& votes, const SlopedPlane& plane, double distance) {
  Votes rest;
  for (std::size_t i = 0; i < votes.size(); ++i) {
    const double off = votes.z[i] - plane.offset - plane.a * votes.u[i] - plane.b * votes.v[i];
    if (std::fabs(off) <= distance) continue;
    rest.u.push_back(votes.u[i]);
    rest.v.push_back(votes.v[i]);
    rest.z.push_back(votes.z[i]);
  }
  return rest;
}

HoughVerdict judge(const HoughSummary& s) {
  const bool majority = s.inlier_share >= 0.5;
  if (s.inlier_share < weak_share || (!majority && s.inlier_share < clear_factor * s.chance_share))
    return HoughVerdict::weak;
  return s.inlier_share < clear_factor * s.runner_up_share ? HoughVerdict::contested
                                                           : HoughVerdict::clear;
}

/// The result for heights that are exactly one plane.
HoughSummary exact_plane(const HeightField& field, const Mask& use, const Plane& plane) {
  HoughSummary s;
  s.plane = s.runner_up = plane;
  s.inliers = Mask(field.z_nm.width(), field.z_nm.height());
  mark_inliers(field, use, plane, std::numeric_limits<double>::max(), s.inliers);
  s.inlier_share = 1;
  return s;
}

}  // namespace

HoughSummary find_plane(const HeightField& field, const HoughOptions& options, const Mask& use) {
  require_not_negative(options.tolerance_nm, "tolerance");
  const Plane rough = fit_plane(field, use);
  const Frame frame(field);
  const Votes votes = draw_votes(field, use, rough);
  const double range = height_range(votes);
  if (!(range > 1e-12 * largest_height(field, use))) return exact_plane(field, use, rough);
  HoughSummary s;
  options.watch.report(0.1, 1);
  SlopeSearch search{.largest_slope = range / (2 * least_share),
                     .slack = slack,
                     .limit = planes_per_search,
                     .watch = options.watch.part(0.1, 0.5)};
  Choice choice;
  if (options.tolerance_nm > 0) {
    search.tolerance = choice.tolerance = options.tolerance_nm;
    choice.plane = search_slopes(votes, search, {}, s.evaluated, s.search_complete);
  } else {
    choice = choose_tolerance(votes, search, least_tolerance(field, range), range, s);
  }
  s.tolerance_nm = choice.tolerance;
  s.plane = to_plane(choice.plane, rough, field, frame);
  s.chance_share = std::min(1.0, 2 * choice.tolerance / range);
  refine(field, use, options.watch.part(0.5, 0.9), s);

  options.watch.report(0.9, 1);
  const Votes rest = away_from(votes, choice.plane, 2 * choice.tolerance);
  search.tolerance = choice.tolerance;
  search.slack = slack_of_runner_up;
  if (rest.size() > 2) {
    const SlopedPlane second = search_slopes(rest, search, {}, s.evaluated, s.search_complete);
    s.runner_up = to_plane(second, rough, field, frame);
    s.runner_up_share = static_cast<double>(second.votes) / static_cast<double>(votes.size());
  } else {
    s.runner_up = s.plane;
  }
  s.verdict = judge(s);
  return s;
}

}  // namespace surf
