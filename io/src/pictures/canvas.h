// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "surf/core/module.h"

namespace surf::io {

/// A drawing in pixels, x right and y down, that becomes a PNG, SVG or PDF.
class Canvas {
 public:
  struct Point {
    double x, y;
  };
  struct Color {
    double red, green, blue, alpha = 1;
  };  ///< 0 to 1
  enum class Align { left, center, right };

  virtual ~Canvas() = default;

  virtual void fill_rectangle(Point corner, double width, double height, Color color) = 0;
  virtual void stroke_rectangle(Point corner, double width, double height, double line_width,
                                Color color) = 0;
  /// Draws one line through the points. It is not darker where it crosses itself.
  virtual void polyline(std::span<const Point> points, double line_width, Color color) = 0;
  /// Draws separate straight lines, from each even point to the next.
  virtual void segments(std::span<const Point> ends, double line_width, Color color) = 0;
  /// Writes text. `at` lies on the baseline. With `upwards` the text is turned by a quarter.
  virtual void text(const std::string& text, Point at, double size, Align align, Color color,
                    bool bold = false, bool upwards = false) = 0;
  virtual double text_width(const std::string& text, double size, bool bold = false) = 0;

  /// Until `unclip`, nothing is drawn outside this rectangle.
  virtual void clip(Point corner, double width, double height) = 0;
  virtual void unclip() = 0;

  /// Writes the file. Nothing can be drawn afterwards. Throws FileError.
  virtual void finish() = 0;
};

/// The function table of the module `cairo`.
struct CanvasLibrary {
  static constexpr ModuleName module{"cairo", "draws pictures of electron tracks",
                                     "Cairo (Debian: libcairo2)", 100, "semsurf-io-image"};
  /// `extension` is ".png", ".svg" or ".pdf". `target` is the path to write to, `file` the name for
  /// messages.
  std::unique_ptr<Canvas> (*make_canvas)(const std::filesystem::path& target,
                                         const std::string& file, const std::string& extension,
                                         int width, int height);
};

}  // namespace surf::io
