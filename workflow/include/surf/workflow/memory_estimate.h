// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace surf::workflow {

/// Memory in bytes that a job takes at its peak, by purpose.
struct MemoryEstimate {
  std::size_t specimen = 0;  ///< triangles as read and as traced, once per machine
  /// Embree's structures while they are built, for all processes together.
  std::size_t ray_tracing = 0;
  std::size_t program = 0;  ///< the program without any specimen

  std::size_t total() const { return specimen + ray_tracing + program; }
};

/// How triangles are given: with shared corners, each with its own corners (STL), or as a grid.
enum class TriangleSource { mesh, soup, height_field };

struct TriangleCount {
  std::uint64_t triangles = 0;
  TriangleSource source = TriangleSource::mesh;
};

/// Counts the triangles of a mesh file by its header, or estimates them from the file's size if it
/// has none (OBJ, OFF, glTF ...). Returns nothing for a file that cannot be read.
std::optional<TriangleCount> triangles_in(const std::filesystem::path& mesh_file);

struct MemoryUse {
  int processes = 1;   ///< on this machine, >= 1
  int threads = 0;     ///< per process; 0: one per hardware thread
  bool shared = true;  ///< false: each process has a specimen of its own
};

/// Estimates the memory that grows with the number of triangles. Calibrated by
/// `bench/bench_large_specimen.py`, see docs/how-to/many_machines.md.
MemoryEstimate estimate_specimen(const TriangleCount& count, const MemoryUse& use = {});

struct MemoryThere {
  std::size_t bytes = 0;
  /// What limits it: "available on this machine", "left by the control group" ...
  std::string limit;
};

/// The memory that this process may still take: the least of the memory available on the machine,
/// the memory left by its control groups (versions 1 and 2), and its limit of address space.
/// SEMSURF_MEMORY, an amount such as "48GB" or "off" for no limit, replaces this value. Throws
/// UsageError if SEMSURF_MEMORY is not an amount.
MemoryThere memory_there();

/// Throws InvalidInput, naming `subject`, if the triangles would take more memory than there is.
void require_memory(const std::string& subject, const TriangleCount& count,
                    const MemoryUse& use = {});

}  // namespace surf::workflow
