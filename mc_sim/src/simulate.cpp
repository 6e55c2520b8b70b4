// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/simulate.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>

#include <fmt/format.h>

#include "dose.h"
#include "forward.h"
#include "gun.h"
#include "scene_impl.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"

namespace surf::mc {

namespace {

constexpr std::int64_t most_electrons = std::int64_t{1} << 31;
constexpr double largest_dose = 1e9;

// How many primaries each pixel gets.
class Share {
 public:
  Share(const Scan& scan, const SimulationOptions& o)
      : width_(scan.width), electrons_(o.electrons), dose_(o.dose), seed_(o.seed) {}

  std::int64_t of(int x, int y) const {
    return dose_ > 0 ? primaries_of_pixel(dose_, seed_, number(x, y)) : electrons_;
  }
  std::uint64_t number(int x, int y) const {
    return static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(width_) +
           static_cast<std::uint64_t>(x);
  }

 private:
  int width_;
  std::int64_t electrons_;
  double dose_;
  std::uint64_t seed_;
};

// One thread's way through units of work.
class Worker {
 public:
  Worker(const Scene::Impl& scene, const SimulationOptions& options)
      : scene_(scene), options_(options), share_(scene.scan, options), geometry_(scene),
        gun_(scene.beam, scene.scan, scene.top_nm),
        detection_(options.detectors, scene.beam, options.spectra) {}

  void simulate(const WorkUnit& unit, Observer* observer, UnitTally& out) {
    if (observer) {
      Forward forward{*observer};
      run(unit, forward, observer, out);
    } else {
      NoObserver nobody;
      run(unit, nobody, nullptr, out);
    }
  }

 private:
  template <class Watcher>
  void run(const WorkUnit& unit, Watcher& watcher, Observer* observer, UnitTally& out) {
    const int width = unit.x1 - unit.x0, height = unit.y1 - unit.y0;
    out.pixels = Grid<PixelTally>(width, height);
    out.counts.assign(options_.detectors.size(), Grid<Counts>(width, height));
    Transport transport(geometry_, scene_.medium_pointers, scene_.physics.barrier,
                        observer == nullptr, watcher, detection_, out.balance);
    for (int y = unit.y0; y < unit.y1; ++y) {
      for (int x = unit.x0; x < unit.x1; ++x) {
        PixelTally& pixel = out.pixels(x - unit.x0, y - unit.y0);
        const std::uint64_t number = share_.number(x, y);
        const std::int64_t end = std::min(share_.of(x, y), unit.first_electron + unit.electrons);
        for (std::int64_t e = unit.first_electron; e < end; ++e) {
          RandomStream random(options_.seed, number, static_cast<std::uint64_t>(e));
          if (observer) observer->primary(static_cast<std::int64_t>(number), e);
          const Gun::Start start = gun_.primary(x, y, random);
          const bool hit = transport.run(start.position, start.direction, scene_.beam.energy_ev, 0,
                                         random);
          ++pixel.primaries;
          pixel.hits += hit ? 1 : 0;
          for (std::size_t d = 0; d < out.counts.size(); ++d)
            out.counts[d](x - unit.x0, y - unit.y0).add(detection_.counts()[d]);
          detection_.end_primary();
        }
      }
    }
    out.spectra = detection_.take_spectra();
  }

  const Scene::Impl& scene_;
  const SimulationOptions& options_;
  Share share_;
  SceneGeometry geometry_;
  Gun gun_;
  Detection detection_;
};

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
}

// Units of work: runs of pixels along a row. Long counts of electrons are split, so that one pixel
// can keep all threads busy. Numbered rather than listed: there may be very many.
class Plan {
 public:
  Plan(const Scan& scan, const SimulationOptions& options) : scan_(scan) {
    const Share share(scan, options);
    if (options.dose > 0) {
      for (int y = 0; y < scan.height; ++y)
        for (int x = 0; x < scan.width; ++x) {
          const std::int64_t n = share.of(x, y);
          most_ = std::max(most_, n);
          total_ += static_cast<double>(n);
        }
    } else {
      most_ = options.electrons;
      total_ = static_cast<double>(options.electrons) * scan.width * scan.height;
    }
    const std::int64_t pixels = std::max<std::int64_t>(1, most_primaries / most_);
    run_ = static_cast<int>(std::min<std::int64_t>({options.tile_pixels, pixels, scan.width}));
    runs_ = (scan.width + run_ - 1) / run_;
    chunks_ = (most_ + most_primaries - 1) / most_primaries;
  }

  double primaries() const { return total_; }

  std::size_t units() const {
    return static_cast<std::size_t>(chunks_) * static_cast<std::size_t>(runs_) *
           static_cast<std::size_t>(scan_.height);
  }

  WorkUnit unit(std::size_t number) const {
    const auto n = static_cast<std::int64_t>(number);
    const std::int64_t first = n % chunks_ * most_primaries;
    const int x = static_cast<int>(n / chunks_ % runs_) * run_;
    const int y = static_cast<int>(n / chunks_ / runs_);
    return {x, y, std::min(x + run_, scan_.width), y + 1, first,
            std::min(most_primaries, most_ - first)};
  }

 private:
  static constexpr std::int64_t most_primaries = 4096;   // a fraction of a second
  Scan scan_;
  std::int64_t most_ = 1;
  double total_ = 0;
  int run_ = 1;
  std::int64_t runs_ = 1, chunks_ = 1;
};

// The scan's tallies, merged from units as they come: sums are whole numbers, so order is nothing.
class Collector {
 public:
  Collector(const Scan& scan, const SimulationOptions& options) {
    result.detectors = options.detectors;
    const auto pixels = static_cast<std::size_t>(scan.width) * static_cast<std::size_t>(scan.height);
    const std::size_t bytes =
        pixels * (sizeof(PixelTally) + options.detectors.size() * sizeof(Counts));
    const std::string folder = bytes > options.tally_memory ? options.scratch_folder : "";
    result.pixels = LargeGrid<PixelTally>(scan.width, scan.height, folder);
    for (std::size_t d = 0; d < options.detectors.size(); ++d)
      result.counts.emplace_back(scan.width, scan.height, folder);
    result.dose = options.dose;
    result.seed = options.seed;
  }

  void add(const WorkUnit& u, const UnitTally& tally) {
    check_shape(u, tally);
    for (int y = u.y0; y < u.y1; ++y)
      for (int x = u.x0; x < u.x1; ++x) {
        result.pixels(x, y) += tally.pixels(x - u.x0, y - u.y0);
        for (std::size_t d = 0; d < result.counts.size(); ++d)
          result.counts[d](x, y) += tally.counts[d](x - u.x0, y - u.y0);
      }
    if (result.spectra.empty()) result.spectra = tally.spectra;
    else
      for (std::size_t d = 0; d < tally.spectra.size(); ++d) result.spectra[d] += tally.spectra[d];
    result.balance += tally.balance;
    added_ += tally.pixels.size();
    if (added_ < most_added) return;
    result.release();
    added_ = 0;
  }

  SimulationResult result;

 private:
  static constexpr std::size_t most_added = std::size_t{1} << 19;   // pixels between releases
  std::size_t added_ = 0;

  // A journal may have been kept for something else.
  void check_shape(const WorkUnit& u, const UnitTally& tally) const {
    bool fits = tally.counts.size() == result.counts.size() &&
                tally.pixels.width() == u.x1 - u.x0 && tally.pixels.height() == u.y1 - u.y0 &&
                (result.spectra.empty() || tally.spectra.size() == result.spectra.size());
    for (const auto& grid : tally.counts) fits = fits && grid.size() == tally.pixels.size();
    if (!fits)
      throw InvalidInput("journal of units", "a unit's tally is of another simulation",
                         "Begin anew, without the journal");
  }
};

}  // namespace

UnitTally simulate_unit(const Scene& scene, const SimulationOptions& options, const WorkUnit& unit,
                        Observer* observer) {
  check_options(options);
  check_unit(scene.scan(), unit);
  SimulationOptions wanted = options;
  wanted.electrons = unit.first_electron + unit.electrons;
  UnitTally out;
  Worker worker(scene.impl(), wanted);
  worker.simulate(unit, observer, out);
  return out;
}

SimulationResult simulate(const Scene& scene, const SimulationOptions& options,
                          const ProgressCallback& progress, const CancelToken* cancel,
                          const ObserverOfThread& observers, UnitJournal* journal) {
  check_options(options);
  if (journal && observers)
    throw UsageError("simulate", "observers would not see the units that a journal recalls",
                     "Leave one of the two out");
  const auto begin = std::chrono::steady_clock::now();
  const Plan plan(scene.scan(), options);
  const int threads = resolve_threads(options.threads);
  struct Bench {
    Worker worker;
    Observer* observer;
  };
  std::vector<std::unique_ptr<Bench>> benches(static_cast<std::size_t>(threads));

  Collector collector(scene.scan(), options);
  double done = 0;
  std::mutex merging;
  parallel_for(plan.units(), threads, [&](std::size_t i, int w) {
    if (cancel && cancel->cancelled()) return;
    const WorkUnit unit = plan.unit(i);
    UnitTally tally;
    const auto merge = [&] {
      collector.add(unit, tally);
      done += static_cast<double>(tally.balance.incident);
    };
    if (journal) {
      const std::lock_guard lock(merging);
      if (journal->recall(i, tally)) {
        collector.result.recalled += tally.balance.incident;
        merge();
        return;
      }
    }
    auto& bench = benches[static_cast<std::size_t>(w)];
    if (!bench)
      bench = std::make_unique<Bench>(Bench{Worker(scene.impl(), options),
                                            observers ? observers(w) : nullptr});
    bench->worker.simulate(unit, bench->observer, tally);
    const std::lock_guard lock(merging);
    merge();
    if (progress) progress(done, plan.primaries());
    if (journal) journal->record(i, tally);
  });
  SimulationResult& result = collector.result;
  result.complete = done == plan.primaries();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return std::move(result);
}

}  // namespace surf::mc
