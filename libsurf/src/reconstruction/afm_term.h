// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>
#include "surf/core/mask.h"

#include "surf/reconstruction/reconstruct.h"
#include "surface_frame.h"
#include "tip_family.h"

namespace surf::reconstruction {

/// The contact of the tip for one AFM pixel.
struct Contact {
  double x = 0, y = 0;  ///< surface samples
  /// 0: the contact is outside the surface, and no height changes it.
  std::uint8_t inside = 0;
  /// Place of the contact, in units of the reach: see MapChange.
  double from_middle_x = 0, from_middle_y = 0;
  /// Row-major index of the tip's sample; -1: none, as for unused pixels.
  std::int32_t tip_sample = -1;
};

/// The likelihood of the scan, given a surface: dilation of the surface's samples by the tip, and
/// the negative log-likelihood of the residual (thesis, 9.2.1), without constants.
class AfmTerm {
 public:
  /// `outside`: heights on the AFM's samples, for example the eroded scan, that are used beyond the
  /// surface. AFM pixels that lie on the surface, according to `surface_to_afm`, contribute.
  AfmTerm(const AfmData& data, const HeightField& outside, const SurfaceFrame& frame,
          const Affine& surface_to_afm, int threads);

  struct State {
    Grid<double> simulated;  ///< on the AFM's samples; 0 where not used
    Grid<double> residual;   ///< image - simulated, 0 where not used
    Grid<double> pull;       ///< derivative of the term by each simulated pixel
    std::vector<Contact> contacts;
    std::vector<TipChange> by_tip;  ///< derivatives of the tip's samples by TipChange
    double value = 0;
  };

  /// `drift_px`: see MapChange.
  State evaluate(const Grid<double>& z_nm, const Affine& surface_to_afm, const TipChange& tip = {},
                 const Point2& drift_px = {}) const;

  /// The vector-Jacobian product: out += J^T w for weights w of pixels. If `map` and `tip` are
  /// given, the derivatives by them are added.
  void add_gradient(const State& state, const Grid<double>& z_nm, const Grid<double>& weights,
                    Grid<double>& out, MapChange* map, TipChange* tip = nullptr) const;
  /// The Jacobian-vector product J (dz, map, tip).
  Grid<double> change(const State& state, const Grid<double>& z_nm, const Grid<double>& dz_nm,
                      const MapChange& map, const TipChange& tip = {}) const;
  /// The precision of the noise times v; the precision is the second derivative by the simulated
  /// pixels.
  Grid<double> precision(const Grid<double>& v) const;

  Affine moved(const Affine& surface_to_afm, const MapChange& change) const;

  bool tip_can_change() const { return family_.can_change(); }
  /// The changed tip on the scan's samples.
  Tip tip(const TipChange& change) const { return family_.changed(first_tip_, change); }
  /// Replaces the heights beyond the surface (see the constructor), as by those of the scan eroded
  /// by another tip.
  void set_outside(const HeightField& outside);

  const Mask& used() const { return used_; }
  std::int64_t used_pixels() const { return used_pixels_; }
  const AfmNoise& noise() const { return noise_; }

 private:
  Affine to_samples(const Affine& surface_to_afm) const;

  HeightField image_;
  AfmNoise noise_;
  Tip first_tip_;  // on the scan's samples
  Tip tip_;        // the tip on the fine samples
  TipFamily family_;
  int factor_;
  SurfaceFrame frame_;
  Grid<double> outside_;  // on the fine samples
  Mask used_;
  std::int64_t used_pixels_ = 0;
  int first_row_ = 0, last_row_ = -1;      // rows of used pixels
  std::vector<std::array<int, 2>> spans_;  // first and last used column of each row
  Point2 middle_;                          // of the used pixels, AFM nm
  double reach_nm_ = 1;
  int threads_;
};

}  // namespace surf::reconstruction
