// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/landmarks_file.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include "surf/core/error.h"
#include "surf/io/csv_line.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

constexpr std::size_t most_bytes = std::size_t{16} << 20;
constexpr std::array<const char*, 4> names = {"sem_x", "sem_y", "afm_x", "afm_y"};
constexpr std::array<const char*, 4> from_top = {"sem_col_px", "sem_row_px", "afm_col_px",
                                                 "afm_row_px"};
constexpr const char* remedy =
    "The first line names the columns sem_x_nm,sem_y_nm,afm_x_nm,afm_y_nm, or ..._px, or as "
    "viewers "
    "count, sem_col_px,sem_row_px; every other line holds one pair";

enum class Unit { nm, px, px_from_top };

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

struct Column {
  std::size_t index;
  Unit unit;
};
using Columns = std::array<Column, 4>;

class Reader {
 public:
  Reader(const std::filesystem::path& path, const PlacedImage& sem, const PlacedImage& afm)
      : path_(path), sem_(sem), afm_(afm) {}

  std::vector<LandmarkPair> read() {
    std::istringstream text(read_file(path_, most_bytes));
    std::vector<LandmarkPair> pairs;
    std::optional<Columns> columns;
    for (std::string line; std::getline(text, line);) {
      ++line_;
      if (line_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
      const std::vector<std::string> fields = split_csv_line(line);
      const std::string first = trimmed(fields.front());
      if (first.starts_with('#') || (fields.size() == 1 && first.empty())) continue;
      if (columns) pairs.push_back(pair_of(fields, *columns));
      else columns = columns_of(fields);
    }
    if (pairs.empty()) throw FileError(path_.string(), "it holds no pairs of landmarks", remedy);
    return pairs;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw FileError(fmt::format("{}, line {}", path_.string(), line_), reason, remedy);
  }

  Columns columns_of(const std::vector<std::string>& fields) const {
    std::array<std::optional<Column>, 4> found;
    for (std::size_t f = 0; f < fields.size(); ++f)
      for (std::size_t i = 0; i < names.size(); ++i)
        for (const Unit unit : {Unit::nm, Unit::px, Unit::px_from_top}) {
          const std::string name = unit == Unit::px_from_top
                                       ? from_top[i]
                                       : std::string(names[i]) + (unit == Unit::px ? "_px" : "_nm");
          if (trimmed(fields[f]) != name) continue;
          if (found[i]) fail(fmt::format("there are two columns of {}", names[i]));
          found[i] = Column{f, unit};
        }
    Columns columns{};
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!found[i])
        fail(fmt::format("there is no column {}_nm, {}_px or {}", names[i], names[i], from_top[i]));
      columns[i] = *found[i];
    }
    for (const std::size_t i : {std::size_t{0}, std::size_t{2}})
      if (columns[i].unit != columns[i + 1].unit)
        fail(fmt::format("{} and {} are in different units", names[i], names[i + 1]));
    return columns;
  }

  double number_of(const std::vector<std::string>& fields, const Columns& columns,
                   std::size_t i) const {
    if (columns[i].index >= fields.size()) fail(fmt::format("{} is missing", names[i]));
    const std::string text = trimmed(fields[columns[i].index]);
    const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
      fail(fmt::format("{} is '{}', which is no finite number", names[i], text));
    return value;
  }

  LandmarkPair pair_of(const std::vector<std::string>& fields, const Columns& columns) const {
    const auto point = [&](std::size_t i, const PlacedImage& image) -> Point2 {
      const double x = number_of(fields, columns, i), y = number_of(fields, columns, i + 1);
      if (columns[i].unit == Unit::nm) return {x, y};
      return image.place_nm(x, columns[i].unit == Unit::px ? y : image.values.height() - 1 - y);
    };
    return {point(0, sem_), point(2, afm_)};
  }

  const std::filesystem::path& path_;
  const PlacedImage& sem_;
  const PlacedImage& afm_;
  int line_ = 0;
};

}  // namespace

std::vector<LandmarkPair> read_landmarks(const std::filesystem::path& path, const PlacedImage& sem,
                                         const PlacedImage& afm) {
  return Reader(path, sem, afm).read();
}

}  // namespace surf::io
