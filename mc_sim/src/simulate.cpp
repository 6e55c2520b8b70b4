// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/simulate.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>

#include "geometry/scene_impl.h"
#include "request/check_options.h"
#include "sampling/unit_worker.h"
#include "scheduling/prepared_simulation.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/mc/scheduling/unit_plan.h"
#include "surf/mc/scheduling/unit_scheduler.h"

namespace surf::mc {

namespace {

// Merges units as they come. Large tallies go back to the disk now and then.
class Collector {
 public:
  Collector(const Scan& scan, const SimulationOptions& options)
      : result(empty_result(scan, options)) {}

  void add(const WorkUnit& u, const UnitTally& tally) {
    merge(result, u, tally);
    added_ += tally.pixels.size();
    if (added_ < most_added) return;
    result.release();
    added_ = 0;
  }

  SimulationResult result;

 private:
  static constexpr std::size_t most_added = std::size_t{1} << 19;  // pixels between releases
  std::size_t added_ = 0;
};

// Hands units out, and merges them as they are finished. For use from many threads.
class Merging {
 public:
  Merging(const UnitPlan& plan, Collector& collector, UnitJournal* journal, const Watch& watch)
      : plan_(plan), collector_(collector), journal_(journal), watch_(watch) {}

  /// The next unit that the journal does not know.
  std::optional<std::size_t> take() {
    const std::lock_guard lock(mutex_);
    while (next_ < plan_.units() && !watch_.cancelled())
      if (const std::size_t number = next_++; !recall(number)) return number;
    return std::nullopt;
  }

  void finish(std::size_t number, const UnitTally& tally) {
    const std::lock_guard lock(mutex_);
    add(number, tally);
    if (watch_.progress) watch_.progress(done_, plan_.total());
    if (journal_) journal_->record(number, tally);
  }

  bool complete() const { return done_ == plan_.total(); }

 private:
  void add(std::size_t number, const UnitTally& tally) {
    const WorkUnit unit = plan_.unit(number);
    collector_.add(unit, tally);
    done_ += plan_.done(unit, tally);
  }

  // Whether the journal knew it.
  bool recall(std::size_t number) {
    UnitTally tally;
    if (!journal_ || !journal_->recall(number, tally)) return false;
    collector_.result.recalled += tally.balance.incident;
    add(number, tally);
    return true;
  }

  const UnitPlan& plan_;
  Collector& collector_;
  UnitJournal* journal_;
  const Watch& watch_;
  std::mutex mutex_;
  std::size_t next_ = 0;
  double done_ = 0;
};

// What simulates on each of the threads, made when the thread first has something to do.
class Workers {
 public:
  Workers(PreparedSimulation& prepared, int threads, const ObserverOfThread& observers,
          const CancelToken* cancel)
      : prepared_(prepared), observers_(observers), cancel_(cancel),
        of_thread_(static_cast<std::size_t>(threads)) {}

  /// False when it was cancelled. What observers have seen of a unit has to count: then it is not.
  bool simulate(const WorkUnit& unit, int thread, UnitTally& tally) {
    Worker& w = of_thread_[static_cast<std::size_t>(thread)];
    if (!w.worker) {
      w = {prepared_.worker(), observers_ ? observers_(thread) : nullptr};
      w.worker->cancel = observers_ ? nullptr : cancel_;
    }
    try {
      w.worker->simulate(unit, w.observer, tally);
    } catch (const Interrupted&) {
      return false;
    }
    return true;
  }

 private:
  struct Worker {
    std::unique_ptr<UnitWorker> worker;
    Observer* observer = nullptr;
  };
  PreparedSimulation& prepared_;
  const ObserverOfThread& observers_;
  const CancelToken* cancel_;
  std::vector<Worker> of_thread_;
};

Scan one_pixel() {
  Scan scan;
  scan.width = scan.height = 1;
  return scan;
}

}  // namespace

void SimulationContext::check(const SimulationOptions& options, const Scene& scene) const {
  if (options.method == Method::replay && observers)
    throw UsageError("`simulation.method=replay`",
                     "stored cascades show observers nothing between surfaces",
                     "Use `simulation.method=direct`");
  if (options.method == Method::replay && !can_replay(scene.physics(), scene.materials()))
    throw UsageError("`simulation.method=replay`",
                     "cascades are joined where energies are equal, which needs "
                     "continuous loss",
                     "Use `simulation.method=direct`, loss=joy-luo, or inelastic=dielectric");
  if (accuracy_of(options.budget) > 0 && observers)
    throw UsageError("`simulation.accuracy`",
                     "what observers see would be of more primaries in some pixels than in others",
                     "Give `simulation.electrons` instead");
  if (const PrimaryNumbers* const numbers = options.primaries.get()) {
    bool fits = true;
    for (const auto* grid : {&numbers->first, &numbers->end})
      fits = fits && grid->width() == scene.scan().width && grid->height() == scene.scan().height;
    for (std::size_t i = 0; fits && i < numbers->first.size(); ++i)
      fits = numbers->first.data()[i] >= 0 && numbers->end.data()[i] >= numbers->first.data()[i] &&
             numbers->end.data()[i] <= std::int64_t{1} << 31;
    if (!fits)
      throw UsageError("numbers of primaries",
                       "they are of another scan, or a pixel's first one is after its last",
                       "Give first and end of each pixel of the scan, 0 to 2^31");
  }
  if (scheduler && observers)
    throw UsageError("`output.deposit`", "each of several processes would see a part of it",
                     "Run it in one process");
  if (journal && observers)
    throw UsageError("simulate", "observers would not see the units that a journal recalls",
                     "Leave one of the two out");
}

SimulationResult simulate(const Scene& scene, const SimulationOptions& options,
                          const SimulationContext& context) {
  check_options(options);
  context.check(options, scene);
  const auto& [watch, observers, journal, libraries, given] = context;
  ThreadScheduler own_threads;
  UnitScheduler& scheduler = given ? *given : own_threads;
  auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const UnitPlan plan(scene.scan(), options);
  // Where nothing is collected, memory need not hold the image.
  const Scan collected = scheduler.collects() ? scene.scan() : one_pixel();
  PreparedSimulation prepared;
  std::optional<Collector> collector;
  std::exception_ptr trouble;
  bool ready = false;
  try {
    prepared.prepare(scene, options, libraries, plan.most(), {{}, watch.cancel});
    ready = true;
    collector.emplace(collected, options);
  } catch (const Interrupted&) {
    ready = false;
  } catch (...) {
    trouble = std::current_exception();
  }
  if (!ready || trouble) scheduler.abandon(trouble, watch.cancel);
  if (trouble) std::rethrow_exception(trouble);
  if (!collector) collector.emplace(collected, options);
  SimulationResult& result = collector->result;
  if (!ready) {
    result.complete = false;
    return std::move(result);
  }
  result.library_cascades = prepared.cascades();
  result.cascade_yields = prepared.yields();
  result.library_seconds = seconds();
  begin = std::chrono::steady_clock::now();
  const int threads = resolve_threads(options.threads);
  Merging merging(plan, *collector, journal, watch);
  Workers workers(prepared, threads, observers, watch.cancel);
  scheduler.run({threads, [&] { return merging.take(); },
                 [&](std::size_t number, int thread, UnitTally& tally) {
                   return workers.simulate(plan.unit(number), thread, tally);
                 },
                 [&](std::size_t number, const UnitTally& tally) { merging.finish(number, tally); },
                 watch.cancel});
  result.complete = merging.complete() || !scheduler.collects();
  result.seconds = seconds();
  return std::move(result);
}

}  // namespace surf::mc
