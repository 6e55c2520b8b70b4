// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace surf::io {

/// Decodes base64 (RFC 4648), with or without padding; blanks and line ends are skipped. Returns
/// nothing if the text is not base64.
std::optional<std::string> decode_base64(std::string_view text);

/// Encodes base64 with padding, in one line.
std::string encode_base64(std::string_view bytes);

/// Decodes base64 piece by piece from the front. Padding may occur in the middle, where one encoded
/// piece ends and the next begins.
class Base64Reader {
 public:
  explicit Base64Reader(std::string_view text) : text_(text) {}

  /// Returns the next `bytes` bytes, or nothing if the text ends before or is not base64.
  std::optional<std::string> take(std::size_t bytes);
  /// An upper limit for the number of remaining bytes.
  std::size_t most() const { return held_.size() + (text_.size() - position_) / 4 * 3 + 3; }

 private:
  bool next_group();

  std::string_view text_;
  std::size_t position_ = 0;
  std::string held_;  // decoded bytes that have not been taken yet
};

}  // namespace surf::io
