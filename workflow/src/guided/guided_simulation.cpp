// SPDX-License-Identifier: GPL-3.0-or-later
#include "guided/guided_simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>

#include "guided/guided_images.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mc/sampling/choose_method.h"

namespace surf::workflow {
namespace {

// Of each pixel before anything is known of it: 16 in either half.
constexpr std::int64_t first_round_electrons = 32;
// Fewer, on average, say too little of their own scatter.
constexpr double fewest_guided_electrons = 8;
constexpr std::int64_t most_pixels = std::int64_t{1} << 24;  // all planes are in memory together
constexpr std::int64_t cascade_run = 32;  // electrons are added in runs of cascades
// Electrons of a pixel times the square of the error that they leave, in scenes of all kinds.
constexpr double usual_guided_variance = 0.1;
constexpr int most_rounds = 24;
constexpr double least_growth = 1.3;
constexpr double most_growth = 4;  // of a pixel's electrons in a round
constexpr double around_px = 5;    // of the neighbourhood that an accuracy is reached in
constexpr double least_target = 1e-9;
constexpr double share_of_time = 0.9, share_of_memory = 0.9;

constexpr double reserve = 1.1;  // over what the estimate of the error asks for
// Cascades for each electron of a pixel: a guided pixel is the mean of up to a hundred, and the
// library's share of its variance is to be a fifth of that.
constexpr double cascades_per_electron = 512;
// With an accuracy a: a tenth of the variance at yields whose one-electron variance is 4 m^2.
constexpr double cascades_of_accuracy = 40;

/// Units of a round, numbered after those of the rounds before.
class RoundJournal final : public mc::UnitJournal {
 public:
  RoundJournal(mc::UnitJournal& all, std::size_t round) : all_(all), first_(round << 40) {}
  bool recall(std::size_t unit, mc::UnitTally& tally) override {
    return all_.recall(first_ + unit, tally);
  }
  void record(std::size_t unit, const mc::UnitTally& tally) override {
    all_.record(first_ + unit, tally);
  }

 private:
  mc::UnitJournal& all_;
  std::size_t first_;
};

/// The root mean square of the error over what is asked for, around each pixel, of the detector
/// that has it worst. Errors are known of neighbourhoods, not of single pixels, and estimates there
/// share their weights: so electrons are added to neighbourhoods.
Grid<double> error_over_target(const std::vector<GuidedImage>& images, const mc::Budget& budget) {
  Grid<double> worst;
  for (const GuidedImage& image : images) {
    Grid<double> square(image.mean.width(), image.mean.height(), 0.0), known = square;
    for (std::size_t i = 0; i < square.size(); ++i) {
      if (!(image.radius_px.data()[i] > 0)) continue;
      const double target = std::max(mc::accuracy_of(budget) * std::max(image.mean.data()[i], 0.0),
                                     std::max(mc::floor_of(budget), least_target));
      square.data()[i] = std::pow(image.error.data()[i] / target, 2);
      known.data()[i] = 1;
    }
    Grid<double> around = mean_around(square, known, around_px);
    if (worst.empty()) worst = Grid<double>(around.width(), around.height(), 0.0);
    for (std::size_t i = 0; i < around.size(); ++i)
      if (known.data()[i] > 0)
        worst.data()[i] = std::max(worst.data()[i], std::sqrt(around.data()[i]));
  }
  return worst;
}

struct NextRound {
  Grid<std::int64_t> end;  ///< of each pixel's primaries
  bool more = false;
  double worst = 0;  ///< error over target
};

NextRound next_round(const mc::SimulationResult& r, const Grid<double>& ratio, std::int64_t most) {
  NextRound next;
  next.end = Grid<std::int64_t>(r.pixels.width(), r.pixels.height());
  bool grows = false;
  for (int y = 0; y < r.pixels.height(); ++y)
    for (int x = 0; x < r.pixels.width(); ++x) {
      const std::int64_t n = r.pixels(x, y).primaries;
      next.worst = std::max(next.worst, ratio(x, y));
      std::int64_t end = n;
      if (ratio(x, y) > 1) {
        const double growth =
            std::clamp(reserve * ratio(x, y) * ratio(x, y), least_growth, most_growth);
        end = static_cast<std::int64_t>(std::ceil(static_cast<double>(n) * growth / cascade_run)) *
              cascade_run;
        end = std::max(n, std::min(end, most));
      }
      next.end(x, y) = end;
      grows = grows || end > n;
    }
  next.more = grows && next.worst > mc::ResultSummary::missed_by;
  return next;
}

std::string packed(const Grid<std::int64_t>& numbers) {
  std::string bytes(numbers.size() * sizeof(std::int64_t), '\0');
  std::memcpy(bytes.data(), numbers.data().data(), bytes.size());
  return bytes;
}

Grid<std::int64_t> unpacked(const std::string& bytes, int width, int height) {
  Grid<std::int64_t> numbers(width, height);
  std::memcpy(numbers.data().data(), bytes.data(), bytes.size());
  return numbers;
}

/// Whether guides are worth their time.
bool guides_pay(const mc::SimulationOptions& options, const mc::Scan& scan) {
  constexpr std::int64_t fewest_pixels = 32 * 32;
  constexpr double most_electrons = 4000, finest = 0.005;
  const std::int64_t pixels = std::int64_t{scan.width} * scan.height;
  if (pixels < fewest_pixels || pixels > most_pixels) return false;
  if (const double accuracy = mc::accuracy_of(options.budget); accuracy > 0)
    return accuracy >= finest;
  const double electrons = mc::mean_electrons_of(options.budget);
  return electrons >= fewest_guided_electrons && electrons <= most_electrons;
}

void check_guided(const mc::SimulationOptions& options, const mc::Scan& scan) {
  const double electrons = mc::mean_electrons_of(options.budget);
  if (!(mc::accuracy_of(options.budget) > 0) && electrons < fewest_guided_electrons)
    throw UsageError(
        "`simulation.estimate=guided`",
        fmt::format("{:g} electrons per pixel are too few to tell their scatter", electrons),
        "Give 8 or more; 64 are often enough");
  if (std::int64_t{scan.width} * scan.height > most_pixels)
    throw UsageError("`simulation.estimate=guided`",
                     fmt::format("{} x {} pixels are more than the 16 million that it holds in "
                                 "memory",
                                 scan.width, scan.height),
                     "Choose a smaller scan, or `simulation.estimate=plain`");
}

/// What an accuracy is expected to take, as a number of electrons; other budgets as they are.
mc::Budget expected_budget(const mc::Budget& budget) {
  const double accuracy = mc::accuracy_of(budget);
  if (!(accuracy > 0)) return budget;
  return mc::ElectronsPerPixel{std::max<std::int64_t>(
      first_round_electrons,
      static_cast<std::int64_t>(usual_guided_variance / (accuracy * accuracy)))};
}

}  // namespace

void settle_estimate(EstimateOptions& estimate, const mc::SimulationOptions& options,
                     const mc::Scan& scan) {
  if (estimate.kind == Estimate::automatic)
    estimate.kind = guides_pay(options, scan) ? Estimate::guided : Estimate::plain;
  if (estimate.kind == Estimate::guided) check_guided(options, scan);
}

mc::SimulationOptions expected_options(const mc::Scene& scene, const mc::SimulationOptions& options,
                                       double& cascades_that_fit) {
  mc::SimulationOptions expected = options;
  expected.budget = expected_budget(options.budget);
  const mc::MethodChoice few = mc::choose_method(scene, expected);
  if (few.library_bytes > 0)
    cascades_that_fit = share_of_memory * mc::MethodLimits{}.library_bytes *
                        static_cast<double>(few.cascades) / few.library_bytes;
  expected.least_cascades = guided_options(options, cascades_that_fit).least_cascades;
  return expected;
}

mc::SimulationOptions guided_options(mc::SimulationOptions options, double cascades_that_fit) {
  double wanted = cascades_per_electron * mc::mean_electrons_of(options.budget);
  if (const double accuracy = mc::accuracy_of(options.budget); accuracy > 0) {
    wanted = cascades_of_accuracy / (accuracy * accuracy);
    options.budget = mc::ElectronsPerPixel{first_round_electrons};
  }
  options.least_cascades = static_cast<std::size_t>(std::min(wanted, cascades_that_fit));
  options.odd_counts = true;
  return options;
}

GuidedSimulation simulate_guided(const mc::Scene& scene, const mc::SimulationOptions& asked,
                                 const SceneGuides& guides, double cascades_that_fit,
                                 const mc::SimulationContext& given, const Simulator& simulator,
                                 const Reporter& reporter, Team* team) {
  mc::SimulationOptions options = guided_options(asked, cascades_that_fit);
  mc::SimulationContext context = given;
  const int width = scene.scan().width, height = scene.scan().height;
  const bool in_rounds = mc::accuracy_of(asked.budget) > 0;
  double done_before = 0;
  context.watch.progress = [&](double done, double total) {
    if (given.watch.progress) given.watch.progress(done_before + done, done_before + total);
  };
  GuidedSimulation out;
  for (int round = 0;; ++round) {
    std::optional<RoundJournal> journal;
    if (given.journal) journal.emplace(*given.journal, static_cast<std::size_t>(round));
    context.journal = journal ? &*journal : nullptr;
    mc::SimulationResult added = simulator(scene, options, context);
    done_before += static_cast<double>(added.balance.incident);
    const bool complete = added.complete;
    if (round == 0) out.result = std::move(added);
    else if (leads(team)) mc::add_round(out.result, added);
    out.rounds = round + 1;
    std::string numbers;
    std::exception_ptr thrown;
    if (leads(team)) try {
        const Watch watch{{}, complete ? context.watch.cancel : nullptr};
        out.images = estimate_images(out.result, guides, options.threads, watch);
        if (in_rounds && complete && out.rounds < most_rounds) {
          const std::int64_t most = out.result.library_cascades > 0
                                        ? static_cast<std::int64_t>(out.result.library_cascades)
                                        : std::int64_t{1} << 31;
          const NextRound next =
              next_round(out.result, error_over_target(out.images, asked.budget), most);
          reporter.note(fmt::format(
              "round {}: {:.0f} electrons per pixel, the worst error is {:.2g} times {}",
              out.rounds,
              static_cast<double>(out.result.balance.incident) /
                  (static_cast<double>(width) * height),
              next.worst, format_share(mc::accuracy_of(asked.budget))));
          if (next.more) numbers = packed(next.end);
        }
      } catch (const Interrupted&) {
        out.result.complete = false;
      } catch (...) {
        if (!team) throw;
        thrown = std::current_exception();
      }
    if (team) team->broadcast(numbers);
    if (thrown) std::rethrow_exception(thrown);
    if (numbers.empty()) break;
    auto primaries = std::make_shared<mc::PrimaryNumbers>();
    primaries->first = options.primaries ? options.primaries->end
                                         : Grid<std::int64_t>(width, height, first_round_electrons);
    primaries->end = unpacked(numbers, width, height);
    options.primaries = std::move(primaries);
  }
  out.result.budget = asked.budget;
  return out;
}

std::int64_t electrons_that_fit(const mc::Scene& scene, const mc::SimulationOptions& asked,
                                const SceneGuides& guides, double cascades_that_fit,
                                const mc::SimulationContext& context, const Simulator& simulator,
                                double seconds, Team* team) {
  mc::SimulationOptions options = asked;
  options.budget = mc::ElectronsPerPixel{first_round_electrons};
  options = guided_options(std::move(options), cascades_that_fit);
  const auto begin = std::chrono::steady_clock::now();
  const auto passed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const mc::SimulationResult first = simulator(scene, options, context);
  const double simulated = passed();
  std::string found;
  std::exception_ptr thrown;
  if (leads(team)) try {
      if (!first.complete) throw Interrupted();
      estimate_images(first, guides, options.threads, {{}, context.watch.cancel});
      const double estimating = passed() - simulated;
      const double left = share_of_time * (seconds - passed()) - estimating;
      const double per_electron = (first.seconds + first.library_seconds) / first_round_electrons;
      const auto electrons = static_cast<std::int64_t>(std::max(0.0, left) / per_electron);
      found = std::to_string(std::clamp<std::int64_t>(
          electrons / cascade_run * cascade_run, first_round_electrons, std::int64_t{1} << 20));
    } catch (...) {
      if (!team) throw;
      thrown = std::current_exception();
    }
  if (team) team->broadcast(found);
  if (thrown) std::rethrow_exception(thrown);
  if (found.empty()) throw Interrupted();  // the leader says why
  return std::stoll(found);
}

void summarize_accuracy(const std::vector<GuidedImage>& images, const mc::Budget& budget,
                        mc::ResultSummary& summary) {
  summary.missed = 0;
  summary.worst = 0;
  if (!(mc::accuracy_of(budget) > 0)) return;
  const Grid<double> ratio = error_over_target(images, budget);
  for (const double here : ratio.data()) {
    summary.worst = std::max(summary.worst, here);
    if (here > mc::ResultSummary::missed_by) ++summary.missed;
  }
}

}  // namespace surf::workflow
