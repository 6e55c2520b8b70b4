// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/overlaps.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <map>
#include <system_error>

#include "surf/core/error.h"

namespace surf::io {
namespace {

namespace fs = std::filesystem;

/// Where a name leads to. Writing goes the same way (`write_atomically`): a link to nothing is
/// replaced itself.
fs::path place_of(const fs::path& path) {
  std::error_code ignored;
  const fs::path whole = fs::absolute(path, ignored);
  fs::path place = fs::weakly_canonical(whole, ignored);
  return place.empty() ? whole.lexically_normal() : place;
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// The same for all names of one file, hard links included.
std::string identity_of(const fs::path& path) {
  const fs::path place = place_of(path);
  struct stat status {};
  if (::stat(place.c_str(), &status) == 0 && S_ISREG(status.st_mode))
    return fmt::format("{}:{}", status.st_dev, status.st_ino);
  return place.string();
}

bool is_within(const fs::path& file, const fs::path& folder) {
  const fs::path inner = place_of(file), outer = place_of(folder);
  auto part = inner.begin();
  for (const fs::path& outer_part : outer)
    if (part == inner.end() || *part++ != outer_part) return false;
  return part != inner.end();
}

std::string describe(const FileUse& use) {
  if (use.named.empty()) return use.path.string();
  return fmt::format("{} (which belongs to {})", use.path.string(), use.named.string());
}

[[noreturn]] void refuse(const FileUse& output, const std::string& reason) {
  throw UsageError(output.option, reason, "Choose another name for the output");
}

void refuse_input(const FileUse& output, const FileUse& input) {
  if (output.named.empty() && input.named.empty() && output.path == input.path)
    refuse(output, fmt::format("{} is an input, too ({})", output.path.string(), input.option));
  refuse(output, fmt::format("{} is the same file as {}, an input ({})", describe(output),
                             describe(input), input.option));
}

void refuse_twin(const FileUse& output, const FileUse& other) {
  if (output.named.empty() && other.named.empty() && output.path == other.path &&
      output.option == other.option)
    throw UsageError(output.option, fmt::format("{} is given twice", output.path.string()),
                     "Leave one out");
  refuse(output, fmt::format("{} is the same file as {} of {}", describe(output), describe(other),
                             other.option));
}

}  // namespace

void refuse_overlaps(const std::vector<FileUse>& inputs, const std::vector<FileUse>& outputs) {
  std::map<std::string, const FileUse*> read, written;
  for (const FileUse& input : inputs)
    if (is_file(input.path)) read.emplace(identity_of(input.path), &input);
  for (const FileUse& output : outputs) {
    std::error_code ignored;
    if (fs::is_directory(output.path, ignored)) {
      for (const auto& [identity, input] : read)
        if (is_within(input->path, output.path))
          refuse(output, fmt::format("{} lies in {}, which is written to ({})", describe(*input),
                                     describe(output), input->option));
      continue;
    }
    const std::string identity = identity_of(output.path);
    if (const auto same = read.find(identity); same != read.end())
      refuse_input(output, *same->second);
    const auto [same, is_new] = written.emplace(identity, &output);
    if (!is_new) refuse_twin(output, *same->second);
  }
}

}  // namespace surf::io
