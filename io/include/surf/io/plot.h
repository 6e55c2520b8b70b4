// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/grid.h"

namespace surf::io {

/// An axis. All texts are plain UTF-8 without markup; "\n" begins a new line.
struct PlotAxis {
  std::string label;  ///< with its unit: "energy (eV)"
  bool log = false;   ///< logarithmic: all values drawn on it must be positive
  struct Range {
    double from, to;
  };
  std::optional<Range> range;  ///< from < to, finite; absent: the range of all data, with a margin
};

enum class PlotStyle {
  line,  ///< from point to point in the order given
  points,
  line_points,
  steps,  ///< a histogram's outline: x holds the edges of the bins
  bars,   ///< a histogram's outline, filled
  band,   ///< a shaded band from y - y_error to y + y_error
};

/// Values to draw. Colours and markers follow the order of the series. The colours can be told
/// apart by colour-blind readers (Okabe and Ito 2008) and repeat after eight.
struct PlotSeries {
  std::string name;             ///< in the legend; empty: not listed there
  std::vector<double> x;        ///< finite; as many as y, or one more and increasing: bin edges
  std::vector<double> y;        ///< finite, at least one
  std::vector<double> y_error;  ///< half lengths of the error bars, >= 0: none, or one for each y
  PlotStyle style = PlotStyle::line;
  bool dashed = false;
  std::optional<int> color;  ///< 0 to 7, index in the palette; absent: the next one
};

/// A text beside the point (x, y), placed where it covers as little as possible.
struct PlotNote {
  std::string text;
  double x = 0, y = 0;
};

enum class PlotDirection { vertical, horizontal };

/// A thin line across the whole panel.
struct PlotReference {
  PlotDirection direction = PlotDirection::horizontal;
  double at = 0;     ///< x of a vertical line, y of a horizontal one
  std::string name;  ///< in the legend; empty: not listed there
};

/// A shaded stripe across the whole panel.
struct PlotBand {
  PlotDirection direction = PlotDirection::horizontal;
  double from = 0, to = 0;  ///< from < to
  std::string name;         ///< in the legend; empty: not listed there
};

enum class PlotColors {
  grey,        ///< low dark, high light
  heights,     ///< perceptually even, dark blue to yellow
  relief,      ///< heights, lit from the upper left; `lit_per_unit` gives their steepness
  difference,  ///< 0 is white, negative blue, positive red; the range is made symmetric
};

/// A picture on the axes: a grid of values in colours, with a colour scale beside it. Both axes
/// have the same scale.
struct PlotImage {
  Grid<double> values;  ///< sample (0, 0) is lower-left; values that are not finite stay blank
  double pitch_x = 1, pitch_y = 1;    ///< > 0, in the axes' unit
  double origin_x = 0, origin_y = 0;  ///< centre of sample (0, 0)
  PlotColors colors = PlotColors::grey;
  /// Range of the colours; absent: the 0.5 and 99.5 percentiles.
  std::optional<PlotAxis::Range> range;
  std::string label;        ///< of the colour scale, with its unit
  double lit_per_unit = 1;  ///< for relief: how many axis units make one unit of the values, > 0
};

struct PlotPanel {
  std::string title;
  PlotAxis x, y;
  std::optional<PlotImage> image;  ///< drawn below everything else
  std::vector<PlotSeries> series;  ///< at least one if there is no image
  std::vector<PlotNote> notes;
  std::vector<PlotReference> references;
  std::vector<PlotBand> bands;
  bool legend = true;  ///< placed where it covers least, else beside the panel; none without names
  int columns = 1;  ///< columns of the plot that it spans; it begins a new row if too few are left
};

struct Plot {
  std::string title;              ///< above all panels
  std::vector<PlotPanel> panels;  ///< at least one; by rows
  int columns = 0;                ///< panels per row, at least 1; 0: chosen, one to three
  /// 300 to 10000, of a PNG; text grows with it. An SVG of 1, 2 or more columns is 8, 11 or 14
  /// inches wide.
  int width_px = 1200;
  int height_px = 0;  ///< 200 to 10000; 0: chosen to suit the panels
  /// How the plot was made: stored in the file as its description, in lines "key = value".
  std::map<std::string, std::string> metadata = {};
};

/// Draws charts in the format of the extension, .svg or .png. The same plot gives the same bytes
/// with one version of Matplotlib. Letters in an SVG are outlines, so that it looks the same
/// everywhere.
/// Matplotlib draws in a process of its own, without a display, run by the Python that
/// $SEMSURF_PYTHON names, else by /usr/bin/python3 or by the `python3` of the search path.
/// The file appears under its name only when it is complete. Throws UsageError for another
/// extension, InvalidInput for data outside the limits above, Unsupported if there is no Python
/// with Matplotlib, FileError.
void write_plot(const std::filesystem::path& path, const Plot& plot);

/// Throws what `write_plot` would throw for the name or folder, before any work is spent.
void check_plot_target(const std::filesystem::path& path);

}  // namespace surf::io
