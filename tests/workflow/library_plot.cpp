// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/library_plot.h"

#include <cmath>
#include <numeric>

#include <gmock/gmock.h>

#include "statistics.h"
#include "surf/core/error.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/simulate.h"
#include "surf/workflow/libraries.h"

namespace surf::workflow {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::Gt;
using testing::SizeIs;

LibraryPlotOptions options_of(std::vector<double> energies_ev) {
  LibraryPlotOptions options;
  options.materials = {io::find_material("Si", "test"), io::find_material("Au", "test")};
  options.energies_ev = std::move(energies_ev);
  return options;
}

io::Plot plot_of(const LibraryPlotOptions& options) {
  CachedLibraries libraries({});
  return plot_libraries(options, libraries);
}

TEST(LibraryPlot, ShowsYieldsAgainstTheTilt) {
  LibraryPlotOptions options = options_of({150});
  options.tilts_deg = {0, 60};
  options.measured = {{"Si", 150, 0.8, false}, {"Si", 400, 0.9, false}, {"Au", 150, 0.4, true}};
  const io::Plot plot = plot_of(options);
  ASSERT_THAT(plot.panels, SizeIs(4));
  for (int i : {0, 1}) {
    const auto& panel = plot.panels[static_cast<std::size_t>(i)];
    ASSERT_THAT(panel.series, SizeIs(2));
    for (const io::PlotSeries& s : panel.series) {
      EXPECT_EQ(s.x.size(), s.y.size() + 1);
      EXPECT_NEAR(std::accumulate(s.y.begin(), s.y.end(), 0.0), 100, 1e-9);
    }
  }
  const auto& se = plot.panels[2].series;
  ASSERT_THAT(se, SizeIs(3));
  EXPECT_THAT(se[0].x, ElementsAre(0, 60));
  EXPECT_GT(se[0].y[1], se[0].y[0]) << "more come out at a slant";
  EXPECT_THAT(se[0].y_error, Each(Gt(0)));
  EXPECT_EQ(se[1].name, "Si, measured");
  EXPECT_THAT(se[1].y, ElementsAre(0.8)) << "of the energy shown alone";
  EXPECT_EQ(se[1].color, se[0].color);
  EXPECT_THAT(plot.panels[3].series, SizeIs(3));
}

TEST(LibraryPlot, ShowsRangesAndYieldsAgainstTheEnergy) {
  LibraryPlotOptions options = options_of({400, 100});
  options.measured = {{"Si", 200, 0.8, false}, {"Si", 5000, 0.9, false}};
  double last = 0;
  CachedLibraries libraries({});
  options.watch.progress = [&](double done, double total) {
    EXPECT_LE(last, done);
    EXPECT_LE(done, total);
    last = done;
  };
  const io::Plot plot = plot_libraries(options, libraries);
  EXPECT_GT(last, 0);
  ASSERT_THAT(plot.panels, SizeIs(5));
  const auto& ranges = plot.panels[2].series;
  ASSERT_THAT(ranges, SizeIs(4));
  for (const io::PlotSeries& s : ranges) {
    EXPECT_THAT(s.x, ElementsAre(0.1, 0.4));
    EXPECT_GT(s.y[1], 1.2 * s.y[0]) << s.name;
  }
  EXPECT_GT(ranges[0].y[1], ranges[2].y[1]) << "farther in silicon than in gold";
  const auto& se = plot.panels[3].series;
  ASSERT_THAT(se, SizeIs(3));
  EXPECT_THAT(se[0].x, ElementsAre(0.1, 0.4));
  EXPECT_THAT(se[1].x, ElementsAre(0.2));
}

TEST(LibraryPlot, ShowsTheYieldsOfDirectSimulation) {
  LibraryPlotOptions options = options_of({300});
  options.materials.pop_back();
  options.tilts_deg = {40};
  const io::Plot plot = plot_of(options);
  mc::Specimen specimen;
  specimen.materials = options.materials;
  specimen.substrate = mc::Substrate{};
  mc::Beam beam;
  beam.energy_ev = 300;
  beam.tilt_deg = 40;
  mc::Scan scan;
  scan.width = scan.height = 1;
  mc::SimulationOptions direct;
  direct.budget = mc::ElectronsPerPixel{10000};
  const auto result = mc::simulate(mc::Scene(specimen, beam, scan), direct);
  for (const std::size_t d : {0, 1}) {
    const io::PlotSeries& s = plot.panels[2 + d].series[0];
    const mc::Estimate e = result.yield(d, 0, 0);
    test::expect_mean(s.y[0], std::hypot(s.y_error[0], e.standard_error), e.mean, 2);
  }
}

TEST(LibraryPlot, RefusesWhatDoesNotFit) {
  CachedLibraries libraries({});
  LibraryPlotOptions options = options_of({});
  EXPECT_THROW(plot_libraries(options, libraries), UsageError);
  options = options_of({500});
  options.cascades = 0;
  EXPECT_THROW(plot_libraries(options, libraries), UsageError);
  options = options_of({500});
  options.materials.resize(9, options.materials[0]);
  EXPECT_THROW(plot_libraries(options, libraries), UsageError);
  options.materials.clear();
  EXPECT_THROW(plot_libraries(options, libraries), UsageError);
}

TEST(LibraryPlot, CanBeCancelled) {
  CachedLibraries libraries({});
  CancelToken cancel;
  cancel.cancel();
  LibraryPlotOptions options = options_of({500});
  options.watch.cancel = &cancel;
  EXPECT_THROW(plot_libraries(options, libraries), Interrupted);
}

}  // namespace
}  // namespace surf::workflow
