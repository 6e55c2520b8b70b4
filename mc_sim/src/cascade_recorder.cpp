// SPDX-License-Identifier: GPL-3.0-or-later
#include "cascade_recorder.h"

#include <algorithm>
#include <cmath>

namespace surf::mc {

namespace {

constexpr double largest_coordinate = 32000;   // leaves room for the rounding of those before
constexpr int finest_exponent = -16;           // 1.5e-5 nm

std::size_t segments_of_level(int level) {
  std::size_t n = segments_per_node;
  for (int i = 0; i < level; ++i) n *= nodes_per_node;
  return n;
}

}  // namespace

// An electron on its way into words.
struct CascadeRecorder::Branch {
  const Electron& electron;
  Vec3 origin;              // its first point, as it will be unpacked
  int exponent;
  std::size_t births_left;

  std::size_t segments() const { return electron.points.size() - 1; }

  PackedVertex vertex(std::size_t i, const EnergyCode& code) const {
    const Vec3 p = (electron.points[i] - electron.points[0]) * (1.0 / double(power_of_two(exponent)));
    const auto round = [](double v) { return static_cast<std::int16_t>(std::lround(v)); };
    return {round(p.x), round(p.y), round(p.z),
            code.encode(electron.energies[i], electron.forgets[i] != 0)};
  }
  Vec3 unpack(const PackedVertex& v) const {
    return origin + Vec3{double(v.x), double(v.y), double(v.z)} * double(power_of_two(exponent));
  }
};

void CascadeRecorder::begin_track(int number, int parent, int, const Vec3& position, const Vec3&,
                                  double energy_ev) {
  const auto n = static_cast<std::size_t>(number);
  if (electrons_.size() <= n) electrons_.resize(n + 1);
  count_ = n + 1;
  Electron& electron = electrons_[n];
  electron.points.assign(1, position);
  electron.energies.assign(1, energy_ev);
  electron.forgets.assign(1, 0);
  electron.births.clear();
  if (parent < 0) return;
  // Electrons that wait are followed last in, first out: of one parent's, the latest comes first.
  Electron& from = electrons_[static_cast<std::size_t>(parent)];
  if (from.births.empty()) from.unborn = from.points.size();
  while (!(from.points[--from.unborn] == position)) {}
  from.births.push_back({from.unborn, n});
}

void CascadeRecorder::segment(const Vec3&, const Vec3& to, double, double energy_to_ev, int) {
  Electron& electron = electrons_[count_ - 1];
  electron.points.push_back(to);
  electron.energies.push_back(energy_to_ev);
  electron.forgets.push_back(0);
}

void CascadeRecorder::finish(std::vector<std::uint64_t>& words) {
  for (std::size_t i = count_; i-- > 0;) {   // children come after their parents
    Electron& electron = electrons_[i];
    electron.box = {};
    for (const Vec3& p : electron.points) electron.box.extend(p);
    for (const Birth& birth : electron.births) electron.box.extend(electrons_[birth.electron].box);
  }
  unpacked_.clear();
  if (count_ > 0) pack_branch(electrons_[0], electrons_[0].points[0], words);
  count_ = 0;
}

CascadeRecorder::Packed CascadeRecorder::pack_branch(const Electron& electron, const Vec3& origin,
                                                     std::vector<std::uint64_t>& words) {
  const Vec3 a = electron.points[0] - electron.box.lower_nm;
  const Vec3 b = electron.box.upper_nm - electron.points[0];
  const double extent = std::max({a.x, a.y, a.z, b.x, b.y, b.z});
  const int exponent = extent > 0 ? static_cast<int>(std::ceil(std::log2(extent / largest_coordinate)))
                                  : finest_exponent;
  Branch branch{electron, origin, std::max(exponent, finest_exponent), electron.births.size()};
  int level = 0;
  while (segments_of_level(level) < branch.segments()) ++level;
  return pack_node(branch, 0, level, words);
}

CascadeRecorder::Packed CascadeRecorder::pack_node(Branch& branch, std::size_t first, int level,
                                                   std::vector<std::uint64_t>& words) {
  Packed packed{words.size(), unpacked_.size(), 0, {}};
  const std::size_t end = std::min(first + segments_of_level(level), branch.segments());
  PackedNode node{};
  node.level = static_cast<std::uint8_t>(level);
  node.exponent = static_cast<std::int8_t>(branch.exponent);
  node.start = branch.vertex(first, code_);
  words.resize(packed.word + header_words);

  std::size_t children = 0;
  if (level == 0) {
    node.count = static_cast<std::uint8_t>(end - first);
    unpacked_.push_back(branch.unpack(node.start));
    for (std::size_t i = first; i < end; ++i) {
      const PackedVertex v = branch.vertex(i + 1, code_);
      words.push_back(std::bit_cast<std::uint64_t>(v));
      unpacked_.push_back(branch.unpack(v));
    }
    while (children < branch.births_left &&
           branch.electron.births[branch.births_left - 1 - children].vertex <= end)
      ++children;
  } else {
    const std::size_t step = segments_of_level(level - 1);
    children = (end - first + step - 1) / step;
    node.count = static_cast<std::uint8_t>(children);
  }
  const std::size_t spheres = words.size(), places = spheres + children;
  words.resize(places + (children + 1) / 2);

  for (std::size_t i = 0; i < children; ++i) {
    Packed child;
    if (level == 0) {
      const Birth& birth = branch.electron.births[--branch.births_left];
      node.births = static_cast<std::uint8_t>(node.births | 1u << (birth.vertex - 1 - first));
      const Electron& electron = electrons_[birth.electron];
      child = pack_branch(electron, branch.unpack(branch.vertex(birth.vertex, code_)), words);
      packed.content += {1, electron.energies[0] - barrier_ev_};
    } else {
      child = pack_node(branch, first + i * segments_of_level(level - 1), level - 1, words);
    }
    packed.content += child.content;
    words[spheres + i] = std::bit_cast<std::uint64_t>(enclose(branch, child));
    const auto place = static_cast<std::uint32_t>(child.word - packed.word);
    std::memcpy(reinterpret_cast<unsigned char*>(&words[places]) + 4 * i, &place, sizeof place);
  }

  packed.end_point = unpacked_.size();
  node.words = static_cast<std::uint32_t>(words.size() - packed.word);
  node.generated = packed.content.generated;
  node.generated_ev = static_cast<float>(packed.content.generated_ev);
  std::memcpy(&words[packed.word], &node, sizeof node);
  return packed;
}

// The sphere about the box of all points, in the branch's units, rounded outward.
PackedSphere CascadeRecorder::enclose(const Branch& branch, const Packed& packed) const {
  Box box;
  for (std::size_t i = packed.first_point; i < packed.end_point; ++i) box.extend(unpacked_[i]);
  const double unit = power_of_two(branch.exponent);
  const Vec3 center = (box.center_nm() - branch.origin) * (1.0 / unit);
  const Vec3 c{std::round(center.x), std::round(center.y), std::round(center.z)};
  const Vec3 rounded = branch.origin + c * unit;
  double squared = 0;
  for (std::size_t i = packed.first_point; i < packed.end_point; ++i) {
    const Vec3 d = unpacked_[i] - rounded;
    squared = std::max(squared, dot(d, d));
  }
  return {static_cast<std::int16_t>(c.x), static_cast<std::int16_t>(c.y),
          static_cast<std::int16_t>(c.z),
          static_cast<std::uint16_t>(std::ceil(std::sqrt(squared) / unit + 0.5))};
}

}  // namespace surf::mc
