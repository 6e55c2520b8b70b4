// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/material_plot.h"

#include <gtest/gtest.h>

#include "surf/io/sim/materials.h"

namespace surf::workflow {
namespace {

TEST(MaterialPlot, ShowsLossesAndScatteringOfEveryMaterial) {
  for (const mc::Material& m : io::builtin_materials()) {
    const io::Plot plot = plot_material(m);
    ASSERT_EQ(plot.panels.size(), 3u) << m.name;
    EXPECT_EQ(plot.title, m.name);
    for (const io::PlotPanel& p : plot.panels) {
      EXPECT_TRUE(p.x.log && p.y.log);
      for (const io::PlotSeries& s : p.series) {
        ASSERT_EQ(s.x.size(), s.y.size());
        for (const double y : s.y) EXPECT_GT(y, 0);
      }
    }
    EXPECT_EQ(plot.panels[0].series.size(), 1u);
    EXPECT_EQ(plot.panels[1].series.size(), 2u);
    EXPECT_EQ(plot.panels[2].series.size(), 2u);
  }
}

TEST(MaterialPlot, ShowsWhatSimulationsUseWhereThereIsNoEnergyLossFunction) {
  mc::Material mine = io::find_material("Si", "test");
  mine.name = "mine";
  const io::Plot plot = plot_material(mine);
  ASSERT_EQ(plot.panels.size(), 2u);
  EXPECT_EQ(plot.panels[0].series.size(), 1u);
  EXPECT_EQ(plot.panels[1].series.size(), 1u);
}

}  // namespace
}  // namespace surf::workflow
