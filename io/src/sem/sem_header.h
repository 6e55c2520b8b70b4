// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../afm/tiff_tags.h"

namespace surf::io {

/// What a microscope says of an image. Numbers that are not there, or impossible, are left out.
struct SemHeader {
  std::string format;
  double pixel_x_nm = 0, pixel_y_nm = 0;  ///< 0: not said
  std::string pixel_from;
  int databar_rows = 0;  ///< less than the image's
  std::optional<double> energy_ev, working_distance_nm, tilt_deg;
  std::string detector, instrument;
  std::map<std::string, std::string> metadata;
  std::vector<std::string> notes;
};

/// The image as stored, with its databar.
struct SemSize {
  int width = 0, height = 0;
};

// Each takes the text of one maker; none is an error: what cannot be understood is not said.

SemHeader parse_fei(std::string_view text, SemSize size);
SemHeader parse_zeiss(std::string_view text, SemSize size);
SemHeader parse_tescan_tag(std::string_view tag, SemSize size);
/// The file NAME-tif.hdr that may lie beside an image.
SemHeader parse_tescan_text(std::string_view text, SemSize size);
SemHeader parse_jeol(std::string_view text, SemSize size);
/// Of the text file, or of the part of it that is repeated in the image.
SemHeader parse_hitachi(std::string_view text, SemSize size);

bool is_jeol_text(std::string_view text);
bool is_hitachi_text(std::string_view text);

/// What ImageJ or an OME-TIFF says in the page's description; empty without a pixel size.
std::optional<SemHeader> described_pixel(const TiffPage& page);

// What they share.

using Settings = std::map<std::string, std::string>;

/// Lines "key=value", the key with "SECTION." before it after a line "[SECTION]"; values are
/// printable.
Settings parse_settings(std::string_view text);
std::string setting(const Settings& settings, const std::string& key);
/// A finite number at the front of a setting, times `factor`; or nothing.
std::optional<double> number_of(const Settings& settings, const std::string& key,
                                double factor = 1);
std::optional<double> positive(std::optional<double> value);
/// "5.00 kV", "15000 Volt" in eV; "3.9 mm" in nm.
std::optional<double> voltage_ev(std::string_view text);
std::optional<double> length_nm(std::string_view text);

/// Sets both sides, the second one as the first where it is missing; nothing without the first.
void set_pixel(SemHeader& header, std::optional<double> x_nm, std::optional<double> y_nm,
               std::string from);
/// Rows below `image_rows`, where there are such and fewer than half of the picture.
int rows_below(SemSize size, std::optional<double> image_rows);

/// UTF-8 from a text file: UTF-16 by its mark, else as it is.
std::string decoded_text(std::string_view bytes);
/// UTF-8 from UTF-16 without a mark, the low byte first; up to its first NUL.
std::string decoded_utf16(std::string_view bytes, bool low_byte_first = true);

}  // namespace surf::io
