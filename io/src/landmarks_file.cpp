// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/landmarks_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "surf/core/error.h"
#include "surf/io/csv_line.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

constexpr const char* layout = "Write a first line sem_x_px,sem_y_px,afm_x_px,afm_y_px (or _nm) and a pair on each after it";

std::string trimmed(std::string text) {
  const auto blank = [](unsigned char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.back())) text.pop_back();
  text.erase(text.begin(), std::ranges::find_if_not(text, blank));
  return text;
}

/// Where the two numbers of one image stand, and in what they are.
struct Columns {
  std::size_t x = 0, y = 0;
  bool pixels = false;
};

std::optional<std::size_t> column(const std::vector<std::string>& names, const std::string& wanted) {
  const auto found = std::ranges::find(names, wanted);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

Columns columns_of(const std::string& file, const std::vector<std::string>& names, const std::string& image) {
  for (const bool pixels : {true, false}) {
    const std::string unit = pixels ? "_px" : "_nm";
    const auto x = column(names, image + "_x" + unit), y = column(names, image + "_y" + unit);
    if (x && y) return {*x, *y, pixels};
  }
  throw FileError(file, fmt::format("its first line names no columns for {0}_x and {0}_y", image), layout);
}

double number(const std::vector<std::string>& fields, std::size_t at, const std::string& place) {
  double value = 0;
  const std::string text = at < fields.size() ? trimmed(fields[at]) : "";
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    throw FileError(place, at < fields.size() ? fmt::format("'{}' is no number", text) : "it has too few columns", layout);
  return value;
}

Point2 place_of(double x, double y, bool pixels, const LandmarkFrame& frame) {
  if (!pixels) return {x, y};
  return {frame.origin_x_nm + x * frame.pitch_x_nm, frame.origin_y_nm + (frame.height - 1 - y) * frame.pitch_y_nm};
}

}  // namespace

std::vector<LandmarkPair> read_landmarks(const std::filesystem::path& path, const LandmarkFrame& sem,
                                         const LandmarkFrame& afm) {
  const std::string file = path.string();
  const std::string text = read_file(path, std::size_t{1} << 24);
  std::vector<LandmarkPair> pairs;
  std::optional<Columns> sem_columns, afm_columns;
  int line_number = 0;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    const std::string line = trimmed(text.substr(from, end - from));
    from = end + 1;
    ++line_number;
    if (line.empty() || line == "\r" || line.front() == '#') continue;
    std::vector<std::string> fields = split_csv_line(line);
    for (std::string& field : fields) field = trimmed(field);
    if (!sem_columns) {
      sem_columns = columns_of(file, fields, "sem");
      afm_columns = columns_of(file, fields, "afm");
      continue;
    }
    const std::string place = fmt::format("{}, line {}", file, line_number);
    const auto point = [&](const Columns& c, const LandmarkFrame& frame) {
      return place_of(number(fields, c.x, place), number(fields, c.y, place), c.pixels, frame);
    };
    pairs.push_back({point(*sem_columns, sem), point(*afm_columns, afm)});
  }
  if (!sem_columns) throw FileError(file, "it is empty", layout);
  return pairs;
}

}  // namespace surf::io
