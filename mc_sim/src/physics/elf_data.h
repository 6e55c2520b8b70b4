// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string_view>

namespace surf::mc {

/// A file of data/elf, as it is.
struct ElfFile {
  std::string_view name, text;
};
std::span<const ElfFile> elf_files();

}  // namespace surf::mc
