// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/dielectric_data.h"

#include <algorithm>

#include "physics/elf_data.h"

namespace surf::mc {

std::string_view find_energy_loss_file(std::string_view name) {
  const auto files = elf_files();
  const auto file = std::ranges::find(files, name, &ElfFile::name);
  return file == files.end() ? std::string_view{} : file->text;
}

}  // namespace surf::mc
