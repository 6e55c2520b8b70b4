// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "surf/core/error.h"
#include "surf/workflow/team.h"

namespace surf::test {

/// What the threads of a crew share: one mailbox, and a table that all put a text on. Whoever waits
/// for long has lost the others: they did not call the same functions in the same order.
class CrewRoom {
 public:
  explicit CrewRoom(int size)
      : handed(), given(), size_(static_cast<std::size_t>(size)), replies_(size_), texts_(size_) {}

  std::vector<std::size_t> handed, given;  ///< numbers of units, in order

  std::vector<std::string> exchange(int rank, const std::string& text) {
    std::unique_lock lock(mutex_);
    texts_[static_cast<std::size_t>(rank)] = text;
    const int round = round_;
    if (++here_ == size_) {
      here_ = 0;
      ++round_;
      result_ = texts_;
      changed_.notify_all();
    }
    wait(lock, [&] { return round_ != round; });
    return result_;
  }

  void lead(const workflow::TakeUnit& take, const workflow::GiveUnit& give) {
    std::string trouble;
    std::exception_ptr own;
    for (std::size_t at_work = size_ - 1; at_work > 0;) {
      Letter letter = next_letter();
      if (letter.ended) {
        --at_work;
        if (!letter.trouble.empty()) trouble = letter.trouble;
      } else if (letter.done) {
        given.push_back(letter.done->number);
        try {
          if (!own) give(std::move(*letter.done));
        } catch (...) {
          own = std::current_exception();
        }
      } else {
        const auto unit = trouble.empty() && !own ? take() : std::nullopt;
        if (unit) handed.push_back(*unit);
        answer(letter.rank, unit);
      }
    }
    if (own) std::rethrow_exception(own);
    if (!trouble.empty()) throw InvalidInput("team", trouble, "Start again");
  }

  std::optional<std::size_t> take(int rank) {
    post({rank, {}, false, {}});
    std::unique_lock lock(mutex_);
    auto& mine = replies_[static_cast<std::size_t>(rank)];
    wait(lock, [&] { return !mine.empty(); });
    const auto unit = mine.front();
    mine.pop_front();
    return unit;
  }
  void give(int rank, workflow::FinishedUnit unit) {
    unit.rank = rank;
    post({rank, std::move(unit), false, {}});
  }
  void end(int rank, const std::string& trouble) { post({rank, {}, true, trouble}); }

 private:
  struct Letter {
    int rank = 0;
    std::optional<workflow::FinishedUnit> done;
    bool ended = false;
    std::string trouble;
  };

  template <class Condition>
  void wait(std::unique_lock<std::mutex>& lock, const Condition& condition) {
    if (!changed_.wait_for(lock, std::chrono::seconds(60), condition))
      throw std::runtime_error("the others do something else");
  }
  void post(Letter letter) {
    const std::lock_guard lock(mutex_);
    letters_.push_back(std::move(letter));
    changed_.notify_all();
  }
  Letter next_letter() {
    std::unique_lock lock(mutex_);
    wait(lock, [&] { return !letters_.empty(); });
    Letter letter = std::move(letters_.front());
    letters_.pop_front();
    return letter;
  }
  void answer(int rank, std::optional<std::size_t> unit) {
    const std::lock_guard lock(mutex_);
    replies_[static_cast<std::size_t>(rank)].push_back(unit);
    changed_.notify_all();
  }

  std::size_t size_, here_ = 0;
  int round_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Letter> letters_;
  std::vector<std::deque<std::optional<std::size_t>>> replies_;
  std::vector<std::string> texts_, result_;
};

/// One thread of a crew.
class ThreadCrew {
 public:
  ThreadCrew(CrewRoom& room, int rank) : room_(room), rank_(rank) {}

  void lead(const workflow::TakeUnit& take, const workflow::GiveUnit& give, const CancelToken*) {
    room_.lead(take, give);
  }
  void follow(const std::function<void(const workflow::TakeUnit&, const workflow::GiveUnit&)>& work,
              int, int, const CancelToken* cancel) {
    try {
      work([&] { return room_.take(rank_); },
           [&](workflow::FinishedUnit unit) { room_.give(rank_, std::move(unit)); });
      if (cancel && cancel->cancelled()) throw Interrupted();
    } catch (const std::exception& e) {
      room_.end(rank_, "rank " + std::to_string(rank_) + ": " + e.what());
      throw;
    }
    room_.end(rank_, "");
  }

 private:
  CrewRoom& room_;
  int rank_;
};

/// Calls `part(rank)` on a thread for each, and tells what each has thrown; empty: nothing.
template <class Part>
std::vector<std::string> on_ranks(int size, const Part& part) {
  std::vector<std::string> errors(static_cast<std::size_t>(size));
  std::vector<std::jthread> threads;
  for (int rank = 0; rank < size; ++rank)
    threads.emplace_back([&, rank] {
      try {
        part(rank);
      } catch (const std::exception& e) {
        errors[static_cast<std::size_t>(rank)] = *e.what() ? e.what() : "it failed";
      }
    });
  threads.clear();
  return errors;
}

}  // namespace surf::test
