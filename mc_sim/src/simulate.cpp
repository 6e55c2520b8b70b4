// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/simulate.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "geometry/scene_impl.h"
#include "request/check_options.h"
#include "sampling/unit_worker.h"
#include "scheduling/prepared_simulation.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/core/try_thread.h"
#include "surf/mc/results/serialize.h"
#include "surf/mc/scheduling/unit_plan.h"
#include "surf/mc/scheduling/unit_scheduler.h"

namespace surf::mc {

namespace {

// Merges units as they come. Large tallies go back to the disk now and then.
class Collector {
 public:
  Collector(const Scan& scan, const SimulationOptions& options) : result(empty_result(scan, options)) {}

  void add(const WorkUnit& u, const UnitTally& tally) {
    merge(result, u, tally);
    added_ += tally.pixels.size();
    if (added_ < most_added) return;
    result.release();
    added_ = 0;
  }

  SimulationResult result;

 private:
  static constexpr std::size_t most_added = std::size_t{1} << 19;   // pixels between releases
  std::size_t added_ = 0;
};

// Units as they are finished, and who is told of them.
struct Merging {
  const UnitPlan& plan;
  Collector& collector;
  const ProgressCallback& progress;
  UnitJournal* journal;
  double done = 0;
  std::mutex mutex{};

  void add(std::size_t number, const UnitTally& tally) {
    const WorkUnit unit = plan.unit(number);
    collector.add(unit, tally);
    done += plan.done(unit, tally);
  }
  /// Whether the journal knew it.
  bool recall(std::size_t number) {
    UnitTally tally;
    if (!journal || !journal->recall(number, tally)) return false;
    collector.result.recalled += tally.balance.incident;
    add(number, tally);
    return true;
  }
  void give(std::size_t number, const UnitTally& tally) {
    add(number, tally);
    if (progress) progress(done, plan.total());
    if (journal) journal->record(number, tally);
  }
};

// What a thread works with, made when it first has something to do.
struct Bench {
  std::unique_ptr<UnitWorker> worker;
  Observer* observer;
};
using Benches = std::vector<std::unique_ptr<Bench>>;

Bench& bench_of(Benches& benches, int thread, PreparedSimulation& prepared, const ObserverOfThread& observers) {
  auto& bench = benches[static_cast<std::size_t>(thread)];
  if (!bench) bench = std::make_unique<Bench>(Bench{prepared.worker(), observers ? observers(thread) : nullptr});
  return *bench;
}

void run_all(const UnitPlan& plan, PreparedSimulation& prepared, int threads, const ObserverOfThread& observers,
             Merging& merging, const CancelToken* cancel) {
  Benches benches(static_cast<std::size_t>(threads));
  parallel_for(plan.units(), threads, [&](std::size_t i, int w) {
    if (cancel && cancel->cancelled()) return;
    if (merging.journal) {
      const std::lock_guard lock(merging.mutex);
      if (merging.recall(i)) return;
    }
    Bench& bench = bench_of(benches, w, prepared, observers);
    bench.worker->cancel = observers ? nullptr : cancel;   // what they have seen of a unit has to count
    UnitTally tally;
    try {
      bench.worker->simulate(plan.unit(i), bench.observer, tally);
    } catch (const Interrupted&) {
      return;   // the unit is left out, and done anew by who resumes
    }
    const std::lock_guard lock(merging.mutex);
    merging.give(i, tally);
  });
}

using GiveTally = std::function<void(std::size_t number, const UnitTally& tally)>;

// Threads of this process take units until there are none.
void take_and_give(const UnitPlan& plan, PreparedSimulation& prepared, int threads, const CancelToken* cancel,
                   const TakeUnit& take, const GiveTally& give) {
  Benches benches(static_cast<std::size_t>(threads));
  parallel_for(static_cast<std::size_t>(threads), threads, [&](std::size_t, int w) {
    while (const auto number = take()) {
      UnitWorker& worker = *bench_of(benches, w, prepared, {}).worker;
      worker.cancel = cancel;
      UnitTally tally;
      try {
        worker.simulate(plan.unit(*number), nullptr, tally);
      } catch (const Interrupted&) {
        return;   // as in run_all
      }
      give(*number, tally);
    }
  });
}

// The same units, whoever does them: they merge to the same result.
void share(UnitScheduler& scheduler, const UnitPlan& plan, PreparedSimulation& prepared, int threads, Merging& merging,
           const CancelToken* cancel) {
  if (!scheduler.leads()) {
    scheduler.follow([&](const TakeUnit& take, const GiveUnit& give) {
      take_and_give(plan, prepared, threads, cancel, take, [&](std::size_t number, const UnitTally& tally) {
        give({number, tally.balance.incident, serialize(tally)});
      });
    }, threads, threads, cancel);
    return;
  }
  std::size_t next = 0;
  bool ended = false;   // an error on either side: the other takes no more
  const TakeUnit take = [&]() -> std::optional<std::size_t> {
    const std::lock_guard lock(merging.mutex);
    while (!ended && next < plan.units() && !(cancel && cancel->cancelled()))
      if (const std::size_t number = next++; !merging.recall(number)) return number;
    return std::nullopt;
  };
  const GiveTally give = [&](std::size_t number, const UnitTally& tally) {
    const std::lock_guard lock(merging.mutex);
    merging.give(number, tally);
  };
  const auto end = [&] {
    const std::lock_guard lock(merging.mutex);
    ended = true;
  };
  std::exception_ptr own, of_crew;
  {
    // The scheduler is led from here: its messages may have to come from the thread that began.
    const auto work = [&] {
      try {
        take_and_give(plan, prepared, threads, cancel, take, give);
      } catch (...) {
        own = std::current_exception();
        end();
      }
    };
    const std::jthread at_work = try_thread(work);
    try {
      scheduler.lead(take, [&](const FinishedUnit& unit) { give(unit.number, deserialize(unit.bytes)); }, cancel);
    } catch (...) {
      of_crew = std::current_exception();
      end();
    }
    if (!at_work.joinable()) work();   // what the others have left
  }
  if (own) std::rethrow_exception(own);
  if (of_crew) std::rethrow_exception(of_crew);
}

// Where this process cannot go on: the others neither wait for it nor begin.
void send_home(UnitScheduler& scheduler, const std::exception_ptr& trouble, const CancelToken* cancel) {
  try {
    if (scheduler.leads())
      scheduler.lead([] { return std::nullopt; }, [](const FinishedUnit&) {}, cancel);
    else
      scheduler.follow(
          [&](const TakeUnit&, const GiveUnit&) {
            if (trouble) std::rethrow_exception(trouble);
            throw Interrupted();
          },
          1, 0, cancel);
  } catch (...) {   // it is told by who calls
  }
}

Scan one_pixel() {
  Scan scan;
  scan.width = scan.height = 1;
  return scan;
}

}  // namespace

void SimulationContext::check(const SimulationOptions& options, const Scene& scene) const {
  if (options.method == Method::replay && observers)
    throw UsageError("`simulation.method=replay`", "stored cascades show observers nothing between surfaces",
                     "Use `simulation.method=direct`");
  if (options.method == Method::replay && !can_replay(scene.physics(), scene.materials()))
    throw UsageError("`simulation.method=replay`", "cascades are joined where energies are equal, which needs "
                                        "continuous loss",
                     "Use `simulation.method=direct`, or loss=joy-luo");
  if (accuracy_of(options.budget) > 0 && observers)
    throw UsageError("`simulation.accuracy`", "what observers see would be of more primaries in some pixels than in others",
                     "Give `simulation.electrons` instead");
  if (scheduler && observers)
    throw UsageError("`output.deposit`", "each of several processes would see a part of it", "Run it in one process");
  if (journal && observers)
    throw UsageError("simulate", "observers would not see the units that a journal recalls",
                     "Leave one of the two out");
}

SimulationResult simulate(const Scene& scene, const SimulationOptions& options, const SimulationContext& context) {
  check_options(options);
  context.check(options, scene);
  const auto& [progress, cancel, observers, journal, libraries, scheduler] = context;
  auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const UnitPlan plan(scene.scan(), options);
  // Who follows has nothing to collect: its memory need not hold the image.
  std::optional<Collector> room;
  PreparedSimulation prepared;
  bool ready = false;
  std::exception_ptr trouble;
  try {
    if (!scheduler) room.emplace(scene.scan(), options);
    // All get the libraries together: nobody may leave for reasons of its own before.
    ready = prepared.prepare(scene, options, libraries, plan.most(), {}, cancel, scheduler != nullptr);
    if (scheduler) room.emplace(scheduler->leads() ? scene.scan() : one_pixel(), options);
  } catch (const Interrupted&) {
    ready = false;
  } catch (...) {
    trouble = std::current_exception();
  }
  if (scheduler && (!ready || trouble)) send_home(*scheduler, trouble, cancel);
  if (trouble) std::rethrow_exception(trouble);
  if (!room) room.emplace(scheduler && !scheduler->leads() ? one_pixel() : scene.scan(), options);
  Collector& collector = *room;
  SimulationResult& result = collector.result;
  if (!ready) {
    result.complete = false;
    return std::move(result);
  }
  result.library_cascades = prepared.cascades();
  result.cascade_yields = prepared.yields();
  result.library_seconds = seconds();
  begin = std::chrono::steady_clock::now();
  Merging merging{plan, collector, progress, journal};
  if (scheduler) share(*scheduler, plan, prepared, resolve_threads(options.threads), merging, cancel);
  else run_all(plan, prepared, resolve_threads(options.threads), observers, merging, cancel);
  result.complete = merging.done == plan.total() || (scheduler && !scheduler->leads());
  result.seconds = seconds();
  return std::move(result);
}

}  // namespace surf::mc
