// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace surf::io {

/// A file that a job reads or writes.
struct FileUse {
  std::string option;  ///< the name used in messages: "`output`", a field
  std::filesystem::path path;
  /// the file given by the user, if `path` only belongs to it; else empty
  std::filesystem::path named;
};

/// Throws UsageError if an output is an input or another output, before any work is spent. Two
/// names denote one file if they lead to one place through links, "." and "..", or to one file by
/// hard links. Names of files that do not exist yet are compared too. A folder that is an output
/// must hold no input. Inputs that are not files are left out: their readers report them.
void refuse_overlaps(const std::vector<FileUse>& inputs, const std::vector<FileUse>& outputs);

/// `path` and the files that are read with it: buffers and pictures of a glTF file, parts of a VTM
/// file, materials and pictures of an OBJ file, settings beside an SEM image. Throws nothing: for a
/// file that cannot be read the result is `path` alone.
std::vector<std::filesystem::path> files_read_with(const std::filesystem::path& path);

/// `path` and the files that writing surfaces to it may write beside it: the files that are always
/// written, and the existing ones among the numbered files.
std::vector<std::filesystem::path> files_written_with(const std::filesystem::path& path);

/// Throws UsageError if one of the files `beside` exists and is a stranger: it bears no mark of
/// semsurf, and `main` does not name it. `main` is the file that is written together with them, or
/// its record; it may be missing.
void refuse_strangers(const std::filesystem::path& main,
                      const std::vector<std::filesystem::path>& beside);

}  // namespace surf::io
