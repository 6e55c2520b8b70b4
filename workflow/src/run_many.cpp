// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_many.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/workflow/version.h"

namespace surf::workflow {
namespace {

using Clock = std::chrono::steady_clock;

// Each process that does a whole image holds it in memory. A shared image is held by the leader
// alone.
constexpr double largest_whole_px = 4e6;
constexpr int tile_px = 32;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class Maker {
 public:
  Maker(const ManyRuns& runs, Team* team)
      : runs_(runs), team_(team),
        total_(std::accumulate(runs.weights.begin(), runs.weights.end(), 0.0)) {}

  ManyDone run_all() {
    const std::size_t single = count_pieces();
    if (single > 0) out_.complete = do_pieces(single);
    for (std::size_t i = single; i < runs_.weights.size() && out_.complete; ++i)
      out_.complete = do_together(i);
    return std::move(out_);
  }

 private:
  // The number of pieces, decided by the leader.
  std::size_t count_pieces() {
    if (!team_ || runs_.weights.empty()) return 0;
    const std::size_t all = runs_.weights.size();
    std::size_t single = pieces_of(all, runs_.tiles, team_->size());
    if (runs_.pixels > largest_whole_px) single = 0;
    if (runs_.whole) single = all;
    std::string text = std::to_string(single);
    team_->broadcast(text);
    return std::stoul(text);
  }

  bool do_pieces(std::size_t count) {
    check_same_folder(*team_, runs_.folder);
    Pieces pieces;
    pieces.weights.assign(runs_.weights.begin(),
                          runs_.weights.begin() + static_cast<std::ptrdiff_t>(count));
    pieces.work = [&](std::size_t i, const ProgressCallback& progress) {
      return simulate(i, runs_.make(i), progress, nullptr);
    };
    pieces.finished = [&](std::size_t i, const std::string& outcome) {
      if (runs_.finished) runs_.finished(i, outcome);
    };
    pieces.progress = [&](double done, double) {
      runs_.reporter.progress(done, total_, runs_.things);
    };
    pieces.talking = &talking_;
    pieces.threads = resolve_threads(runs_.threads);
    pieces.cancel = runs_.reporter.cancel;
    const bool complete = share_pieces(*team_, pieces, out_.tallies);
    for (const MemberTally& tally : out_.tallies) {
      out_.primaries += tally.primaries;
      out_.seconds += tally.seconds;
    }
    done_ = std::accumulate(pieces.weights.begin(), pieces.weights.end(), 0.0);
    return complete;
  }

  // Does a run with the whole team, unit by unit, or without a team.
  bool do_together(std::size_t i) {
    const auto start = Clock::now();
    const auto show = [&](double done, double of) {
      const std::lock_guard lock(talking_);
      if (of > 0)
        runs_.reporter.progress(done_ + runs_.weights[i] * done / of, total_, runs_.things);
    };
    std::optional<FinishedPiece> piece;
    SimulateJob job;
    // Separately: a run may not wait for all members inside.
    together(team_, [&] { job = runs_.make(i); });
    together(team_, [&] { piece = simulate(i, std::move(job), show, team_); });
    std::string complete = piece ? "yes" : "no";
    if (team_) team_->broadcast(complete);
    if (complete == "no") return false;
    done_ += runs_.weights[i];
    out_.primaries += piece ? piece->primaries : 0;
    out_.seconds += seconds_since(start);
    together(team_, [&] {
      if (leads(team_) && runs_.finished) runs_.finished(i, piece->outcome);
    });
    return true;
  }

  // Returns nothing if cancelled.
  std::optional<FinishedPiece> simulate(std::size_t i, SimulateJob job,
                                        const ProgressCallback& progress, Team* with) {
    try {
      const SimulateSummary s = run(job, quietly(progress), with);
      if (!s.result.complete) return std::nullopt;
      FinishedPiece piece{s.result.balance.incident - s.result.recalled, {}};
      if (runs_.outcome && leads(with)) piece.outcome = runs_.outcome(i, job, s);
      return piece;
    } catch (const Interrupted&) {  // cancelled before there was a result
      return std::nullopt;
    }
  }

  // A reporter that passes on one message at a time, because other members report meanwhile.
  // `progress` is the run's share of the whole.
  Reporter quietly(const ProgressCallback& progress) {
    Reporter one;
    one.on_progress = [this, progress](double done, double total, std::string_view things) {
      if (things != "cascades") return progress(done, total);
      const std::lock_guard lock(talking_);
      runs_.reporter.progress(done, total, things);
    };
    one.on_note = aloud(runs_.reporter.on_note);
    one.on_warning = aloud(runs_.reporter.on_warning);
    one.cancel = runs_.reporter.cancel;
    return one;
  }
  NoteCallback aloud(const NoteCallback& tell) {
    return [this, tell](const std::string& text) {
      const std::lock_guard lock(talking_);
      if (tell) tell(text);
    };
  }

  const ManyRuns& runs_;
  Team* team_;
  double total_, done_ = 0;
  std::mutex talking_;
  ManyDone out_;
};

}  // namespace

ManyDone run_many(const ManyRuns& runs, Team* team) { return Maker(runs, team).run_all(); }

void ManyDone::add(const ManyDone& other) {
  complete = complete && other.complete;
  primaries += other.primaries;
  seconds += other.seconds;
  tallies.resize(std::max(tallies.size(), other.tallies.size()));
  for (std::size_t i = 0; i < other.tallies.size(); ++i) {
    tallies[i].pieces += other.tallies[i].pieces;
    tallies[i].primaries += other.tallies[i].primaries;
    tallies[i].seconds += other.tallies[i].seconds;
  }
}

std::string team_record(const Team& team, const ManyDone& done, double seconds, int threads,
                        const std::string& command_line) {
  using Json = nlohmann::ordered_json;
  Json json{{"semsurf", version()}, {"command", command_line},     {"complete", done.complete},
            {"seconds", seconds},   {"primaries", done.primaries}, {"ranks", Json::array()}};
  const auto members = team.members();
  std::int64_t others = 0;
  for (const TeamMember& m : members) others += m.rank > 0 ? m.primaries : 0;
  for (const TeamMember& m : members) {
    const auto rank = static_cast<std::size_t>(m.rank);
    const MemberTally whole = rank < done.tallies.size() ? done.tallies[rank] : MemberTally{};
    json["ranks"].push_back({{"rank", m.rank},
                             {"host", m.host},
                             {"threads", m.rank == 0 ? resolve_threads(threads) : m.threads},
                             {"whole_runs", whole.pieces},
                             {"whole_runs_seconds", whole.seconds},
                             {"units", m.rank == 0 ? 0 : m.units - whole.pieces},
                             {"primaries", m.rank == 0 ? done.primaries - others : m.primaries},
                             {"waiting_seconds", m.waiting_s},
                             {"bytes_sent", m.bytes_sent}});
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::size_t tiles_of(const mc::Scan& scan) {
  const auto across = [](int pixels) {
    return static_cast<std::size_t>((pixels + tile_px - 1) / tile_px);
  };
  return across(scan.width) * across(scan.height);
}

}  // namespace surf::workflow
