// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "surf/sem/image_model.h"

namespace surf {

/// A model that shows only some channels of another, in the order of `names`. The model itself if
/// these are all of its channels. Throws InvalidInput for a channel that it has not, or no names.
std::shared_ptr<const ImageModel> with_channels(std::shared_ptr<const ImageModel> model,
                                                const std::vector<std::string>& names);

}  // namespace surf
