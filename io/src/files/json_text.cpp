// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/json_text.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "surf/core/error.h"

namespace surf::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t widest = 100;

bool is_plain(const Json& json) { return !json.is_object() && !json.is_array(); }

bool holds_plain_values(const Json& json) {
  for (const auto& item : json.items())
    if (!is_plain(item.value())) return false;
  return true;
}

class Writer {
 public:
  std::string text() && { return std::move(text_) + "\n"; }

  void write(const Json& json, std::size_t indent, const std::string& place) {
    if (is_plain(json)) text_ += plain(json, place);
    else if (holds_plain_values(json) && fits(json, indent, place)) text_ += one_line(json, place);
    else if (json.is_array() && holds_plain_values(json)) write_wrapped(json, indent + 2, place);
    else write_tall(json, indent + 2, place);
  }

 private:
  static std::string plain(const Json& json, const std::string& place) {
    if (json.is_number_float() && !std::isfinite(json.get<double>()))
      throw InvalidInput(place, "it is not finite, which files cannot hold", "Give finite numbers");
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
  }

  static std::string key(const std::string& name) {
    return Json(name).dump(-1, ' ', false, Json::error_handler_t::replace) + ": ";
  }

  static std::string step(const std::string& place, const std::string& key, bool array) {
    if (array) return fmt::format("{}[{}]", place, key);
    return place.empty() ? key : place + "." + key;
  }

  static std::string one_line(const Json& json, const std::string& place) {
    std::string line = json.is_array() ? "[" : "{";
    for (const auto& item : json.items()) {
      if (line.size() > 1) line += ", ";
      if (!json.is_array()) line += key(item.key());
      line += plain(item.value(), step(place, item.key(), json.is_array()));
    }
    line += json.is_array() ? ']' : '}';
    return line;
  }

  static bool fits(const Json& json, std::size_t indent, const std::string& place) {
    return json.size() <= 40 && indent + one_line(json, place).size() <= widest;
  }

  void new_line(std::size_t indent) {
    text_ += '\n';
    text_.append(indent, ' ');
  }

  /// As many values in a line as fit.
  void write_wrapped(const Json& json, std::size_t indent, const std::string& place) {
    text_ += "[";
    std::size_t used = widest;
    for (std::size_t i = 0; i < json.size(); ++i) {
      const std::string value =
          plain(json[i], fmt::format("{}[{}]", place, i)) + (i + 1 < json.size() ? "," : "");
      if (used + 1 + value.size() > widest) {
        new_line(indent);
        used = indent;
      } else {
        text_ += " ";
        ++used;
      }
      text_ += value;
      used += value.size();
    }
    new_line(indent - 2);
    text_ += "]";
  }

  void write_tall(const Json& json, std::size_t indent, const std::string& place) {
    text_ += json.is_array() ? "[" : "{";
    bool first = true;
    for (const auto& item : json.items()) {
      if (!first) text_ += ",";
      first = false;
      new_line(indent);
      if (!json.is_array()) text_ += key(item.key());
      write(item.value(), indent, step(place, item.key(), json.is_array()));
    }
    new_line(indent - 2);
    text_ += json.is_array() ? "]" : "}";
  }

  std::string text_;
};

}  // namespace

std::string json_text(const Json& json) {
  Writer writer;
  writer.write(json, 0, "");
  return std::move(writer).text();
}

}  // namespace surf::io
