// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/core/height_field.h"
#include "surf/sem/image_model.h"

namespace surf {

/// Throws InvalidInput where heights span so much that single precision cannot hold their
/// curvatures.
void check_span(const HeightField& field);

/// Throws InvalidInput unless there is a finite image of the heights' size for each channel.
void check_weights(const ModelImages& weights, std::size_t channels, const Grid<double>& z_nm);

/// Throws InvalidInput unless the change of heights is finite and of their size.
void check_change(const Grid<double>& dz_nm, const Grid<double>& z_nm);

/// A power of two near the largest magnitude, by which values can be divided without a change to
/// their digits, to keep them in single precision's range; 0 if all are 0.
double magnitude(const std::vector<double>& values);

/// Throws InvalidInput unless there are 1 to 8 channels of different names, none empty.
void check_channels(const std::vector<std::string>& names, const char* subject);

}  // namespace surf
