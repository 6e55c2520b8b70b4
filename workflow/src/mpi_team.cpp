// SPDX-License-Identifier: GPL-3.0-or-later
// The module `mpi`, the only source that uses MPI.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <fmt/format.h>
#include <mpi.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <deque>
#include <exception>
#include <list>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

#include "mpi_library.h"
#include "surf/core/error.h"
#include "surf/core/try_thread.h"
#include "surf/workflow/team.h"

namespace surf::workflow {
namespace {

using Clock = std::chrono::steady_clock;

// Messages from followers: the number of units wanted, the result of a unit, the end of their work,
// an error. Messages from the leader: numbers of units.
enum Tag : int { wants = 1, tally, finished, failed, units };

constexpr std::uint64_t no_more = ~std::uint64_t{0};
constexpr std::size_t largest_part = std::size_t{1} << 30;  // MPI counts in int
// Probing for messages costs tens of microseconds. The longer no message has come, the longer the
// process sleeps between probes. A unit of work takes longer than these sleeps, and followers ask
// for more units before they run out.
constexpr std::chrono::microseconds shortest_nap(50), longest_nap(5000);
constexpr std::chrono::microseconds longest_nap_sending(
    1000);  // large messages need both sides awake
// Checks whether the job is cancelled.
constexpr auto between_looks = std::chrono::milliseconds(20);
constexpr auto awake = std::chrono::milliseconds(1);
// After a cancellation the leader waits this long for units that others have begun. MPI launchers
// kill all processes about a second after one has died.
constexpr auto patience = std::chrono::milliseconds(700);

void sleep_longer(std::chrono::microseconds& nap, std::chrono::microseconds longest = longest_nap) {
  std::this_thread::sleep_for(nap);
  nap = std::min(2 * nap, longest);
}

double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

// Adds to a sum the processor time of this thread; waiting costs nothing.
class ThreadTime {
 public:
  explicit ThreadTime(double& sum) : sum_(sum), start_(now()) {}
  ~ThreadTime() { sum_ += now() - start_; }

 private:
  static double now() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  double& sum_;
  double start_;
};

std::string host() {
  char name[MPI_MAX_PROCESSOR_NAME];
  int length = 0;
  MPI_Get_processor_name(name, &length);
  return {name, static_cast<std::size_t>(length)};
}

// Waits for a collective call without keeping a processor busy, as MPI's own waiting does: the
// leader may be at work for minutes. It sleeps only if the call does not complete at once.
template <class Begin>
void await(const Begin& begin) {
  MPI_Request request;
  begin(&request);
  const auto start = Clock::now();
  for (;;) {
    int done = 0;
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done) return;
    const auto waited = Clock::now() - start;
    if (waited < awake) std::this_thread::yield();
    else std::this_thread::sleep_for(std::min<Clock::duration>(waited / 20, longest_nap));
  }
}

// The processes of one machine. They share memory through MPI's windows, or each has a copy if
// windows are unavailable.
class MpiNode : public NodeMemory {
 public:
  MpiNode() {
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &comm_);
    MPI_Comm_set_errhandler(comm_, MPI_ERRORS_RETURN);
    MPI_Comm_rank(comm_, &rank_);
    MPI_Comm_size(comm_, &size_);
  }
  // Called by all processes at once.
  void leave() {
    for (Window& w : windows_) MPI_Win_free(&w.window);
    MPI_Comm_free(&comm_);
  }

  bool is_first() const override { return rank_ == 0; }
  int processes() const override { return size_; }

  void tell(std::string& bytes) override {
    std::uint64_t length = bytes.size();
    await([&](MPI_Request* r) { MPI_Ibcast(&length, 1, MPI_UINT64_T, 0, comm_, r); });
    bytes.resize(length);
    broadcast(bytes.data(), length);
  }

  std::shared_ptr<std::byte> allocate(std::size_t bytes) override {
    free_unused();
    Window w;
    void* mine = nullptr;
    const auto size = static_cast<MPI_Aint>(is_first() ? bytes + alignment : 0);
    // Checked beforehand: if the first process cannot allocate it, Open MPI leaves the others
    // waiting.
    int room = is_first() && has_room(bytes + alignment);
    await([&](MPI_Request* r) { MPI_Ibcast(&room, 1, MPI_INT, 0, comm_, r); });
    int good = room && MPI_Win_allocate_shared(size, 1, MPI_INFO_NULL, comm_, &mine, &w.window) ==
                           MPI_SUCCESS;
    const bool made = good;
    MPI_Allreduce(MPI_IN_PLACE, &good, 1, MPI_INT, MPI_MIN, comm_);
    if (!good) {
      if (made) MPI_Win_free(&w.window);
      if (is_first() && !told_)
        std::fprintf(stderr,
                     "semsurf: note: no memory to share (is /dev/shm full?): each process has its "
                     "own copy\n");
      told_ = true;
      const std::shared_ptr<std::byte> copy(
          static_cast<std::byte*>(::operator new (bytes, std::align_val_t{alignment})),
          [](std::byte* p) { ::operator delete (p, std::align_val_t{alignment}); });
      copies_.push_back(copy.get());
      return copy;
    }
    MPI_Aint whole = 0;
    int unit = 1;
    MPI_Win_shared_query(w.window, 0, &whole, &unit, &mine);
    w.held = std::make_shared<std::atomic<bool>>(true);
    const auto at =
        (reinterpret_cast<std::uintptr_t>(mine) + alignment - 1) / alignment * alignment;
    windows_.push_back(w);
    return {reinterpret_cast<std::byte*>(at), [held = w.held](std::byte*) { *held = false; }};
  }

  void share(std::byte* memory, std::size_t bytes) override {
    if (std::erase(copies_, memory) > 0) return broadcast(reinterpret_cast<char*>(memory), bytes);
    std::atomic_thread_fence(std::memory_order_seq_cst);
    await([&](MPI_Request* r) { MPI_Ibarrier(comm_, r); });
    std::atomic_thread_fence(std::memory_order_seq_cst);
  }

 private:
  static constexpr std::size_t alignment = 64;
  struct Window {
    MPI_Win window = MPI_WIN_NULL;
    std::shared_ptr<std::atomic<bool>> held;
  };

  void broadcast(char* bytes, std::size_t length) {
    for (std::size_t from = 0; from < length; from += largest_part) {
      const int part = static_cast<int>(std::min(largest_part, length - from));
      await([&](MPI_Request* r) { MPI_Ibcast(bytes + from, part, MPI_CHAR, 0, comm_, r); });
    }
  }

  // Open MPI's windows are files in /dev/shm that are five percent larger.
  static bool has_room(std::size_t bytes) {
    struct statvfs s {};
    if (statvfs("/dev/shm", &s) != 0) return true;  // then windows are elsewhere
    return static_cast<double>(s.f_bavail) * static_cast<double>(s.f_frsize) >
           1.06 * static_cast<double>(bytes) + 1e6;
  }

  // Frees the windows that no process holds any more. All processes free a window together.
  void free_unused() {
    std::vector<Window> kept;
    for (Window& w : windows_) {
      int held = *w.held;
      MPI_Allreduce(MPI_IN_PLACE, &held, 1, MPI_INT, MPI_MAX, comm_);
      if (held) kept.push_back(w);
      else MPI_Win_free(&w.window);
    }
    windows_ = std::move(kept);
  }

  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0, size_ = 1;
  bool told_ = false;
  std::vector<const std::byte*> copies_;  // not shared yet
  std::vector<Window> windows_;
};

class MpiTeam : public Team {
 public:
  MpiTeam() {
    int given = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    members_.resize(static_cast<std::size_t>(size_));
    for (int r = 0; r < size_; ++r) members_[static_cast<std::size_t>(r)].rank = r;
    own().host = host();
    node_.emplace();
  }

  ~MpiTeam() override {
    // MPI_Finalize would wait for processes that do not answer.
    if (deaf_) MPI_Abort(MPI_COMM_WORLD, 130);
    // Waits without using the processor, unlike the calls below.
    await([](MPI_Request* r) { MPI_Ibarrier(MPI_COMM_WORLD, r); });
    node_->leave();
    MPI_Finalize();
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  std::vector<TeamMember> members() const override { return members_; }
  NodeMemory* node() override { return node_->processes() > 1 ? &*node_ : nullptr; }

  void broadcast(std::string& bytes) override {
    if (deaf_) return;
    std::uint64_t length = bytes.size();
    await([&](MPI_Request* r) { MPI_Ibcast(&length, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD, r); });
    bytes.resize(length);
    for (std::size_t from = 0; from < length; from += largest_part) {
      const int part = static_cast<int>(std::min<std::size_t>(largest_part, length - from));
      await([&](MPI_Request* r) {
        MPI_Ibcast(bytes.data() + from, part, MPI_CHAR, 0, MPI_COMM_WORLD, r);
      });
    }
  }

  std::vector<std::string> exchange(const std::string& text) override {
    const auto count = static_cast<std::size_t>(size_);
    if (deaf_) return std::vector<std::string>(count);
    const int length = static_cast<int>(std::min(text.size(), std::size_t{1} << 16));
    std::vector<int> lengths(count), starts(count, 0);
    await([&](MPI_Request* r) {
      MPI_Iallgather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, MPI_COMM_WORLD, r);
    });
    for (std::size_t i = 1; i < count; ++i) starts[i] = starts[i - 1] + lengths[i - 1];
    std::string all(static_cast<std::size_t>(starts.back() + lengths.back()), '\0');
    await([&](MPI_Request* r) {
      MPI_Iallgatherv(text.data(), length, MPI_CHAR, all.data(), lengths.data(), starts.data(),
                      MPI_CHAR, MPI_COMM_WORLD, r);
    });
    std::vector<std::string> out;
    for (std::size_t i = 0; i < count; ++i)
      out.push_back(
          all.substr(static_cast<std::size_t>(starts[i]), static_cast<std::size_t>(lengths[i])));
    return out;
  }

  void lead(const TakeUnit& take, const GiveUnit& give, const CancelToken* cancel) override {
    const ThreadTime time(own().messaging_s);
    int at_work = size_ - 1;
    std::string trouble;
    std::exception_ptr thrown;  // exception of `give`; the others are told to end first
    Clock::time_point stopped{};
    auto nap = shortest_nap;
    while (at_work > 0) {
      MPI_Status status;
      int there = 0;
      MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
      if (!there) {
        if (cancel && cancel->cancelled()) {
          if (stopped == Clock::time_point{}) stopped = Clock::now();
          if (Clock::now() - stopped > patience) {
            deaf_ = true;
            return;
          }
        }
        sleep_longer(nap);
        continue;
      }
      nap = shortest_nap;
      const std::string bytes = receive(status);
      TeamMember& member = members_[static_cast<std::size_t>(status.MPI_SOURCE)];
      switch (status.MPI_TAG) {
        case wants:
          try {
            hand_out(take, trouble.empty() && !thrown ? number(bytes, 0) : 0, status.MPI_SOURCE);
          } catch (...) {  // a damaged checkpoint
            thrown = std::current_exception();
            hand_out(take, 0, status.MPI_SOURCE);
          }
          break;
        case tally: {
          const auto primaries = static_cast<std::int64_t>(number(bytes, 1));
          ++member.units;
          member.primaries += primaries;
          try {
            if (!thrown)
              give({number(bytes, 0), primaries, bytes.substr(2 * sizeof(std::uint64_t)),
                    status.MPI_SOURCE});
          } catch (...) {
            thrown = std::current_exception();
          }
          break;
        }
        case failed:
          trouble = "rank " + std::to_string(status.MPI_SOURCE) + ": " + bytes;
          [[fallthrough]];
        case finished:
          if (status.MPI_TAG == finished) note_member(bytes, member);
          --at_work;
          break;
        default:
          break;
      }
      all_sent();
    }
    wait_until_sent();
    if (thrown) std::rethrow_exception(thrown);
    if (!trouble.empty() && !(cancel && cancel->cancelled()))
      throw InvalidInput("team", trouble, "Look at that machine, and start the same command again");
  }

  void follow(const std::function<void(const TakeUnit&, const GiveUnit&)>& work, int threads,
              int ahead, const CancelToken* cancel) override {
    Desk desk;
    desk.ahead = static_cast<std::size_t>(ahead);
    own().threads = threads;
    std::exception_ptr error;
    {
      const std::jthread at_work = try_thread([&] {
        try {
          work([&] { return desk.take(); }, [&](FinishedUnit unit) { desk.give(std::move(unit)); });
        } catch (...) {
          error = std::current_exception();
        }
        desk.leave();
      });
      if (!at_work.joinable()) {
        error = std::make_exception_ptr(
            Unsupported("threads", "the system cannot start another one",
                        "Raise the limits of processes and memory (ulimit -u, ulimit -v)"));
        desk.leave();
      }
      const ThreadTime time(own().messaging_s);
      serve(desk, cancel);
    }
    if (!error && cancel && cancel->cancelled()) error = std::make_exception_ptr(Interrupted());
    TeamMember& me = own();
    me.waiting_s += desk.waiting_s;
    if (error) {
      std::string text = "it failed";
      try {
        std::rethrow_exception(error);
      } catch (const std::exception& e) {
        text = e.what();
      } catch (...) {
      }
      send(text, failed, 0);
      wait_until_sent();
      std::rethrow_exception(error);
    }
    std::ostringstream sums;
    sums << me.threads << ' ' << me.waiting_s << ' ' << me.messaging_s << ' ' << me.bytes_sent
         << ' ' << me.messages << ' ' << me.host;
    send(sums.str(), finished, 0);
    wait_until_sent();
  }

 private:
  // The queue between the thread that exchanges messages and the threads that simulate.
  struct Desk {
    std::mutex mutex;
    std::condition_variable changed;  // for the simulating threads
    std::condition_variable news;     // for the messaging thread
    std::deque<std::size_t> in;
    std::deque<FinishedUnit> out;
    std::size_t ahead = 0, takers = 0;  // takers: threads that wait for a unit
    bool closed = false, left = false;
    double waiting_s = 0;

    std::optional<std::size_t> take() {
      std::unique_lock lock(mutex);
      const auto start = Clock::now();
      ++takers;
      news.notify_one();
      changed.wait(lock, [&] { return closed || !in.empty(); });
      --takers;
      waiting_s += seconds(Clock::now() - start);
      if (in.empty()) return std::nullopt;
      const std::size_t unit = in.front();
      in.pop_front();
      news.notify_one();
      return unit;
    }
    void give(FinishedUnit unit) {
      const std::lock_guard lock(mutex);
      out.push_back(std::move(unit));
      news.notify_one();
    }
    void leave() {
      const std::lock_guard lock(mutex);
      left = true;
      news.notify_one();
    }
    std::size_t enough() const { return std::max(ahead, takers); }
    bool has_few() const { return !closed && !left && in.size() < enough(); }
  };

  // Asks for units before they run out, and sends tallies.
  void serve(Desk& desk, const CancelToken* cancel) {
    bool asked = false;
    auto nap = shortest_nap;
    for (;;) {
      if (cancel && cancel->cancelled()) {
        const std::lock_guard lock(desk.mutex);
        desk.closed = true;
        desk.in.clear();
        desk.changed.notify_all();
      }
      std::deque<FinishedUnit> done;
      bool all_done = false, ask = false;
      std::uint64_t want = 0;
      {
        const std::lock_guard lock(desk.mutex);
        done.swap(desk.out);
        all_done = desk.left;
        ask = !asked && desk.has_few();
        want = desk.enough() + desk.ahead - desk.in.size();
      }
      for (const FinishedUnit& unit : done) {
        const std::uint64_t head[] = {unit.number, static_cast<std::uint64_t>(unit.primaries)};
        send(std::string(reinterpret_cast<const char*>(head), sizeof head) + unit.bytes, tally, 0);
      }
      if (ask) {
        std::string message(sizeof want, '\0');
        std::memcpy(message.data(), &want, sizeof want);
        send(message, wants, 0);
        asked = true;
        nap = shortest_nap;
      }
      MPI_Status status;
      int there = 0;
      MPI_Iprobe(0, units, MPI_COMM_WORLD, &there, &status);
      if (there) {
        const std::string bytes = receive(status);
        asked = false;
        const std::lock_guard lock(desk.mutex);
        for (std::size_t i = 0; i < bytes.size() / sizeof(std::uint64_t); ++i) {
          const std::uint64_t unit = number(bytes, i);
          if (unit == no_more) desk.closed = true;
          else desk.in.push_back(unit);
        }
        desk.changed.notify_all();
        continue;
      }
      if (!done.empty()) {
        nap = shortest_nap;
        continue;
      }
      const bool sent = all_sent();
      if (all_done && !asked) return;  // the rest is awaited together with the last message
      if (asked || !sent) {
        sleep_longer(nap, sent ? longest_nap : longest_nap_sending);
        continue;
      }
      std::unique_lock lock(desk.mutex);  // only requested messages come
      desk.news.wait_for(lock, between_looks,
                         [&] { return !desk.out.empty() || desk.left || desk.has_few(); });
    }
  }

  void hand_out(const TakeUnit& take, std::uint64_t wanted, int to) {
    std::vector<std::uint64_t> numbers;
    while (numbers.size() < wanted) {
      const auto unit = take();
      if (!unit) break;
      numbers.push_back(*unit);
    }
    if (numbers.size() < wanted || wanted == 0) numbers.push_back(no_more);
    send(std::string(reinterpret_cast<const char*>(numbers.data()),
                     numbers.size() * sizeof(std::uint64_t)),
         units, to);
  }

  // Does not wait for the receiver, which may be asleep: MPI would poll for it all the time.
  void send(std::string bytes, Tag tag, int to) {
    ++own().messages;
    if (to == 0) own().bytes_sent += static_cast<std::int64_t>(bytes.size());
    sending_.push_back({MPI_REQUEST_NULL, std::move(bytes)});
    const std::string& kept = sending_.back().bytes;
    MPI_Isend(kept.data(), static_cast<int>(kept.size()), MPI_CHAR, to, tag, MPI_COMM_WORLD,
              &sending_.back().request);
  }

  bool all_sent() {
    std::erase_if(sending_, [](Sending& message) {
      int done = 0;
      MPI_Test(&message.request, &done, MPI_STATUS_IGNORE);
      return done != 0;
    });
    return sending_.empty();
  }

  void wait_until_sent() {
    for (auto nap = shortest_nap; !all_sent();) sleep_longer(nap, longest_nap_sending);
  }

  static std::string receive(const MPI_Status& status) {
    int length = 0;
    MPI_Get_count(&status, MPI_CHAR, &length);
    std::string bytes(static_cast<std::size_t>(length), '\0');
    MPI_Recv(bytes.data(), length, MPI_CHAR, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    return bytes;
  }

  static std::uint64_t number(const std::string& bytes, std::size_t at) {
    std::uint64_t n = 0;
    std::memcpy(&n, bytes.data() + at * sizeof n, sizeof n);
    return n;
  }

  static void note_member(const std::string& text, TeamMember& member) {
    std::istringstream in(text);
    in >> member.threads >> member.waiting_s >> member.messaging_s >> member.bytes_sent >>
        member.messages;
    in.ignore();
    std::getline(in, member.host);
  }

  TeamMember& own() { return members_[static_cast<std::size_t>(rank_)]; }

  struct Sending {
    MPI_Request request;
    std::string bytes;
  };
  std::list<Sending> sending_;  // elements keep their addresses
  int rank_ = 0, size_ = 1;
  bool deaf_ = false;
  std::optional<MpiNode> node_;
  std::vector<TeamMember> members_;
};

std::unique_ptr<Team> join() { return std::make_unique<MpiTeam>(); }

constexpr MpiLibrary table{join};

}  // namespace
}  // namespace surf::workflow

SEMSURF_MODULE(mpi, surf::workflow::table)
