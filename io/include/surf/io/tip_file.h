// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "surf/afm/tip.h"
#include "surf/core/height_field.h"

namespace surf::io {

/// Makes a tip from heights and their metadata, as `read_tip` does with a file. Throws
/// InvalidInput, naming `subject`, if the highest value occurs in several places that do not touch,
/// or nowhere.
Tip to_tip(HeightField field, const std::map<std::string, std::string>& metadata,
           const std::string& subject = "tip");

/// A tip as a height field: the structuring function about the apex at (0, 0), with holes where it
/// is -infinity, and the metadata that turns it into a tip again.
struct TipHeights {
  HeightField field;
  std::map<std::string, std::string> metadata;
};
TipHeights to_heights(const Tip& tip, const char* subject = "tip");

/// Reads a tip from any file of heights. A file holds the structuring function, as `Tip` does,
/// unless its metadata "tip" is "physical": then it holds the tip's own surface, apex down or up,
/// and is turned over. The highest sample becomes the apex with height 0; holes become -infinity.
/// Throws FileError, and InvalidInput if the highest value occurs in several places that do not
/// touch.
Tip read_tip(const std::filesystem::path& path);

/// Writes the structuring function as heights, with holes where it is -infinity. The metadata "tip"
/// is "structuring function"; "tip.doubt" is the tip's doubt, if it has one.
void write_tip(const std::filesystem::path& path, const Tip& tip,
               const std::map<std::string, std::string>& metadata = {});

}  // namespace surf::io
