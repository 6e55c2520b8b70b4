// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/height_field.h"
#include "surf/core/mask.h"
#include "surf/core/parameters.h"

namespace surf::cli {

/// Which samples of a scan decide: images of its size, where what is not 0 counts.
struct MaskInput {
  std::optional<std::string> use, exclude;

  /// Those that are given.
  std::vector<std::string> files() const;
};
/// scan.use and scan.exclude.
void describe(ParameterVisitor& visit, MaskInput& input);

/// 1 where a sample decides; empty if neither is given. Throws UsageError, FileError, InvalidInput
/// if a size differs or nothing remains.
Mask read_masks(const MaskInput& input, const HeightField& field);

/// 1 at samples whose centre lies in "X0,Y0,X1,Y1" (nm, in the scan's coordinates). Throws
/// UsageError, also where there are none.
Mask parse_mask_region(const std::string& text, const char* subject, const HeightField& field);

/// As an image of 0 and 1; `made` says how.
void write_mask(const std::string& path, const Mask& mask, const HeightField& field,
                const std::map<std::string, std::string>& made);

}  // namespace surf::cli
