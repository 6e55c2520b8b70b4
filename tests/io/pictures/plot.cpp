// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/plot.h"

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>

#include "environment.h"
#include "io_test.h"
#include "some_plots.h"

namespace surf::io {
namespace {

using test::content_of;
using testing::HasSubstr;
using testing::Not;

/// Plots need Matplotlib; without it these tests are skipped.
class PlotFile : public testing::Test {
 protected:
  void SetUp() override {
    Plot plot;
    plot.panels = {test::yields_panel()};
    try {
      write_plot(folder.path() / "probe.png", plot);
    } catch (const Unsupported& error) {
      GTEST_SKIP() << error.what();
    }
  }

  std::string svg_of(const Plot& plot) {
    write_plot(folder.path() / "plot.svg", plot);
    return content_of(folder.path() / "plot.svg");
  }

  const test::TemporaryFolder folder;
};

/// Width and height of a PNG, from its header.
std::pair<unsigned, unsigned> size_of(const std::string& png) {
  const auto number = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value = value << 8 | static_cast<unsigned char>(png.at(at + i));
    return value;
  };
  return {number(16), number(20)};
}

Plot plot_of(std::vector<PlotPanel> panels) {
  Plot plot;
  plot.panels = std::move(panels);
  return plot;
}

TEST_F(PlotFile, HasTheSizeThatWasAskedFor) {
  const std::string probe = content_of(folder.path() / "probe.png");
  EXPECT_TRUE(probe.starts_with("\x89PNG\r\n"));
  EXPECT_EQ(size_of(probe), std::pair(1200u, 750u));
  Plot plot = plot_of({test::noise_panel(PlotStyle::bars), test::noise_panel(PlotStyle::steps)});
  plot.width_px = 801;
  plot.height_px = 403;
  write_plot(folder.path() / "two.PNG", plot);
  EXPECT_EQ(size_of(content_of(folder.path() / "two.PNG")), std::pair(801u, 403u));
}

TEST_F(PlotFile, HasTheSameBytesForTheSameInput) {
  for (const char* const name : {"a.svg", "probe.png"}) {
    Plot plot = plot_of({test::yields_panel()});
    if (name == std::string("a.svg")) {
      plot.title = "Four panels";
      plot.panels.push_back(test::pareto_panel());
      for (const PlotStyle style : {PlotStyle::bars, PlotStyle::steps}) {
        plot.panels.push_back(test::noise_panel(style));
      }
      write_plot(folder.path() / name, plot);
    }
    const std::string first = content_of(folder.path() / name);
    // Neither the user's settings nor the folder matter.
    test::write(folder.path() / "matplotlibrc", "lines.linewidth: 9\naxes.facecolor: red\n");
    const test::Environment environment{
        {"MATPLOTLIBRC", folder.path().c_str()}, {"LC_ALL", "C"}, {"SOURCE_DATE_EPOCH", "1"}};
    write_plot(folder.path() / "new" / name, plot);
    EXPECT_TRUE(content_of(folder.path() / "new" / name) == first) << name;
  }
  EXPECT_THAT(content_of(folder.path() / "a.svg"), Not(HasSubstr("<dc:date>")));
  EXPECT_EQ(test::files_in(folder.path() / "new"), 2);
}

TEST_F(PlotFile, ColoursFollowTheOrderOfTheSeries) {
  Plot plot = plot_of({test::yields_panel()});
  const std::string two = svg_of(plot);
  EXPECT_THAT(two, HasSubstr("#0072b2"));
  EXPECT_THAT(two, HasSubstr("#d55e00"));
  plot.panels[0].series[1].color = 2;
  const std::string chosen = svg_of(plot);
  EXPECT_THAT(chosen, HasSubstr("#009e73"));
  EXPECT_THAT(chosen, Not(HasSubstr("#d55e00")));
}

TEST_F(PlotFile, TakesTextAsItIs) {
  Plot plot = plot_of({test::yields_panel()});
  plot.title = "costs $5 and $6, \\frac{1}{2}, 5 % & <b>";
  plot.panels[0].series[0].name = "_hidden";
  plot.panels[0].series[1].name = "$x^{$";
  plot.panels[0].notes = {{"two\nlines", 1000, 1}, {"bad \xFF byte", 2000, 1}};
  const std::string svg = svg_of(plot);
  EXPECT_THAT(svg, HasSubstr("costs $5 and $6, \\frac{1}{2}, 5 % &amp; &lt;b&gt;"));
  EXPECT_THAT(svg, HasSubstr("\"DejaVuSans-Bold-24\"")) << "the letter $ is drawn";
  for (const char* const name : {"_hidden", "$x^{$", "one for one", "maximum"}) {
    EXPECT_THAT(svg, HasSubstr(std::string("<!-- ") + name + " -->"));
  }
}

TEST_F(PlotFile, LegendsListWhatHasAName) {
  Plot plot = plot_of({test::yields_panel()});
  const std::string all = svg_of(plot);
  for (const char* const name : {"SE", "BSE", "one for one", "maximum"}) {
    EXPECT_THAT(all, HasSubstr(std::string("<!-- ") + name + " -->"));
  }
  plot.panels[0].series[1].name = "";
  EXPECT_THAT(svg_of(plot), Not(HasSubstr("<!-- BSE -->")));
  plot.panels[0].legend = false;
  EXPECT_THAT(svg_of(plot), Not(HasSubstr("legend_1")));
}

struct Box {
  double x0, y0, x1, y1;
};

/// The frame of the legend, in the units of the SVG.
Box legend_of(const std::string& svg) {
  Box box{1e9, 1e9, -1e9, -1e9};
  const std::string rest = svg.substr(svg.find("id=\"legend_1\""));
  const std::size_t path = rest.find(" d=\"");
  const std::string outline = rest.substr(path, rest.find('"', path + 4) - path);
  const std::regex corner("([0-9.]+) ([0-9.]+)");
  for (std::sregex_iterator i(outline.begin(), outline.end(), corner), end; i != end; ++i) {
    const double x = std::stod((*i)[1]), y = std::stod((*i)[2]);
    box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x), std::max(box.y1, y)};
  }
  return box;
}

/// Markers of data and of ticks under the legend.
int covered(const std::string& svg) {
  const Box box = legend_of(svg);
  EXPECT_LT(box.x0, box.x1);
  const std::string before = svg.substr(0, svg.find("id=\"legend_1\""));
  const std::regex marker("<use [^>]*x=\"([-0-9.]+)\" y=\"([-0-9.]+)\"");
  int inside = 0;
  for (std::sregex_iterator i(before.begin(), before.end(), marker), end; i != end; ++i) {
    const double x = std::stod((*i)[1]), y = std::stod((*i)[2]);
    inside += box.x0 < x && x < box.x1 && box.y0 < y && y < box.y1;
  }
  return inside;
}

TEST_F(PlotFile, LegendsCoverNoPoints) {
  // Points everywhere except in one place, and points everywhere.
  for (const int free : {0, 3, -1}) {
    PlotSeries series;
    series.name = "a name of some length";
    series.style = PlotStyle::points;
    for (int x = 0; x < 30; ++x) {
      for (int y = 0; y < 30; ++y) {
        if (free == (x >= 15 ? 1 : 0) + (y >= 15 ? 2 : 0)) continue;
        series.x.push_back(x);
        series.y.push_back(y);
      }
    }
    Plot plot = plot_of({{}});
    plot.panels[0].series = {series};
    EXPECT_EQ(covered(svg_of(plot)), 0) << "free corner " << free;
    plot.panels[0].y.range = PlotAxis::Range{-1, 30};
    EXPECT_EQ(covered(svg_of(plot)), 0) << "free corner " << free << ", a range that stays";
  }
}

/// As a chart of time against error: four falling lines close together, a reference across them,
/// named points, and a legend that finds no room inside.
PlotPanel crowded_panel(bool legend) {
  PlotPanel panel;
  panel.x = {"time (s)", true, {}};
  for (int line = 0; line < 4; ++line) {
    PlotSeries series;
    series.name = "method " + std::to_string(line) + " with a long name, to an accuracy";
    series.style = PlotStyle::line_points;
    for (int i = 0; i < 6; ++i) {
      series.x.push_back(std::pow(10, -1 + 0.4 * i - 0.2 * line));
      series.y.push_back(60 / std::sqrt(series.x.back() * (1 + line)));
    }
    panel.series.push_back(series);
  }
  panel.y = {"rms error (%)", true, PlotAxis::Range{9, 340}};
  panel.references = {{PlotDirection::horizontal, 22, "noise of the reference"}};
  panel.notes = {{"the scene's default", panel.series[1].x[2], panel.series[1].y[2]}};
  for (const int i : {1, 3, 5})
    panel.notes.push_back({"--accuracy " + std::to_string(i) + " %",
                           panel.series[2].x[static_cast<std::size_t>(i)],
                           panel.series[2].y[static_cast<std::size_t>(i)]});
  panel.legend = legend;
  return panel;
}

TEST_F(PlotFile, TextsCoverNothing) {
  const char* const python = std::getenv("SEMSURF_PYTHON");
  const auto report = folder.path() / "report.json";
  const std::string interpreter = python && *python ? python
                                  : std::filesystem::exists("/usr/bin/python3")
                                      ? "/usr/bin/python3"
                                      : "python3";  // as plot.cpp looks for it
  const auto script =
      test::write(folder.path() / "python",
                  "#!/bin/sh\nexec " + interpreter + " \"$@\" '" + report.string() + "'\n");
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  const std::string name = script.string();
  const test::Environment environment{{"SEMSURF_PYTHON", name.c_str()}};
  Plot plot = plot_of(
      {crowded_panel(false), crowded_panel(true), crowded_panel(false), crowded_panel(false)});
  plot.columns = 2;
  plot.width_px = 1800;
  write_plot(folder.path() / "plot.svg", plot);
  const auto told = nlohmann::json::parse(content_of(report));
  ASSERT_EQ(told.size(), 4 * 4 + 1u);  // all notes, and the legend
  for (const auto& text : told) EXPECT_EQ(text["covers"], 0) << text["text"];
}

}  // namespace
}  // namespace surf::io
