// SPDX-License-Identifier: GPL-3.0-or-later
// The definition of blind tip reconstruction, word by word, beside the quick one: the same to the
// last bit on every instruction set, with as many points tried in as many rounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "surf/afm/blind_tip.h"
#include "surf/afm/height_range.h"
#include "surf/afm/noise.h"
#include "surf/core/random.h"
#include "vector_targets.h"

namespace surf {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr std::size_t batch = 1024;  // points that see the same tip

struct Point {
  std::size_t scan;
  int x, y;
  float misfit;
};

class Definition {
 public:
  Definition(const std::vector<HeightField>& scans, const BlindTipOptions& o)
      : o_(o), tip_(o.width, o.height), threshold_(o.width, o.height) {
    const HeightRange range = height_range(scans);
    const float slack = static_cast<float>(0x1p-20 * range.span_nm());
    tolerance_ = static_cast<float>(o.apex_tolerance_nm) + slack;
    for (const HeightField& s : scans) {
      Grid<float>& z = scans_.emplace_back(s.z_nm.width(), s.z_nm.height(), NAN);
      for (int y = 0; y < z.height(); ++y)
        for (int x = 0; x < z.width(); ++x)
          if (s.is_valid(x, y))
            z(x, y) = static_cast<float>(s.z_nm(x, y) - 0.5 * (range.low_nm + range.high_nm));
      tried_.emplace_back(z.width(), z.height());
    }
    const double t = o.threshold_nm, across = o.threshold_y_nm.value_or(t);
    for (int j = 0; j < o.height; ++j)
      for (int i = 0; i < o.width; ++i) {
        const double dx = i - o.width / 2, dy = j - o.height / 2, r = std::hypot(dx, dy);
        threshold_(i, j) =
            static_cast<float>(slack + (r > 0 ? std::hypot(t * dx / r, across * dy / r) : t));
        tip_(i, j) = o.start ? static_cast<float>(o.start->z_nm(i, j)) : 0;
      }
  }

  BlindTip run() {
    std::vector<Point> maxima = points(true);
    while (carve(maxima)) ++out_.summary.rounds;
    for (bool changed = !o_.maxima_only; changed; ++out_.summary.rounds)
      changed = carve(points(false));
    out_.tip.z_nm = Grid<double>(o_.width, o_.height);
    for (int j = 0; j < o_.height; ++j)
      for (int i = 0; i < o_.width; ++i) out_.tip.z_nm(i, j) = std::min(0.0f, tip_(i, j));
    out_.tip.z_nm(o_.width / 2, o_.height / 2) = 0;
    return out_;
  }

 private:
  float top(std::size_t s, int x, int y) const {
    const Grid<float>& z = scans_[s];
    const bool there = x >= 0 && y >= 0 && x < z.width() && y < z.height() && !std::isnan(z(x, y));
    return there ? z(x, y) + static_cast<float>(o_.layer_nm) : infinity;
  }
  float bottom(std::size_t s, int x, int y) const {
    const float z = scans_[s](x, y);
    return std::isnan(z) ? -infinity : z - static_cast<float>(o_.layer_nm);
  }

  // Calls work(i, j, dx, dy) for each sample of the tip, at (dx, dy) from the apex.
  template <class Work>
  void each_sample(const Work& work) const {
    for (int j = 0; j < o_.height; ++j)
      for (int i = 0; i < o_.width; ++i) work(i, j, i - o_.width / 2, j - o_.height / 2);
  }

  Grid<float> opening(std::size_t s) const {
    const int w = scans_[s].width(), h = scans_[s].height(), mx = o_.width, my = o_.height;
    Grid<float> apex(w + 2 * mx, h + 2 * my, infinity), out(w, h, -infinity);
    for (int y = -my; y < h + my; ++y)
      for (int x = -mx; x < w + mx; ++x)
        each_sample([&](int i, int j, int dx, int dy) {
          float& z = apex(x + mx, y + my);
          z = std::min(z, top(s, x + dx, y + dy) + (threshold_(i, j) - tip_(i, j)));
        });
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x)
        each_sample([&](int i, int j, int dx, int dy) {
          out(x, y) = std::max(out(x, y), apex(x - dx + mx, y - dy + my) + tip_(i, j));
        });
    return out;
  }

  static bool is_maximum(const Grid<float>& z, int x, int y) {
    int lower = 0;
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) {
        if (!(z(x + i, y + j) <= z(x, y))) return false;
        lower += z(x + i, y + j) < z(x, y);
      }
    return lower >= 2;
  }

  std::vector<Point> points(bool maxima) const {
    std::vector<Point> out;
    for (std::size_t s = 0; s < scans_.size(); ++s) {
      const int dx = o_.border ? 1 : o_.width - 1, dy = o_.border ? 1 : o_.height - 1;
      const Grid<float> made = opening(s);
      for (int y = dy; y < made.height() - dy; ++y)
        for (int x = dx; x < made.width() - dx; ++x) {
          const float z = bottom(s, x, y);
          if (z == -infinity || tried_[s](x, y) == version_ || !(made(x, y) < z)) continue;
          if (!maxima || is_maximum(scans_[s], x, y))
            out.push_back({s, x, y, maxima ? z : z - made(x, y)});
        }
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Point& a, const Point& b) { return a.misfit > b.misfit; });
    return out;
  }

  // What any contact with the point allows each sample.
  Grid<float> allowed_by(const Point& p) const {
    Grid<float> allowed(o_.width, o_.height, -infinity);
    const float here = bottom(p.scan, p.x, p.y);
    each_sample([&](int i, int j, int dx, int dy) {
      const float offset = tip_(i, j) - here;
      const int ax = p.x - dx, ay = p.y - dy;
      if (!(top(p.scan, ax, ay) + offset >= -tolerance_)) return;
      each_sample([&](int u, int v, int du, int dv) {
        allowed(u, v) = std::max(allowed(u, v), top(p.scan, ax + du, ay + dv) + offset);
      });
    });
    return allowed;
  }

  bool carve(const std::vector<Point>& all) {
    bool changed = false;
    for (std::size_t first = 0; first < all.size(); first += batch) {
      const std::size_t last = std::min(all.size(), first + batch);
      Grid<float> lower = tip_;
      for (std::size_t n = first; n < last; ++n) {
        const Grid<float> allowed = allowed_by(all[n]);
        for (std::size_t k = 0; k < allowed.size(); ++k) {
          const float a = allowed.data()[k], t = threshold_.data()[k];
          if (a > -infinity && a < tip_.data()[k] - t)
            lower.data()[k] = std::min(lower.data()[k], a + t);
        }
        tried_[all[n].scan](all[n].x, all[n].y) = version_;
      }
      out_.summary.points += static_cast<std::int64_t>(last - first);
      if (lower == tip_) continue;
      tip_ = lower;
      ++version_;
      changed = true;
    }
    return changed;
  }

  BlindTipOptions o_;
  std::vector<Grid<float>> scans_;
  std::vector<Grid<int>> tried_;
  Grid<float> tip_, threshold_;
  float tolerance_ = 0;
  int version_ = 1;
  BlindTip out_;
};

// Spikes below a lopsided tip, and noise.
HeightField scan_of(std::uint64_t seed, int width, int height, double noise_nm) {
  HeightField f;
  f.z_nm = Grid<double>(width, height);
  RandomStream random(seed, 0, 0);
  for (int n = 0; n < width * height / 40; ++n) {
    const int cx = static_cast<int>(random.uniform() * width),
              cy = static_cast<int>(random.uniform() * height);
    const double top = 12 * random.uniform();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        f.z_nm(x, y) = std::max(f.z_nm(x, y), top - 0.8 * std::hypot(x - cx, 1.5 * (y - cy)) -
                                                  0.1 * std::max(0, x - cx));
  }
  if (noise_nm == 0) return f;
  const Grid<double> e = simulate_noise({0, noise_nm * noise_nm}, width, height, seed);
  for (std::size_t k = 0; k < e.size(); ++k) f.z_nm.data()[k] += e.data()[k];
  return f;
}

HeightField with_holes(HeightField f) {
  RandomStream random(5, 0, 0);
  f.valid = Mask(f.z_nm.width(), f.z_nm.height(), 1);
  for (std::size_t k = 0; k < f.z_nm.size(); ++k)
    if (random.uniform() < 0.03) f.valid.data()[k] = 0, f.z_nm.data()[k] = NAN;
  return f;
}

void expect_like_definition(const std::vector<HeightField>& scans, BlindTipOptions o,
                            const std::string& what) {
  const BlindTip expected = Definition(scans, o).run();
  for (const std::int64_t target : test::vector_targets()) {
    const test::OnlyTarget only(target);
    for (const int threads : {1, 3}) {
      o.threads = threads;
      const BlindTip found = blind_tip(scans, o);
      const std::string where = what + ", " + test::name_of_target(target);
      EXPECT_TRUE(found.tip.z_nm == expected.tip.z_nm) << where;
      EXPECT_EQ(found.summary.rounds, expected.summary.rounds) << where;
      EXPECT_EQ(found.summary.points, expected.summary.points) << where;
    }
  }
}

TEST(BlindTipReference, IsTheDefinitionToTheLastBit) {
  const HeightField scan = scan_of(1, 61, 47, 0.1), holes = with_holes(scan_of(2, 50, 40, 0.1));
  for (const auto& [width, height] : {std::pair(9, 9), {17, 6}, {4, 12}, {1, 1}})
    for (const double threshold : {0.0, 0.15, 0.6})
      for (const double tolerance : {0.0, 0.3, 0.6}) {
        BlindTipOptions o;
        o.width = width, o.height = height;
        o.threshold_nm = threshold, o.apex_tolerance_nm = tolerance;
        expect_like_definition(
            {scan}, o, fmt::format("{} x {}, {} and {} nm", width, height, threshold, tolerance));
        if (width == 17) expect_like_definition({holes, scan}, o, "two scans, one with holes");
      }
}

TEST(BlindTipReference, SoAreItsOtherOptions) {
  const HeightField scan = scan_of(3, 60, 50, 0.1), smooth = scan_of(4, 60, 50, 0);
  BlindTipOptions o;
  o.width = 11, o.height = 9;
  expect_like_definition({smooth}, o, "no noise");
  o.threshold_nm = o.apex_tolerance_nm = 0.5;
  const Tip start = blind_tip({scan}, o).tip;
  o.border = false;
  expect_like_definition({scan}, o, "no border");
  o.border = true, o.maxima_only = true;
  expect_like_definition({scan}, o, "maxima only");
  o.maxima_only = false, o.threshold_y_nm = 1.2;
  expect_like_definition({scan}, o, "two thresholds");
  o.layer_nm = 0.2;
  expect_like_definition({scan}, o, "layer");
  o.layer_nm = 0, o.threshold_y_nm.reset(), o.threshold_nm = o.apex_tolerance_nm = 0.3;
  o.start = start;
  expect_like_definition({scan}, o, "from a blunter tip");
}

}  // namespace
}  // namespace surf
