// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace surf::io {

/// Decodes base64 (RFC 4648) with or without padding; blanks and line ends are skipped. Nothing for
/// text that is not base64.
std::optional<std::string> decode_base64(std::string_view text);

/// Base64 with padding, in one line.
std::string encode_base64(std::string_view bytes);

/// Decodes base64 from the front, as much as is asked for. Padding may stand in the middle, where
/// one encoded piece ends and the next begins.
class Base64Reader {
 public:
  explicit Base64Reader(std::string_view text) : text_(text) {}

  /// The next `bytes` bytes; nothing where the text ends before or is not base64.
  std::optional<std::string> take(std::size_t bytes);
  /// No fewer bytes than there can still be.
  std::size_t most() const { return held_.size() + (text_.size() - position_) / 4 * 3 + 3; }

 private:
  bool next_group();

  std::string_view text_;
  std::size_t position_ = 0;
  std::string held_;  // decoded, not yet taken
};

}  // namespace surf::io
