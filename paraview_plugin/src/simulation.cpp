// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulation.h"

#include <vtkCommunicator.h>
#include <vtkMultiProcessController.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <exception>
#include <map>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include "attempt.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/mc/results/serialize.h"
#include "surf/mc/scheduling/unit_plan.h"
#include "surf/workflow/guided_view.h"

namespace surf::pv {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double scene_share = 0.02, library_share = 0.3;  // of the progress

/// Leaves to each rank every so many-eth unit: neighbours take alike long.
class ShareOfRank final : public mc::UnitJournal {
 public:
  ShareOfRank(const mc::Scan& scan, const mc::SimulationOptions& options, int rank, int ranks)
      : plan_(scan, options), options_(options), rank_(rank), ranks_(ranks) {}

  bool recall(std::size_t unit, mc::UnitTally& tally) override {
    if (static_cast<int>(unit % static_cast<std::size_t>(ranks_)) == rank_) return false;
    tally = mc::empty_tally(plan_.unit(unit), options_);
    return true;
  }

  void record(std::size_t unit, const mc::UnitTally& tally) override {
    const std::string packed = mc::serialize(tally);
    const std::uint64_t head[2] = {unit, packed.size()};
    bytes.append(reinterpret_cast<const char*>(head), sizeof head);
    bytes += packed;
  }

  std::string bytes;  // of the units done here

 private:
  mc::UnitPlan plan_;
  const mc::SimulationOptions& options_;
  int rank_, ranks_;
};

/// Knows what all ranks have done.
class AllRanks final : public mc::UnitJournal {
 public:
  explicit AllRanks(std::string_view bytes) {
    while (bytes.size() >= sizeof(std::uint64_t[2])) {
      std::uint64_t head[2];
      std::memcpy(head, bytes.data(), sizeof head);
      units_[head[0]] = bytes.substr(sizeof head, head[1]);
      bytes.remove_prefix(sizeof head + head[1]);
    }
  }

  bool recall(std::size_t unit, mc::UnitTally& tally) override {
    const auto found = units_.find(unit);
    if (found == units_.end()) return false;
    tally = mc::deserialize(found->second);
    return true;
  }
  void record(std::size_t, const mc::UnitTally&) override {}

 private:
  std::map<std::uint64_t, std::string_view> units_;
};

std::string gather(vtkMultiProcessController* ranks, const std::string& own) {
  const auto count = static_cast<std::size_t>(ranks->GetNumberOfProcesses());
  const auto length = static_cast<vtkIdType>(own.size());
  std::vector<vtkIdType> lengths(count), starts(count, 0);
  ranks->AllGather(&length, lengths.data(), 1);
  for (std::size_t i = 1; i < count; ++i) starts[i] = starts[i - 1] + lengths[i - 1];
  std::string all(static_cast<std::size_t>(starts.back() + lengths.back()), '\0');
  ranks->AllGatherV(own.data(), all.data(), length, lengths.data(), starts.data());
  return all;
}

/// Does a part of the work that all ranks do, and fails on all if it fails or is aborted on one:
/// who went on alone would wait for the others for ever.
void together(vtkMultiProcessController* ranks, const std::function<void()>& part) {
  std::exception_ptr error;
  try {
    part();
  } catch (...) {
    error = std::current_exception();
  }
  int failed = error ? 1 : 0, any = failed;
  if (ranks) ranks->AllReduce(&failed, &any, 1, vtkCommunicator::MAX_OP);
  if (error) std::rethrow_exception(error);
  if (any) throw Interrupted();
}

/// Progress of a job as a share of the whole, and its warnings.
workflow::Reporter reporter_of(const Watch& watch, std::vector<std::string>& warnings) {
  workflow::Reporter reporter;
  auto begun = std::make_shared<double>(scene_share);  // where the simulation itself begins
  reporter.on_progress = [watch, begun](double done, double total, std::string_view things) {
    if (things == "cascades") {
      *begun = library_share;
      watch.part(scene_share, library_share).report(done, total);
    } else {
      watch.part(*begun, 1).report(done, total);
    }
  };
  reporter.on_warning = [&warnings](const std::string& text) { warnings.push_back(text); };
  reporter.cancel = watch.cancel;
  return reporter;
}

/// What the job's thread and ParaView's, which alone may talk to other ranks, have for each other.
struct Exchange {
  std::mutex mutex;
  std::condition_variable changed;
  std::optional<std::string> own, all;  // units done here, and by everybody
  bool given_up = false, ended = false;

  template <class Condition>
  void await(const Condition& condition) {
    std::unique_lock lock(mutex);
    changed.wait(lock, condition);
  }
  void tell(const std::function<void()>& change) {
    const std::lock_guard lock(mutex);
    change();
    changed.notify_all();
  }
};

/// Simulates this rank's share, and takes the others' from the exchange.
workflow::Simulator sharing(Exchange& exchange, int rank, int count) {
  return [&exchange, rank, count](const mc::Scene& scene, const mc::SimulationOptions& options,
                                  const mc::SimulationContext& context) {
    ShareOfRank share(scene.scan(), options, rank, count);
    mc::SimulationContext own = context;
    own.journal = &share;
    mc::simulate(scene, options, own);
    context.watch.check();
    exchange.tell([&] { exchange.own = std::move(share.bytes); });
    exchange.await([&] { return exchange.all || exchange.given_up; });
    if (exchange.given_up) throw Interrupted();
    AllRanks journal(*exchange.all);
    mc::SimulationContext whole = context;
    whole.watch.progress = {};
    whole.journal = &journal;
    return mc::simulate(scene, options, whole);
  };
}

workflow::SimulateSummary simulate_together(vtkAlgorithm* self, const workflow::SimulateJob& job,
                                            vtkMultiProcessController* ranks,
                                            std::vector<std::string>& warnings) {
  Exchange exchange;
  CancelToken cancel;
  std::mutex telling;
  Watch told;  // of the phase that ParaView's thread is in
  const Watch forward{[&](double done, double total) {
                        const std::lock_guard lock(telling);
                        if (told.progress) told.progress(done, total);
                      },
                      &cancel};
  workflow::SimulateSummary summary;
  std::exception_ptr error;
  std::thread thread([&] {
    try {
      summary = workflow::run(
          job, reporter_of(forward, warnings), nullptr,
          sharing(exchange, ranks->GetLocalProcessId(), ranks->GetNumberOfProcesses()));
    } catch (...) {
      error = std::current_exception();
    }
    exchange.tell([&] { exchange.ended = true; });
  });
  const auto follow = [&](const std::function<bool()>& there) {
    together(ranks, [&] {
      work(self, [&](const Watch& watch) {
        {
          const std::lock_guard lock(telling);
          told = watch;
        }
        std::unique_lock lock(exchange.mutex);
        while (!exchange.changed.wait_for(lock, std::chrono::milliseconds(50),
                                          [&] { return there() || exchange.ended; }))
          if (watch.cancel->cancelled()) cancel.cancel();
        lock.unlock();
        const std::lock_guard quiet(telling);
        told = {};
      });
      if (exchange.ended && error) std::rethrow_exception(error);
    });
  };
  try {
    follow([&] { return exchange.own.has_value(); });
    const std::string all = gather(ranks, *exchange.own);
    exchange.tell([&] { exchange.all = all; });
    follow([] { return false; });
  } catch (...) {
    cancel.cancel();
    exchange.tell([&] { exchange.given_up = true; });
    thread.join();
    throw;
  }
  thread.join();
  return summary;
}

}  // namespace

workflow::SimulateSummary simulate(vtkAlgorithm* self, const workflow::SimulateJob& job,
                                   vtkMultiProcessController* ranks) {
  workflow::SimulateSummary summary;
  std::vector<std::string> warnings;
  if (ranks) summary = simulate_together(self, job, ranks, warnings);
  else
    work(self,
         [&](const Watch& watch) { summary = workflow::run(job, reporter_of(watch, warnings)); });
  for (const std::string& text : warnings) warn(self, text);
  return summary;
}

struct LiveSimulation::Shared {
  Shared(workflow::SimulateJob j, const mc::Scan& s) : job(std::move(j)), scan(s) {
    const mc::SimulationOptions options = mc::options_of(job.scene, job.execution);
    coarse_options = options;
    coarse_options.budget = mc::ElectronsPerPixel{coarse_electrons};
    coarse = mc::empty_result(scan, coarse_options);
    fine = mc::empty_result(scan, options);
    thread = std::thread([this] { run(); });
  }

  using ShowUnit = std::function<void(const mc::WorkUnit&, const mc::UnitTally&)>;

  void run();
  mc::SimulationResult simulate_guided(const mc::Scene& scene, const mc::SimulationOptions& options,
                                       const mc::SimulationContext& context, const ShowUnit& show);
  void look_coarsely(const mc::Scene& scene);
  void tell() {
    news = true;
    told.notify_all();
  }

  static constexpr int coarse_electrons = 8;
  static constexpr std::int64_t first_guided = 16;
  static constexpr int coarsest = 8;  // places along the longer side, doubled again and again
  static constexpr std::chrono::milliseconds coarse_time{600};

  workflow::SimulateJob job;
  mc::Scan scan;
  mc::SimulationOptions coarse_options;
  std::unique_ptr<workflow::GuidedView> view;  // of the thread that simulates
  CancelToken cancel;

  // Guarded by `mutex`.
  mutable std::mutex mutex;
  mutable std::condition_variable told;
  mc::SimulationResult coarse, fine;  // the pixels done
  std::vector<int> strides;           // of the coarse ones, falling
  std::vector<Track> tracks;
  std::vector<std::string> warnings;  // nobody has seen yet
  Record record;
  std::exception_ptr error;
  std::optional<Image> guided;  // of the round before
  bool coarse_done = false, has_fine = false, news = false, ended = false, looked_at = false;

  std::thread thread;  // last: it uses the others
};

namespace {

/// Merges the units that are done into what is shown.
class Shown final : public mc::UnitJournal {
 public:
  Shown(const mc::Scan& scan, const mc::SimulationOptions& options,
        std::function<void(const mc::WorkUnit&, const mc::UnitTally&)> show)
      : plan_(scan, options), show_(std::move(show)) {}

  bool recall(std::size_t, mc::UnitTally&) override { return false; }
  void record(std::size_t unit, const mc::UnitTally& tally) override {
    show_(plan_.unit(unit), tally);
  }

 private:
  mc::UnitPlan plan_;
  std::function<void(const mc::WorkUnit&, const mc::UnitTally&)> show_;
};

}  // namespace

/// Electrons in few pixels, then in those between, as far as the time goes. They are those of a
/// direct simulation.
void LiveSimulation::Shared::look_coarsely(const mc::Scene& scene) {
  const auto end = Clock::now() + coarse_time;
  const int longer = std::max(scan.width, scan.height);
  for (int places = coarsest;; places *= 2) {
    const int stride = std::max(1, longer / places);
    const int columns = (scan.width + stride - 1) / stride,
              rows = (scan.height + stride - 1) / stride;
    {
      const std::lock_guard lock(mutex);
      if (strides.empty() || strides.back() != stride) strides.push_back(stride);
    }
    parallel_for(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
                 job.execution.threads, [&](std::size_t i, int) {
                   if (cancel.cancelled() || Clock::now() > end) return;
                   const int x = static_cast<int>(i) % columns * stride,
                             y = static_cast<int>(i) / columns * stride;
                   const mc::WorkUnit unit{x, y, x + 1, y + 1, 0, coarse_electrons};
                   {
                     const std::lock_guard lock(mutex);
                     if (coarse.pixels(x, y).primaries > 0) return;  // done with a larger stride
                   }
                   const mc::UnitTally tally = mc::simulate_unit(scene, coarse_options, unit);
                   const std::lock_guard lock(mutex);
                   mc::merge(coarse, unit, tally);
                 });
    const std::lock_guard lock(mutex);
    tell();
    if (stride == 1 || cancel.cancelled() || Clock::now() > end) return;
  }
}

/// The first electrons in rounds, each twice as many; after each the guided image is what is shown.
mc::SimulationResult LiveSimulation::Shared::simulate_guided(const mc::Scene& scene,
                                                             const mc::SimulationOptions& options,
                                                             const mc::SimulationContext& context,
                                                             const ShowUnit& show) {
  const Watch watch{{}, &cancel};
  if (!view) {
    view = std::make_unique<workflow::GuidedView>(scene, job.estimate, job.cache, options.threads,
                                                  watch);
    const std::lock_guard lock(mutex);
    fine = mc::empty_result(scan, options);
  }
  const std::int64_t all = mc::electrons_of(options.budget);
  std::optional<mc::SimulationResult> result;
  for (std::int64_t first = 0, end = first_guided; !result || first < all;
       first = end, end = std::min(2 * end, all)) {
    mc::SimulationOptions round = options;
    if (options.primaries) end = all;  // a round that adds to those before
    else
      round.primaries = std::make_shared<mc::PrimaryNumbers>(
          mc::PrimaryNumbers{Grid<std::int64_t>(scan.width, scan.height, first),
                             Grid<std::int64_t>(scan.width, scan.height, std::min(end, all))});
    Shown shown(scan, round, show);
    mc::SimulationContext own = context;
    own.journal = &shown;
    mc::SimulationResult added = mc::simulate(scene, round, own);
    fine.library_cascades = added.library_cascades;
    if (result) mc::add_round(*result, added);
    else result = std::move(added);
    if (!result->complete) break;
    Image image = view->image(fine, watch);  // nobody else changes it
    const std::lock_guard lock(mutex);
    guided = std::move(image);
    tell();
  }
  return *std::move(result);
}

void LiveSimulation::Shared::run() {
  try {
    workflow::Reporter reporter;
    reporter.cancel = &cancel;
    reporter.on_warning = [this](const std::string& text) {
      const std::lock_guard lock(mutex);
      warnings.push_back(text);
    };
    const auto watched = [this](const mc::Scene& scene, const mc::SimulationOptions& options,
                                const mc::SimulationContext& context) {
      look_coarsely(scene);
      {
        const std::lock_guard lock(mutex);
        coarse_done = true;
        tell();
      }
      if (cancel.cancelled()) throw Interrupted();
      const auto show = [this](const mc::WorkUnit& unit, const mc::UnitTally& tally) {
        const std::lock_guard lock(mutex);
        mc::merge(fine, unit, tally);
        has_fine = true;
        tell();
      };
      if (job.estimate.kind != workflow::Estimate::plain && options.odd_counts)
        return simulate_guided(scene, options, context, show);
      Shown shown(scan, options, show);
      mc::SimulationContext own = context;
      own.journal = &shown;
      return mc::simulate(scene, options, own);
    };
    workflow::SimulateSummary summary = workflow::run(job, reporter, nullptr, watched);
    const std::lock_guard lock(mutex);
    if (!summary.guided.empty()) guided = workflow::image_of(summary);
    fine = std::move(summary.result);
    tracks = std::move(summary.tracks);
    record = std::move(summary.record);
  } catch (...) {
    const std::lock_guard lock(mutex);
    error = std::current_exception();
  }
  const std::lock_guard lock(mutex);
  ended = true;
  tell();
}

LiveSimulation::LiveSimulation(workflow::SimulateJob job, const mc::Scan& scan)
    : shared_(std::make_unique<Shared>(std::move(job), scan)) {}

LiveSimulation::~LiveSimulation() {
  shared_->cancel.cancel();
  shared_->thread.join();
}

bool LiveSimulation::has_news() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->news;
}

bool LiveSimulation::ended() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->ended;
}

void LiveSimulation::wait(double seconds, const CancelToken& cancel) const {
  using namespace std::chrono_literals;
  const Shared& s = *shared_;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  std::unique_lock lock(s.mutex);
  const bool first = !s.looked_at;
  while (!cancel.cancelled() && !s.ended) {
    if (s.news && (!first || s.coarse_done || Clock::now() > end)) return;
    if (!first && Clock::now() > end) return;
    s.told.wait_for(lock, 50ms);
  }
}

LiveSimulation::View LiveSimulation::look() {
  const mc::Scan& scan = shared_->scan;
  const std::lock_guard lock(shared_->mutex);
  if (shared_->error) std::rethrow_exception(shared_->error);
  shared_->news = false;
  shared_->looked_at = true;
  View view;
  view.tracks = shared_->tracks;
  view.warnings = std::exchange(shared_->warnings, {});
  view.record = shared_->ended
                    ? shared_->record
                    : record_of(static_cast<const mc::SimulationRequest&>(shared_->job.scene));
  view.image = shared_->guided ? *shared_->guided : mc::make_image(shared_->fine, scan);
  view.state = shared_->ended ? "done" : shared_->has_fine ? "refining" : "coarse";
  // A copy: the tallies go on growing.
  view.result = mc::empty_result(scan, shared_->coarse_options);
  const mc::SimulationResult& r = shared_->fine;
  view.result.budget = r.budget;
  view.result.balance = r.balance;
  std::ranges::copy(r.pixels.data(), view.result.pixels.data().begin());
  for (std::size_t d = 0; d < r.counts.size(); ++d)
    std::ranges::copy(r.counts[d].data(), view.result.counts[d].data().begin());
  for (const auto& controls : r.controls) {
    view.result.controls.emplace_back(scan.width, scan.height);
    std::ranges::copy(controls.data(), view.result.controls.back().data().begin());
  }
  view.result.library_cascades = r.library_cascades;
  view.result.cascade_yields = r.cascade_yields;
  if (shared_->ended || shared_->guided) return view;
  const Image coarse = mc::make_image(shared_->coarse, scan);
  for (int y = 0; y < scan.height; ++y)
    for (int x = 0; x < scan.width; ++x) {
      if (r.pixels(x, y).primaries > 0 || r.pixels(x, y).hits > 0) continue;
      for (auto stride = shared_->strides.rbegin(); stride != shared_->strides.rend(); ++stride) {
        const int u = x - x % *stride, v = y - y % *stride;
        if (shared_->coarse.pixels(u, v).primaries == 0) continue;
        for (Channel& channel : view.image.channels)
          if (const Channel* of_coarse = coarse.find(channel.name))
            channel.values(x, y) = of_coarse->values(u, v);
        break;
      }
    }
  return view;
}

}  // namespace surf::pv
