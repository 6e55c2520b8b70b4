// SPDX-License-Identifier: GPL-3.0-or-later
// The pages of docs/reference and the manual page, made from what the program itself knows.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace surf::cli::reference {

/// Names of files in docs/reference, and their text.
std::map<std::string, std::string> pages();

std::string commands_page();
std::string scene_files_page();
std::string results_page();
std::string exit_codes_page();
std::string index_page();
std::string manual_page();

/// What channels and metadata of images are called, and what they are. "N" stands for a number,
/// "NAME" for a name.
struct NamedEntry {
  std::string name, meaning;
};
std::vector<NamedEntry> image_channels();
std::vector<NamedEntry> image_metadata();

}  // namespace surf::cli::reference
