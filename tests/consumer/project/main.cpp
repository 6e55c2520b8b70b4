// SPDX-License-Identifier: GPL-3.0-or-later
// A gold sphere of 50 nm on a 4 x 4 grid at 1 keV: prints the mean yields.
#include <cstdio>

#include "surf/mc/physics/material_draft.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/shapes.h"

int main() {
  using namespace surf;
  mc::MaterialDraft gold;  // what is not given here is estimated
  gold.name = "Au";
  gold.density_g_cm3 = 19.3;
  gold.formula = mc::parse_formula("Au", "gold");
  gold.work_function_ev = 5.1;

  mc::Specimen specimen;
  specimen.materials = {mc::complete(gold)};
  specimen.bodies = {{.name = "sphere", .mesh = make_sphere({0, 0, 50}, 50), .material = 0}};

  const mc::Beam beam{.energy_ev = 1000};
  const mc::Scan scan{.width = 4, .height = 4, .pixel_x_nm = 10, .pixel_y_nm = 10};
  const mc::Scene scene(specimen, beam, scan);
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{50};
  const auto result = mc::simulate(scene, options);
  const auto& b = result.balance;
  std::printf("yield SE %.3f BSE %.3f\n", double(b.se) / double(b.incident),
              double(b.bse) / double(b.incident));
  return b.incident == 800 && b.bse > 0 ? 0 : 1;
}
