// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace surf::mc {

/// Changes whenever the packing or the transport's use of random numbers does.
inline constexpr int cascade_format_version = 2;

// How a cascade is packed, in words of 8 bytes.
//
//   branch    one electron with all that it generates: a node
//   node      header (3 words), then
//               level 0:  a vertex per segment; then a sphere per birth, the place of each birth's
//                         branch, and the branches
//               above:    a sphere per node below, the place of each, and the nodes
//
// A sphere holds everything in a node or branch, secondaries and theirs included. It is kept with
// the parent, so that what is far from every surface is passed over without being looked at. Places
// are in words from the parent's header, two to a word. Coordinates count from the electron's first
// point, in units of 2^exponent nm.

/// A point of a track, the energy there and what it forgets (see EnergyCode).
struct PackedVertex {
  std::int16_t x, y, z;
  std::uint16_t energy;
};

struct PackedSphere {
  std::int16_t x, y, z;
  std::uint16_t radius;
};

struct PackedNode {
  std::uint8_t level;   ///< 0: holds segments
  std::uint8_t count;   ///< of segments on level 0, of nodes above: 1 to 8
  std::uint8_t births;  ///< level 0: bit i: a secondary starts at the end of segment i
  std::int8_t exponent;
  std::uint32_t generated;  ///< secondaries in the node, theirs included
  float generated_ev;       ///< their total energies
  std::uint32_t words;      ///< of the node with all that is in it
  PackedVertex start;       ///< where its first segment starts
};
static_assert(offsetof(PackedNode, start) ==
              sizeof(PackedNode) - sizeof(PackedVertex));  // the vertices follow
static_assert(sizeof(PackedVertex) == 8 && sizeof(PackedSphere) == 8 && sizeof(PackedNode) == 24);

inline constexpr int segments_per_node = 8;
inline constexpr int nodes_per_node = 8;
inline constexpr std::size_t header_words = sizeof(PackedNode) / 8;

inline PackedNode read_node(const std::uint64_t* at) {
  PackedNode node;
  std::memcpy(&node, at, sizeof node);
  return node;
}

inline PackedVertex read_vertex(const std::uint64_t* at) {
  return std::bit_cast<PackedVertex>(*at);
}

/// How many of eight bits are set. Processors count them, but not those that every build has to run
/// on.
inline int bits_in(unsigned eight) {
  static constexpr auto counts = [] {
    std::array<std::uint8_t, 256> table{};
    for (std::size_t i = 1; i < table.size(); ++i)
      table[i] = static_cast<std::uint8_t>(table[i / 2] + i % 2);
    return table;
  }();
  return counts[eight];
}

/// The parts of a node.
struct NodeView {
  explicit NodeView(const std::uint64_t* at) : begin(at), node(read_node(at)) {}

  int children() const { return node.level > 0 ? node.count : bits_in(node.births); }
  /// Where its first segment starts, and the vertices: one after another.
  const std::uint64_t* points() const { return begin + header_words - 1; }
  const std::uint64_t* vertex(int i) const { return begin + header_words + i; }
  const std::uint64_t* spheres() const {
    return begin + header_words + (node.level > 0 ? 0 : node.count);
  }
  const std::uint64_t* child(int i) const {
    std::uint32_t place;
    std::memcpy(&place, reinterpret_cast<const unsigned char*>(spheres() + children()) + 4 * i,
                sizeof place);
    return begin + place;
  }

  const std::uint64_t* begin;
  PackedNode node;
};

/// 2^exponent.
inline float power_of_two(int exponent) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(127 + exponent) << 23);
}

/// Energies are packed as the root of what they are above the cutoff: fine where they are small.
/// The lowest bit says that the electron was scattered into all directions alike: what comes after
/// does not remember the direction before.
class EnergyCode {
 public:
  EnergyCode(double cutoff_ev, double top_ev)
      : cutoff_ev_(cutoff_ev), per_square_((top_ev - cutoff_ev) / (32767.0 * 32767.0)),
        squares_per_ev_(1.0 / per_square_) {}

  double decode(std::uint16_t code) const {
    const double c = code >> 1;
    return cutoff_ev_ + c * c * per_square_;
  }
  std::uint16_t encode(double energy_ev, bool forgets) const {
    const double c = std::sqrt(std::max(energy_ev - cutoff_ev_, 0.0) * squares_per_ev_);
    const auto code = static_cast<unsigned>(std::min(c + 0.5, 32767.0));
    return static_cast<std::uint16_t>(code << 1 | (forgets ? 1u : 0u));
  }
  /// Falls with the energy, whatever is forgotten.
  static std::uint16_t energy_part(std::uint16_t code) {
    return static_cast<std::uint16_t>(code >> 1);
  }
  static bool forgets(std::uint64_t vertex) { return (vertex >> 48 & 1) != 0; }

 private:
  double cutoff_ev_;
  double per_square_;
  double squares_per_ev_;
};

}  // namespace surf::mc
