// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "surf/core/placed_image.h"
#include "surf/sem/image_model.h"

namespace surf::workflow {

/// What the model's detectors would show if they stood elsewhere: turned clockwise about the beam
/// by quarters. The heights have square pixels and no holes.
ModelImages seen_from(const ImageModel& model, const HeightField& field, int quarters,
                      const ModelOptions& options);

/// Whether a correlation is larger than another by more than chance and the model make of it.
bool clearly_larger(double correlation, double than);

/// Why an image is not of the detector that was told, by how it agrees with what that would show
/// from each of four quarters (`seen_from`); empty: it is. `channel`: the detector's name.
std::string facing_doubt(const std::string& channel,
                         const std::function<double(int quarters)>& correlation_from);

/// The correlation of an image with another one that its places are mapped into; 0 where too little
/// overlaps.
double correlation_at(const PlacedImage& image, const PlacedImage& other, const Affine& map);

}  // namespace surf::workflow
