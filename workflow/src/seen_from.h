// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "surf/core/placed_image.h"
#include "surf/sem/image_model.h"

namespace surf::workflow {

/// What the model's detectors would show if they stood elsewhere: turned clockwise about the beam
/// by quarters. The heights have square pixels and no holes.
ModelImages seen_from(const ImageModel& model, const HeightField& field, int quarters,
                      const ModelOptions& options);

/// How an image of a detector at a side agrees with what it should show, and with what it would
/// show elsewhere.
struct Facing {
  explicit Facing(double correlation) : told(correlation), best(correlation) {}
  void add(double correlation, int at_quarters) {
    if (correlation > best) best = correlation, quarters = at_quarters;
  }

  double told;       ///< correlation with the detector where it is said to be
  double best;       ///< the largest anywhere
  int quarters = 0;  ///< where that is
};

/// Why the image is not of the detector that was told; empty: it is. `channel`: its name.
std::string doubt_of(const Facing& facing, const std::string& channel);

/// The correlation of an image with another one that its places are mapped into; nothing where too
/// little overlaps.
std::optional<double> correlation_at(const PlacedImage& image, const PlacedImage& other,
                                     const Affine& map);

}  // namespace surf::workflow
