// SPDX-License-Identifier: GPL-3.0-or-later
#include "judge_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chain_steps.h"
#include "sem_preparation.h"
#include "surf/core/error.h"

namespace surf::workflow {
namespace {

constexpr std::size_t most_rivals = 3;
constexpr double worth_a_closer_look = 50;  // of a place's negative log-likelihood
constexpr double too_unlikely = 0.05;

struct Candidate {
  Affine map;
  FirstCalibration calibration;
  Reconstruction found;
  double value = 0;
};

double objective_of(const Reconstruction& r) {
  const ScaleReport& last = r.scales.back();
  return last.afm + last.sem + last.prior;
}

/// By how much residuals that are larger than noise make differences of likelihoods seem larger
/// than they are.
double excess(const Reconstruction& r) {
  const ScaleReport& last = r.scales.back();
  return std::max(
      {1.0, std::pow(last.afm_residual.deviation, 2), std::pow(last.sem_residual.deviation, 2)});
}

/// The SEM's noise may be taken for too large where flat places are missing.
bool explained(const Reconstruction& r) {
  constexpr double largest_deviation = 1.15;
  return r.scales.back().afm_residual.like_noise &&
         r.scales.back().sem_residual.deviation <= largest_deviation;
}

std::vector<Candidate> candidates_of(const ReconstructJob& job, const ReconstructSummary& s,
                                     const PlacedImage& image) {
  std::vector<Affine> maps{s.pose->sem_to_afm};
  for (const RegistrationRival& rival : s.pose->registration->rivals)
    if (maps.size() <= most_rivals) maps.push_back(rival.sem_to_afm);
  std::vector<Candidate> out;
  for (const Affine& map : maps) {
    try {
      out.push_back({map,
                     calibrate_first(image, &s.afm->eroded(), *s.model->model, map, job.calibration,
                                     job.sem_noise, job.options.threads),
                     {}});
    } catch (const InvalidInput&) {
      // The images have nothing in common there.
    }
  }
  return out;
}

/// All candidates are judged by the noise of the one that explains most.
SemNoise least_noise(const std::vector<Candidate>& all, const PlacedImage& image) {
  double level = 0;
  for (const double v : image.values.data()) level += v / static_cast<double>(image.values.size());
  return std::ranges::min(all, {},
                          [&](const Candidate& c) { return c.calibration.noise.variance(level); })
      .calibration.noise;
}

/// The negative log-likelihood of the SEM image at this place, given the scan: what both images
/// cost together, less what the scan costs alone, because places differ in how much of the scan
/// they show and in how much it bends there.
void fit(Candidate& c, const ReconstructJob& job, const ReconstructSummary& s,
         const PlacedImage& image, const AfmData& afm, const SemNoise& noise, bool closely,
         const Watch& watch) {
  constexpr double says_nothing = 1e12;  // of the noise's variance
  SemData sem = sem_at(job, s, image, c.map, c.calibration);
  sem.noise = noise;
  ReconstructionOptions o = coarse_options(job, s, c.calibration.tied);
  if (closely) o.scales_px.clear(), o.iterations = job.options.iterations;
  o.watch = watch.part(0, 0.6);
  c.found = reconstruct(&afm, &sem, o);
  sem.noise = {0, says_nothing * noise.variance(c.calibration.offset), 1e-3};
  sem.discrepancy.clear();
  sem.row_jitter = {};
  o.refine_transform = o.refine_calibration = o.refine_tip = false;
  o.watch = watch.part(0.6, 1);
  c.value = objective_of(c.found) - objective_of(reconstruct(&afm, &sem, o));
}

void likeliest_first(std::vector<Candidate>& all) {
  std::ranges::stable_sort(all, {}, &Candidate::value);
}

std::vector<JudgedPlace> judged(const std::vector<Candidate>& all) {
  const double scale = excess(all.front().found);
  std::vector<JudgedPlace> places;
  double sum = 0;
  for (const Candidate& c : all) {
    const double worse = (c.value - all.front().value) / scale;
    places.push_back({c.found.sem_to_afm, worse, std::exp(-worse), explained(c.found)});
    sum += places.back().probability;
  }
  for (JudgedPlace& place : places) place.probability /= sum;
  return places;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The share of heights in which two surfaces differ by more than two deviations of the difference.
double share_apart(const Reconstruction& a, const Reconstruction& b) {
  std::vector<double> off(a.surface.z_nm.size());
  for (std::size_t i = 0; i < off.size(); ++i)
    off[i] = a.surface.z_nm.data()[i] - b.surface.z_nm.data()[i];
  const double level = median(off);
  double apart = 0;
  for (std::size_t i = 0; i < off.size(); ++i)
    apart += std::abs(off[i] - level) >
             2 * std::hypot(a.deviation_nm.data()[i], b.deviation_nm.data()[i]);
  return apart / static_cast<double>(off.size());
}

}  // namespace

void judge_places(const ReconstructJob& job, ReconstructSummary& s, const PlacedImage& image,
                  const AfmData& afm, const Reporter& reporter) {
  Pose& pose = *s.pose;
  if (!pose.registration || pose.registration->verdict != RegistrationVerdict::ambiguous ||
      pose.registration->rivals.empty())
    return;
  begin(reporter, "rival places");
  std::vector<Candidate> all = candidates_of(job, s, image);
  if (all.size() < 2) return;
  const SemNoise noise = job.sem_noise.value_or(least_noise(all, image));
  const auto fit_all = [&](bool closely, double from, double to) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto part = [&](std::size_t k) {
        return from + (to - from) * static_cast<double>(k) / static_cast<double>(all.size());
      };
      fit(all[i], job, s, image, afm, noise, closely, reporter.watch().part(part(i), part(i + 1)));
    }
    likeliest_first(all);
  };
  fit_all(false, 0, 0.3);
  const double best = all.front().value, scale = excess(all.front().found);
  std::erase_if(all,
                [&](const Candidate& c) { return c.value - best > worth_a_closer_look * scale; });
  fit_all(true, 0.3, 1);
  pose.places = judged(all);
  pose.every_rival_judged = pose.registration->rivals.size() <= most_rivals;
  pose.sem_to_afm = pose.places.front().sem_to_afm;
  reporter.note(fmt::format(
      "registration: of {} places that the images might be at, both together say that this one has "
      "a probability of {:.3g}",
      1 + pose.registration->rivals.size(), pose.places.front().probability));
}

std::optional<RivalSurface> rival_surface(const ReconstructJob& job, const ReconstructSummary& s,
                                          const AfmData& afm, const SemData& sem,
                                          const Reporter& reporter) {
  constexpr double same = 0.1;  // share of heights; by chance some 0.05 are apart
  if (!s.pose || s.pose->places.size() < 2 || s.pose->places[1].probability < too_unlikely)
    return std::nullopt;
  begin(reporter, "rival surface");
  SemData there = sem;
  there.model = s.model->model;
  there.sem_to_afm = s.pose->places[1].sem_to_afm;
  ReconstructionOptions o = options_of(job, s);
  o.uncertainty = true;
  o.watch = reporter.watch();
  RivalSurface rival{reconstruct(&afm, &there, o), s.pose->places[1].probability, 0};
  if (s.result.deviation_nm.empty()) return rival;
  rival.share_apart = share_apart(s.result, rival.found);
  if (rival.share_apart < same) return std::nullopt;
  return rival;
}

}  // namespace surf::workflow
