// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>
#include "surf/core/mask.h"

#include "discrepancy.h"
#include "surf/reconstruction/reconstruct.h"
#include "surface_frame.h"

namespace surf::reconstruction {

/// How an image is made of the model's channels.
struct Mixture {
  std::vector<double> gains;  ///< one per channel
  double offset = 0;
  /// By how much the real spot's variance along each axis exceeds the model's, in squared pixels.
  double blur_px2 = 0;
  double film_nm = 0;  ///< thickness of the film, if there is one
};

/// A change of the mixture: the relative change of all gains, the change of the offset, of the blur
/// and of the film's thickness. The gains keep their ratios, because channels are so alike that
/// their gains would compensate errors of the model (docs/explanation/calibration.md).
constexpr int mixture_numbers = 4;
using MixtureChange = std::array<double, mixture_numbers>;

/// The likelihood of the SEM image, given a surface: the mixed channels of the model, and the
/// negative log-likelihood (thesis, 9.2.2).
class SemTerm {
 public:
  /// Pixel (0, 0) of the image lies on sample (`left`, `below`) of the surface.
  SemTerm(const SemData& data, const SurfaceFrame& frame, int left, int below, int threads);

  struct State {
    std::unique_ptr<Linearization> linear;
    Grid<double> sharp;        ///< the simulated image without offset and blur
    Grid<double> simulated;    ///< on the surface's samples, in the image's unit
    Grid<double> pull;         ///< derivative of the term by each simulated pixel, 0 where not used
    Grid<double> information;  ///< expected second derivative by each simulated pixel
    double value = 0;
    Grid<double> discrepancy;        ///< the most likely one; empty without
    std::vector<double> row_jitter;  ///< the likeliest of each of the surface's rows; or empty
  };

  /// A sparse approximation of J that is exact for waves of 12 samples along x and y: a pixel
  /// depends on its own height and its four neighbours only. Short waves are determined by the
  /// prior and long ones by the AFM; the SEM determines those in between. Making it costs four
  /// Jacobian-vector products; a product with it costs next to nothing.
  struct Near {
    /// Derivatives of a pixel by these heights; 0 along the border.
    Grid<double> left, right, below, above, own;

    double change(const Grid<double>& dz_nm, int x, int y) const;
    /// The transpose of `change`.
    void scatter(double weight, int x, int y, Grid<double>& out) const;
  };
  Near near(const State& state, const Mixture& mixture) const;

  State evaluate(const Grid<double>& z_nm, const Mixture& mixture) const;

  /// The vector-Jacobian product: out += J^T w. If `by_mixture` is given, the derivatives by
  /// MixtureChange are added to it. `near`, if given, replaces J.
  void add_gradient(const State& state, const Mixture& mixture, const Grid<double>& weights,
                    const Near* near, Grid<double>& out, MixtureChange* by_mixture) const;
  /// The Jacobian-vector product J (dz, mixture_change). `near`, if given, replaces J.
  Grid<double> change(const State& state, const Mixture& mixture, const Grid<double>& dz_nm,
                      const MixtureChange& mixture_change, const Near* near = nullptr) const;

  /// The product of the second derivative by the simulated pixels, in which the discrepancy is
  /// eliminated, and a change of them.
  Grid<double> precision(const State& state, const Grid<double>& change) const;
  /// The change of the simulated image with each number of a change of the mixture.
  std::array<Grid<double>, mixture_numbers> mixture_images(const State& state,
                                                           const Mixture& mixture) const;
  /// `precision` between the numbers of a change of the mixture.
  std::array<std::array<double, mixture_numbers>, mixture_numbers> mixture_precision(
      const State& state, const Mixture& mixture) const;
  /// A draw of `precision`: normal, with that covariance.
  Grid<double> draw_precision(const State& state, std::uint64_t seed) const;

  /// The discrepancy follows these fields, too, each times a coefficient of this deviation.
  void follow(std::vector<Grid<double>> fields, double deviation);

  std::size_t channels() const { return channels_; }
  bool has_film() const { return film_; }
  const Grid<double>& image() const { return image_; }  ///< on the surface's samples
  const Mask& used() const { return used_; }
  std::int64_t used_pixels() const { return used_pixels_; }
  const SemNoise& noise() const { return noise_; }

 private:
  /// The gain of each channel of `model_`.
  std::vector<double> gains_of(const Mixture& mixture) const;
  Grid<double> mixed(const ModelImages& images, const std::vector<double>& gains) const;
  /// What 1 nm of film changes in the image without blur.
  Grid<double> change_by_film(const State& state, const Mixture& mixture) const;

  std::shared_ptr<const ImageModel> model_;  // with twice the channels if there is a film
  bool film_ = false;
  SurfaceFrame frame_;
  SemNoise noise_;
  ModelOptions options_;
  std::size_t channels_ = 0;
  Grid<double> image_;
  Mask used_;
  std::int64_t used_pixels_ = 0;
  std::vector<SemDiscrepancy> parts_;  // of the discrepancy, on the surface's samples
  Grid<double> row_jitter_, weight_;
  std::shared_ptr<const Discrepancy::Factor> factor_;  // null: there is no discrepancy
};

}  // namespace surf::reconstruction
