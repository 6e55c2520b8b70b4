// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <vector>
#include "surf/core/mask.h"

#include "surf/reconstruction/reconstruct.h"
#include "surface_frame.h"

namespace surf::reconstruction {

/// A change of gains and offset: the share by which all gains grow, and that of the offset. The
/// gains keep their ratios: channels are so alike that their gains would trade what the model is
/// off by (docs/methods/calibration.md).
using MixtureChange = std::array<double, 2>;

/// The SEM image, given a surface: the model's channels, mixed, and the negative log-likelihood
/// (thesis, 9.2.2).
class SemTerm {
 public:
  /// Pixel (0, 0) of the image lies on sample (`left`, `below`) of the surface.
  SemTerm(const SemData& data, const SurfaceFrame& frame, int left, int below, int threads);

  struct State {
    std::unique_ptr<Linearization> linear;
    Grid<double> simulated;    ///< on the surface's samples; of the image's unit
    Grid<double> pull;         ///< derivative of the term by each simulated pixel, 0 where not used
    Grid<double> information;  ///< expected second derivative by it
    double value = 0;
  };

  /// A sparse stand-in for J that does the same to waves of 12 samples along x and y: as if a pixel
  /// saw its own height and the four beside it. Short waves are the prior's, long ones the AFM's;
  /// those between are what the SEM decides. It costs four changes, and a product with it next to
  /// nothing.
  struct Near {
    Grid<double> left, right, below, above,
        own;  ///< derivatives of a pixel by these heights; 0 along the border

    double change(const Grid<double>& dz_nm, int x, int y) const;
    void scatter(double weight, int x, int y, Grid<double>& out) const;  ///< its transpose
  };
  Near near(const State& state, const std::vector<double>& mixture) const;

  /// `mixture`: a gain for each channel and the offset.
  State evaluate(const Grid<double>& z_nm, const std::vector<double>& mixture) const;

  /// out += J^T w; `by_mixture` gets the derivatives by MixtureChange, if given. `near`, if given,
  /// stands for J.
  void add_gradient(const State& state, const std::vector<double>& mixture,
                    const Grid<double>& weights, const Near* near, Grid<double>& out,
                    MixtureChange* by_mixture) const;
  /// J (dz, change of the mixture), likewise.
  Grid<double> change(const State& state, const std::vector<double>& mixture,
                      const Grid<double>& dz_nm, const MixtureChange& mixture_change,
                      const Near* near = nullptr) const;

  std::size_t channels() const { return channels_; }
  const Grid<double>& image() const { return image_; }  ///< on the surface's samples
  const Mask& used() const { return used_; }
  std::int64_t used_pixels() const { return used_pixels_; }
  const SemNoise& noise() const { return noise_; }

 private:
  Grid<double> mixed(const ModelImages& images, const std::vector<double>& mixture) const;

  std::shared_ptr<const ImageModel> model_;
  SurfaceFrame frame_;
  SemNoise noise_;
  ModelOptions options_;
  std::size_t channels_ = 0;
  Grid<double> image_;
  Mask used_;
  std::int64_t used_pixels_ = 0;
};

}  // namespace surf::reconstruction
