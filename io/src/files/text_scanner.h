// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace surf::io {

/// A word made short and printable, for messages.
std::string shown(std::string_view word);

/// Walks through a text file without copying it. Numbers do not cross the end of a line. Every
/// failure is a FileError that names the file and the line.
class TextScanner {
 public:
  struct Syntax {
    char comment = '\0';        ///< begins a comment to the end of the line; 0: none
    bool continuation = false;  ///< a backslash at the end of a line joins it with the next
  };

  TextScanner(std::string file, std::string_view text) : TextScanner(file, text, Syntax{}) {}
  TextScanner(std::string file, std::string_view text, Syntax syntax);

  /// Whether nothing is left on this line.
  bool at_line_end();
  /// Goes to the next line that is not empty; false at the end of the text.
  bool next_filled_line();
  /// Whether only blanks and comments are left.
  bool at_end();
  void skip_line();

  /// The next word of this line; empty at the end of the line.
  std::string_view word();
  /// The next word of this or a later line; empty at the end of the text.
  std::string_view word_on_any_line();

  /// A finite number. `what` completes "expected ...".
  double number(std::string_view what);
  std::int64_t integer(std::string_view what);

  /// Throws unless nothing is left on this line.
  void expect_line_end(std::string_view what);

  std::size_t position() const { return position_; }
  void go_to(std::size_t position) { position_ = position; }

  [[noreturn]] void fail(const std::string& reason, const std::string& remedy = {}) const;

 private:
  void skip_blanks();
  [[noreturn]] void fail_expected(std::string_view what, std::string_view found) const;

  std::string file_;
  std::string_view text_;
  Syntax syntax_;
  std::size_t position_ = 0;
};

}  // namespace surf::io
