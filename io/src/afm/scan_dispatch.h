// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "scan.h"

namespace surf::io {

/// A scan with the content that its channels are read from.
struct ScanFile {
  std::unique_ptr<const std::string> content;
  Scan scan;
};

/// Finds the format by content, then by name, and then tries Gwyddion if it is installed. Throws
/// FileError, Unsupported.
ScanFile open_scan(const std::filesystem::path& path);

/// Whether `open_scan` recognises the content or name without Gwyddion; plain images do not count.
bool is_scan_file(const std::filesystem::path& path);

}  // namespace surf::io
