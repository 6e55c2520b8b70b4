// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration_outcomes.h"

namespace surf::limits {

std::vector<double> registered_from(
    const std::function<Affine(const Affine&, RandomStream&)>& start) {
  constexpr std::uint64_t scenes = 12;
  Outcomes usual, narrow;
  for (std::uint64_t seed = 1; seed <= scenes; ++seed) {
    const SpotScene scene(seed);
    RandomStream random(seed, 7, 7);
    RegistrationOptions options;
    options.start = start(scene.truth, random);
    const Registration r = register_images(scene.sem, scene.simulated, options);
    usual.add(r, scene.error_px(r.sem_to_afm));
    options.blurs_px = {2, 1, 0};
    const Registration n = register_images(scene.sem, scene.simulated, options);
    narrow.add(n, scene.error_px(n.sem_to_afm));
  }
  std::vector<double> row = usual.shares();
  row.push_back(narrow.verified_right());
  row.push_back(narrow.verified_wrong());
  return row;
}

std::vector<std::string> columns_from_starts() {
  return {"verified_right", "verified_wrong",        "ambiguous",
          "refused",        "narrow_verified_right", "narrow_verified_wrong"};
}

io::PlotPanel panel_of_starts(const Table& t, const std::string& title, const io::PlotAxis& x) {
  return panel(t, title, x, {"share of 12 scenes", false, io::PlotAxis::Range{-0.04, 1.04}},
               {{"verified_right", "right, verified"},
                {"verified_wrong", "WRONG, verified"},
                {"ambiguous", "ambiguous"},
                {"refused", "unconverged or unrelated"},
                {"narrow_verified_right", "right, verified; blurs 2, 1, 0 px only", true}});
}

}  // namespace surf::limits
