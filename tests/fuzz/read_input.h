// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace surf::test {

/// Gives the file to the reader of its extension, as users do. True where it was read; false where
/// it was refused with one of the project's errors. Everything else comes through: another
/// exception, or std::logic_error where a reader returned what it must not.
bool read_input(const std::filesystem::path& path);

}  // namespace surf::test
