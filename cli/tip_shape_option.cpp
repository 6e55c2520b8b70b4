// SPDX-License-Identifier: GPL-3.0-or-later
#include "tip_shape_option.h"

#include <fmt/format.h>

#include <string_view>
#include <tuple>
#include <vector>

#include "options.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/core/words.h"

namespace surf::cli {

Tip parse_tip_shape(const std::string& shape, const std::string& size,
                    const std::optional<std::string>& pixel_size) {
  TipSampling sampling;
  sampling.width = sampling.height = static_cast<int>(parse_whole(size, "--size", 1, 4001));
  if (sampling.width % 2 == 0)
    throw UsageError("--size", fmt::format("{} samples have no middle for the apex", sampling.width),
                     fmt::format("Ask for {}", sampling.width + 1));
  if (pixel_size)
    std::tie(sampling.pitch_x_nm, sampling.pitch_y_nm) = parse_pixel_size(*pixel_size, "--pixel-size");
  const std::size_t colon = std::min(shape.find(':'), shape.size());
  const std::string kind = shape.substr(0, colon);
  const std::vector<std::string_view> words =
      split(colon < shape.size() ? std::string_view(shape).substr(colon + 1) : std::string_view(), ",");
  const auto length = [&](std::size_t k) { return parse_length_nm(words[k], "--shape"); };
  const auto angle = [&](std::size_t k) { return parse_angle_deg(words[k], "--shape") * degrees_to_radians; };
  try {
    if (kind == "parabola" && words.size() == 1) return parabolic_tip(length(0), sampling);
    if (kind == "cone" && words.size() == 2) return conical_tip(length(0), angle(1), sampling);
    if (kind == "pyramid" && words.size() == 3) {
      PyramidShape pyramid;
      pyramid.radius_nm = length(0);
      pyramid.face_angles_rad.assign(static_cast<std::size_t>(parse_whole(words[2], "--shape", 3, 100)), angle(1));
      return pyramidal_tip(pyramid, sampling);
    }
    if (kind == "ball" && words.size() == 1)   // on a cylinder, which is never seen
      return ball_tip(length(0), 0.5 * length(0), 0, sampling);
    if (kind == "ball" && words.size() == 3) return ball_tip(length(0), length(1), angle(2), sampling);
  } catch (const InvalidInput& e) {
    throw UsageError("--shape", fmt::format("{}: {}", shape, e.reason()), e.remedy());
  }
  throw UsageError("--shape", fmt::format("'{}' is no shape", shape),
                   "Write parabola:10nm, cone:10nm,15deg, pyramid:10nm,20deg,4 or ball:30nm");
}

}  // namespace surf::cli
