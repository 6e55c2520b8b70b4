// SPDX-License-Identifier: GPL-3.0-or-later
#include "correct_and_reconstruct.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "chain_steps.h"
#include "surf/core/units.h"
#include "surf/sem/corrected_model.h"

namespace surf::workflow {
namespace {

constexpr double nothing_px = 0.04;  // a surface that moves by less has not moved

/// Goes on from the state before. A round of corrections repeats its last scale.
class Rounds : public ReconstructionJournal {
 public:
  explicit Rounds(ReconstructionCheckpoint* file) : file_(file) {}

  void begin(int round, const std::vector<ModelCorrection>& corrections) {
    if (file_) file_->begin_round(round, corrections);
    repeats_ = true;
  }
  std::optional<ReconstructionState> found() override {
    if (auto stored = file_ ? file_->found() : std::nullopt; stored && (repeats_ || !last_)) {
      repeats_ = false;
      last_ = std::move(stored);
    }
    std::optional<ReconstructionState> state = last_;
    if (state && repeats_) state->scales.pop_back();
    repeats_ = false;
    return state;
  }
  void keep(const ReconstructionState& state) override {
    last_ = state;
    if (file_) file_->keep(state);
  }
  const ReconstructionState& last() const { return *last_; }

 private:
  ReconstructionCheckpoint* file_;
  std::optional<ReconstructionState> last_;
  bool repeats_ = false;
};

double rms(const Grid<double>& values) {
  double sum = 0;
  for (const double v : values.data()) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double moved_nm(const Grid<double>& from, const Grid<double>& to) {
  Grid<double> change = to;
  double mean = 0;
  for (std::size_t i = 0; i < change.size(); ++i) {
    change.data()[i] -= from.data()[i];
    mean += change.data()[i] / static_cast<double>(change.size());
  }
  for (double& c : change.data()) c -= mean;
  return rms(change);
}

CorrectionRound report_of(const std::vector<ModelCorrection>& corrections,
                          const HeightField& before, const HeightField& after) {
  CorrectionRound round;
  const ModelCorrection& correction = corrections.front();
  for (std::size_t c = 0; c < correction.off.size(); ++c) {
    const double mean = correction.mean[c], per_yield = mean > 0 ? 1 / mean : 0;
    round.off_share.push_back(rms(correction.off[c]) * per_yield);
    round.error_share.push_back(rms(correction.error[c]) * per_yield);
  }
  round.moved_nm = moved_nm(before.z_nm, after.z_nm);
  for (const ModelCorrection& c : corrections)
    round.primaries += c.primaries, round.seconds += c.seconds;
  return round;
}

std::string in_words(const CorrectionRound& round) {
  return fmt::format(
      "Monte Carlo corrects the model by {:.1f} % of the yield, known to {:.1f} %: the surface "
      "moves by {}",
      100 * *std::ranges::max_element(round.off_share),
      100 * *std::ranges::max_element(round.error_share), format_length(round.moved_nm));
}

/// What the correction may be off by adds to what the model may be off by.
std::vector<SemDiscrepancy> with_errors(std::vector<SemDiscrepancy> parts,
                                        const ModelCorrection& correction,
                                        const std::vector<double>& gains) {
  if (parts.empty()) return parts;
  Grid<double>& deviation = parts.front().deviation;
  for (std::size_t i = 0; i < deviation.size(); ++i) {
    double variance = deviation.data()[i] * deviation.data()[i];
    for (std::size_t c = 0; c < gains.size(); ++c)
      variance += std::pow(gains[c] * correction.error[c].data()[i], 2);
    deviation.data()[i] = std::sqrt(variance);
  }
  return parts;
}

/// What the tilted beam of a view sees of a surface, without holes.
HeightField seen_by(const ViewPose& pose, const HeightField& surface, const PlacedImage& image,
                    int threads) {
  constexpr int margin_px = 12;
  HeightField out = heights_along_beam(surface, image, pose, margin_px, threads);
  out.valid = {};
  return out;
}

/// The corrections of all images at a surface: the first one's, then each view's.
std::vector<ModelCorrection> corrections_at(const HeightField& surface, const Reconstruction& fit,
                                            const SemData& sem, const std::vector<SemView>& views,
                                            const ReconstructSummary& s,
                                            const CorrectionRequest& request,
                                            const Reporter& reporter) {
  constexpr std::uint64_t apart = 1000;  // seeds of images, more than there are rounds
  std::vector<ModelCorrection> out{correction_at(surface, sem.image, *s.model, request, reporter)};
  for (std::size_t k = 0; k < views.size(); ++k) {
    CorrectionRequest own = request;
    own.seed += apart * (k + 1);
    const PlacedImage& image = views[k].sem.image;
    out.push_back(correction_at(seen_by(fit.views[k].pose, surface, image, request.threads), image,
                                s.views[k].model, own, reporter));
  }
  return out;
}

/// Puts a model right by its correction, at an image whose data were `before`.
void correct(const ModelCorrection& correction, const SemData& before,
             const std::vector<double>& gains, SemData& sem) {
  sem.model = std::make_shared<CorrectedModel>(before.model, correction.off, sem.image.placement());
  sem.discrepancy = with_errors(before.discrepancy, correction, gains);
}

}  // namespace

Reconstruction correct_and_reconstruct(
    const AfmData* afm, SemData& sem, std::vector<SemView>& views,
    const ReconstructionOptions& options, const ReconstructSummary& summary,
    const CorrectionRequest& request, int rounds, ReconstructionCheckpoint* checkpoint,
    const Reporter& reporter, std::vector<CorrectionRound>& done) {
  constexpr double share_of_fits = 0.75;  // of the progress; the uncertainty takes the rest
  Rounds journal(checkpoint);
  const SemData uncorrected = sem;
  const std::vector<SemView> uncorrected_views = views;
  ReconstructionOptions o = options;
  o.uncertainty = false;
  const auto part = [&](int fit) { return share_of_fits * fit / (rounds + 1); };
  const auto fit = [&](int number) {
    o.watch = options.watch.part(part(number), part(number + 1));
    return reconstruct(afm, &sem, views, o, &journal);
  };
  Reconstruction result = fit(0);
  for (int round = 0; round < rounds; ++round) {
    const ReconstructionState before = journal.last();
    std::vector<ModelCorrection> corrections =
        checkpoint ? checkpoint->corrections(round) : std::vector<ModelCorrection>();
    if (corrections.empty()) {
      begin(reporter, "correction");
      CorrectionRequest own = request;
      own.seed += static_cast<std::uint64_t>(round);
      corrections = corrections_at(before.surface, result, sem, views, summary, own, reporter);
      begin(reporter, "reconstruction");
    }
    journal.begin(round, corrections);
    correct(corrections.front(), uncorrected, before.gains, sem);
    for (std::size_t k = 0; k < views.size(); ++k)
      correct(corrections[k + 1], uncorrected_views[k].sem, before.views[k].gains, views[k].sem);
    result = fit(round + 1);
    done.push_back(report_of(corrections, before.surface, journal.last().surface));
    reporter.note(in_words(done.back()));
    if (done.back().moved_nm < nothing_px * sem.image.pitch_x_nm) break;
  }
  if (!options.uncertainty) return result;
  o = options;
  o.watch = options.watch.part(share_of_fits, 1);
  return reconstruct(afm, &sem, views, o, &journal);
}

}  // namespace surf::workflow
