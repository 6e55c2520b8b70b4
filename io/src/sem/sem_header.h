// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../afm/tiff_tags.h"

namespace surf::io {

/// The data that a microscope notes about an image. Missing and impossible numbers are left out.
struct SemHeader {
  std::string format;
  double pixel_x_nm = 0, pixel_y_nm = 0;  ///< 0: not stated
  std::string pixel_from;
  int databar_rows = 0;  ///< fewer than the image's rows
  std::optional<double> energy_ev, working_distance_nm, tilt_deg;
  std::string detector, instrument;
  std::map<std::string, std::string> metadata;
  std::vector<std::string> notes;
};

/// Size of the image as stored, with its databar.
struct SemSize {
  int width = 0, height = 0;
};

// Each parses the text of one maker. No text is an error: what cannot be parsed is left out.

SemHeader parse_fei(std::string_view text, SemSize size);
SemHeader parse_zeiss(std::string_view text, SemSize size);
SemHeader parse_tescan_tag(std::string_view tag, SemSize size);
/// Parses the file NAME-tif.hdr that may lie beside an image.
SemHeader parse_tescan_text(std::string_view text, SemSize size);
SemHeader parse_jeol(std::string_view text, SemSize size);
/// Parses the text file, or the part of it that is repeated in the image.
SemHeader parse_hitachi(std::string_view text, SemSize size);

bool is_jeol_text(std::string_view text);
bool is_hitachi_text(std::string_view text);

/// Parses the page description of ImageJ or OME-TIFF; empty without a pixel size.
std::optional<SemHeader> described_pixel(const TiffPage& page);

// Functions shared by the parsers.

using Settings = std::map<std::string, std::string>;

/// Parses lines "key=value". After a line "[SECTION]" keys get the prefix "SECTION.". Values are
/// made printable.
Settings parse_settings(std::string_view text);
std::string setting(const Settings& settings, const std::string& key);
/// A finite number at the front of a setting, times `factor`; or nothing.
std::optional<double> number_of(const Settings& settings, const std::string& key,
                                double factor = 1);
std::optional<double> positive(std::optional<double> value);
/// Parse "5.00 kV" and "15000 Volt" to eV, and "3.9 mm" to nm.
std::optional<double> voltage_ev(std::string_view text);
std::optional<double> length_nm(std::string_view text);

/// Sets both sides of the pixel. A missing second side equals the first. Does nothing without the
/// first.
void set_pixel(SemHeader& header, std::optional<double> x_nm, std::optional<double> y_nm,
               std::string from);
/// Number of rows below `image_rows`, if there are any and they are fewer than half of the picture.
int rows_below(SemSize size, std::optional<double> image_rows);

/// Decodes a text file to UTF-8: UTF-16 if it has a byte order mark, else unchanged.
std::string decoded_text(std::string_view bytes);
/// Decodes UTF-16 without a byte order mark to UTF-8, up to its first NUL.
std::string decoded_utf16(std::string_view bytes, bool low_byte_first = true);

}  // namespace surf::io
