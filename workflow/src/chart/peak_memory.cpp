// SPDX-License-Identifier: GPL-3.0-or-later
#include "peak_memory.h"

#include <algorithm>
#include <fstream>
#include <string>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace surf::workflow {
namespace {

double status(const std::string& key) {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);)
    if (line.compare(0, key.size(), key) == 0) return 1024 * std::stod(line.substr(key.size()));
  return 0;
}

}  // namespace

PeakMemory::PeakMemory() {
#if defined(__GLIBC__)
  malloc_trim(0);  // freed memory that is still held would hide new allocations
#endif
  std::ofstream reset("/proc/self/clear_refs");
  known_ = static_cast<bool>(reset << "5" << std::flush);  // resets the peak to the present value
  before_ = status("VmRSS:");
}

double PeakMemory::bytes() const { return known_ ? std::max(0.0, status("VmHWM:") - before_) : 0; }

}  // namespace surf::workflow
