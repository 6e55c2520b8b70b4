// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "surf/core/edge.h"
#include "surf/core/grid.h"
#include "surf/core/height_field.h"
#include "surf/core/progress.h"

namespace surf {

/// One image per channel of a model, each of the size of the height field. Yields are counts per
/// primary.
using ModelImages = std::vector<Grid<double>>;

/// What a model holds for. It says nothing about surfaces that are imaged otherwise.
struct ModelScope {
  double pixel_nm = 0;   ///< distance of samples; 0: any
  std::string material;  ///< empty: any
  double energy_ev = 0;  ///< of the beam; 0: any
  double spot_nm = 0;    ///< standard deviation of the beam's Gaussian spot

  friend bool operator==(const ModelScope&, const ModelScope&) = default;
};

struct ModelOptions {
  Edge edge = Edge::mirror;  ///< how the heights go on outside the field
  int threads = 0;           ///< 0: one per hardware thread. Does not change the result
  bool double_precision =
      false;    ///< compute in double where a model computes in float: slower, to check with
  Watch watch;  ///< of the making of images; derivatives are not watched
};

/// A model at one surface: its images there, and how they change with the heights. J is the matrix
/// of derivatives of all pixels of all channels by all heights (per nm). It is exact; where the
/// images have no derivative (a slope or a difference of principal curvatures of zero, a kink of a
/// table), J holds the mean of the one-sided ones, so that it is finite everywhere.
class Linearization {
 public:
  virtual ~Linearization() = default;
  virtual const ModelImages& images() const = 0;

  /// J^T w: the gradient by the heights of the sum over all pixels of weight times image. With
  /// weights that are a loss's derivatives by the images it is the loss's gradient. One weight
  /// image per channel (InvalidInput for other sizes).
  virtual Grid<double> gradient(const ModelImages& weights) const = 0;

  /// J dz: the first-order change of the images as the heights change by dz, nm.
  virtual ModelImages change(const Grid<double>& dz_nm) const = 0;
};

/// A fast model of SEM images: a function of the heights that stands in for Monte Carlo. Models
/// hold no state and may be shared by threads.
///
/// `predict` and `linearize` throw InvalidInput for a field that is invalid, has masked samples, is
/// not sampled alike along x and y where the model needs that, or has another pitch than the
/// model's pixels by more than 0.1 % (the message names both).
class ImageModel {
 public:
  virtual ~ImageModel() = default;

  /// Names of the channels, in the order of the images: SE and BSE, or the one signal of a
  /// microscope.
  virtual const std::vector<std::string>& channels() const = 0;
  virtual const ModelScope& scope() const = 0;

  virtual ModelImages predict(const HeightField& field, const ModelOptions& options = {}) const = 0;

  /// The same images, and their derivatives. Refers to nothing but itself and the model.
  virtual std::unique_ptr<Linearization> linearize(const HeightField& field,
                                                   const ModelOptions& options = {}) const = 0;
};

/// Throws InvalidInput, naming `subject`, if heights sampled like `field` are not what a model of
/// this scope can be used for: see ImageModel.
void check_field(const ModelScope& scope, const HeightField& field,
                 const char* subject = "height field");

/// Throws UsageError naming both where an image was or is to be taken of another material, with
/// another energy or another spot than the model was made for. What is empty or 0 in `wanted` is
/// not compared.
void check_conditions(const ModelScope& scope, const ModelScope& wanted);

}  // namespace surf
