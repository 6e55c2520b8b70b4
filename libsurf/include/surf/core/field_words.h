// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace surf {

/// What a field, as "scan.pixel_size", is called where the reader of a message sets it. `value` is
/// what the message would set it to, else empty.
using FieldWord = std::function<std::string(std::string_view field, std::string_view value)>;

/// `text` with every field in backticks, `beam.tilt` or `beam.tilt=30deg`, replaced by its word.
/// Messages of the libraries name fields so; who sets them by other names (a command line, a file,
/// a form) says them in its own words. Fields are words of small letters, digits and '_', joined by
/// dots; anything else in backticks stays as it is.
std::string with_field_words(std::string_view text, const FieldWord& word);

/// The last part of a field's name, with `space` in place of each '_': "pixel-size" of
/// "scan.pixel_size" and '-'.
std::string last_part(std::string_view field, char space);

}  // namespace surf
