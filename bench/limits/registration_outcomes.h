// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "libsurf/registration/made_images.h"
#include "surf/registration/register_images.h"
#include "sweep.h"

namespace surf::limits {

/// What became of some registrations whose truth is known.
class Outcomes {
 public:
  /// `error_px`: how far off it is.
  void add(const Registration& r, double error_px) {
    const bool verified = r.verdict == RegistrationVerdict::verified;
    ++all_;
    verified_right_ += verified && error_px < right_px;
    verified_wrong_ += verified && error_px >= right_px;
    ambiguous_ += r.verdict == RegistrationVerdict::ambiguous;
    refused_ += !verified && r.verdict != RegistrationVerdict::ambiguous;
  }

  double verified_right() const { return verified_right_ / all_; }
  double verified_wrong() const { return verified_wrong_ / all_; }

  /// Verified though right, verified though wrong, ambiguous, and called unconverged or unrelated.
  std::vector<double> shares() const {
    return {verified_right(), verified_wrong(), ambiguous_ / all_, refused_ / all_};
  }

 private:
  static constexpr double right_px = 1;
  double all_ = 0, verified_right_ = 0, verified_wrong_ = 0, ambiguous_ = 0, refused_ = 0;
};

/// Spots of 3 to 9 SEM pixels, 120 x 90 of them, over a scan as wide; another scene and map for
/// each seed.
struct SpotScene {
  static constexpr int width = 120, height = 90, scan = 120;
  Affine truth;
  PlacedImage sem, simulated;

  explicit SpotScene(std::uint64_t seed) {
    RandomStream random(seed, 5, 5);
    const auto between = [&](double a, double b) { return a + (b - a) * random.uniform(); };
    truth = make_affine({between(-3.1, 3.1), between(0.9, 1.1), between(0.9, 1.1),
                         between(-0.03, 0.03), between(-8, 8), between(-8, 8)});
    const test::Spots spots(seed);
    sem = test::image_of(spots, truth, width, height, 1, 0.3, 2 * seed);
    simulated = test::image_of(spots, {}, scan, scan, 1, 0.03, 2 * seed + 1);
  }

  double error_px(const Affine& map) const {
    return test::error_px(truth, map, width, height, 0.5 * scan);
  }
};

/// Registers scenes from starts that are wrong: `start` makes one of the truth and a stream of
/// random numbers. With the usual blurs first, then with none wider than two pixels.
std::vector<double> registered_from(
    const std::function<Affine(const Affine& truth, RandomStream&)>& start);
std::vector<std::string> columns_from_starts();
io::PlotPanel panel_of_starts(const Table& t, const std::string& title, const io::PlotAxis& x);

}  // namespace surf::limits
