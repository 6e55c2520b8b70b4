// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "commands.h"

namespace surf::cli {

/// The program's commands and options. Parsing a command line sets `action`, which must outlive it;
/// `command_line` is recorded in what the action writes.
std::unique_ptr<CLI::App> make_app(Action& action, const std::string& command_line);

}  // namespace surf::cli
