// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace surf::test {

// Programs that link memory_files.cpp read their inputs from memory: it takes the place of
// io/src/files/read_file.cpp. Only files that were put here exist, until another takes their name.

/// Sets the content of a file, which the readers of `io` find under this path.
void put_memory_file(const std::filesystem::path& path, std::string content);

/// The path of an ordinary file without a disk, for readers that use file descriptors. Its content
/// is replaced by the next call. Throws std::runtime_error if the system has no such files.
std::filesystem::path descriptor_file(const std::string& content);

}  // namespace surf::test
