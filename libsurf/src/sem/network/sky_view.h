// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "core/aligned.h"
#include "network_operations.h"
#include "surf/core/edge.h"
#include "surf/core/grid.h"

namespace surf::network {

/// The samples of the sky view, in 16 directions. Each is at a whole multiple of its direction's
/// shortest step of samples, so that rotating the surface by 90 degrees rotates the outcome. Each
/// band of distances has at most two samples per direction; if it has none, the step nearest to its
/// far end is used.
class SkyView {
 public:
  struct Sample {
    int dx, dy, band;
    double distance_nm, weight;
    bool last;  ///< the last sample of its direction
  };

  SkyView(const std::vector<double>& edges_nm, double pitch_nm);

  int bands() const { return bands_; }
  int reach() const { return reach_; }  ///< in samples
  const std::vector<Sample>& samples() const { return samples_; }

 private:
  int bands_;
  int reach_ = 0;
  std::vector<Sample> samples_;
};

/// Heights in T, relative to the field's first height, continued by `edge` as far as `reach`.
template <class T>
struct SkyPlane {
  SkyPlane() = default;
  SkyPlane(const Grid<double>& z_nm, double level, double unit, Edge edge, int reach, int columns);

  const T* at(int x, int y) const { return values.data() + (y + reach) * stride + x + reach; }

  int reach = 0;
  std::ptrdiff_t stride = 0;
  AlignedVector<T> values;
};

/// The samples in the form that the loops need, for a plane with this stride.
template <class T>
std::vector<SkySample<T>> in_plane(const SkyView& view, std::ptrdiff_t stride);

extern template struct SkyPlane<float>;
extern template struct SkyPlane<double>;

}  // namespace surf::network
