// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "network_operations.h"
#include "sem/model/aligned.h"
#include "surf/core/edge.h"
#include "surf/core/grid.h"

namespace surf::network {

/// Which samples the sky view looks at: in 16 directions, each a whole number of its shortest step
/// of samples away, so that a quarter turn of the surface turns the outcome; in each band of
/// distances at most two, and where a band has none the nearest step to its far end.
class SkyView {
 public:
  struct Sample {
    int dx, dy, band;
    double distance_nm, weight;
    bool last;  ///< of its direction
  };

  SkyView(const std::vector<double>& edges_nm, double pitch_nm);

  int bands() const { return bands_; }
  int inputs() const { return bands_ == 0 ? 0 : 2 * bands_ + 1; }
  int reach() const { return reach_; }  ///< in samples
  const std::vector<Sample>& samples() const { return samples_; }

 private:
  int bands_;
  int reach_ = 0;
  std::vector<Sample> samples_;
};

/// Heights in T, relative to the field's first, with what lies around within `reach` as `edge`
/// says.
template <class T>
struct SkyPlane {
  SkyPlane() = default;
  SkyPlane(const Grid<double>& z_nm, double level, double unit, Edge edge, int reach, int columns);

  const T* at(int x, int y) const { return values.data() + (y + reach) * stride + x + reach; }

  int reach = 0;
  std::ptrdiff_t stride = 0;
  AlignedVector<T> values;
};

/// The samples as the loops take them, in a plane of that stride.
template <class T>
std::vector<SkySample<T>> in_plane(const SkyView& view, std::ptrdiff_t stride);

extern template struct SkyPlane<float>;
extern template struct SkyPlane<double>;

}  // namespace surf::network
