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

  void begin(int round, const ModelCorrection& correction) {
    if (file_) file_->begin_round(round, correction);
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

CorrectionRound report_of(const ModelCorrection& correction, const HeightField& before,
                          const HeightField& after) {
  CorrectionRound round;
  for (std::size_t c = 0; c < correction.off.size(); ++c) {
    const double mean = correction.mean[c], per_yield = mean > 0 ? 1 / mean : 0;
    round.off_share.push_back(rms(correction.off[c]) * per_yield);
    round.error_share.push_back(rms(correction.error[c]) * per_yield);
  }
  round.moved_nm = moved_nm(before.z_nm, after.z_nm);
  round.primaries = correction.primaries;
  round.seconds = correction.seconds;
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

}  // namespace

Reconstruction correct_and_reconstruct(const AfmData* afm, SemData& sem,
                                       const ReconstructionOptions& options,
                                       const StoredModel& model, const CorrectionRequest& request,
                                       int rounds, ReconstructionCheckpoint* checkpoint,
                                       const Reporter& reporter,
                                       std::vector<CorrectionRound>& done) {
  constexpr double share_of_fits = 0.75;  // of the progress; the uncertainty takes the rest
  Rounds journal(checkpoint);
  const SemData uncorrected = sem;
  ReconstructionOptions o = options;
  o.uncertainty = false;
  const auto part = [&](int fit) { return share_of_fits * fit / (rounds + 1); };
  const auto fit = [&](int number) {
    o.watch = options.watch.part(part(number), part(number + 1));
    return reconstruct(afm, &sem, o, &journal);
  };
  Reconstruction result = fit(0);
  for (int round = 0; round < rounds; ++round) {
    const ReconstructionState before = journal.last();
    std::optional<ModelCorrection> correction =
        checkpoint ? checkpoint->correction(round) : std::nullopt;
    if (!correction) {
      begin(reporter, "correction");
      CorrectionRequest own = request;
      own.seed += static_cast<std::uint64_t>(round);
      correction = correction_at(before.surface, sem.image, model, own, reporter);
      begin(reporter, "reconstruction");
    }
    journal.begin(round, *correction);
    sem.model =
        std::make_shared<CorrectedModel>(model.model, correction->off, sem.image.placement());
    sem.discrepancy = with_errors(uncorrected.discrepancy, *correction, before.gains);
    result = fit(round + 1);
    done.push_back(report_of(*correction, before.surface, journal.last().surface));
    reporter.note(in_words(done.back()));
    if (done.back().moved_nm < nothing_px * sem.image.pitch_x_nm) break;
  }
  if (!options.uncertainty) return result;
  o = options;
  o.watch = options.watch.part(share_of_fits, 1);
  return reconstruct(afm, &sem, o, &journal);
}

}  // namespace surf::workflow
