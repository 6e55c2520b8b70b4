// SPDX-License-Identifier: GPL-3.0-or-later
#include "cascades/cascade_recorder.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace surf::mc {

namespace {

constexpr int largest_coordinate = 32000;  // leaves room for the rounding of those before
constexpr int finest_exponent = -16;       // 1.5e-5 nm

std::size_t segments_of_level(int level) {
  std::size_t n = segments_per_node;
  for (int i = 0; i < level; ++i) n *= nodes_per_node;
  return n;
}

// The nearest whole number to -32768 <= v < 32767.
double nearest(double v) {
  constexpr int positive = 1 << 15;
  return static_cast<int>(v + (positive + 0.5)) - positive;
}
Vec3 nearest(const Vec3& v) { return {nearest(v.x), nearest(v.y), nearest(v.z)}; }

// The smallest exponent of units of which no more than largest_coordinate reach that far.
int exponent_for(double extent_nm) {
  constexpr int mantissa_bits = 52, bias = 1023;
  const auto bits = std::bit_cast<std::uint64_t>(extent_nm * (1.0 / largest_coordinate));
  constexpr std::uint64_t mantissa = (std::uint64_t{1} << mantissa_bits) - 1;
  const int exponent = static_cast<int>((bits + mantissa) >> mantissa_bits) - bias;
  return std::max(exponent, finest_exponent);
}

}  // namespace

// An electron on its way into words.
struct CascadeRecorder::Branch {
  std::size_t first, end;  // of its points
  Vec3 origin;             // its first point, as it will be unpacked
  double unit_nm;
  int exponent;
  int next_birth;  // the electron that is born next

  std::size_t segments() const { return end - first - 1; }
};

void CascadeRecorder::begin_track(int number, int parent, int, const Vec3& position, const Vec3&,
                                  double energy_ev) {
  if (!electrons_.empty()) electrons_.back().end = points_.size();
  std::size_t birth = 0;
  int next = -1;
  if (parent >= 0) {
    // Electrons that wait are followed last in, first out: of one parent's, the latest comes first.
    Electron& from = electrons_[static_cast<std::size_t>(parent)];
    if (from.first_child < 0) from.unborn = from.end;
    while (!(points_[--from.unborn].position == position)) {
    }
    birth = from.unborn - from.first;
    next = from.first_child;
    from.first_child = number;
  }
  electrons_.push_back({points_.size(), 0, 0, birth, parent, -1, next, {}});
  points_.push_back({position, energy_ev, false});
}

void CascadeRecorder::finish(std::vector<std::uint64_t>& words) {
  if (electrons_.empty()) return;
  electrons_.back().end = points_.size();
  measure();
  vertices_.resize(points_.size());
  pack_branch(electrons_[0], points_[0].position, words);
  electrons_.clear();
  points_.clear();
  bounds_.clear();
}

void CascadeRecorder::measure() {
  for (std::size_t i = electrons_.size(); i-- > 0;) {  // children come after their parents
    Electron& electron = electrons_[i];
    Box box = electron.box;
    for (std::size_t k = electron.first; k < electron.end; ++k) box.extend(points_[k].position);
    electron.box = box;
    if (electron.parent >= 0) electrons_[static_cast<std::size_t>(electron.parent)].box.extend(box);
  }
}

CascadeRecorder::Packed CascadeRecorder::pack_branch(const Electron& electron, const Vec3& origin,
                                                     std::vector<std::uint64_t>& words) {
  const Vec3 start = points_[electron.first].position;
  const Vec3 a = start - electron.box.lower_nm;
  const Vec3 b = electron.box.upper_nm - start;
  const int exponent = exponent_for(std::max({a.x, a.y, a.z, b.x, b.y, b.z}));
  Branch branch{electron.first,         electron.end, origin,
                power_of_two(exponent), exponent,     electron.first_child};
  const double per_nm = power_of_two(-exponent);
  for (std::size_t i = electron.first; i < electron.end; ++i) {
    Point& p = points_[i];
    const Vec3 v = nearest((p.position - start) * per_nm);
    vertices_[i] = {static_cast<std::int16_t>(v.x), static_cast<std::int16_t>(v.y),
                    static_cast<std::int16_t>(v.z), code_.encode(p.energy_ev, p.forgets)};
    p.position = origin + v * branch.unit_nm;
  }
  int level = 0;
  while (segments_of_level(level) < branch.segments()) ++level;
  return pack_node(branch, 0, level, words);
}

CascadeRecorder::Packed CascadeRecorder::pack_node(Branch& branch, std::size_t first, int level,
                                                   std::vector<std::uint64_t>& words) {
  Packed packed{words.size(), bounds_.size(), {}, {}};
  const std::size_t end = std::min(first + segments_of_level(level), branch.segments());
  const std::size_t start = branch.first + first;
  PackedNode node{};
  node.level = static_cast<std::uint8_t>(level);
  node.exponent = static_cast<std::int8_t>(branch.exponent);
  node.start = vertices_[start];
  bounds_.push_back({{}, 0, start, level > 0 ? start : branch.first + end + 1, 0});

  std::size_t children = 0, own = 0;
  if (level == 0) {
    own = end - first;
    node.count = static_cast<std::uint8_t>(own);
    for (std::size_t i = start; i <= start + own; ++i) packed.box.extend(points_[i].position);
    for (int i = branch.next_birth; i >= 0;) {
      const Electron& electron = electrons_[static_cast<std::size_t>(i)];
      if (electron.birth > end) break;
      node.births = static_cast<std::uint8_t>(node.births | 1u << (electron.birth - 1 - first));
      ++children;
      i = electron.next;
    }
  } else {
    const std::size_t step = segments_of_level(level - 1);
    children = (end - first + step - 1) / step;
    node.count = static_cast<std::uint8_t>(children);
  }
  const std::size_t spheres = packed.word + header_words + own, places = spheres + children;
  words.resize(places + (children + 1) / 2);
  if (own > 0)
    std::memcpy(&words[packed.word + header_words], &vertices_[start + 1],
                own * sizeof(PackedVertex));

  for (std::size_t i = 0; i < children; ++i) {
    Packed child;
    if (level == 0) {
      const Electron& electron = electrons_[static_cast<std::size_t>(branch.next_birth)];
      branch.next_birth = electron.next;
      packed.content += {1, paid_ ? 0 : points_[electron.first].energy_ev - barrier_ev_};
      child = pack_branch(electron, points_[branch.first + electron.birth].position, words);
    } else {
      child = pack_node(branch, first + i * segments_of_level(level - 1), level - 1, words);
    }
    packed.box.extend(child.box);
    packed.content += child.content;
    words[spheres + i] = std::bit_cast<std::uint64_t>(enclose(branch, child));
    const auto place = static_cast<std::uint32_t>(child.word - packed.word);
    std::memcpy(reinterpret_cast<unsigned char*>(&words[places]) + 4 * i, &place, sizeof place);
  }

  bounds_[packed.bound].end = bounds_.size();
  node.words = static_cast<std::uint32_t>(words.size() - packed.word);
  node.generated = packed.content.generated;
  node.generated_ev = static_cast<float>(packed.content.generated_ev);
  std::memcpy(&words[packed.word], &node, sizeof node);
  return packed;
}

// The sphere about the middle of the box of all points, in the branch's units, rounded outward.
PackedSphere CascadeRecorder::enclose(const Branch& branch, const Packed& packed) {
  const Vec3 c = nearest((packed.box.center_nm() - branch.origin) * (1.0 / branch.unit_nm));
  Bound& bound = bounds_[packed.bound];
  bound.center = branch.origin + c * branch.unit_nm;
  bound.radius_nm = farthest(bound.center, packed.bound);
  return {static_cast<std::int16_t>(c.x), static_cast<std::int16_t>(c.y),
          static_cast<std::int16_t>(c.z),
          static_cast<std::uint16_t>(std::ceil(bound.radius_nm / branch.unit_nm + 0.5))};
}

// The distance to the farthest point of what `bound` stands for. What is in it has spheres already:
// those that do not reach beyond the farthest point so far are passed over.
double CascadeRecorder::farthest(const Vec3& center, std::size_t bound) const {
  double squared = 0, distance = 0;
  const std::size_t end = bounds_[bound].end;
  for (std::size_t i = bound; i < end;) {
    const Bound& b = bounds_[i];
    if (i > bound && distance > b.radius_nm) {
      const Vec3 d = b.center - center;
      const double room = distance - b.radius_nm;
      if (dot(d, d) <= room * room) {
        i = b.end;
        continue;
      }
    }
    for (std::size_t k = b.first_point; k < b.end_point; ++k) {
      const Vec3 d = points_[k].position - center;
      squared = std::max(squared, dot(d, d));
    }
    distance = std::sqrt(squared);
    ++i;
  }
  return distance;
}

}  // namespace surf::mc
