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

/// One image per channel of a model, each of the size of the height field. Values are yields:
/// counts per primary.
using ModelImages = std::vector<Grid<double>>;

/// The conditions that a model is made for. The model is not valid for other conditions.
struct ModelScope {
  double pixel_nm = 0;   ///< distance between samples; 0: any
  std::string material;  ///< empty: any
  double energy_ev = 0;  ///< of the beam; 0: any
  double spot_nm = 0;    ///< standard deviation of the beam's Gaussian spot

  friend bool operator==(const ModelScope&, const ModelScope&) = default;
};

struct ModelOptions {
  Edge edge = Edge::mirror;  ///< how the heights are continued outside the field
  int threads = 0;           ///< 0: one per hardware thread. Does not change the result
  /// Computes in double precision instead of float: slower, for checks.
  bool double_precision = false;
  Watch watch;  ///< for the images; derivatives are not watched
};

/// A model, linearised at one surface: the images and their derivatives. J is the matrix of
/// derivatives of all pixels of all channels by all heights (per nm). It is exact. Where the images
/// have no derivative (a slope or a difference of principal curvatures of zero, a kink of a table),
/// J contains the mean of the one-sided derivatives, so that it is finite everywhere.
class Linearization {
 public:
  virtual ~Linearization() = default;
  virtual const ModelImages& images() const = 0;

  /// The vector-Jacobian product J^T w: the gradient by the heights of the sum over all pixels of
  /// weight times image. If the weights are the derivatives of a loss by the images, it is the
  /// gradient of the loss. One weight image per channel (InvalidInput for other sizes).
  virtual Grid<double> gradient(const ModelImages& weights) const = 0;

  /// The Jacobian-vector product J dz: the first-order change of the images when the heights change
  /// by dz, nm.
  virtual ModelImages change(const Grid<double>& dz_nm) const = 0;
};

/// A fast model of SEM images: a function of the heights that replaces the Monte Carlo simulation.
/// Models have no mutable state; threads may share them.
///
/// `predict` and `linearize` throw InvalidInput for a field that is invalid, has masked samples,
/// has different pitches along x and y if the model needs equal ones, or has a pitch that differs
/// from the model's pixels by more than 0.1 % (the message names both).
class ImageModel {
 public:
  virtual ~ImageModel() = default;

  /// Names of the channels, in the order of the images: SE and BSE, or the one signal of a
  /// microscope.
  virtual const std::vector<std::string>& channels() const = 0;
  virtual const ModelScope& scope() const = 0;

  virtual ModelImages predict(const HeightField& field, const ModelOptions& options = {}) const = 0;

  /// The images and their derivatives. The result owns all data except the model.
  virtual std::unique_ptr<Linearization> linearize(const HeightField& field,
                                                   const ModelOptions& options = {}) const = 0;
};

/// Throws InvalidInput, naming `subject`, if a model of this scope cannot be used for `field`: see
/// ImageModel.
void check_field(const ModelScope& scope, const HeightField& field,
                 const char* subject = "height field");

/// Throws UsageError if `wanted` differs from the model's scope in material, energy or spot; the
/// message names both. Members of `wanted` that are empty or 0 are not compared.
void check_conditions(const ModelScope& scope, const ModelScope& wanted);

}  // namespace surf
