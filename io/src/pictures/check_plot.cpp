// SPDX-License-Identifier: GPL-3.0-or-later
#include "check_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "surf/core/error.h"

namespace surf::io {
namespace {

bool is_histogram(const PlotSeries& series) {
  return series.style == PlotStyle::steps || series.style == PlotStyle::bars;
}

/// NaN without its sign, which means nothing.
std::string text_of(double value) { return std::isnan(value) ? "nan" : fmt::format("{}", value); }

/// Checks one panel and says where something is wrong in it.
class PanelCheck {
 public:
  PanelCheck(const PlotPanel& panel, std::string place) : panel_(panel), place_(std::move(place)) {}

  void check() const {
    if (panel_.series.empty() && !panel_.image)
      fail(place_, "a panel without series cannot be drawn", "Add one");
    if (panel_.image) check_image(*panel_.image);
    check_range(panel_.x, "x");
    check_range(panel_.y, "y");
    for (std::size_t i = 0; i < panel_.series.size(); ++i) {
      const std::string& name = panel_.series[i].name;
      check_series(panel_.series[i], fmt::format("{}, series {}{}", place_, i + 1,
                                                 name.empty() ? "" : " '" + name + "'"));
    }
    for (const PlotNote& note : panel_.notes) {
      const std::string place = fmt::format("{}, note '{}'", place_, note.text);
      check_value(note.x, panel_.x, place, "its x");
      check_value(note.y, panel_.y, place, "its y");
    }
    for (const PlotReference& line : panel_.references) {
      check_value(line.at, axis_of(line.direction),
                  fmt::format("{}, reference line '{}'", place_, line.name), "its place");
    }
    for (const PlotBand& band : panel_.bands) {
      const std::string place = fmt::format("{}, band '{}'", place_, band.name);
      check_value(band.from, axis_of(band.direction), place, "its begin");
      check_value(band.to, axis_of(band.direction), place, "its end");
      if (!(band.from < band.to)) fail(place, "it is empty", "Give from < to");
    }
  }

 private:
  [[noreturn]] static void fail(const std::string& place, const std::string& reason,
                                const std::string& remedy) {
    throw InvalidInput(place, reason, remedy);
  }

  /// A vertical thing has its place on the x axis.
  const PlotAxis& axis_of(PlotDirection direction) const {
    return direction == PlotDirection::vertical ? panel_.x : panel_.y;
  }

  static void check_value(double value, const PlotAxis& axis, const std::string& place,
                          const std::string& what) {
    if (!std::isfinite(value)) {
      fail(place, fmt::format("{} is {}", what, text_of(value)), "Leave out what is not finite");
    }
    if (axis.log && value <= 0) {
      fail(place, fmt::format("{} is {}, which a logarithmic axis does not have", what, value),
           "Give positive values or a linear axis");
    }
  }

  void check_range(const PlotAxis& axis, const std::string& name) const {
    if (!axis.range) return;
    const std::string place = fmt::format("{}, range of {}", place_, name);
    check_value(axis.range->from, axis, place, "its begin");
    check_value(axis.range->to, axis, place, "its end");
    if (!(axis.range->from < axis.range->to)) fail(place, "it is empty", "Give from < to");
  }

  void check_image(const PlotImage& image) const {
    const std::string place = fmt::format("{}, image", place_);
    if (image.values.empty()) fail(place, "it has no samples", "Leave it out");
    for (const double length : {image.pitch_x, image.pitch_y, image.lit_per_unit})
      if (!(length > 0) || !std::isfinite(length))
        fail(place, fmt::format("its pitch or scale is {}", text_of(length)),
             "Give lengths above 0");
    for (const double origin : {image.origin_x, image.origin_y})
      if (!std::isfinite(origin)) fail(place, "its origin is not finite", "Give its place");
    if (panel_.x.log || panel_.y.log) fail(place, "its axes are logarithmic", "Use linear ones");
    if (image.range && !(image.range->from < image.range->to &&
                         std::isfinite(image.range->to - image.range->from)))
      fail(place, "its range of colours is empty", "Give from < to");
  }

  void check_series(const PlotSeries& series, const std::string& place) const {
    if (series.y.empty()) fail(place, "it has no values", "Give at least one, or leave it out");
    check_lengths(series, place);
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      check_value(series.x[i], panel_.x, place, fmt::format("x[{}]", i));
    }
    for (std::size_t i = 0; i < series.y.size(); ++i) {
      check_value(series.y[i], panel_.y, place, fmt::format("y[{}]", i));
    }
    for (std::size_t i = 0; i < series.y_error.size(); ++i) {
      if (series.y_error[i] >= 0 && std::isfinite(series.y_error[i])) continue;
      fail(place, fmt::format("y_error[{}] is {}", i, text_of(series.y_error[i])),
           "Give finite half lengths, not negative");
    }
    if (series.color && (*series.color < 0 || *series.color > 7)) {
      fail(place, fmt::format("there is no colour {}", *series.color), "Give 0 to 7");
    }
  }

  static void check_lengths(const PlotSeries& series, const std::string& place) {
    const std::size_t expected = series.y.size() + (is_histogram(series) ? 1 : 0);
    if (series.x.size() != expected) {
      fail(place, fmt::format("it has {} x for {} y", series.x.size(), series.y.size()),
           fmt::format("Give {}{}", expected,
                       is_histogram(series) ? ", the edges of the bins" : ""));
    }
    if (series.style == PlotStyle::band && series.y_error.empty())
      fail(place, "it is a band without y_error", "Give its half width at each x");
    if (!series.y_error.empty() && series.y_error.size() != series.y.size()) {
      fail(place, fmt::format("it has {} y_error for {} y", series.y_error.size(), series.y.size()),
           "Give none or one for each");
    }
    if (is_histogram(series) &&
        std::adjacent_find(series.x.begin(), series.x.end(),
                           [](double a, double b) { return a >= b; }) != series.x.end()) {
      fail(place, "the edges of its bins do not increase", "Sort them and leave out empty bins");
    }
  }

  const PlotPanel& panel_;
  std::string place_;
};

void check_size(int value, int least, int most, const char* name, const std::string& file) {
  if (value >= least && value <= most) return;
  throw InvalidInput(file, fmt::format("a plot with {} = {} cannot be drawn", name, value),
                     fmt::format("Give {} to {}", least, most));
}

}  // namespace

void check_plot(const Plot& plot, const std::string& file) {
  if (plot.panels.empty()) throw InvalidInput(file, "the plot has no panels", "Add one");
  check_size(plot.width_px, 300, 10000, "width_px", file);
  if (plot.height_px != 0) check_size(plot.height_px, 200, 10000, "height_px", file);
  if (plot.columns != 0) check_size(plot.columns, 1, 100, "columns", file);
  for (std::size_t i = 0; i < plot.panels.size(); ++i) {
    check_size(plot.panels[i].columns, 1, 100, "columns of a panel", file);
    PanelCheck(plot.panels[i], fmt::format("{}, panel {}", file, i + 1)).check();
  }
}

}  // namespace surf::io
