// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "surf/mc/request/scan_request.h"

namespace surf::cli {

/// "X0,Y0,X1,Y1". Throws UsageError naming `subject`.
mc::ScanRequest::Region parse_region(std::string_view text, std::string_view subject);

}  // namespace surf::cli
