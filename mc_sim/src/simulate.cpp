// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/simulate.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "plane_controls.h"
#include "replay_site.h"
#include "scene_impl.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/mc/crew.h"
#include "surf/mc/pack.h"
#include "surf/mc/unit_plan.h"
#include "unit_worker.h"

namespace surf::mc {

namespace {

constexpr std::int64_t most_electrons = std::int64_t{1} << 31;
constexpr double largest_dose = 1e9;

void check_unit(const Scan& scan, const WorkUnit& u) {
  if (u.x0 < 0 || u.y0 < 0 || u.x1 > scan.width || u.y1 > scan.height || u.x0 >= u.x1 ||
      u.y0 >= u.y1 || u.electrons < 1 || u.first_electron < 0)
    throw UsageError("unit of work", "it is empty or reaches beyond the scan",
                     "Choose pixels within the scan and at least one electron");
}

void check_options(const SimulationOptions& options) {
  if (options.electrons < 1 || options.electrons > most_electrons)
    throw UsageError("--electrons", "the number of primaries per pixel must be 1 to 2^31",
                     "Ask for 200, say");
  if (!(options.dose >= 0 && options.dose <= largest_dose))
    throw UsageError("dose", fmt::format("{:g} primaries per pixel are outside 0 to 1e9",
                                         options.dose), "Choose a smaller current or dwell time");
  if (options.tile_pixels < 1)
    throw UsageError("tile size", "a tile needs at least one pixel", "Ask for 1024, say");
  if (options.detectors.empty())
    throw UsageError("detectors", "there are none", "Use SE and BSE");
  validate(options.detectors);
  if (options.accuracy != 0 && !(options.accuracy >= 1e-4 && options.accuracy <= 1))
    throw UsageError("--accuracy", fmt::format("{:g} is outside 0.0001 to 1", options.accuracy),
                     "Ask for 0.01 or 1%, say");
  if (!(options.accuracy_floor >= 0 && std::isfinite(options.accuracy_floor)))
    throw UsageError("--accuracy-floor", "it must be zero or more", "Leave it out: 0.002");
  if (options.accuracy > 0 && (options.dose > 0 || options.spectra))
    throw UsageError("--accuracy", "pixels then get different numbers of electrons, and spectra or a "
                                   "dose would mean nothing",
                     "Give --electrons with --spectra, or --current and --dwell alone");
}

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

// A pilot finds a variance a little low at times.
constexpr double all_of_the_variance = 0.9;

// What the workers of a simulation share.
class Workshop {
 public:
  // False when cancelled.
  bool prepare(const Scene& scene, const SimulationOptions& options, LibrarySource* source,
               std::int64_t most_primaries, const ProgressCallback& progress,
               const CancelToken* cancel) {
    scene_ = &scene.impl();
    options_ = &options;
    if (options.method == Method::direct) return true;
    FreshLibraries fresh;
    if (!source) source = &fresh;
    const auto get = [&](std::size_t wanted) {
      libraries_.clear();
      cascades_ = 0;
      for (std::size_t m = 0; m < scene.materials().size(); ++m) {
        const Medium& medium = *scene_->medium_pointers[m];
        const CascadeSettings settings{scene.materials()[m], scene.physics(),
                                       scene.beam().energy_ev + medium.barrier_ev(), options.seed};
        auto library = source->library(settings, wanted, options.threads, progress, cancel);
        if (!library) return false;
        libraries_.push_back(std::move(library));
      }
      for (const auto& library : libraries_)
        cascades_ = cascades_ == 0 ? library->cascades() : std::min(cascades_, library->cascades());
      return true;
    };
    const std::size_t least = library_size(options, most_primaries);
    if (!get(least)) return false;
    if (!(options.accuracy > 0)) return true;
    measure_yields(static_cast<int>(scene.materials().size()), cancel);
    const double share = options.planar_control && only_planes() ? all_of_the_variance : usual_share_of_variance;
    const std::size_t wanted = std::min(library_size(options, most_primaries, yields_, share),
                                        cascades_that_fit(options.library_memory));
    if (wanted > least && !get(wanted)) return false;
    controls_.emplace(*scene_, options, libraries_, cancel);
    return true;
  }

  /// Of each material in each detector, with a wanted accuracy.
  const std::vector<CascadeYield>& yields() const { return yields_; }

  std::unique_ptr<UnitWorker> worker() {
    if (options_->method == Method::direct)
      return options_->accuracy > 0 ? make_direct_spending_worker(*scene_, *options_)
                                    : make_direct_worker(*scene_, *options_);
    if (controls_) return make_spending_worker(*scene_, *options_, libraries_, *controls_);
    return make_replay_worker(*scene_, *options_, libraries_);
  }

  // Of each material, those that there are; 0 without replay.
  std::size_t cascades() const { return cascades_; }

 private:
  // On the plane where counts scatter most for their mean: the one across the beam.
  void measure_yields(int materials, const CancelToken* cancel) {
    constexpr std::size_t pilot = 5 * CascadeLibrary::page_cascades;
    Libraries first;
    for (const auto& library : libraries_)
      first.push_back(std::make_shared<CascadeLibrary>(
          library->first(pilot / CascadeLibrary::page_cascades)));
    PlaneControls controls(*scene_, *options_, first, cancel);
    for (int m = 0; m < materials; ++m) {
      const auto match = controls.match(m, -direction(scene_->beam), false);
      for (const Counts& sums : match.control->sums) {
        const auto n = static_cast<double>(controls.cascades());
        const Estimate e = estimate(static_cast<std::int64_t>(controls.cascades()), sums);
        yields_.push_back({e.mean, e.standard_error * e.standard_error * n});
      }
    }
  }

  // Whether every pixel is proved to be a plane, so that nothing but the library's error is in it. Ends at
  // the first that is not.
  bool only_planes() const {
    SiteReplay replay(*scene_, *options_, libraries_);
    for (int y = 0; y < scene_->scan.height; ++y)
      for (int x = 0; x < scene_->scan.width; ++x) {
        const ReplaySite site = replay.site(x, y, true);
        if (!site.single || (site.hit && !replay.proved_plane(site))) return false;
      }
    return true;
  }

  std::size_t cascades_that_fit(double bytes) const {
    constexpr std::size_t page = CascadeLibrary::page_cascades;
    double of_a_page = 0;
    for (const auto& library : libraries_)
      of_a_page += static_cast<double>(library->bytes()) / static_cast<double>(library->pages());
    return static_cast<std::size_t>(bytes / of_a_page) * page;
  }

  const Scene::Impl* scene_ = nullptr;
  const SimulationOptions* options_ = nullptr;
  std::size_t cascades_ = 0;
  Libraries libraries_;
  std::vector<CascadeYield> yields_;
  std::optional<PlaneControls> controls_;
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

Bench& bench_of(Benches& benches, int thread, Workshop& workshop, const ObserverOfThread& observers) {
  auto& bench = benches[static_cast<std::size_t>(thread)];
  if (!bench) bench = std::make_unique<Bench>(Bench{workshop.worker(), observers ? observers(thread) : nullptr});
  return *bench;
}

void run_all(const UnitPlan& plan, Workshop& workshop, int threads, const ObserverOfThread& observers,
             Merging& merging, const CancelToken* cancel) {
  Benches benches(static_cast<std::size_t>(threads));
  parallel_for(plan.units(), threads, [&](std::size_t i, int w) {
    if (cancel && cancel->cancelled()) return;
    if (merging.journal) {
      const std::lock_guard lock(merging.mutex);
      if (merging.recall(i)) return;
    }
    Bench& bench = bench_of(benches, w, workshop, observers);
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
void take_and_give(const UnitPlan& plan, Workshop& workshop, int threads, const CancelToken* cancel,
                   const TakeUnit& take, const GiveTally& give) {
  Benches benches(static_cast<std::size_t>(threads));
  parallel_for(static_cast<std::size_t>(threads), threads, [&](std::size_t, int w) {
    while (const auto number = take()) {
      UnitWorker& worker = *bench_of(benches, w, workshop, {}).worker;
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
void share(Crew& crew, const UnitPlan& plan, Workshop& workshop, int threads, Merging& merging,
           const CancelToken* cancel) {
  if (!crew.leads()) {
    crew.follow([&](const TakeUnit& take, const GiveUnit& give) {
      take_and_give(plan, workshop, threads, cancel, take, [&](std::size_t number, const UnitTally& tally) {
        give({number, tally.balance.incident, pack(tally)});
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
    // The crew is led from here: its messages may have to come from the thread that began.
    const std::jthread at_work([&] {
      try {
        take_and_give(plan, workshop, threads, cancel, take, give);
      } catch (...) {
        own = std::current_exception();
        end();
      }
    });
    try {
      crew.lead(take, [&](const FinishedUnit& unit) { give(unit.number, unpack(unit.bytes)); }, cancel);
    } catch (...) {
      of_crew = std::current_exception();
      end();
    }
  }
  if (own) std::rethrow_exception(own);
  if (of_crew) std::rethrow_exception(of_crew);
}

Scan one_pixel() {
  Scan scan;
  scan.width = scan.height = 1;
  return scan;
}

}  // namespace

std::size_t library_size(const SimulationOptions& options, std::int64_t most_primaries,
                         std::span<const CascadeYield> yields, double of_the_variance) {
  double wanted = static_cast<double>(most_primaries) / of_the_variance;
  if (options.accuracy > 0) {
    wanted = 4 / (options.accuracy * options.accuracy);
    for (const CascadeYield& y : yields) {
      const double error = std::max(options.accuracy * y.mean, options.accuracy_floor);
      if (error > 0) wanted = std::max(wanted, y.variance / (of_the_variance * error * error));
    }
  }
  const double pages = std::ceil(std::max(wanted, 1e4) / CascadeLibrary::page_cascades);
  return static_cast<std::size_t>(pages) * CascadeLibrary::page_cascades;
}

std::size_t tally_bytes(const Scan& scan, const SimulationOptions& options) {
  return static_cast<std::size_t>(scan.width) * static_cast<std::size_t>(scan.height) *
         (sizeof(PixelTally) +
          options.detectors.size() *
              (sizeof(Counts) + (options.accuracy > 0 ? sizeof(Control) : 0)));
}

UnitTally simulate_unit(const Scene& scene, const SimulationOptions& options, const WorkUnit& unit,
                        Observer* observer) {
  check_options(options);
  check_unit(scene.scan(), unit);
  SimulationOptions wanted = options;
  wanted.electrons = unit.first_electron + unit.electrons;
  wanted.method = Method::direct;
  wanted.accuracy = 0;
  UnitTally out;
  make_direct_worker(scene.impl(), wanted)->simulate(unit, observer, out);
  return out;
}

SimulationResult simulate(const Scene& scene, const SimulationOptions& options,
                          const ProgressCallback& progress, const CancelToken* cancel,
                          const ObserverOfThread& observers, UnitJournal* journal,
                          LibrarySource* libraries, Crew* crew) {
  check_options(options);
  if (options.method == Method::replay && observers)
    throw UsageError("--method replay", "stored cascades show observers nothing between surfaces",
                     "Use --method direct");
  if (options.method == Method::replay && !can_replay(scene.physics()))
    throw UsageError("--method replay", "cascades are joined where energies are equal, which needs "
                                        "continuous loss",
                     "Use --method direct, or loss=joy-luo");
  if (options.accuracy > 0 && observers)
    throw UsageError("--accuracy", "what observers see would be of more primaries in some pixels than in others",
                     "Give --electrons instead");
  if (crew && observers)
    throw UsageError("--deposit", "each of several processes would see a part of it", "Run it in one process");
  if (journal && observers)
    throw UsageError("simulate", "observers would not see the units that a journal recalls",
                     "Leave one of the two out");
  auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const UnitPlan plan(scene.scan(), options);
  // Who follows has nothing to collect: its memory need not hold the image.
  Collector collector(crew && !crew->leads() ? one_pixel() : scene.scan(), options);
  SimulationResult& result = collector.result;
  Workshop workshop;
  const auto ready = [&] {
    try {
      return workshop.prepare(scene, options, libraries, plan.most(), {}, cancel);
    } catch (const Interrupted&) {
      return false;
    }
  };
  if (!ready()) {
    result.complete = false;
    return std::move(result);
  }
  result.library_cascades = workshop.cascades();
  result.cascade_yields = workshop.yields();
  result.library_seconds = seconds();
  begin = std::chrono::steady_clock::now();
  Merging merging{plan, collector, progress, journal};
  if (crew) share(*crew, plan, workshop, resolve_threads(options.threads), merging, cancel);
  else run_all(plan, workshop, resolve_threads(options.threads), observers, merging, cancel);
  result.complete = merging.done == plan.total() || (crew && !crew->leads());
  result.seconds = seconds();
  return std::move(result);
}

}  // namespace surf::mc
