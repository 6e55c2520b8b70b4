// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace surf::io {

/// Reads a whole file. A pipe, such as the shell's <(command), can be read once and up to 512 MiB.
/// Throws FileError if the file is missing, a folder, a device, a named pipe, unreadable, or larger
/// than `max_bytes`. The size is checked before memory is allocated.
std::string read_file(const std::filesystem::path& path,
                      std::size_t max_bytes = std::size_t{8} << 30);

/// Throws FileError unless `path` is an ordinary file. For readers that open the file themselves,
/// or twice.
void require_regular_file(const std::filesystem::path& path);

/// Calls `write(temporary)` with a name in the same folder, then renames the result to `path`: a
/// crash never leaves half a file under the real name. On failure the temporary is removed and
/// FileError is thrown. Creates missing parent folders.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// Whether a file has the name of a temporary of `write_atomically`. An old temporary was left
/// behind by a process that was killed.
bool is_temporary_name(const std::filesystem::path& path);

/// Writes text through `write_atomically`.
void write_text(const std::filesystem::path& path, const std::string& text);

/// Throws FileError if no file can be created at `path`: the folder is missing and cannot be
/// created, is not writable, or `path` is a folder. Leaves nothing behind but created folders.
void check_writable(const std::filesystem::path& path);

/// SHA-256 in lower-case hexadecimal, as `sha256sum` prints it. A pipe must be read by `read_file`
/// first.
std::string sha256_of_file(const std::filesystem::path& path);
std::string sha256_of(std::span<const std::byte> bytes);

}  // namespace surf::io
