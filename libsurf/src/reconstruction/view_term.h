// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <utility>

#include "beam_heights.h"
#include "sem_term.h"

namespace surf::reconstruction {

/// What is fitted of a view besides the surface.
struct ViewUnknowns {
  PoseChange pose{};  ///< change from the given pose
  Mixture mixture;
};

/// A change of them, or a derivative by them.
struct ViewChange {
  PoseChange pose{};
  MixtureChange mixture{};
};

/// The likelihood of a further SEM image, which sees the surface from another side, and the prior
/// of its pose: the term of an upright image of the surface's heights along the beam.
class ViewTerm {
 public:
  /// Pixels that do not see `z_nm` are left out.
  ViewTerm(const SemView& view, const SurfaceFrame& surface, const Grid<double>& z_nm, int margin,
           int threads);

  struct State {
    std::shared_ptr<const BeamHeights> heights;
    SemTerm::State sem;
    double value = 0;  ///< with the prior
  };
  State evaluate(const Grid<double>& z_nm, const ViewUnknowns& at) const;

  /// See SemTerm. Weights and images are on the view's samples. Derivatives by the view's numbers
  /// are without their prior's.
  SemTerm::Near near(const State& state, const ViewUnknowns& at) const;
  void add_gradient(const State& state, const ViewUnknowns& at, const Grid<double>& weights,
                    const SemTerm::Near* near, Grid<double>& out, ViewChange* by_view) const;
  Grid<double> change(const State& state, const ViewUnknowns& at, const Grid<double>& dz_nm,
                      const ViewChange& view, const SemTerm::Near* near = nullptr) const;

  /// The derivatives of -log of the pose's prior, and its precisions.
  PoseChange prior_pull(const ViewUnknowns& at) const;
  const PoseChange& prior_precision() const { return precision_; }

  /// Second derivatives by the view's numbers alone, the pose's first, with the prior; those of the
  /// mixture only if `mixture` (gains and offset) are fitted, else 1.
  static constexpr int numbers = pose_numbers + 2;
  std::array<std::array<double, numbers>, numbers> block(const State& state, const ViewUnknowns& at,
                                                         bool mixture,
                                                         const SemTerm::Near* near) const;

  ViewUnknowns moved(const ViewUnknowns& at, const ViewChange& by, bool mixture) const;
  /// Fits the view's numbers to a surface.
  void fit(const Grid<double>& z_nm, ViewUnknowns& at, bool mixture, const Watch& watch) const;

  ViewPose pose(const ViewUnknowns& at) const { return changed(given_, frame_, at.pose); }
  const SemTerm& sem() const { return sem_; }
  int margin() const { return margin_; }
  const SurfaceFrame& frame() const { return frame_; }

 private:
  int margin_, threads_;
  SurfaceFrame surface_, frame_;
  ViewPose given_;
  PoseChange precision_{};
  SemTerm sem_;
};

}  // namespace surf::reconstruction
