// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <functional>
#include <limits>

#include "environment.h"
#include "io_test.h"
#include "some_plots.h"

namespace surf::io {
namespace {

using test::complaint;
using testing::AllOf;
using testing::HasSubstr;

Plot good_plot() {
  Plot plot;
  plot.panels = {test::yields_panel(), test::noise_panel(PlotStyle::bars)};
  return plot;
}

TEST(PlotErrors, SayWhatIsWrongAndWhere) {
  struct Case {
    std::function<void(Plot&)> spoil;
    std::string place, reason;
  };
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const std::string first = "panel 1, series 1 'SE'", second = "panel 2, series 1 'measured'";
  const std::vector<Case> cases = {
      {[](Plot& p) { p.panels.clear(); }, "a.svg", "no panels"},
      {[](Plot& p) { p.width_px = 299; }, "a.svg", "width_px = 299"},
      {[](Plot& p) { p.height_px = 10001; }, "a.svg", "height_px = 10001"},
      {[](Plot& p) { p.columns = -1; }, "a.svg", "columns = -1"},
      {[](Plot& p) { p.panels[1].series.clear(); }, "panel 2", "without series"},
      {[](Plot& p) { p.panels[0].series[0] = {}; }, "panel 1, series 1", "no values"},
      {[&](Plot& p) { p.panels[0].series[0].y[3] = -nan; }, first, "y[3] is nan"},
      {[&](Plot& p) { p.panels[0].series[0].x[2] = infinity; }, first, "x[2] is inf"},
      {[](Plot& p) { p.panels[0].series[0].x[0] = 0; }, first, "x[0] is 0, which a logarithmic"},
      {[](Plot& p) {
         p.panels[1].y.log = true;
         p.panels[1].series[0].y[5] = 0;
       },
       second, "which a logarithmic axis does not have"},
      {[](Plot& p) { p.panels[0].series[0].x.pop_back(); }, first, "x for"},
      {[](Plot& p) { p.panels[1].series[0].x.pop_back(); }, second, "edges of the bins"},
      {[](Plot& p) { p.panels[1].series[0].x[1] = -4; }, second, "do not increase"},
      {[](Plot& p) { p.panels[0].series[0].y_error.pop_back(); }, first, "y_error for"},
      {[](Plot& p) { p.panels[0].series[0].y_error[1] = -0.1; }, first, "y_error[1] is -0.1"},
      {[&](Plot& p) { p.panels[0].series[0].y_error[1] = nan; }, first, "y_error[1] is nan"},
      {[](Plot& p) { p.panels[0].series[0].color = 8; }, first, "no colour 8"},
      {[](Plot& p) {
         p.panels[0].notes = {{"here", -1, 1}};
       },
       "note 'here'", "its x is -1"},
      {[&](Plot& p) {
         p.panels[0].notes = {{"here", 1, nan}};
       },
       "note 'here'", "its y is nan"},
      {[&](Plot& p) { p.panels[0].references[0].at = nan; }, "'one for one'", "its place is nan"},
      {[](Plot& p) { p.panels[0].bands[0].from = 0; }, "band 'maximum'", "its begin is 0"},
      {[](Plot& p) { p.panels[0].bands[0].to = 300; }, "band 'maximum'", "empty"},
      {[](Plot& p) {
         p.panels[0].x.range = {{0, 1}};
       },
       "range of x", "its begin is 0"},
      {[](Plot& p) {
         p.panels[0].y.range = {{1, 1}};
       },
       "range of y", "empty"},
  };
  const test::TemporaryFolder folder;
  for (const Case& c : cases) {
    Plot plot = good_plot();
    c.spoil(plot);
    EXPECT_THAT(complaint<InvalidInput>([&] { write_plot(folder.path() / "a.svg", plot); }),
                AllOf(HasSubstr(c.place), HasSubstr(c.reason)));
  }
  EXPECT_EQ(test::files_in(folder.path()), 0);
}

TEST(PlotErrors, UnknownExtensionsAndPlacesAreRefused) {
  const test::TemporaryFolder folder;
  for (const char* const name : {"a.pdf", "a"}) {
    const auto path = folder.path() / name;
    EXPECT_THAT(complaint<UsageError>([&] { write_plot(path, good_plot()); }),
                HasSubstr("Use .svg or .png"));
    complaint<UsageError>([&] { check_plot_target(path); });
  }
  test::write(folder.path() / "file", "");
  const auto below = folder.path() / "file" / "a.png";
  complaint<FileError>([&] { write_plot(below, good_plot()); });
  complaint<FileError>([&] { check_plot_target(below); });
  check_plot_target(folder.path() / "a.png");
  EXPECT_EQ(test::files_in(folder.path()), 1);
}

/// A stand-in for Python that prints a text to its standard error and ends with a code.
std::filesystem::path stand_in(const std::filesystem::path& folder, const std::string& script) {
  const auto path = test::write(folder / "python", "#!/bin/sh\n" + script + "\n");
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

std::string attempt_with(const std::filesystem::path& folder, const std::string& python) {
  const test::Environment environment{{"SEMSURF_PYTHON", python.c_str()}};
  std::string message;
  try {
    write_plot(folder / "a.png", good_plot());
  } catch (const Unsupported& error) {
    message = std::string("unsupported: ") + error.what();
  } catch (const FileError& error) {
    message = std::string("file: ") + error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
  return message;
}

TEST(PlotErrors, WithoutMatplotlibTheRemedyIsTold) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(attempt_with(folder.path(), "/nonexistent/python3"),
              AllOf(HasSubstr("unsupported: "), HasSubstr("/nonexistent/python3 cannot be run"),
                    HasSubstr("python3-matplotlib"), HasSubstr("SEMSURF_PYTHON")));
  EXPECT_THAT(attempt_with(folder.path(), stand_in(folder.path(), "exit 3")),
              AllOf(HasSubstr("unsupported: "), HasSubstr("has no Matplotlib")));
}

TEST(PlotErrors, WhatThePythonSaysIsPassedOn) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(attempt_with(folder.path(), stand_in(folder.path(), "exit 5")),
              AllOf(HasSubstr("file: "), HasSubstr("exit code 5")));
  EXPECT_THAT(attempt_with(folder.path(), stand_in(folder.path(), "exit 0")),
              AllOf(HasSubstr("file: "), HasSubstr("exit code 0")))
      << "and no picture";
  EXPECT_THAT(attempt_with(folder.path(),
                           stand_in(folder.path(), "echo trace >&2; echo No space >&2; exit 1")),
              AllOf(HasSubstr("file: "), HasSubstr(": No space)")));
  EXPECT_THAT(attempt_with(folder.path(), stand_in(folder.path(), "kill -9 $$")),
              HasSubstr("exit code 137"));
  // Far more than a pipe holds.
  EXPECT_THAT(
      attempt_with(folder.path(),
                   stand_in(folder.path(), "yes | head -c 300000 >&2; echo end >&2; exit 1")),
      HasSubstr(": end)"));
  EXPECT_EQ(test::files_in(folder.path()), 1) << "the stand-in alone";
}

}  // namespace
}  // namespace surf::io
