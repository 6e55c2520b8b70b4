// SPDX-License-Identifier: GPL-3.0-or-later
#include "mpi_team.h"

#include <cstdlib>
#include <memory>
#include <string>

#include "surf/core/error.h"

#if defined(SEMSURF_MPI)
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <deque>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <thread>

#include "surf/mc/pack.h"
#endif

namespace surf::cli {
namespace {

std::unique_ptr<workflow::Team> joined;

// What the starters of MPI programs tell those they start: Open MPI, MPICH and Slurm.
int started_together() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_SIZE"})
    if (const char* value = std::getenv(name)) return std::atoi(value);
  // Slurm sets it for programs that are not of MPI, too: one task is nobody else.
  if (std::getenv("PMIX_RANK") || std::getenv("PMI_RANK"))
    if (const char* value = std::getenv("SLURM_NTASKS")) return std::atoi(value);
  return 1;
}

}  // namespace

#if defined(SEMSURF_MPI)
namespace {

using Clock = std::chrono::steady_clock;

// From those who follow: how many units they want, tallies, that they have no more, what went wrong.
// From the leader: numbers of units.
enum Tag : int { wants = 1, tally, finished, failed, units };

constexpr std::uint64_t no_more = ~std::uint64_t{0};
constexpr std::size_t largest_part = std::size_t{1} << 30;   // MPI counts in int
constexpr auto nap = std::chrono::microseconds(200);
// After the leader was told to stop, how long it waits for what others have begun. Starters of MPI kill
// everybody a second or so after one has died.
constexpr auto patience = std::chrono::milliseconds(700);

double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

std::string host() {
  char name[MPI_MAX_PROCESSOR_NAME];
  int length = 0;
  MPI_Get_processor_name(name, &length);
  return {name, static_cast<std::size_t>(length)};
}

// The processes of one machine: memory from MPI's windows, or a copy for each where they cannot be had.
class MpiNode : public mc::NodeMemory {
 public:
  MpiNode() {
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &comm_);
    MPI_Comm_set_errhandler(comm_, MPI_ERRORS_RETURN);
    MPI_Comm_rank(comm_, &rank_);
    MPI_Comm_size(comm_, &size_);
  }
  // By all at once.
  void leave() {
    for (Window& w : windows_) MPI_Win_free(&w.window);
    MPI_Comm_free(&comm_);
  }

  bool is_first() const override { return rank_ == 0; }
  int processes() const override { return size_; }

  void tell(std::string& bytes) override {
    std::uint64_t length = bytes.size();
    MPI_Bcast(&length, 1, MPI_UINT64_T, 0, comm_);
    bytes.resize(length);
    broadcast(bytes.data(), length);
  }

  std::shared_ptr<std::byte> allocate(std::size_t bytes) override {
    free_unused();
    Window w;
    void* mine = nullptr;
    const auto size = static_cast<MPI_Aint>(is_first() ? bytes + alignment : 0);
    int good = MPI_Win_allocate_shared(size, 1, MPI_INFO_NULL, comm_, &mine, &w.window) == MPI_SUCCESS;
    const bool made = good;
    MPI_Allreduce(MPI_IN_PLACE, &good, 1, MPI_INT, MPI_MIN, comm_);
    if (!good) {
      if (made) MPI_Win_free(&w.window);
      if (is_first() && !copied_)
        std::fprintf(stderr, "semsurf: note: no memory to share (is /dev/shm full?): each process has its own copy\n");
      copied_ = true;
      return {static_cast<std::byte*>(::operator new(bytes, std::align_val_t{alignment})),
              [](std::byte* p) { ::operator delete(p, std::align_val_t{alignment}); }};
    }
    MPI_Aint whole = 0;
    int unit = 1;
    MPI_Win_shared_query(w.window, 0, &whole, &unit, &mine);
    w.held = std::make_shared<std::atomic<bool>>(true);
    const auto at = (reinterpret_cast<std::uintptr_t>(mine) + alignment - 1) / alignment * alignment;
    windows_.push_back(w);
    return {reinterpret_cast<std::byte*>(at), [held = w.held](std::byte*) { *held = false; }};
  }

  void share(std::byte* memory, std::size_t bytes) override {
    if (copied_) return broadcast(reinterpret_cast<char*>(memory), bytes);
    std::atomic_thread_fence(std::memory_order_seq_cst);
    MPI_Barrier(comm_);
    std::atomic_thread_fence(std::memory_order_seq_cst);
  }

 private:
  static constexpr std::size_t alignment = 64;
  struct Window {
    MPI_Win window = MPI_WIN_NULL;
    std::shared_ptr<std::atomic<bool>> held;
  };

  void broadcast(char* bytes, std::size_t length) {
    for (std::size_t from = 0; from < length; from += largest_part)
      MPI_Bcast(bytes + from, static_cast<int>(std::min(largest_part, length - from)), MPI_CHAR, 0, comm_);
  }

  // Windows are freed by all together: those that nobody holds any more.
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
  bool copied_ = false;   // the same for all
  std::vector<Window> windows_;
};

class MpiTeam : public workflow::Team {
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
    if (deaf_) MPI_Abort(MPI_COMM_WORLD, 130);   // who does not answer would be waited for
    node_->leave();
    MPI_Finalize();
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  std::vector<workflow::TeamMember> members() const override { return members_; }
  mc::NodeMemory* node() override { return node_->processes() > 1 ? &*node_ : nullptr; }

  void broadcast(std::string& bytes) override {
    std::uint64_t length = bytes.size();
    MPI_Bcast(&length, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
    bytes.resize(length);
    for (std::size_t from = 0; from < length; from += largest_part)
      MPI_Bcast(bytes.data() + from, static_cast<int>(std::min<std::size_t>(largest_part, length - from)), MPI_CHAR, 0,
                MPI_COMM_WORLD);
  }

  std::vector<std::string> exchange(const std::string& text) override {
    const int length = static_cast<int>(std::min(text.size(), std::size_t{1} << 16));
    const auto count = static_cast<std::size_t>(size_);
    std::vector<int> lengths(count), starts(count, 0);
    MPI_Allgather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, MPI_COMM_WORLD);
    for (std::size_t i = 1; i < count; ++i) starts[i] = starts[i - 1] + lengths[i - 1];
    std::string all(static_cast<std::size_t>(starts.back() + lengths.back()), '\0');
    MPI_Allgatherv(text.data(), length, MPI_CHAR, all.data(), lengths.data(), starts.data(), MPI_CHAR, MPI_COMM_WORLD);
    std::vector<std::string> out;
    for (std::size_t i = 0; i < count; ++i)
      out.push_back(all.substr(static_cast<std::size_t>(starts[i]), static_cast<std::size_t>(lengths[i])));
    return out;
  }

  void lead(const mc::TakeUnit& take, const mc::GiveTally& give, const CancelToken* cancel) override {
    int at_work = size_ - 1;
    std::string trouble;
    Clock::time_point stopped{};
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
        std::this_thread::sleep_for(nap);
        continue;
      }
      const std::string bytes = receive(status);
      workflow::TeamMember& member = members_[static_cast<std::size_t>(status.MPI_SOURCE)];
      switch (status.MPI_TAG) {
        case wants: hand_out(take, trouble.empty() ? number(bytes, 0) : 0, status.MPI_SOURCE); break;
        case tally: {
          const mc::UnitTally done = mc::unpack(std::string_view(bytes).substr(sizeof(std::uint64_t)));
          ++member.units;
          member.primaries += done.balance.incident;
          give(number(bytes, 0), done);
          break;
        }
        case failed: trouble = "rank " + std::to_string(status.MPI_SOURCE) + ": " + bytes; [[fallthrough]];
        case finished:
          if (status.MPI_TAG == finished) note_member(bytes, member);
          --at_work;
          break;
        default: break;
      }
    }
    if (!trouble.empty() && !(cancel && cancel->cancelled()))
      throw InvalidInput("team", trouble, "Look at that machine, and start the same command again");
  }

  void follow(const std::function<void(const mc::TakeUnit&, const mc::GiveTally&)>& work, int threads,
              const CancelToken* cancel) override {
    Desk desk;
    own().threads = threads;
    std::exception_ptr error;
    {
      const std::jthread at_work([&] {
        try {
          work([&] { return desk.take(); },
               [&](std::size_t unit, const mc::UnitTally& done) { desk.give(unit, mc::pack(done)); });
        } catch (...) {
          error = std::current_exception();
        }
        desk.leave();
      });
      serve(desk, cancel);
    }
    if (!error && cancel && cancel->cancelled()) error = std::make_exception_ptr(Interrupted());
    workflow::TeamMember& me = own();
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
      std::rethrow_exception(error);
    }
    send(std::to_string(me.threads) + " " + std::to_string(me.waiting_s) + " " + std::to_string(me.bytes_sent) + " " + me.host,
         finished, 0);
  }

 private:
  // Between the thread that sends and receives and those that simulate.
  struct Desk {
    std::mutex mutex;
    std::condition_variable changed;
    std::deque<std::size_t> in;
    std::deque<std::pair<std::size_t, std::string>> out;
    bool closed = false, left = false;
    double waiting_s = 0;

    std::optional<std::size_t> take() {
      std::unique_lock lock(mutex);
      const auto start = Clock::now();
      changed.wait(lock, [&] { return closed || !in.empty(); });
      waiting_s += seconds(Clock::now() - start);
      if (in.empty()) return std::nullopt;
      const std::size_t unit = in.front();
      in.pop_front();
      return unit;
    }
    void give(std::size_t unit, std::string bytes) {
      const std::lock_guard lock(mutex);
      out.emplace_back(unit, std::move(bytes));
    }
    void leave() {
      const std::lock_guard lock(mutex);
      left = true;
    }
  };

  // Asks for units before they run out, and sends tallies.
  void serve(Desk& desk, const CancelToken* cancel) {
    bool asked = false;
    for (;;) {
      if (cancel && cancel->cancelled()) {
        const std::lock_guard lock(desk.mutex);
        desk.closed = true;
        desk.in.clear();
        desk.changed.notify_all();
      }
      std::deque<std::pair<std::size_t, std::string>> done;
      bool all_done = false, ask = false;
      std::uint64_t want = 0;
      {
        const std::lock_guard lock(desk.mutex);
        done.swap(desk.out);
        all_done = desk.left;
        const auto threads = static_cast<std::size_t>(std::max(1, own().threads));
        ask = !asked && !desk.closed && !desk.left && desk.in.size() < threads;
        want = 2 * threads - desk.in.size();
      }
      for (const auto& [unit, bytes] : done) {
        std::string message(sizeof(std::uint64_t), '\0');
        const std::uint64_t n = unit;
        std::memcpy(message.data(), &n, sizeof n);
        send(message + bytes, tally, 0);
      }
      if (ask) {
        std::string message(sizeof want, '\0');
        std::memcpy(message.data(), &want, sizeof want);
        send(message, wants, 0);
        asked = true;
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
      if (all_done && !asked) {
        const std::lock_guard lock(desk.mutex);
        if (desk.out.empty()) return;
        continue;
      }
      if (done.empty()) std::this_thread::sleep_for(nap);
    }
  }

  void hand_out(const mc::TakeUnit& take, std::uint64_t wanted, int to) {
    std::vector<std::uint64_t> numbers;
    while (numbers.size() < wanted) {
      const auto unit = take();
      if (!unit) break;
      numbers.push_back(*unit);
    }
    if (numbers.size() < wanted || wanted == 0) numbers.push_back(no_more);
    send(std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(std::uint64_t)), units, to);
  }

  void send(const std::string& bytes, Tag tag, int to) {
    MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_CHAR, to, tag, MPI_COMM_WORLD);
    if (to == 0) own().bytes_sent += static_cast<std::int64_t>(bytes.size());
  }

  static std::string receive(const MPI_Status& status) {
    int length = 0;
    MPI_Get_count(&status, MPI_CHAR, &length);
    std::string bytes(static_cast<std::size_t>(length), '\0');
    MPI_Recv(bytes.data(), length, MPI_CHAR, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return bytes;
  }

  static std::uint64_t number(const std::string& bytes, std::size_t at) {
    std::uint64_t n = 0;
    std::memcpy(&n, bytes.data() + at * sizeof n, sizeof n);
    return n;
  }

  static void note_member(const std::string& text, workflow::TeamMember& member) {
    std::size_t at = 0;
    member.threads = std::stoi(text, &at);
    std::string rest = text.substr(at);
    member.waiting_s = std::stod(rest, &at);
    rest = rest.substr(at);
    member.bytes_sent = std::stoll(rest, &at);
    member.host = rest.substr(at + 1);
  }

  workflow::TeamMember& own() { return members_[static_cast<std::size_t>(rank_)]; }

  int rank_ = 0, size_ = 1;
  bool deaf_ = false;
  std::optional<MpiNode> node_;
  std::vector<workflow::TeamMember> members_;
};

}  // namespace

void join_team() {
  if (started_together() > 1) joined = std::make_unique<MpiTeam>();
}
#else
void join_team() {
  if (started_together() < 2) return;
  throw Unsupported("mpirun", "this semsurf was built without MPI",
                    "Build it where MPI is installed (libopenmpi-dev), or start it once, without mpirun");
}
#endif

workflow::Team* team() { return joined.get(); }

void leave_team() { joined.reset(); }

}  // namespace surf::cli
