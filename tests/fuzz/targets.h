// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "accepted.h"
#include "mutators/mutators.h"

namespace surf::test {

/// A reader that is given hostile files, and how files are changed for it.
struct FuzzTarget {
  const char* name;  ///< also of its folder in corpus/
  /// Reads the content. Throws one of the project's errors if the content is refused.
  Accepted (*read)(const std::string& content);
  Mutator mutate;  ///< keeps the form of the format, so that most results are read
};

/// All readers: of meshes, scans, other files, and states that programs keep.
std::vector<FuzzTarget> fuzz_targets();

/// The target of that name. Throws std::invalid_argument with the known names if there is none.
FuzzTarget fuzz_target(std::string_view name);

/// Gives the content to a reader. True if it was read, false if it was refused with one of the
/// project's errors. Everything else comes through: another exception, or std::logic_error if the
/// reader returned invalid data or an error without a reason and a remedy.
bool is_read(const FuzzTarget& target, const std::string& content, bool go_on);

}  // namespace surf::test
