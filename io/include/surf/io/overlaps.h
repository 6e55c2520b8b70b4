// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace surf::io {

/// A file that a job reads or writes.
struct FileUse {
  std::string option;  ///< what names it in a message: "`output`", a field
  std::filesystem::path path;
  std::filesystem::path
      named;  ///< the file that the option names, where `path` only belongs to it; else empty
};

/// Throws UsageError where an output is an input or another output, before any work is spent. Two
/// names are one file if they lead to one place through links, "." and "..", or to one file by hard
/// links. Names of files that do not exist yet are compared, too. An output that is a folder must
/// hold no input. Inputs that are no files are left out: what reads them says so.
void refuse_overlaps(const std::vector<FileUse>& inputs, const std::vector<FileUse>& outputs);

/// `path` and the files that are read with it: the buffers and pictures of a glTF file, the parts
/// of a VTM file, the materials and pictures of an OBJ file, the settings beside an SEM image.
/// Throws nothing for a file that cannot be read: then it is `path` alone.
std::vector<std::filesystem::path> files_read_with(const std::filesystem::path& path);

/// `path` and the files that writing surfaces to it may write beside it: those that are always
/// written, and those that exist of the numbered ones.
std::vector<std::filesystem::path> files_written_with(const std::filesystem::path& path);

/// Throws UsageError where one of `beside` exists and is a stranger: it bears no mark of semsurf,
/// and `main` does not name it. `main` is the file that is written together with them, or its
/// record; it may be missing.
void refuse_strangers(const std::filesystem::path& main,
                      const std::vector<std::filesystem::path>& beside);

}  // namespace surf::io
