// SPDX-License-Identifier: GPL-3.0-or-later
#include "checkpoint.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "surf/core/error.h"
#include "surf/mc/results/serialize.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;
using Seconds = std::chrono::duration<double>;

constexpr double first_seconds = 10;                         // shorter jobs write no checkpoint
constexpr std::size_t most_waiting = std::size_t{16} << 20;  // bytes of unwritten records
constexpr double most_of_the_time = 0.05;                    // share of the time spent on writing
constexpr std::string_view extension = ".checkpoint";
constexpr std::size_t name_digits = 8;

// Whole numbers in a block take 8 bytes, lowest first.
void put(std::string& out, std::uint64_t value) {
  for (int shift = 0; shift < 64; shift += 8) out.push_back(static_cast<char>(value >> shift));
}

class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}
  bool empty() const { return rest_.empty(); }
  std::uint64_t number() {
    std::uint64_t value = 0;
    const std::string_view bytes = take(8);
    for (std::size_t i = 0; i < 8; ++i)
      value |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
    return value;
  }
  std::string_view take(std::uint64_t size) {
    if (size > rest_.size())
      throw InvalidInput("checkpoint", "a record is cut off", "Add `job.restart` to begin anew");
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

 private:
  std::string_view rest_;
};

// A batch of units: its first unit, the primaries (or pixels) in it, and those of the whole job as
// a double. Each unit's number, size and tally follow.
struct BatchHead {
  std::uint64_t first_unit;
  std::uint64_t work;
  double expected;
};

BatchHead read_head(Reader& reader) {
  BatchHead head{};
  head.first_unit = reader.number();
  head.work = reader.number();
  head.expected = std::bit_cast<double>(reader.number());
  return head;
}

std::string identity_text(const Identity& identity) {
  return nlohmann::json(identity).dump(1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Identity read_identity(const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  Identity identity;
  if (json.is_object())
    for (const auto& [key, value] : json.items())
      if (value.is_string()) identity[key] = value.get<std::string>();
  return identity;
}

// The identity as it is read back from a file: file names need not be UTF-8.
Identity normal(const Identity& identity) { return read_identity(identity_text(identity)); }

std::string date_of(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return "unknown date";
  return fmt::format("{:%Y-%m-%d %H:%M}", fmt::localtime(status.st_mtime));
}

// "63 %", rounded down, so that 100 % means all.
std::string share(double work, double expected) {
  return expected > 0 ? fmt::format("{:.0f} %", std::floor(100 * work / expected)) : "a part";
}

bool looks_like_ours(const std::string& name, const std::string& stem) {
  if (name.size() != stem.size() + 1 + name_digits + extension.size()) return false;
  if (!name.starts_with(stem + ".") || !name.ends_with(extension)) return false;
  const std::string digits = name.substr(stem.size() + 1, name_digits);
  return digits.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

fs::path checkpoint_path(const fs::path& output, const Identity& identity) {
  fs::path path = output;
  return path.replace_extension("." + fingerprint(identity).substr(0, name_digits) +
                                std::string(extension));
}

Checkpoint::Checkpoint(const CheckpointOptions& options, const fs::path& output, Identity identity,
                       Say note, Say warn)
    : options_(options), identity_(normal(identity)), note_(std::move(note)),
      warn_(std::move(warn)) {
  path_ = options_.file.empty() ? checkpoint_path(output, identity_) : options_.file;
  due_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                            Seconds(std::min(first_seconds, options_.seconds)));
  if (file_.open(path_)) resume();
  if (options_.file.empty()) note_others();
}

Checkpoint::~Checkpoint() {
  if (!finished_ && file_.is_open() && !waiting_.empty()) write();
}

void Checkpoint::resume() {
  const std::string name = path_.string();
  const bool begun = !file_.blocks().empty();
  if (options_.restart || !begun) {
    if (!begun && file_.damaged()) warn_(name + ": its beginning is damaged; the job begins anew");
    else if (begun) note_(name + ": not used, as asked; the job begins anew");
    file_.clear();
    return;
  }
  const Identity there = read_identity(file_.read(file_.blocks().front()));
  if (const std::string what = difference(there, identity_); !what.empty())
    throw FileError(
        name, "it is the checkpoint of another job; different: " + what,
        "Choose another name by `job.checkpoint=FILE`, or give up what is in it by `job.restart`");

  double work = 0, expected = 0;
  for (auto block = file_.blocks().begin() + 1; block != file_.blocks().end(); ++block) {
    const std::string content = file_.read(*block);
    Reader reader(content);
    const BatchHead head = read_head(reader);
    work += static_cast<double>(head.work);
    expected = head.expected;
    batches_.push_back({head.first_unit, *block});
  }
  std::stable_sort(batches_.begin(), batches_.end(),
                   [](const Batch& a, const Batch& b) { return a.first_unit > b.first_unit; });
  if (file_.damaged())
    warn_(name + ": a part of it is damaged or cut off; that part is done again");
  if (batches_.empty()) return;
  note_(fmt::format("resuming: {} is done, in {} of {}", share(work, expected), name,
                    date_of(path_)));
}

// Notes checkpoints of other jobs with the same output, which nobody would find otherwise.
void Checkpoint::note_others() const {
  const std::string own = path_.filename().string();
  const std::string stem = own.substr(0, own.size() - extension.size() - name_digits - 1);
  std::vector<fs::path> others;
  std::error_code error;
  const fs::path folder = path_.has_parent_path() ? path_.parent_path() : ".";
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name != own && looks_like_ours(name, stem)) others.push_back(path_.parent_path() / name);
  }
  std::sort(others.begin(), others.end());
  for (const fs::path& other : others) {
    const std::string begin = CheckpointFile::first_block(other);
    if (!begin.empty())
      note_(fmt::format("{} of {} is left as it is: the checkpoint of another job; different: {}",
                        other.string(), date_of(other),
                        difference(read_identity(begin), identity_)));
  }
}

void Checkpoint::load(const Batch& batch) {
  std::string content;
  try {
    content = file_.read(batch.block);
  } catch (const FileError& error) {
    warn_(std::string(error.what()) + ". That part is done again");
    return;
  }
  Reader reader(content);
  read_head(reader);
  while (!reader.empty()) {
    const std::uint64_t unit = reader.number();
    recalled_[unit] = reader.take(reader.number());
  }
}

bool Checkpoint::recall(std::size_t unit, mc::UnitTally& tally) {
  // Units are requested nearly in order, so only a batch or two is in memory.
  while (!batches_.empty() && batches_.back().first_unit <= unit) {
    load(batches_.back());
    batches_.pop_back();
  }
  const auto found = recalled_.find(unit);
  if (found == recalled_.end()) return false;
  tally = mc::deserialize(found->second);
  recalled_.erase(found);
  return true;
}

void Checkpoint::record(std::size_t unit, const mc::UnitTally& tally) {
  const std::string bytes = mc::serialize(tally);
  first_waiting_ = waiting_.empty() ? unit : std::min(first_waiting_, unit);
  put(waiting_, unit);
  put(waiting_, bytes.size());
  waiting_ += bytes;
  // With a wanted accuracy the number of primaries is not known beforehand, so pixels are counted.
  work_waiting_ += tally.controls.empty() ? tally.balance.incident
                                          : static_cast<std::int64_t>(tally.pixels.size());
  if (waiting_.size() < most_waiting && Clock::now() < due_) return;
  const auto begin = Clock::now();
  write();
  const auto now = Clock::now();
  due_ =
      now + std::max(std::chrono::duration_cast<Clock::duration>(Seconds(options_.seconds)),
                     std::chrono::duration_cast<Clock::duration>((now - begin) / most_of_the_time));
}

bool Checkpoint::write() {
  std::string content;
  content.reserve(waiting_.size() + 24);
  put(content, first_waiting_);
  put(content, static_cast<std::uint64_t>(work_waiting_));
  put(content, std::bit_cast<std::uint64_t>(expected_));
  content += waiting_;
  // If writing fails, a resumed job does only these units again, not the later ones.
  waiting_.clear();
  work_waiting_ = 0;
  try {
    if (!file_.is_open()) file_.create(path_);
    if (file_.empty()) file_.append(identity_text(identity_));
    file_.append(content);
    return true;
  } catch (const Error& error) {
    if (!trouble_) warn_(std::string(error.what()) + ". The job goes on");
    trouble_ = true;
    return false;
  }
}

bool Checkpoint::keep() {
  if (!waiting_.empty()) write();
  return file_.is_open() && !file_.empty();
}

void Checkpoint::finish() {
  finished_ = true;
  if (file_.is_open()) file_.remove();
}

}  // namespace surf::workflow
