// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace surf::io {

/// The whole file, or what comes through a pipe such as the shell's <(command), once and at most
/// 512 MiB. Throws FileError (missing, a folder, a device, a named pipe, unreadable, larger than
/// `max_bytes`: that is judged before memory is taken).
std::string read_file(const std::filesystem::path& path,
                      std::size_t max_bytes = std::size_t{8} << 30);

/// Throws FileError unless `path` is an ordinary file: for readers that open it themselves, or
/// twice.
void require_regular_file(const std::filesystem::path& path);

/// Calls `write(temporary)` with a name in the same folder and renames the result to `path`, so
/// that a crash never leaves half a file under the real name. On failure the temporary is removed
/// and FileError is thrown. Creates missing parent folders.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// Whether a file has the name of a temporary of `write_atomically`: one that is old was left
/// behind by a process that was killed.
bool is_temporary_name(const std::filesystem::path& path);

/// Writes text through `write_atomically`.
void write_text(const std::filesystem::path& path, const std::string& text);

/// Throws FileError if no file can be created at `path` (folder missing and not creatable, not
/// writable, or `path` is a folder). Leaves nothing behind but created folders.
void check_writable(const std::filesystem::path& path);

/// Lower-case hexadecimal SHA-256, as `sha256sum` prints it. Of a pipe only after `read_file`.
std::string sha256_of_file(const std::filesystem::path& path);
std::string sha256_of(std::span<const std::byte> bytes);

}  // namespace surf::io
