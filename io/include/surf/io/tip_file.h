// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "surf/afm/tip.h"
#include "surf/core/height_field.h"

namespace surf::io {

/// A tip from heights and what is said of them, as `read_tip` reads a file. Throws InvalidInput,
/// naming `subject`, where the highest value is found in several places that do not touch, or
/// nowhere.
Tip to_tip(HeightField field, const std::map<std::string, std::string>& metadata,
           const std::string& subject = "tip");

/// The structuring function as heights about the apex at (0, 0), holes where it is -infinity, and
/// the metadata that makes it a tip again.
struct TipHeights {
  HeightField field;
  std::map<std::string, std::string> metadata;
};
TipHeights to_heights(const Tip& tip, const char* subject = "tip");

/// Reads a tip from any file of heights. Files hold the structuring function, as `Tip` does, unless
/// their metadata "tip" says "physical": then the tip's own surface, apex down or up, is turned.
/// The highest sample becomes 0 and the apex; holes become -infinity. Throws FileError,
/// InvalidInput where the highest value is found in several places that do not touch.
Tip read_tip(const std::filesystem::path& path);

/// Writes the structuring function as heights, holes where it is -infinity; metadata "tip" is
/// "structuring function", and "tip.doubt" is the tip's doubt, where it has one.
void write_tip(const std::filesystem::path& path, const Tip& tip,
               const std::map<std::string, std::string>& metadata = {});

}  // namespace surf::io
