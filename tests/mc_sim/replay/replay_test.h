// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "geometry/scene_impl.h"
#include "sampling/unit_worker.h"
#include "specimens.h"
#include "statistics.h"
#include "surf/mc/cascades/cascade_library.h"
#include "surf/mc/cascades/library_source.h"
#include "surf/mc/simulate.h"

namespace surf::test {

/// A row of pixels along x through the origin, at these many nm apart, the first at `first_nm`.
inline mc::Scan row_of_pixels(double first_nm, double pitch_nm, int pixels) {
  mc::Scan scan;
  scan.width = pixels;
  scan.height = 1;
  scan.pixel_x_nm = scan.pixel_y_nm = pitch_nm;
  scan.center_x_nm = first_nm + 0.5 * (pixels - 1) * pitch_nm;
  return scan;
}

/// Libraries of `pages` pages for the materials of a scene; none where `with` says so.
inline mc::Libraries make_libraries(const mc::Scene& scene, std::uint64_t seed, std::size_t pages,
                                    const std::vector<bool>& with = {}) {
  mc::Libraries libraries;
  for (std::size_t m = 0; m < scene.materials().size(); ++m) {
    libraries.emplace_back();
    if (m < with.size() && !with[m]) continue;
    const double barrier = scene.impl().medium_pointers[m]->barrier_ev();
    auto library = std::make_shared<mc::CascadeLibrary>(mc::CascadeSettings{
        scene.materials()[m], scene.physics(), scene.beam().energy_ev + barrier, seed});
    library->grow(pages * mc::CascadeLibrary::page_cascades, 1);
    libraries.back() = std::move(library);
  }
  return libraries;
}

/// Libraries of so many pages, whatever is asked for; kept for who asks again. For one physics.
class SmallLibraries final : public mc::LibrarySource {
 public:
  explicit SmallLibraries(std::size_t pages) : pages_(pages) {}
  std::shared_ptr<const mc::CascadeLibrary> library(const mc::CascadeSettings& settings,
                                                    std::size_t, int threads,
                                                    const Watch&) override {
    auto& known = known_[{settings.material.name, settings.start_energy_ev, settings.seed}];
    if (!known) {
      auto library = std::make_shared<mc::CascadeLibrary>(settings);
      library->grow(pages_ * mc::CascadeLibrary::page_cascades, threads);
      known = std::move(library);
    }
    return known;
  }

 private:
  std::size_t pages_;
  std::map<std::tuple<std::string, double, std::uint64_t>,
           std::shared_ptr<const mc::CascadeLibrary>>
      known_;
};

/// What the primaries of one pixel gave, in blocks of equally many: the scatter between blocks
/// tells how well any of their means is known.
struct PixelSample {
  std::vector<mc::Counts> counts;    ///< per detector
  std::vector<Sample> squares;       ///< per detector: a block's mean of squared counts
  std::vector<mc::Spectra> spectra;  ///< per detector
  Sample generated;                  ///< secondaries per primary
  std::int64_t primaries = 0;
  std::int64_t hits = 0;
};

struct SceneSample {
  std::vector<PixelSample> pixels;
  mc::Balance balance;
};

/// Adds `blocks` blocks of `size` primaries of every pixel, from the electron number `first`.
inline void add_blocks(SceneSample& out, mc::UnitWorker& worker, const mc::Scan& scan, int blocks,
                       int size) {
  out.pixels.resize(static_cast<std::size_t>(scan.width * scan.height));
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    PixelSample& p = out.pixels[i];
    const int x = static_cast<int>(i) % scan.width, y = static_cast<int>(i) / scan.width;
    for (int b = 0; b < blocks; ++b) {
      mc::UnitTally unit;
      worker.simulate({x, y, x + 1, y + 1, std::int64_t{b} * size, size}, nullptr, unit);
      p.counts.resize(unit.counts.size());
      p.squares.resize(unit.counts.size());
      for (std::size_t d = 0; d < unit.counts.size(); ++d) {
        p.counts[d] += unit.counts[d](0, 0);
        p.squares[d].add(static_cast<double>(unit.counts[d](0, 0).squares) / size);
      }
      if (p.spectra.empty()) p.spectra = unit.spectra;
      else
        for (std::size_t d = 0; d < unit.spectra.size(); ++d) p.spectra[d] += unit.spectra[d];
      p.generated.add(static_cast<double>(unit.balance.generated) / size);
      p.primaries += unit.pixels(0, 0).primaries;
      p.hits += unit.pixels(0, 0).hits;
      out.balance += unit.balance;
    }
  }
}

inline void expect_balanced(const mc::Balance& b) {
  EXPECT_EQ(b.total_lost(), 0);
  EXPECT_EQ(b.incident + b.generated, b.se + b.bse + b.transmitted + b.absorbed + b.total_lost());
  const double in = b.incident_energy.ev() + b.generated_energy.ev();
  const double out = b.escaped_energy.ev() + b.deposited_energy.ev() + b.lost_energy.ev();
  EXPECT_NEAR(out, in, 1e-9 * in + 1e-4 * static_cast<double>(b.incident));  // each is rounded
}

/// z-scores of differences, judged together: none beyond what chance allows one of them.
class ZScores {
 public:
  /// Of two numbers with standard errors.
  void compare(double a, double a_error, double b, double b_error, const std::string& what) {
    const double error = std::hypot(a_error, b_error);
    if (error > 0) scores_.push_back({(a - b) / error, what, a, b});
    else EXPECT_EQ(a, b) << what;
  }
  void expect_none_large() const {
    for (const Score& s : scores_)
      EXPECT_LT(std::fabs(s.z), z_limit(scores_.size()))
          << s.what << ": " << s.a << " against " << s.b << " in " << scores_.size()
          << " comparisons";
  }
  std::size_t size() const { return scores_.size(); }

 private:
  struct Score {
    double z;
    std::string what;
    double a, b;
  };
  std::vector<Score> scores_;
};

/// One detector's histogram and how its counts scatter.
struct Spread {
  const mc::Histogram& histogram;
  const mc::Counts& counts;  ///< of the detector
  std::int64_t primaries;
};

/// Compares two histograms in up to `most` wider bins. Electrons of one primary come together:
/// counts in a bin scatter more than their root, in proportion no more than the detector's.
inline void compare_histograms(const Spread& a, const Spread& b, int most, const std::string& what,
                               ZScores& scores) {
  const std::vector<mc::Counts>& bins_a = a.histogram.bins;
  const std::vector<mc::Counts>& bins_b = b.histogram.bins;
  std::int64_t all = 0;
  for (std::size_t i = 0; i < bins_a.size(); ++i) all += bins_a[i].sum + bins_b[i].sum;
  const std::int64_t enough = std::max<std::int64_t>(50, all / most);
  const double clustering = static_cast<double>(a.counts.squares + b.counts.squares) /
                            static_cast<double>(a.counts.sum + b.counts.sum);
  std::int64_t in_a = 0, in_b = 0;
  std::size_t from = 0;
  for (std::size_t i = 0; i < bins_a.size(); ++i) {
    in_a += bins_a[i].sum;
    in_b += bins_b[i].sum;
    if (in_a + in_b < enough) continue;
    const double n_a = static_cast<double>(a.primaries), n_b = static_cast<double>(b.primaries);
    const double rate = static_cast<double>(in_a + in_b) / (n_a + n_b);  // as if they were the same
    scores.compare(static_cast<double>(in_a) / n_a, std::sqrt(clustering * rate / n_a),
                   static_cast<double>(in_b) / n_b, std::sqrt(clustering * rate / n_b),
                   what + " from " + std::to_string(a.histogram.edge(from)));
    in_a = in_b = 0;
    from = i + 1;
  }
}

/// Compares two samples of one scene in everything that detectors tell.
inline void expect_same_sample(const SceneSample& a, const SceneSample& b,
                               const std::vector<mc::Detector>& detectors) {
  ZScores scores;
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const PixelSample& p = a.pixels[i];
    const PixelSample& q = b.pixels[i];
    for (std::size_t d = 0; d < detectors.size(); ++d) {
      const std::string what = detectors[d].name + " at pixel " + std::to_string(i);
      if (p.counts[d].sum + q.counts[d].sum < 50) continue;  // too few for the normal approximation
      const mc::Estimate mean_p = mc::estimate(p.primaries, p.counts[d]);
      const mc::Estimate mean_q = mc::estimate(q.primaries, q.counts[d]);
      scores.compare(mean_p.mean, mean_p.standard_error, mean_q.mean, mean_q.standard_error, what);
      scores.compare(p.squares[d].mean(), p.squares[d].standard_error(), q.squares[d].mean(),
                     q.squares[d].standard_error(), "squared " + what);
      if (p.spectra.empty()) continue;
      const auto compare = [&](mc::Histogram mc::Spectra::*of, int most, const char* name) {
        compare_histograms({p.spectra[d].*of, p.counts[d], p.primaries},
                           {q.spectra[d].*of, q.counts[d], q.primaries}, most, name + what, scores);
      };
      compare(&mc::Spectra::energy_ev, 8, "energy on ");
      compare(&mc::Spectra::polar_deg, 6, "polar angle on ");
      compare(&mc::Spectra::azimuth_deg, 6, "azimuth on ");
    }
  }
  EXPECT_GT(scores.size(), 10u);
  scores.expect_none_large();
}

}  // namespace surf::test
