// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/memory_estimate.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>

#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/io/mesh_file.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

// Measured with the version of Embree in Debian 12, bytes per triangle.
constexpr double per_body = 58;   // 24 as read, 24 as traced + 6 in single precision, 4 for shells
constexpr double per_field = 46;  // a grid is smaller
// While STL is read: the file, the corners, the map of equal corners.
constexpr double per_soup = 165;
constexpr double per_built_tree = 100;  // Embree's tree while it is built; half of this remains
// Distance bounds, while they are computed.
constexpr double per_faces = 48, per_faces_and_thread = 4;
constexpr std::size_t program_bytes = std::size_t{180} << 20;
constexpr double share_to_take = 0.97;  // share of the available memory
constexpr std::uint64_t few_triangles = 100000;

constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

std::optional<std::uint64_t> number_after(std::string_view text, std::string_view word) {
  const std::size_t at = text.find(word);
  if (at == std::string_view::npos) return {};
  std::size_t begin = at + word.size();
  while (begin < text.size() && text[begin] == ' ') ++begin;
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data() + begin, text.data() + text.size(), value);
  if (error != std::errc() || end == text.data() + begin) return {};
  return value;
}

std::string text_of(const fs::path& path, std::size_t most = 65536) {
  std::ifstream in(path, std::ios::binary);
  std::string text(most, '\0');
  in.read(text.data(), static_cast<std::streamsize>(most));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

std::optional<std::size_t> amount(const fs::path& path) {
  const std::string text = text_of(path, 64);
  return number_after(text, "");  // "max" is none
}

// Finds the least memory that this group and the groups above it leave. The path may have more
// parts than the visible tree, if only a part of the tree is mounted.
void ask_groups(const fs::path& root, std::string group, const char* limit, const char* used,
                const char* cache, std::size_t& least) {
  for (;;) {
    const fs::path folder = root / fs::path(group).relative_path();
    const auto most = amount(folder / limit), taken = amount(folder / used);
    if (most && taken && *most < (std::size_t{1} << 60)) {
      const auto file_cache = number_after(text_of(folder / "memory.stat"), cache);
      const std::size_t held =
          *taken - std::min(*taken, static_cast<std::size_t>(file_cache.value_or(0)));
      least = std::min(least, *most - std::min(*most, held));
    }
    if (group.size() < 2) return;
    group = fs::path(group).parent_path().string();
  }
}

std::size_t left_by_groups() {
  std::size_t least = no_limit;
  std::istringstream groups(text_of("/proc/self/cgroup"));
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string kind = line.substr(first + 1, second - first - 1),
                      group = line.substr(second + 1);
    if (kind.empty())
      ask_groups("/sys/fs/cgroup", group, "memory.max", "memory.current", "inactive_file", least);
    else if (("," + kind + ",").find(",memory,") != std::string::npos)
      ask_groups("/sys/fs/cgroup/memory", group, "memory.limit_in_bytes", "memory.usage_in_bytes",
                 "total_inactive_file", least);
  }
  return least;
}

std::size_t left_of_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return no_limit;
  const auto used = number_after(text_of("/proc/self/status"), "VmSize:\t");
  const std::size_t taken = used.value_or(0) * 1024;
  return limit.rlim_cur - std::min<std::size_t>(limit.rlim_cur, taken);
}

std::size_t asked_for(const char* text) {
  const std::string_view all(text);
  if (all == "off") return no_limit;
  double value = 0;
  const auto [end, error] = std::from_chars(all.data(), all.data() + all.size(), value);
  const std::string_view unit = all.substr(static_cast<std::size_t>(end - all.data()));
  const double factor = unit == "GB"    ? 1e9
                        : unit == "GiB" ? 1073741824.0
                        : unit == "MB"  ? 1e6
                        : unit.empty()  ? 1
                                        : 0;
  if (error != std::errc() || !(value > 0) || !(value * factor > 0) || !(value * factor < 1e18))
    throw UsageError("SEMSURF_MEMORY", fmt::format("'{}' is no amount of memory", all),
                     "Write for example 48GB, or off for no limit");
  return static_cast<std::size_t>(value * factor);
}

std::size_t bytes(double triangles, double each) {
  return static_cast<std::size_t>(triangles * each);
}

}  // namespace

std::optional<TriangleCount> triangles_in(const fs::path& path) {
  std::error_code error;
  double size = 0;
  for (const fs::path& part :
       io::mesh_input_files(path)) {  // some formats have their triangles in other files
    const auto bytes = fs::file_size(part, error);
    if (error) return {};
    size += static_cast<double>(bytes);
  }
  const std::string head = text_of(path);
  if (head.empty()) return {};
  const auto about = [&](double bytes_each, TriangleSource source) {
    return TriangleCount{static_cast<std::uint64_t>(size / bytes_each), source};
  };
  if (head.starts_with("ply")) {
    const auto faces = number_after(head, "element face");
    // No face takes less than four bytes in a file.
    return TriangleCount{
        static_cast<std::uint64_t>(std::min<double>(double(faces.value_or(0)), size / 4))};
  }
  if (head.size() > 84) {
    std::uint32_t facets = 0;
    std::memcpy(&facets, head.data() + 80, sizeof facets);  // little-endian, like this machine
    if (size == 84 + 50.0 * facets) return TriangleCount{facets, TriangleSource::soup};
  }
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".stl" || head.find("facet normal") != std::string::npos)
    return about(260, TriangleSource::soup);
  if (extension == ".obj" || extension == ".off") return about(38, TriangleSource::mesh);
  if (extension == ".vtp" || extension == ".vtm") return about(30, TriangleSource::mesh);
  if (extension == ".3mf") return about(8, TriangleSource::mesh);  // compressed
  return about(18, TriangleSource::mesh);                          // glTF
}

MemoryEstimate estimate_specimen(const TriangleCount& count, const MemoryUse& use) {
  const auto n = static_cast<double>(count.triangles);
  MemoryEstimate out;
  out.program = program_bytes * static_cast<std::size_t>(use.processes);
  out.specimen = bytes(n, count.source == TriangleSource::height_field ? per_field : per_body);
  const double faces = per_faces + per_faces_and_thread * resolve_threads(use.threads);
  out.ray_tracing = bytes(n, std::max(per_built_tree, faces) * use.processes);
  if (count.source == TriangleSource::soup)
    out.specimen =
        std::max(out.specimen, bytes(n, per_soup) - std::min(bytes(n, per_soup), out.ray_tracing));
  if (!use.shared) out.specimen *= static_cast<std::size_t>(use.processes);
  return out;
}

MemoryThere memory_there() {
  if (const char* asked = std::getenv("SEMSURF_MEMORY"))
    return {asked_for(asked), "there by SEMSURF_MEMORY"};
  MemoryThere there{no_limit, ""};
  const auto limit = [&](std::size_t bytes, const char* what) {
    if (bytes < there.bytes) there = {bytes, what};
  };
  if (const auto kb = number_after(text_of("/proc/meminfo"), "MemAvailable:"))
    limit(static_cast<std::size_t>(*kb) * 1024, "available on this machine");
  limit(left_by_groups(), "left by the control group (container or job)");
  limit(left_of_address_space(), "left by the limit of address space (ulimit -v)");
  return there;
}

void require_memory(const std::string& subject, const TriangleCount& count, const MemoryUse& use) {
  const auto needed = static_cast<double>(estimate_specimen(count, use).total());
  const MemoryThere there = memory_there();
  if (there.bytes == no_limit || needed <= share_to_take * static_cast<double>(there.bytes)) return;
  // The program itself takes most of the memory.
  const bool small = count.triangles < few_triangles;
  const std::string triangles =
      small ? std::string("this mesh and the program")
            : fmt::format("{:.3g} million triangles", double(count.triangles) / 1e6);
  const double left_gb = double(there.bytes) / 1e9;
  throw InvalidInput(
      subject,
      fmt::format("{} need about {:.2f} GB of memory{}, and {} {}", triangles, needed / 1e9,
                  use.processes > 1 ? fmt::format(" for {} processes", use.processes) : "",
                  left_gb < 0.01 ? "less than 0.01 GB is" : fmt::format("{:.2f} GB are", left_gb),
                  there.limit),
      fmt::format("{}{}; SEMSURF_MEMORY=off tries nevertheless",
                  small ? "Make more memory available"
                        : "Crop the mesh or simplify it where there is more memory (semsurf mesh "
                          "--mesh-tolerance)",
                  use.processes > 1 ? ", or start one process for each machine" : ""));
}

}  // namespace surf::workflow
