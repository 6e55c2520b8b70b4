// SPDX-License-Identifier: GPL-3.0-or-later
#include "share_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

#include "surf/core/random.h"

namespace surf::scale {
namespace {

enum class Kind : std::uint8_t { own_unit, unit, tally, wants, answer };

struct Event {
  double at_s;
  std::int32_t rank;
  std::int32_t count;  // units wanted, or answered
  Kind kind;
  bool last = false;  // there is no more
};
struct Later {
  bool operator()(const Event& a, const Event& b) const { return a.at_s > b.at_s; }
};

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// The leader's own units, by looking for messages.
double slowed(const Messages& m, const Machines& machines) {
  return machines.ranks > 1 ? 1 / (1 - m.looking_share / machines.threads) : 1;
}

// Naps double: the last is half of the time without a message, and one comes in its middle.
double asleep_s(const Messages& m, double without_s) {
  return std::clamp((without_s + m.shortest_nap_s) / 2, m.shortest_nap_s, m.longest_nap_s) / 2;
}

class Run {
 public:
  Run(const UnitCosts& costs, const Messages& messages, const Machines& machines,
      std::int64_t units)
      : costs_(costs), m_(messages), threads_(machines.threads),
        of_helper_(machines.threads * machines.crowd), crowd_(machines.crowd), left_(units),
        slow_(slowed(messages, machines)), helpers_(static_cast<std::size_t>(machines.ranks)) {
    for (int t = 0; t < threads_; ++t) begin_own(0);
    for (int r = 1; r < machines.ranks; ++r) {
      helpers_[static_cast<std::size_t>(r)].idle = of_helper_;
      ask(r, 0);
    }
  }

  double seconds() {
    while (!events_.empty()) {
      const Event e = events_.top();
      events_.pop();
      handle(e);
    }
    return end_s_;
  }
  double served_s() const { return served_s_; }
  double waiting_s() const { return waiting_s_; }
  std::int64_t of_others() const { return of_others_; }

 private:
  struct Helper {
    int idle = 0, in_hand = 0;
    double idle_since_s = 0, asked_s = 0;
    bool asked = false, closed = false;
  };

  void handle(const Event& e) {
    end_s_ = std::max(end_s_, e.at_s);
    switch (e.kind) {
      case Kind::own_unit: {
        // What messages took of this thread meanwhile it has to make up for.
        const double lost_s =
            (busy_s(e.at_s) - seen_busy_[static_cast<std::size_t>(e.count)]) / (threads_ + 1);
        seen_busy_[static_cast<std::size_t>(e.count)] = busy_s(e.at_s);
        if (lost_s > 1e-3 * shortest_s) events_.push({e.at_s + lost_s, 0, e.count, Kind::own_unit});
        else begin_own(e.at_s, e.count);
        break;
      }
      case Kind::unit:
        finish(e.rank, e.at_s);
        break;
      case Kind::tally: {
        const double wire_s = costs_.bytes / m_.bytes_per_s;
        serve(e.at_s, std::max(wire_s, m_.leader_s + costs_.unpack_s + costs_.merge_s));
        break;
      }
      case Kind::wants: {
        const auto given = static_cast<std::int32_t>(std::min<std::int64_t>(e.count, left_));
        left_ -= given;
        of_others_ += given;
        const double sent_s = serve(e.at_s, 2 * m_.leader_s);
        const double there_s = sent_s + m_.latency_s;
        const double lag_s =
            asleep_s(m_, there_s - helpers_[static_cast<std::size_t>(e.rank)].asked_s);
        events_.push({there_s + lag_s, e.rank, given, Kind::answer, given < e.count});
        break;
      }
      case Kind::answer: {
        Helper& h = helpers_[static_cast<std::size_t>(e.rank)];
        h.asked = false;
        h.in_hand += e.count;
        count_waiting(h, e.at_s);
        h.closed = e.last;
        for (; h.idle > 0 && h.in_hand > 0; --h.idle) begin(e.rank, e.at_s);
        ask(e.rank, e.at_s);
        break;
      }
    }
  }

  void begin_own(double at_s, int thread = -1) {
    if (thread < 0) {
      thread = static_cast<int>(seen_busy_.size());
      seen_busy_.push_back(0);
    }
    if (left_ == 0) return;
    --left_;
    events_.push({at_s + (duration() + costs_.merge_s) * slow_, 0, thread, Kind::own_unit});
  }

  void begin(int rank, double at_s) {
    --helpers_[static_cast<std::size_t>(rank)].in_hand;
    const double works_s = duration() + costs_.pack_s + m_.follower_s;
    events_.push({at_s + crowd_ * works_s, rank, 0, Kind::unit});
  }

  void finish(int rank, double at_s) {
    Helper& h = helpers_[static_cast<std::size_t>(rank)];
    events_.push({at_s + m_.latency_s, rank, 0, Kind::tally});
    if (h.in_hand > 0) begin(rank, at_s);
    else {
      count_waiting(h, at_s);
      ++h.idle;
    }
    ask(rank, at_s);
  }

  void count_waiting(Helper& h, double at_s) {
    if (!h.closed) waiting_s_ += h.idle * (at_s - h.idle_since_s);
    h.idle_since_s = at_s;
  }

  void ask(int rank, double at_s) {
    Helper& h = helpers_[static_cast<std::size_t>(rank)];
    if (h.asked || h.closed || h.in_hand >= of_helper_) return;
    h.asked = true;
    h.asked_s = at_s;
    events_.push({at_s + m_.latency_s, rank, 2 * of_helper_ - h.in_hand, Kind::wants});
  }

  // The leader's one thread for messages, which shares processors with those that simulate. When it
  // is done.
  double serve(double at_s, double processor_s) {
    const bool asleep = at_s > free_s_;
    const double begin_s = asleep ? at_s + asleep_s(m_, at_s - free_s_) : free_s_;
    const double clock_s = left_ > 0 ? processor_s * (threads_ + 1) / threads_ : processor_s;
    free_s_ = begin_s + clock_s;
    served_s_ += clock_s;
    end_s_ = std::max(end_s_, free_s_);
    return free_s_;
  }

  double busy_s(double at_s) const { return served_s_ - std::max(0.0, free_s_ - at_s); }

  double duration() {
    const auto n = costs_.durations_s.size();
    return costs_.durations_s[std::min(
        n - 1, static_cast<std::size_t>(random_.uniform() * static_cast<double>(n)))];
  }

  static constexpr double shortest_s = 1e-4;
  const UnitCosts& costs_;
  const Messages& m_;
  int threads_, of_helper_, crowd_;
  std::int64_t left_;
  double slow_;
  std::vector<Helper> helpers_;
  std::vector<double> seen_busy_;  // by thread of the leader
  std::priority_queue<Event, std::vector<Event>, Later> events_;
  RandomStream random_{1, 0, 0};
  double free_s_ = 0, served_s_ = 0, end_s_ = 0, waiting_s_ = 0;
  std::int64_t of_others_ = 0;
};

double ideal_s(const UnitCosts& costs, const Machines& machines, std::int64_t units) {
  return static_cast<double>(units) * mean(costs.durations_s) /
         (static_cast<double>(machines.ranks) * machines.threads);
}

}  // namespace

double service_s(const UnitCosts& costs, const Messages& m, int threads) {
  // A request and its answer bring one unit for each thread at least: two at the first.
  return std::max(costs.bytes / m.bytes_per_s, m.leader_s + costs.unpack_s + costs.merge_s) +
         2 * m.leader_s / threads;
}

Sharing simulate_sharing(const UnitCosts& costs, const Messages& messages, const Machines& machines,
                         std::int64_t units, std::int64_t most) {
  const std::int64_t enough = std::max(most, std::int64_t{24} * machines.ranks * machines.threads);
  const std::int64_t done = std::min(units, enough);
  Run run(costs, messages, machines, done);
  Sharing out;
  out.seconds = run.seconds();
  out.leader_busy = std::min(1.0, run.served_s() / out.seconds);
  out.waiting_s_per_unit =
      run.waiting_s() / static_cast<double>(std::max<std::int64_t>(1, run.of_others()));
  if (units > done) {
    const double half_s = Run(costs, messages, machines, done / 2).seconds();
    out.seconds += (out.seconds - half_s) / static_cast<double>(done - done / 2) *
                   static_cast<double>(units - done);
  }
  out.efficiency = ideal_s(costs, machines, units) / out.seconds;
  return out;
}

Sharing bound_sharing(const UnitCosts& costs, const Messages& m, const Machines& machines,
                      std::int64_t units) {
  const double unit_s = mean(costs.durations_s);
  const double own = machines.threads / ((unit_s + costs.merge_s) * slowed(m, machines));
  const double others =
      (machines.ranks - 1.0) * machines.threads / (unit_s + costs.pack_s + m.follower_s);
  const double serves = machines.threads / (machines.threads + 1.0) /
                        service_s(costs, m, machines.threads * machines.crowd);
  const double by_others = std::min(others, serves);
  // Serving takes processor time from the leader's own units.
  const double lost = by_others / serves / (machines.threads + 1.0);
  Sharing out;
  out.seconds = static_cast<double>(units) / (by_others + own * (1 - lost)) +
                (machines.ranks > 1 ? 2 * unit_s : unit_s / 2);
  out.efficiency = ideal_s(costs, machines, units) / out.seconds;
  out.leader_busy = by_others / serves;
  return out;
}

}  // namespace surf::scale
