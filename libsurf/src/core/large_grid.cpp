// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/large_grid.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "surf/core/error.h"

namespace surf {
namespace {

[[noreturn]] void fail(const std::string& folder, std::size_t bytes, int error) {
  throw FileError(folder,
                  fmt::format("{:.3g} GB for intermediate results cannot be had there: {}",
                              static_cast<double>(bytes) / 1e9, std::strerror(error)),
                  "Free some space, write the output to a larger disk, or ask for fewer pixels");
}

// Without a reservation, a full disk would end the program when it first uses a page.
int take_space(int file, std::size_t bytes) {
#ifdef __linux__
  return ::posix_fallocate(file, 0, static_cast<off_t>(bytes));
#else
  return ::ftruncate(file, static_cast<off_t>(bytes)) == 0 ? 0 : errno;
#endif
}

}  // namespace

ScratchMemory::ScratchMemory(const std::string& folder, std::size_t bytes) : bytes_(bytes) {
  std::string name = (folder.empty() ? "." : folder) + "/.semsurf-scratch-XXXXXX";
  const int file = ::mkstemp(name.data());
  if (file < 0) fail(folder, bytes, errno);
  ::unlink(name.c_str());
  int error = take_space(file, bytes);
  if (error == 0) {
    data_ = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (data_ == MAP_FAILED) error = errno;
  }
  ::close(file);
  if (error != 0) fail(folder, bytes, error);
}

ScratchMemory::~ScratchMemory() { ::munmap(data_, bytes_); }

void ScratchMemory::release() const { ::madvise(data_, bytes_, MADV_DONTNEED); }

}  // namespace surf
