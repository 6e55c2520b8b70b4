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

/// A channel of a scan file, as its reader understands it. The values are read when they are asked
/// for.
struct ScanChannel {
  std::string name;           ///< as the file calls it; may be empty
  std::string z_unit;         ///< as the file calls it; empty where it does not say
  int width = 0, height = 0;  ///< checked against the file: at least 1
  double pitch_x_nm = 0;      ///< 0: the file does not say
  double pitch_y_nm = 0;
  bool pitch_guessed = false;  ///< the file gives numbers without a unit, taken as nm
  /// In `z_unit`, row 0 the lowest; NaN where there is none. The file's content must outlive it.
  std::function<Grid<double>()> values;
  std::map<std::string, std::string> metadata = {};  ///< of this channel
};

/// What a scan file holds.
struct Scan {
  std::string format;  ///< "Gwyddion", "Bruker Nanoscope" ...
  std::vector<ScanChannel> channels;
  std::map<std::string, std::string> metadata;  ///< of the file
  std::vector<std::string> notes;               ///< what had to be assumed
  double origin_x_nm = 0, origin_y_nm = 0;  ///< centre of the lower-left sample; only our files say
};

/// The nm of one `unit` as instruments write it: "m", "nm", "um" with u, Greek mu, the micro sign
/// of UTF-8 or Latin-1 or Nanoscope's "~m", the angstrom sign. "A" is the ampere. Empty: not a
/// length.
std::optional<double> scan_length_nm(std::string_view unit);

/// Whether a channel of this name and unit holds heights: the unit is a length or not said, and the
/// name is not that of an error signal (amplitude, deflection ...), which has a length's unit in
/// some files.
bool holds_heights(const ScanChannel& channel);

/// Throws FileError where no image has such a size, or one that the file cannot hold: `bytes_each`
/// is what a sample takes at least, in a file of `file_bytes`.
void check_scan_size(const std::string& file, double width, double height, std::size_t bytes_each,
                     std::size_t file_bytes);

/// A number as instruments write it, blanks around it ignored and one decimal comma taken for a
/// point; "nan" in any case is one. Empty where it is none.
std::optional<double> scan_number(std::string_view text);
/// The number at the front of a text, and what follows it without blanks: "2.5 um" to 2.5 and "um".
std::optional<double> leading_number(std::string_view text, std::string_view& rest);

/// Without blanks, line ends and NULs at both ends.
std::string_view trimmed(std::string_view text);
/// In small letters (ASCII).
std::string lower_case(std::string_view text);
/// Printable UTF-8 for metadata: Latin-1 is translated, control characters become blanks.
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
