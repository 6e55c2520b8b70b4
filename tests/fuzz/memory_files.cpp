// SPDX-License-Identifier: GPL-3.0-or-later
#include "memory_files.h"

#include <sys/mman.h>
#include <unistd.h>

#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::test {
namespace {

std::map<std::string, std::string>& files() {
  static std::map<std::string, std::string> all;
  return all;
}

const std::string& file_at(const std::filesystem::path& path) {
  const auto found = files().find(path.lexically_normal().string());
  if (found == files().end())
    throw FileError(path.string(), "there is no such file", "Check the name and the folder");
  return found->second;
}

}  // namespace

void put_memory_file(const std::filesystem::path& path, std::string content) {
  files()[path.lexically_normal().string()] = std::move(content);
}

std::filesystem::path descriptor_file(const std::string& content) {
  static const int file = ::memfd_create("input", MFD_CLOEXEC);
  const auto size = static_cast<::off_t>(content.size());
  if (file < 0 || ::ftruncate(file, 0) != 0 ||
      ::pwrite(file, content.data(), content.size(), 0) != size)
    throw std::runtime_error("there are no files in memory");
  return "/proc/self/fd/" + std::to_string(file);
}

}  // namespace surf::test

// The functions of io/src/files/read_file.cpp.
namespace surf::io {

std::string read_file(const std::filesystem::path& path, std::size_t max_bytes) {
  const std::string& content = test::file_at(path);
  if (content.size() > max_bytes)
    throw FileError(path.string(), "it is too large", "Give a smaller file");
  return content;
}

void require_regular_file(const std::filesystem::path& path) { test::file_at(path); }

std::string sha256_of_file(const std::filesystem::path& path) {
  return sha256_of(std::as_bytes(std::span(test::file_at(path))));
}

}  // namespace surf::io
