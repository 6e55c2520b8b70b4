// SPDX-License-Identifier: GPL-3.0-or-later
// Targets that read scans.
#include <algorithm>

#include "memory_files.h"
#include "surf/io/height_field_file.h"
#include "target_lists.h"

namespace surf::test {
namespace {

/// Every channel as heights, up to eight.
Accepted read_scan_as(const char* path, const std::string& content) {
  put_memory_file(path, content);
  const io::HeightFile file(path);
  constexpr std::size_t most = 8;
  const std::size_t channels = std::min(file.channels().size(), most);
  Accepted accepted;
  for (std::size_t i = 1; i <= channels; ++i)
    accepted.fields.push_back(file.read({std::to_string(i), 2.0, {}, {}}).field);
  return accepted;
}

template <const char* Path>
Accepted scan(const std::string& content) {
  return read_scan_as(Path, content);
}

constexpr char gwy[] = "input.gwy", gsf[] = "input.gsf", spm[] = "input.spm", ibw[] = "input.ibw",
               nid[] = "input.nid", sxm[] = "input.sxm", stp[] = "input.stp", jpk[] = "input.jpk",
               park[] = "input.tiff", txt[] = "input.txt", xyz[] = "input.xyz";

}  // namespace

std::vector<FuzzTarget> scan_targets() {
  return {{"gwy", scan<gwy>, mutate_gwy},       {"gsf", scan<gsf>, mutate_gsf},
          {"spm", scan<spm>, mutate_nanoscope}, {"ibw", scan<ibw>, mutate_ibw},
          {"nid", scan<nid>, mutate_nid},       {"sxm", scan<sxm>, mutate_sxm},
          {"stp", scan<stp>, mutate_wsxm},      {"jpk", scan<jpk>, mutate_numbers},
          {"park", scan<park>, mutate_numbers}, {"txt", scan<txt>, mutate_text},
          {"xyz", scan<xyz>, mutate_text}};
}

}  // namespace surf::test
