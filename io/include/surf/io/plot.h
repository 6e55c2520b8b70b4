// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/grid.h"

namespace surf::io {

/// All text is plain: UTF-8, no markup; "\n" begins a new line.
struct PlotAxis {
  std::string label;  ///< with its unit: "energy (eV)"
  bool log = false;   ///< logarithmic: everything drawn on it has to be positive
  struct Range {
    double from, to;
  };
  std::optional<Range> range;  ///< from < to, finite; by default what holds all data, with a margin
};

enum class PlotStyle {
  line,  ///< from point to point in the order given
  points,
  line_points,
  steps,  ///< a histogram's outline: x holds the edges of the bins
  bars,   ///< the same, filled
  band,   ///< what lies within y_error of y, shaded
};

/// Values to draw. Colours and markers follow the order of the series; the colours can be told
/// apart by the colour-blind (Okabe and Ito 2008), and repeat after eight.
struct PlotSeries {
  std::string name;       ///< in the legend; empty: not listed there
  std::vector<double> x;  ///< finite; as many as y, or one more and increasing: edges of bins
  std::vector<double> y;  ///< finite, at least one
  std::vector<double>
      y_error;  ///< half lengths of the error bars, not negative: none or one for each y
  PlotStyle style = PlotStyle::line;
  bool dashed = false;
  std::optional<int> color;  ///< 0 to 7 in the order of the palette; by default the next one
};

/// A text beside the point (x, y), where it covers as little as possible.
struct PlotNote {
  std::string text;
  double x = 0, y = 0;
};

enum class PlotDirection { vertical, horizontal };

/// A thin line through the whole panel.
struct PlotReference {
  PlotDirection direction = PlotDirection::horizontal;
  double at = 0;     ///< x of a vertical one, y of a horizontal one
  std::string name;  ///< in the legend; empty: not listed there
};

/// A shaded stripe through the whole panel.
struct PlotBand {
  PlotDirection direction = PlotDirection::horizontal;
  double from = 0, to = 0;  ///< from < to
  std::string name;         ///< in the legend; empty: not listed there
};

enum class PlotColors {
  grey,        ///< low dark, high light
  heights,     ///< perceptually even, dark blue to yellow
  relief,      ///< heights, lit from the upper left; `lit_per_unit` says how steep they are
  difference,  ///< 0 white, below blue, above red; the range is made symmetric
};

/// A picture on the axes: a grid of values in colours, with a scale beside it. Both axes have one
/// scale.
struct PlotImage {
  Grid<double> values;                ///< sample (0, 0) lower-left; what is not finite stays blank
  double pitch_x = 1, pitch_y = 1;    ///< > 0, in the axes' unit
  double origin_x = 0, origin_y = 0;  ///< centre of sample (0, 0)
  PlotColors colors = PlotColors::grey;
  std::optional<PlotAxis::Range>
      range;                ///< of the colours; by default the 0.5 and 99.5 percentiles
  std::string label;        ///< of the colours, with the unit
  double lit_per_unit = 1;  ///< of relief: the axes' unit in one unit of the values, > 0
};

struct PlotPanel {
  std::string title;
  PlotAxis x, y;
  std::optional<PlotImage> image;  ///< under everything else
  std::vector<PlotSeries> series;  ///< at least one where there is no image
  std::vector<PlotNote> notes;
  std::vector<PlotReference> references;
  std::vector<PlotBand> bands;
  bool legend = true;  ///< where it covers least, else beside the panel; none without names
  int columns = 1;     ///< of the plot's that it takes; it begins a new row where too few are left
};

struct Plot {
  std::string title;              ///< above all panels
  std::vector<PlotPanel> panels;  ///< at least one; by rows
  int columns = 0;                ///< of panels, at least 1; 0: one to three beside each other
  int width_px = 1200;  ///< of a PNG, 300 to 10000; text grows with it. An SVG is 8 inches
  int height_px = 0;    ///< 200 to 10000; 0: what suits the panels
  /// How it was made, kept in the file as its description: lines "key = value".
  std::map<std::string, std::string> metadata = {};
};

/// Draws charts by extension, .svg or .png; the same plot gives the same bytes with one version of
/// Matplotlib. Letters of an SVG are outlines, so that it looks the same everywhere.
/// Matplotlib does the drawing in a process of its own, without a display: by the Python that
/// $SEMSURF_PYTHON names, else by /usr/bin/python3 or by the `python3` of the search path.
/// The file appears under its name only when it is complete. Throws UsageError for another
/// extension, InvalidInput for data outside the limits above, Unsupported where there is no
/// Python with Matplotlib, FileError.
void write_plot(const std::filesystem::path& path, const Plot& plot);

/// Throws what `write_plot` would for the name or folder, before any work is spent.
void check_plot_target(const std::filesystem::path& path);

}  // namespace surf::io
