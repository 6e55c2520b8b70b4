// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "surf/mc/request/scan_request.h"

namespace surf::cli {

/// "X0,Y0,X1,Y1". Throws UsageError naming `subject`.
mc::ScanRequest::Region parse_region(std::string_view text, std::string_view subject);

/// The candidate that `word` was most likely meant to be; empty if none is near.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace surf::cli
