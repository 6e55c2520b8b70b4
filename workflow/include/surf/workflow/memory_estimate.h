// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace surf::workflow {

/// Memory that a job takes at its peak, by what it is for, bytes.
struct MemoryEstimate {
  std::size_t specimen = 0;     ///< triangles as read and as traced; once for each machine
  std::size_t ray_tracing = 0;  ///< Embree's structures while they are made; all processes together
  std::size_t program = 0;      ///< what it takes without any specimen

  std::size_t total() const { return specimen + ray_tracing + program; }
};

/// How triangles are told of: with shared corners, each with corners of its own (STL), as a grid.
enum class TriangleSource { mesh, soup, height_field };

struct TriangleCount {
  std::uint64_t triangles = 0;
  TriangleSource source = TriangleSource::mesh;
};

/// From a mesh file's header, or from its size where it has none (OBJ, OFF, glTF ...: about).
/// Nothing for a file that cannot be read.
std::optional<TriangleCount> triangles_in(const std::filesystem::path& mesh_file);

struct MemoryUse {
  int processes = 1;   ///< on this machine, >= 1:
  int threads = 0;     ///< of each; 0: one per hardware thread
  bool shared = true;  ///< else each of them has a specimen of its own
};

/// The parts that grow with triangles; calibrated by `bench/bench_large_specimen.py`, see
/// docs/many_machines.md.
MemoryEstimate estimate_specimen(const TriangleCount& count, const MemoryUse& use = {});

struct MemoryThere {
  std::size_t bytes = 0;
  std::string limit;  ///< what it is: "available on this machine", "left by the control group" ...
};

/// What this process may still take: the least of what the machine has available, what its control
/// groups (versions 1 and 2) leave, and its limit of address space. SEMSURF_MEMORY, an amount such
/// as "48GB" or "off" for no limit, stands in its place. Throws UsageError where that is no amount.
MemoryThere memory_there();

/// Throws InvalidInput, naming `subject`, where the triangles would take more than there is.
void require_memory(const std::string& subject, const TriangleCount& count,
                    const MemoryUse& use = {});

}  // namespace surf::workflow
