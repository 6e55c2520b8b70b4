// SPDX-License-Identifier: GPL-3.0-or-later
#include "kept_point.h"

#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::workflow {

using Json = nlohmann::ordered_json;

void keep_point(const std::filesystem::path& path, const std::string& identity, const Json& point) {
  io::write_text(path, Json{{"job", identity}, {"point", point}}.dump(1) + "\n");
}

std::optional<Json> kept_point(const std::filesystem::path& path, const std::string& identity) {
  const auto json = read_json(path);
  try {
    if (json && json->at("job") == identity) return json->at("point");
  } catch (const Json::exception&) {
  }
  return std::nullopt;
}

std::optional<Json> read_json(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
  try {
    return Json::parse(io::read_file(path));
  } catch (const Json::exception&) {
  } catch (const FileError&) {
  }
  return std::nullopt;  // damaged: the point is made again
}

}  // namespace surf::workflow
