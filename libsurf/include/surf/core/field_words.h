// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace surf {

/// The name of a field, such as "scan.pixel_size", in the interface where the reader of the message
/// sets it. `value` is the value that the message suggests, or empty.
using FieldWord = std::function<std::string(std::string_view field, std::string_view value)>;

/// Returns `text` with every field in backticks, `beam.tilt` or `beam.tilt=30deg`, replaced by
/// `word(field, value)`. The libraries' messages name fields; a command line, a file reader or a
/// form replaces them by its own names. A field consists of words of small letters, digits and '_',
/// joined by dots. Other text in backticks stays as it is.
std::string with_field_words(std::string_view text, const FieldWord& word);

/// The last part of a field's name, with every '_' replaced by `space`: "pixel-size" for
/// "scan.pixel_size" and '-'.
std::string last_part(std::string_view field, char space);

}  // namespace surf
