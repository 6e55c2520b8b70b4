// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/verdict.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace surf {
namespace {

constexpr double sliding_px = 1;
constexpr double least_sigmas = 6;  // for the score with a given initial map

}  // namespace

double chance_bound(const std::vector<double>& sorted, double odds) {
  if (sorted.empty()) return 0;
  const auto at = [&](double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  };
  // Quantiles of the standard Gumbel distribution: -log(-log p).
  const double ln2 = std::numbers::ln2;
  const double half = -std::log(ln2), quarter = -std::log(2 * ln2);
  const double scale = (at(0.5) - at(0.25)) / (half - quarter), place = at(0.5) - half * scale;
  return place + scale * std::log(static_cast<double>(sorted.size()) * odds);
}

void judge(Registration& r, const Evidence& e) {
  r.slides = e.slid_off || e.loosest_px > sliding_px;
  if (!e.any_place) {
    r.verdict = RegistrationVerdict::unrelated;
    r.reason =
        "Nowhere do enough of both images overlap and agree. Check that they show the same place "
        "and that pixel "
        "sizes are right, or give landmarks";
  } else if (e.slid_off) {
    r.verdict = RegistrationVerdict::ambiguous;
    r.reason =
        "The images slide on each other: whatever fits slides beyond the limits of scale, shear or "
        "overlap. Give "
        "images with ends or corners of what they show, or landmarks";
  } else if (!e.settled) {
    r.verdict = RegistrationVerdict::unconverged;
    r.reason =
        "The optimiser did not settle. Give landmarks nearer to the truth, or blurs that begin "
        "wider";
  } else if (!e.within_limits) {
    r.verdict = RegistrationVerdict::unconverged;
    r.reason =
        "It settled at a limit of scale, shear or overlap. Check pixel sizes, widen the limits, or "
        "give landmarks";
  } else if (e.searched && !e.related) {
    r.verdict = RegistrationVerdict::unrelated;
    r.reason = fmt::format(
        "The best place found agrees no better than chance allows (evidence {:.3g} of the {:.3g} "
        "that "
        "wrong places reach). Check that both images show the same place, or give landmarks",
        e.best_coarse_evidence, e.chance_evidence);
  } else if (!e.searched && e.score < least_sigmas * e.score_error) {
    r.verdict = RegistrationVerdict::unrelated;
    r.reason = fmt::format(
        "The images do not agree there: the score is {:.3g} with a standard error of {:.2g}. Check "
        "the "
        "landmarks, or let the start be searched for",
        e.score, e.score_error);
  } else if (e.loosest_px > sliding_px) {
    r.verdict = RegistrationVerdict::ambiguous;
    r.reason = fmt::format(
        "The images slide on each other: along one motion the place is known to {:.2g} SEM pixels "
        "only. "
        "Give images with ends or corners of what they show, or landmarks",
        e.loosest_px);
  } else if (!r.rivals.empty()) {
    r.verdict = RegistrationVerdict::ambiguous;
    r.reason = fmt::format(
        "Another place, {:.3g} SEM pixels away, fits nearly as well (score {:.4g} against {:.4g}): "
        "{} such. "
        "Give landmarks that say which, or larger images",
        r.rivals.front().distance_px, r.rivals.front().score, r.score, r.rivals.size());
  } else if (e.searched && e.coarse_evidence < e.chance_evidence) {
    r.verdict = RegistrationVerdict::ambiguous;
    r.reason = fmt::format(
        "While both images were coarse this place agreed no better than chance allows (evidence "
        "{:.3g} of "
        "{:.3g}): what agrees may repeat. Give landmarks, or larger images",
        e.coarse_evidence, e.chance_evidence);
  } else if (r.stderr_px > e.largest_stderr_px) {
    r.verdict = RegistrationVerdict::ambiguous;
    r.reason = fmt::format(
        "Too few edges hold the place, which is known to {:.2g} SEM pixels only, where {:.2g} are "
        "wanted. "
        "Give images that show more, landmarks, or allow a larger standard error",
        r.stderr_px, e.largest_stderr_px);
  } else {
    r.verdict = RegistrationVerdict::verified;
    r.reason = fmt::format(
        "Converged to {:.2g} SEM pixels; no other place comes within {:.3g} standard errors of its "
        "score",
        r.stderr_px, e.rival_sigmas);
    if (e.repeat_px > 0)
      r.reason += fmt::format(
          ". The scan repeats {:.3g} SEM pixels away, and it is the start that says which place is "
          "meant: landmarks have to be right to half of that",
          e.repeat_px);
  }
}

}  // namespace surf
