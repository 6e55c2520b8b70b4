// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Reads packed cascades by the description of their format alone, and checks on the way that nodes
// fill their words, that what they say of their content is so, and that spheres hold it.

#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "surf/core/vec3.h"

namespace surf::test {

struct PackedElectron {
  std::vector<Vec3> points_nm;
  std::vector<int> energies;                  ///< as packed, without the bit for what is forgotten
  std::map<std::size_t, std::size_t> births;  ///< number of the point to that of the electron
  double unit_nm = 0;
  double blur_nm = 0;  ///< how far rounding may have moved its points
};

class CascadeReader {
 public:
  /// `cutoff_ev` and `top_ev` are what the packed energies 0 and 32767 stand for.
  CascadeReader(std::span<const std::uint64_t> words, double cutoff_ev, double top_ev,
                double barrier_ev)
      : words_(words), cutoff_ev_(cutoff_ev), top_ev_(top_ev), barrier_ev_(barrier_ev) {
    EXPECT_EQ(branch(0, {}, 0).end, words.size());
  }

  std::vector<PackedElectron> electrons;  ///< the primary first

  double energy_ev(int packed) const {
    const double share = packed / 32767.0;
    return cutoff_ev_ + share * share * (top_ev_ - cutoff_ev_);
  }

 private:
  struct Part {
    std::size_t end = 0;       // the word behind it
    std::vector<Vec3> points;  // all that lie in it
    std::uint64_t generated = 0;
    double generated_ev = 0;  // their energies above the barrier
  };

  static std::uint64_t bits(std::uint64_t word, int from, int count) {
    return word >> from & ((std::uint64_t{1} << count) - 1);
  }
  static Vec3 point(std::uint64_t word) {
    const auto coordinate = [word](int from) {
      return static_cast<double>(static_cast<std::int16_t>(bits(word, from, 16)));
    };
    return {coordinate(0), coordinate(16), coordinate(32)};
  }

  Part branch(std::size_t at, const Vec3& origin, double blur_nm) {
    const std::size_t number = electrons.size();
    PackedElectron electron;
    electron.unit_nm = std::ldexp(1.0, static_cast<std::int8_t>(bits(words_[at], 24, 8)));
    electron.blur_nm = blur_nm + 0.5 * std::sqrt(3.0) * electron.unit_nm;
    electrons.push_back(electron);
    EXPECT_EQ(point(words_[at + 2]), Vec3{});
    return node(at, number, origin);
  }

  Part node(std::size_t at, std::size_t electron, const Vec3& origin) {
    const std::uint64_t header = words_[at];
    const auto level = bits(header, 0, 8), count = bits(header, 8, 8), births = bits(header, 16, 8);
    const double unit = electrons[electron].unit_nm;
    EXPECT_EQ(std::ldexp(1.0, static_cast<std::int8_t>(bits(header, 24, 8))), unit);
    EXPECT_GE(count, 1u);
    EXPECT_LE(count, 8u);
    Part part;
    const auto keep = [&](std::uint64_t word) {
      electrons[electron].points_nm.push_back(origin + point(word) * unit);
      electrons[electron].energies.push_back(static_cast<int>(bits(word, 49, 15)));
      part.points.push_back(electrons[electron].points_nm.back());
    };
    const std::uint64_t start = words_[at + 2];
    std::size_t next = at + 3;
    std::vector<std::size_t> bearing;  // points
    if (electrons[electron].points_nm.empty()) keep(start);
    EXPECT_EQ(electrons[electron].points_nm.back(), origin + point(start) * unit);
    EXPECT_EQ(electrons[electron].energies.back(), static_cast<int>(bits(start, 49, 15)));
    part.points.assign(1, origin + point(start) * unit);
    for (std::size_t i = 0; level == 0 && i < count; ++i) {
      keep(words_[next++]);
      if (bits(births, static_cast<int>(i), 1))
        bearing.push_back(electrons[electron].points_nm.size() - 1);
    }
    const std::size_t children = level > 0 ? count : bearing.size();
    const std::size_t spheres = next, places = spheres + children;
    next = places + (children + 1) / 2;
    for (std::size_t i = 0; i < children; ++i) {
      EXPECT_EQ(bits(words_[places + i / 2], 32 * static_cast<int>(i % 2), 32), next - at);
      Part child;
      if (level > 0) {
        EXPECT_EQ(bits(words_[next], 0, 8), level - 1);
        child = node(next, electron, origin);
      } else {
        const std::size_t number = electrons.size();
        electrons[electron].births[bearing[i]] = number;
        child =
            branch(next, electrons[electron].points_nm[bearing[i]], electrons[electron].blur_nm);
        part.generated += 1;
        part.generated_ev += energy_ev(electrons[number].energies[0]) - barrier_ev_;
      }
      expect_inside(child, words_[spheres + i], origin, unit);
      part.points.insert(part.points.end(), child.points.begin(), child.points.end());
      part.generated += child.generated;
      part.generated_ev += child.generated_ev;
      next = child.end;
    }
    part.end = next;
    expect_content(part, at);
    return part;
  }

  static void expect_inside(const Part& part, std::uint64_t sphere, const Vec3& origin,
                            double unit) {
    const Vec3 center = origin + point(sphere) * unit;
    const double radius = static_cast<double>(bits(sphere, 48, 16)) * unit;
    for (const Vec3& p : part.points) EXPECT_LE(length(p - center), radius);
  }

  void expect_content(const Part& part, std::size_t at) const {
    EXPECT_EQ(bits(words_[at], 32, 32), part.generated);
    EXPECT_EQ(bits(words_[at + 1], 32, 32), part.end - at);
    const auto said = std::bit_cast<float>(static_cast<std::uint32_t>(bits(words_[at + 1], 0, 32)));
    // Energies were added before they were rounded.
    const double rounding = 1e-4 * (1 + part.generated_ev) + 0.01 * double(part.generated);
    EXPECT_NEAR(said, part.generated_ev, rounding);
  }

  std::span<const std::uint64_t> words_;
  double cutoff_ev_, top_ev_, barrier_ev_;
};

}  // namespace surf::test
