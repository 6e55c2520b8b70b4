// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "surf/core/landmark_pair.h"
#include "surf/core/placed_image.h"

namespace surf::io {

/// Reads pairs of landmarks: a CSV file whose first line names its four columns, in any order,
///     sem_x_nm,sem_y_nm,afm_x_nm,afm_y_nm
/// or, of either image, in its pixels: `sem_x_px`, `sem_y_px`, `afm_x_px`, `afm_y_px`, with the
/// centre of the lower-left pixel at 0, 0 and y upwards; or as viewers count, from the top left
/// with rows downwards: `sem_col_px`, `sem_row_px`, `afm_col_px`, `afm_row_px`. Other columns are
/// passed over, and so are empty lines and those that begin with #. `sem` and `afm` say where their
/// pixels lie; their values do not matter. Throws FileError with the line for a column that is
/// missing, doubled or in both units, for a field that is missing or no finite number, and for a
/// file without pairs.
std::vector<LandmarkPair> read_landmarks(const std::filesystem::path& path, const PlacedImage& sem,
                                         const PlacedImage& afm);

}  // namespace surf::io
