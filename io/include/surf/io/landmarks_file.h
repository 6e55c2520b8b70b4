// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "surf/core/landmark_pair.h"
#include "surf/core/placed_image.h"

namespace surf::io {

/// Reads pairs of landmarks from a CSV file. Its first line names four columns, in any order:
///     sem_x_nm,sem_y_nm,afm_x_nm,afm_y_nm
/// For either image the columns may instead be in pixels: `sem_x_px`, `sem_y_px`, `afm_x_px`,
/// `afm_y_px`, with the centre of the lower-left pixel at 0, 0 and y upwards; or, as image viewers
/// count, from the top left with rows downwards: `sem_col_px`, `sem_row_px`, `afm_col_px`,
/// `afm_row_px`. Other columns, empty lines and lines that begin with # are ignored. `sem` and
/// `afm` give the positions of the pixels; their values do not matter. Throws FileError with the
/// line if a column is missing, doubled or given in both units, if a field is missing or not a
/// finite number, and if the file has no pairs.
std::vector<LandmarkPair> read_landmarks(const std::filesystem::path& path, const PlacedImage& sem,
                                         const PlacedImage& afm);

}  // namespace surf::io
