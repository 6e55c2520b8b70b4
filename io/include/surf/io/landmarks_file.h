// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "surf/registration/landmarks.h"

namespace surf::io {

/// The size and the place of an image whose pixels landmarks name.
struct LandmarkFrame {
  int width = 0, height = 0;
  double pitch_x_nm = 1, pitch_y_nm = 1;
  double origin_x_nm = 0, origin_y_nm = 0;   ///< centre of the lower-left pixel
};

/// Reads pairs from a table (CSV): a line of names, then one pair a line. Columns in any order: sem_x, sem_y,
/// afm_x, afm_y, each with _nm (from the image's origin, y up) or _px (pixels as image viewers count them: the centre
/// of the upper-left one is 0, 0, and y goes down), both of an image alike. Further columns and lines that begin with #
/// are passed over. Throws FileError naming the line.
std::vector<LandmarkPair> read_landmarks(const std::filesystem::path& path, const LandmarkFrame& sem,
                                         const LandmarkFrame& afm);

}  // namespace surf::io
