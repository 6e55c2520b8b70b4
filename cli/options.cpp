// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/core/words.h"

namespace surf::cli {
mc::ScanRequest::Region parse_region(std::string_view text, std::string_view subject) {
  const auto parts = split(text, ",");
  if (parts.size() != 4)
    throw UsageError(std::string(subject), fmt::format("'{}' has {} numbers", text, parts.size()),
                     "Give the outer edges X0,Y0,X1,Y1, as -96,-96,96,96");
  return {parse_length_nm(parts[0], subject), parse_length_nm(parts[1], subject),
          parse_length_nm(parts[2], subject), parse_length_nm(parts[3], subject)};
}

}  // namespace surf::cli
