// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace surf::io {

/// A drawing in pixels, x right and y down, that becomes a PNG, SVG or PDF.
class Canvas {
 public:
  struct Point { double x, y; };
  struct Color { double red, green, blue, alpha = 1; };   ///< 0 to 1
  enum class Align { left, center, right };

  /// `extension` is ".png", ".svg" or ".pdf". `target` is the name to write to, `file` the one for
  /// messages.
  Canvas(const std::filesystem::path& target, const std::string& file,
         const std::string& extension, int width, int height);
  ~Canvas();

  void fill_rectangle(Point corner, double width, double height, Color color);
  void stroke_rectangle(Point corner, double width, double height, double line_width, Color color);
  /// One line through the points; where it crosses itself it is not darker.
  void polyline(std::span<const Point> points, double line_width, Color color);
  /// Separate straight lines, from each even point to the next.
  void segments(std::span<const Point> ends, double line_width, Color color);
  /// `at` is on the line that the letters stand on. Turned by a quarter where `upwards`.
  void text(const std::string& text, Point at, double size, Align align, Color color,
            bool bold = false, bool upwards = false);
  double text_width(const std::string& text, double size, bool bold = false);

  /// Until `unclip`, nothing is drawn outside.
  void clip(Point corner, double width, double height);
  void unclip();

  /// Writes the file; nothing can be drawn afterwards. Throws FileError.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace surf::io
