// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "surf/io/web_page.h"

namespace surf::workflow {

/// What became of a map.
struct LaidScalar {
  std::size_t values = 0;                  ///< places that got one
  std::vector<std::string> left_out = {};  ///< surfaces below the map whose extent it does not fit
};

/// Gives surfaces the channel's values at their vertices or samples, between pixels in proportion
/// to the four around; NaN beyond the image, where it is not valid and beside holes. Surfaces that
/// it does not lie over go without. So do those that it does not fit: their extent shares less with
/// the map's (area of the intersection over that of the union) than half of what the best surface's
/// shares. A map of a scan is so not laid on the tip, which lies somewhere below it.
LaidScalar add_sampled_scalar(io::WebPage& page, const Image& image, const std::string& channel,
                              const std::string& name);

/// Whether some of the surface lies under the image.
bool lies_over(const Image& image, const io::WebSurface& surface);

}  // namespace surf::workflow
