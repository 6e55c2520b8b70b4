// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>

#include "io_test.h"
#include "some_plots.h"

namespace surf::io {
namespace {

using testing::HasSubstr;

PlotPanel picture(PlotColors colors) {
  PlotImage image;
  image.values = Grid<double>(40, 20);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x) image.values(x, y) = 1e6 + std::sin(0.3 * x) * y;
  image.values(3, 4) = std::numeric_limits<double>::quiet_NaN();
  image.pitch_x = image.pitch_y = 0.02;
  image.colors = colors;
  image.label = "nm";
  PlotPanel panel;
  panel.image = image;
  return panel;
}

TEST(PlotImage, PicturesStandBesideCharts) {
  Plot plot;
  for (const auto colors :
       {PlotColors::grey, PlotColors::heights, PlotColors::relief, PlotColors::difference})
    plot.panels.push_back(picture(colors));
  plot.panels[0].series.push_back(
      {"outline", {0, 0.5, 0.5}, {0, 0, 0.3}, {}, PlotStyle::line, false, 1});
  PlotPanel band = test::yields_panel();
  band.series[0].style = PlotStyle::band;
  band.columns = 2;
  plot.panels.push_back(band);
  plot.columns = 2;
  const test::TemporaryFolder folder;
  try {
    write_plot(folder.path() / "a.png", plot);
    write_plot(folder.path() / "b.png", plot);
  } catch (const Unsupported& error) {
    GTEST_SKIP() << error.what();
  }
  EXPECT_EQ(test::content_of(folder.path() / "a.png"), test::content_of(folder.path() / "b.png"));
  EXPECT_GT(std::filesystem::file_size(folder.path() / "a.png"), 20000u);
}

TEST(PlotImage, BadOnesAreRefused) {
  const test::TemporaryFolder folder;
  const auto complaint_of = [&](const auto& spoil) {
    Plot plot;
    plot.panels = {picture(PlotColors::grey)};
    spoil(plot.panels[0]);
    return test::complaint<InvalidInput>([&] { write_plot(folder.path() / "a.png", plot); });
  };
  EXPECT_THAT(complaint_of([](PlotPanel& p) { p.image->values = {}; }), HasSubstr("no samples"));
  EXPECT_THAT(complaint_of([](PlotPanel& p) { p.image->pitch_x = 0; }),
              HasSubstr("pitch or scale is 0"));
  EXPECT_THAT(complaint_of([](PlotPanel& p) {
                p.image->range = PlotAxis::Range{2, 1};
              }),
              HasSubstr("range of colours"));
  EXPECT_THAT(complaint_of([](PlotPanel& p) { p.x.log = true; }), HasSubstr("logarithmic"));
  EXPECT_THAT(complaint_of([](PlotPanel& p) { p.columns = 0; }), HasSubstr("columns of a panel"));
  EXPECT_THAT(complaint_of([](PlotPanel& p) {
                p.series = {{"b", {1}, {1}, {}, PlotStyle::band, false, {}}};
              }),
              HasSubstr("band without y_error"));
}

}  // namespace
}  // namespace surf::io
