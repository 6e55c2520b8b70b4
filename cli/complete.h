// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace surf::cli {

/// `semsurf __complete WORD...`, which the completion scripts call: tells what the last word may
/// become, in a command line of these words after the program's name. The last word is empty where
/// one is begun.
///
/// The first line says what the shell offers by itself: ":files", ":folders" or ":nothing". Each
/// further line is a word that begins as the last one does, and may have a tab and a description
/// after it. No space belongs after a word that ends in "=". Words that the shell has split at "="
/// and ":" may be given in their pieces.
std::string completions(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace surf::cli
