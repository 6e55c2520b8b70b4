// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/scheduling/pilot.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <numeric>
#include <vector>

#include "request/check_options.h"
#include "scheduling/prepared_simulation.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/mc/results/serialize.h"
#include "surf/mc/scheduling/unit_plan.h"

namespace surf::mc {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int block = 2;  // pixels across, of a part of a unit
constexpr double share_of_parts =
    0.2;  // of the time: whether units are short enough to be tried whole
constexpr double longest_share = 0.1;   // of the time, that such a unit takes on average
constexpr double most_for_planes = 2;   // times the time, on top of it
constexpr int pixels_looked_at = 4096;  // for planes

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Numbers 0 to count - 1, each once, any few in a row spread evenly; then once again. Steps of the
// golden section: what comes back after so many units, as rows of an image do, is met at all its
// places.
class Spread {
 public:
  explicit Spread(std::size_t count)
      : count_(count), step_(static_cast<std::size_t>(0.6180339887 * static_cast<double>(count))) {
    while (std::gcd(++step_, count_) != 1) {
    }
  }
  std::size_t next() {
    if (given_ == count_) {
      given_ = 0;
      ++round_;
    }
    ++given_;
    at_ = (at_ + step_) % count_;
    return at_;
  }
  /// How often all have been given.
  std::size_t round() const { return round_; }

 private:
  std::size_t count_, step_, at_ = 0, given_ = 0, round_ = 0;
};

// Pixels times electrons: units at the edge have less of it.
double work(const WorkUnit& u) {
  return static_cast<double>(u.x1 - u.x0) * (u.y1 - u.y0) * static_cast<double>(u.electrons);
}

// A few pixels of a unit, at another place in each and each time.
WorkUnit part_of(const WorkUnit& u, std::size_t number, std::size_t round) {
  WorkUnit part = u;
  const std::uint64_t hash =
      (number * 0x9e3779b97f4a7c15u + round * 0xc2b2ae3d27d4eb4fu) ^ (number >> 7);
  const auto place = [](int from, int to, std::uint64_t bits) {
    const int blocks = std::max(1, (to - from) / block);
    return from + block * static_cast<int>(bits % static_cast<std::uint64_t>(blocks));
  };
  part.x0 = place(u.x0, u.x1, hash >> 40);
  part.y0 = place(u.y0, u.y1, hash >> 20);
  part.x1 = std::min(part.x0 + block, u.x1);
  part.y1 = std::min(part.y0 + block, u.y1);
  return part;
}

// What was seen of units, where parts are scaled up to the whole of theirs.
struct Sums {
  double units = 0, work = 0, seconds = 0, primaries = 0, rays = 0, steps = 0, bytes = 0;
  double seconds_squared = 0, work_squared = 0, seconds_by_work = 0;

  void add(double s, const UnitTally& tally, const WorkUnit& unit, const WorkUnit& tried) {
    const double w = surf::mc::work(unit), scale = w / surf::mc::work(tried);
    units += 1;
    work += w;
    work_squared += w * w;
    seconds += s * scale;
    seconds_squared += s * scale * s * scale;
    seconds_by_work += s * scale * w;
    primaries += scale * static_cast<double>(tally.balance.incident);
    rays += scale * static_cast<double>(tally.balance.rays);
    steps += scale * static_cast<double>(tally.balance.steps);
    bytes += scale * static_cast<double>(serialize(tally).size());
  }
};

// The ratio of what was seen to the work that it was seen in, times all work.
void conclude(const Sums& sums, double all_work, bool whole, int threads, Pilot& pilot) {
  const double all_units = static_cast<double>(pilot.units_in_all);
  const double each = all_work / sums.work;
  const double at_once = std::min(static_cast<double>(threads), all_units);
  pilot.units = static_cast<std::size_t>(sums.units);
  pilot.expected_s = sums.seconds * each / at_once;
  const double per_work = sums.seconds / sums.work;
  const double about_it = std::max(0.0, sums.seconds_squared - 2 * per_work * sums.seconds_by_work +
                                            per_work * per_work * sums.work_squared);
  const double variance =
      sums.units > 1 ? about_it / (sums.units - 1) : sums.seconds_squared;  // of one unit
  const double left =
      whole ? std::max(0.0, 1 - sums.units / all_units) : 1;  // nothing is where all were tried
  pilot.standard_error_s = each / at_once * std::sqrt(variance * left * sums.units);
  pilot.primaries = sums.primaries * each;
  pilot.rays = sums.rays * each;
  pilot.steps = sums.steps * each;
  pilot.packed_bytes = sums.bytes * each;
}

}  // namespace

Pilot run_pilot(const Scene& scene, const SimulationOptions& options, double seconds,
                LibrarySource* libraries, const Watch& watch) {
  if (!(seconds > 0 && std::isfinite(seconds)))
    throw UsageError("pilot", "it needs some time", "Give it ten seconds, say");
  check_options(options);
  Pilot pilot;
  const UnitPlan plan(scene.scan(), options);
  pilot.units_in_all = plan.units();
  const auto begin = Clock::now();
  PreparedSimulation prepared;
  prepared.prepare(scene, options, libraries, plan.most(), watch);
  pilot.library_seconds = since(begin);
  pilot.library_cascades = prepared.cascades();
  pilot.library_bytes = prepared.library_bytes();

  const int threads = resolve_threads(options.threads);
  Spread of_parts(plan.units()), of_units(plan.units());
  std::mutex mutex;
  Sums parts, units;
  // Who is the first on a plane makes it: that is no matter of the unit.
  const std::size_t planes = prepared.planes_expected(pixels_looked_at);
  const PlanarControls::Made made_before = prepared.planes_made();
  const auto start = Clock::now();
  const auto out_of_time = [&] {
    const double for_planes = (prepared.planes_made().seconds - made_before.seconds) / threads;
    return since(start) - std::min(for_planes, most_for_planes * seconds) > seconds;
  };
  const auto probing = [&] {
    return parts.units < threads || since(start) < share_of_parts * seconds;
  };
  const auto short_enough = [&] { return parts.seconds / parts.units < longest_share * seconds; };
  parallel_for(static_cast<std::size_t>(threads), threads, [&](std::size_t, int) {
    const auto worker = prepared.worker();
    worker->cancel = watch.cancel;
    UnitTally tally;
    worker->simulate(part_of(plan.unit(0), 0, 0), nullptr,
                     tally);  // gets tables and memory ready
    for (;;) {
      WorkUnit unit, tried;
      bool whole = false;
      {
        const std::lock_guard lock(mutex);
        watch.check();
        if (out_of_time() && parts.units > 0) return;
        whole = !probing() && short_enough();
        if (whole && of_units.round() > 0) return;
        const std::size_t number = whole ? of_units.next() : of_parts.next();
        if (whole && of_units.round() > 0) return;  // that was the first one again
        unit = plan.unit(number);
        tried = whole ? unit : part_of(unit, number, of_parts.round());
      }
      tally = {};
      const auto now = Clock::now();
      const double planes_before = PlanarControls::seconds_of_this_thread();
      worker->simulate(tried, nullptr, tally);
      const double took = since(now) - (PlanarControls::seconds_of_this_thread() - planes_before);
      const std::lock_guard lock(mutex);
      (whole ? units : parts).add(took, tally, unit, tried);
      watch.report(std::min(seconds, since(start)), seconds);
    }
  });
  // A thread may have got one whole unit before parts showed that they are long.
  pilot.whole = units.units >= 2 && (short_enough() || units.units >= parts.units);
  const Sums& sums = pilot.whole ? units : parts;
  pilot.seconds = since(start);
  const double all_work = static_cast<double>(scene.scan().width) * scene.scan().height *
                          static_cast<double>(plan.most());
  conclude(sums, all_work, pilot.whole, threads, pilot);
  if (const PlanarControls::Made made = prepared.planes_made(); made.planes > 0) {
    pilot.planes = planes;
    pilot.planes_s =
        made.seconds / static_cast<double>(made.planes) * static_cast<double>(planes) / threads;
    pilot.expected_s += pilot.planes_s;
  }
  return pilot;
}

}  // namespace surf::mc
