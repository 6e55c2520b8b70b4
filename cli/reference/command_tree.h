// SPDX-License-Identifier: GPL-3.0-or-later
// What help shows of the program, as data.
#pragma once

#include <string>
#include <vector>

namespace surf::cli::reference {

struct OptionText {
  std::string names;  ///< "-o, --output", or "INPUT"
  std::string form;   ///< "FILE"; empty for flags
  std::string help;   ///< in one line
};

struct OptionGroup {
  std::string heading;
  std::vector<OptionText> options;
};

struct CommandText {
  std::string group;  ///< heading in help
  std::string name;   ///< "semsurf noise scan"
  std::string usage, title;
  std::vector<OptionGroup> options;
  std::string examples, notes;  ///< of the text below the options
  std::vector<CommandText> commands;
};

/// `semsurf` itself, without what is hidden and without --help.
CommandText read_program();

}  // namespace surf::cli::reference
