// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

#include "surf/io/web_page.h"

namespace surf::cli {

/// Gives each surface the channel's values at its vertices or samples, between pixels in proportion to
/// the four around; NaN beyond the image, where it is not valid and beside holes. Surfaces that it does
/// not lie over go without. Returns how many places have a value.
std::size_t add_sampled_scalar(io::WebPage& page, const Image& image, const std::string& channel,
                               const std::string& name);

/// Whether some of the surface lies under the image.
bool lies_over(const Image& image, const io::WebSurface& surface);

}  // namespace surf::cli
