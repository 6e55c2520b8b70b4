// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/material_plot.h"

#include <gtest/gtest.h>

#include "surf/io/sim/materials.h"

namespace surf::workflow {
namespace {

TEST(MaterialPlot, ShowsLossesScatteringAndYieldsOfAMaterial) {
  for (const char* const name : {"Si", "Au", "SiO2", "PMMA"}) {
    const mc::Material& m = io::find_material(name, "test");
    const io::Plot plot = plot_material(m, {.electrons = 1});
    ASSERT_EQ(plot.panels.size(), 4u) << m.name;
    EXPECT_EQ(plot.title, m.name);
    for (std::size_t i = 0; i < plot.panels.size(); ++i) {
      const io::PlotPanel& p = plot.panels[i];
      EXPECT_TRUE(p.x.log);
      EXPECT_EQ(p.y.log, i < 3);
      for (const io::PlotSeries& s : p.series) {
        ASSERT_EQ(s.x.size(), s.y.size());
        for (const double y : s.y) EXPECT_GT(y, i < 3 ? 0 : -1e-300);
      }
    }
    EXPECT_EQ(plot.panels[0].series.size(), 1u);
    EXPECT_EQ(plot.panels[1].series.size(), 4u);
    EXPECT_EQ(plot.panels[2].series.size(), 3u);
    EXPECT_EQ(plot.panels[3].series.size(), 4u);
  }
}

TEST(MaterialPlot, DrawsYieldsThatFallWithTheEnergy) {
  const io::Plot plot = plot_material(io::find_material("Al", "test"), {.electrons = 2000});
  const io::PlotSeries& se = plot.panels[3].series[0];
  EXPECT_EQ(se.name, "SE, dielectric");
  EXPECT_GT(se.y[2], 2 * se.y.back());
}

}  // namespace
}  // namespace surf::workflow
