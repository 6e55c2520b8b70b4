// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/reach.h"

#include <algorithm>

#include "surf/mc/geometry/field_in_reach.h"

namespace surf::mc {

std::vector<Medium> make_media(const std::vector<Material>& materials, const Physics& physics) {
  std::vector<Medium> media;
  for (const Material& m : materials) media.push_back(make_medium(m, physics));
  return media;
}

Reach reach_of(const std::vector<Medium>& media, const Beam& beam) {
  Reach reach;
  for (const Medium& m : media) {
    reach.of_any_nm = std::max(reach.of_any_nm, reach_nm(m, beam));
    reach.through_all_nm += m.range_nm(beam.energy_ev + m.barrier_ev());
  }
  return reach;
}

}  // namespace surf::mc
