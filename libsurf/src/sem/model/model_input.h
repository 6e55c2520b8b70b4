// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "surf/core/height_field.h"
#include "surf/sem/image_model.h"

namespace surf {

/// Throws InvalidInput if the heights span so much that single precision cannot represent their
/// curvatures.
void check_span(const HeightField& field);

/// Throws InvalidInput unless there is a finite image of the heights' size for each channel.
void check_weights(const ModelImages& weights, std::size_t channels, const Grid<double>& z_nm);

/// Throws InvalidInput unless the change of heights is finite and of the size of the heights.
void check_change(const Grid<double>& dz_nm, const Grid<double>& z_nm);

/// Throws InvalidInput unless a model's images are finite: large numbers in a model overflow.
void check_images(const ModelImages& images, const std::vector<std::string>& channels);

/// A power of two near the largest magnitude; 0 if all values are 0. Division by it keeps values in
/// the range of single precision without changing their digits.
double magnitude(const std::vector<double>& values);

/// Throws InvalidInput unless there are 1 to 8 channels with different, non-empty names.
void check_channels(const std::vector<std::string>& names, const char* subject);

}  // namespace surf
