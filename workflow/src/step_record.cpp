// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/step_record.h"

#include <fmt/format.h>

#include "surf/io/files.h"
#include "surf/workflow/version.h"

namespace surf::workflow {

std::map<std::string, std::string> step_record(const std::string& step, const Record& parameters,
                                               const std::vector<std::filesystem::path>& inputs) {
  std::map<std::string, std::string> made{{"semsurf.version", version()}, {"command", step}};
  for (const auto& [name, value] : parameters) made["option." + name] = value;
  int number = 0;
  for (const std::filesystem::path& input : inputs)
    made[fmt::format("input.{}", ++number)] =
        fmt::format("{} sha256 {}", input.filename().string(), io::sha256_of_file(input));
  return made;
}

}  // namespace surf::workflow
