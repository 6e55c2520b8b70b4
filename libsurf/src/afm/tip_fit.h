// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/afm/noise.h"
#include "surf/afm/tip.h"
#include "surf/core/height_field.h"

namespace surf {

/// A tip and the surfaces under it, fitted to scans: see best_tip.h. The surfaces extend beyond the
/// scans by the size of the tip.
class TipFit {
 public:
  TipFit() = default;

  /// The surfaces start as the erosions of the scans by the tip.
  TipFit(const std::vector<HeightField>& scans, const AfmNoise& noise, const Tip& start);

  /// Makes scaled gradient steps. Updates `misfit`, `freedom` and `risk`.
  void iterate(int times);

  const Tip& tip() const { return tip_; }
  double misfit() const { return misfit_; }    ///< per pixel
  double freedom() const { return freedom_; }  ///< touched surface pixels per pixel
  double risk() const { return misfit_ + 2 * freedom_; }
  /// The risk after removing surface pixels that do not reduce the misfit enough.
  double risk_when_thinned() const;
  /// Standard error of each sample of the tip, from the number of its contacts; infinity without
  /// contact.
  Grid<double> standard_errors() const;

 private:
  struct Frame {
    int width, height;           // of the scan
    int row;                     // its width, rounded up to whole vectors
    std::ptrdiff_t stride;       // of the surface, which has the tip's margin
    std::vector<float> scan;     // NaN: a hole
    std::vector<float> surface;  // -infinity: not under any pixel
    // The dilation, and its value without the surface pixel in contact.
    std::vector<float> made, next;
    std::vector<std::int32_t> touching, next_touching;  // index of the tip's sample in contact
  };
  struct Sample {
    int i, j;
  };  // a sample of the tip that can touch the surface

  void dilate(Frame& frame) const;
  void follow(Frame& frame) const;
  void pull(Frame& frame, std::vector<double>& slope);
  void thin(Frame& frame) const;

  std::ptrdiff_t surface_at(const Frame& f, int x, int y, const Sample& u) const {
    return (y - (u.j - tip_.apex_y) + below_) * f.stride + x - (u.i - tip_.apex_x) + left_;
  }

  AfmNoise noise_;
  Tip tip_;
  int left_ = 0, below_ = 0;  // margins
  std::vector<Frame> frames_;
  std::vector<Sample> samples_;
  std::vector<double> surface_slope_, surface_weight_;
  std::vector<std::int64_t> contacts_;  // per sample
  double misfit_ = 0, freedom_ = 0;
  double pixels_ = 0;
};

}  // namespace surf
