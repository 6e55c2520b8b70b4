// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "surf/core/grid.h"

namespace surf::io {

/// A parsed channel of a scan file. The values are read on demand.
struct ScanChannel {
  std::string name;           ///< as the file calls it; may be empty
  std::string z_unit;         ///< as the file calls it; empty if not stated
  int width = 0, height = 0;  ///< checked against the file: at least 1
  double pitch_x_nm = 0;      ///< 0: not stated by the file
  double pitch_y_nm = 0;
  bool pitch_guessed = false;  ///< the file gives numbers without a unit, taken as nm
  /// Reads the values in `z_unit`; row 0 is the lowest; missing values are NaN. The file's content
  /// must outlive this function.
  std::function<Grid<double>()> values;
  std::map<std::string, std::string> metadata = {};  ///< metadata of this channel
};

/// The content of a scan file.
struct Scan {
  std::string format;  ///< "Gwyddion", "Bruker Nanoscope" ...
  std::vector<ScanChannel> channels;
  std::map<std::string, std::string> metadata;  ///< of the file
  std::vector<std::string> notes;               ///< assumptions that were made
  /// Centre of the lower-left sample; stated only by semsurf's own files.
  double origin_x_nm = 0, origin_y_nm = 0;
};

/// The length in nm of one `unit` as instruments write it: "m", "nm", "um" with u, Greek mu, the
/// micro sign of UTF-8 or Latin-1 or Nanoscope's "~m", the angstrom sign. "A" is the ampere. Empty
/// if the unit is not a length.
std::optional<double> scan_length_nm(std::string_view unit);

/// Whether a channel of this name and unit holds heights: the unit is a length or not stated, and
/// the name is not that of an error signal (amplitude, deflection ...), which has a length unit in
/// some files.
bool holds_heights(const ScanChannel& channel);

/// Throws FileError if the size is impossible for an image, or too large for a file of `file_bytes`
/// in which each sample takes at least `bytes_each`.
void check_scan_size(const std::string& file, double width, double height, std::size_t bytes_each,
                     std::size_t file_bytes);

/// Parses a number as instruments write it. Blanks around it are ignored, one decimal comma counts
/// as a point, and "nan" in any case is a number. Empty if the text is not a number.
std::optional<double> scan_number(std::string_view text);
/// Parses the number at the front of a text. `rest` becomes the text after it without blanks: "2.5
/// um" gives 2.5 and "um".
std::optional<double> leading_number(std::string_view text, std::string_view& rest);

/// The text without blanks, line ends and NULs at both ends.
std::string_view trimmed(std::string_view text);
/// The text in lower case (ASCII).
std::string lower_case(std::string_view text);
/// Converts text to printable UTF-8 for metadata: Latin-1 is translated, control characters become
/// blanks.
std::string clean_text(std::string_view text);

/// Calls `use(line)` for each line, without its line end.
template <class Use>
void for_each_text_line(std::string_view text, const Use& use) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    use(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace surf::io
