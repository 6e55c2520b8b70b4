// SPDX-License-Identifier: GPL-3.0-or-later
#include "common_options.h"

#include "options.h"

namespace surf::cli {

CLI::Option* add_materials_option(CLI::App& app, std::vector<std::string>& files) {
  return app.add_option("--materials", files, "Your own materials (TOML); may be repeated")
      ->type_name("FILE")->option_text("FILE")->allow_extra_args(false);
}

void add_unit_options(CLI::App& app, std::optional<std::string>& unit, bool& overrides, const std::string& group) {
  app.add_option("--unit", unit, "Length of one unit of the mesh files (as they say, else nm; glTF: m)")
      ->type_name("nm|um|mm|m|pm|A|in")->group(group);
  app.add_flag("--override-unit", overrides, "Take --unit even where a file says another unit")->group(group);
}

CLI::Option* add_threads_option(CLI::App& app, std::optional<std::string>& threads) {
  return app.add_option("--threads", threads,
                        "Number of threads, which does not change the result (one per hardware thread)")
      ->type_name("N");
}

CLI::Option* add_quiet_flag(CLI::App& app, bool& quiet) {
  return app.add_flag("-q,--quiet", quiet, "Only errors and warnings");
}

int parse_threads(const std::optional<std::string>& text) {
  constexpr std::int64_t most = 4096;
  return text ? static_cast<int>(parse_whole(*text, "--threads", 0, most)) : 0;
}

}  // namespace surf::cli
