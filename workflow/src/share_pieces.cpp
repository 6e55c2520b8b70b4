// SPDX-License-Identifier: GPL-3.0-or-later
#include "share_pieces.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <thread>

#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto patience = std::chrono::seconds(60), soon = std::chrono::seconds(5);
constexpr auto nap = std::chrono::milliseconds(50);

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// The state of the pieces on the leader: taken, done and reported.
class Ledger {
 public:
  Ledger(const Pieces& pieces, std::vector<MemberTally>& tallies)
      : pieces_(pieces), tallies_(tallies),
        total_(std::accumulate(pieces.weights.begin(), pieces.weights.end(), 0.0)) {}

  std::optional<std::size_t> take() {
    const std::lock_guard lock(*pieces_.talking);
    if (ended_ || next_ == pieces_.weights.size() ||
        (pieces_.cancel && pieces_.cancel->cancelled()))
      return std::nullopt;
    return next_++;
  }

  void give(const FinishedUnit& unit) {
    const std::size_t tab = unit.bytes.find('\t');
    const std::lock_guard lock(*pieces_.talking);
    MemberTally& tally = tallies_.at(static_cast<std::size_t>(unit.rank));
    ++tally.pieces;
    tally.primaries += unit.primaries;
    tally.seconds += std::stod(unit.bytes);
    ++done_;
    weight_ += pieces_.weights.at(unit.number);
    if (pieces_.finished) pieces_.finished(unit.number, unit.bytes.substr(tab + 1));
    if (pieces_.progress) pieces_.progress(weight_, total_);
  }

  void show(double of_own_piece) {
    const std::lock_guard lock(*pieces_.talking);
    if (pieces_.progress) pieces_.progress(weight_ + of_own_piece, total_);
  }

  void end() {
    const std::lock_guard lock(*pieces_.talking);
    ended_ = true;
  }

  bool complete() const { return done_ == pieces_.weights.size(); }

 private:
  const Pieces& pieces_;
  std::vector<MemberTally>& tallies_;
  std::size_t next_ = 0, done_ = 0;
  bool ended_ = false;
  double weight_ = 0, total_;
};

// Does pieces until there are no more.
void do_pieces(const Pieces& pieces, const TakeUnit& take, const GiveUnit& give,
               const std::function<void(double)>& show) {
  while (const auto number = take()) {
    const auto start = Clock::now();
    const auto progress = [&](double done, double total) {
      if (show && total > 0) show(pieces.weights[*number] * done / total);
    };
    auto piece = pieces.work(*number, progress);
    if (!piece) return;
    give({*number, piece->primaries,
          fmt::format("{:.6f}\t{}", seconds_since(start), piece->outcome)});
  }
}

void lead(Team& team, const Pieces& pieces, Ledger& ledger) {
  const TakeUnit take = [&] { return ledger.take(); };
  const GiveUnit give = [&](const FinishedUnit& unit) { ledger.give(unit); };
  lead_while(
      team, take, give, pieces.cancel,
      [&] { do_pieces(pieces, take, give, [&](double done) { ledger.show(done); }); },
      [&] { ledger.end(); });
}

void follow(Team& team, const Pieces& pieces) {
  try {
    team.follow(
        [&](const TakeUnit& take, const GiveUnit& give) { do_pieces(pieces, take, give, {}); },
        pieces.threads, 0, pieces.cancel);
  } catch (const Interrupted&) {  // the leader knows, and reports that the work is not complete
  }
}

}  // namespace

bool share_pieces(Team& team, const Pieces& pieces, std::vector<MemberTally>& tallies) {
  tallies.resize(static_cast<std::size_t>(team.size()));
  Ledger ledger(pieces, tallies);
  together(&team, [&] {
    if (team.leads()) lead(team, pieces, ledger);
    else follow(team, pieces);
  });
  std::string complete = ledger.complete() ? "yes" : "no";
  team.broadcast(complete);
  return complete == "yes";
}

std::size_t pieces_of(std::size_t images, std::size_t units, int members) {
  const auto n = static_cast<std::size_t>(members);
  const std::size_t over = images % n;
  return 2 * over <= std::min(n, units) ? images - over : images;
}

void check_same_folder(Team& team, const fs::path& folder) {
  std::string name;
  together(&team, [&] {
    if (!team.leads()) return;
    name = fmt::format(".semsurf-{}-{}", ::getpid(), Clock::now().time_since_epoch().count());
    io::write_text(folder / name, "");
  });
  team.broadcast(name);
  const auto clean = [&] {
    std::error_code ignored;
    if (team.leads()) fs::remove(folder / name, ignored);
  };
  try {
    together(&team, [&] {
      std::error_code ignored;
      const auto seen = [&] {
        // Listing refreshes the view of a network folder.
        for (const auto& entry : fs::directory_iterator(folder, ignored))
          if (entry.path().filename() == name) return true;
        return fs::exists(folder / name, ignored);
      };
      for (const auto start = Clock::now(); !seen(); std::this_thread::sleep_for(nap))
        if (Clock::now() - start > soon)
          throw FileError(folder.string(),
                          fmt::format("rank {} does not see what rank 0 writes there", team.rank()),
                          "Write to a folder that all machines share");
    });
  } catch (...) {
    clean();
    throw;
  }
  clean();
}

void await_file(const fs::path& file, const std::function<bool()>& there) {
  for (const auto start = Clock::now(); !there(); std::this_thread::sleep_for(nap))
    if (Clock::now() - start > patience)
      throw FileError(file.string(), "another process has written it, and it is not seen here",
                      "Write to a folder that all machines share");
}

}  // namespace surf::workflow
