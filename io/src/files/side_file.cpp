// SPDX-License-Identifier: GPL-3.0-or-later
#include "side_file.h"

#include <system_error>

namespace surf::io {
namespace {

namespace fs = std::filesystem;

bool leads_out(const fs::path& path) {
  return path.empty() || path.is_absolute() || *path.begin() == "..";
}

/// Both with all links followed.
bool is_below(const fs::path& file, const fs::path& folder) {
  return !leads_out(file.lexically_relative(folder));
}

}  // namespace

std::optional<fs::path> side_file(const fs::path& main, const fs::path& name) {
  const fs::path place = name.lexically_normal();
  if (leads_out(place)) return std::nullopt;
  const fs::path path = main.parent_path() / place;
  std::error_code error;
  const fs::path target = fs::weakly_canonical(fs::absolute(path), error);
  const fs::path folder =
      error ? fs::path() : fs::weakly_canonical(fs::absolute(main).parent_path(), error);
  const fs::path real_folder =
      error ? fs::path() : fs::weakly_canonical(fs::absolute(main), error).parent_path();
  if (error || !(is_below(target, folder) || is_below(target, real_folder))) return std::nullopt;
  return path;
}

}  // namespace surf::io
