// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/transport/boundary.h"

#include <cmath>

#include "surf/core/error.h"
#include "transport/detection.h"
#include "transport/forward.h"
#include "transport/transport.h"

namespace surf::mc {

namespace {

// A caller's boundary function as a Geometry.
class CustomGeometry {
 public:
  using State = int;  // the material itself
  struct Surface {
    double distance = 0;
    Vec3 position, position_ahead, normal;
    State state_ahead = -1;
  };

  explicit CustomGeometry(const CustomSpecimen& specimen) : specimen_(specimen) {}

  int material(State s) const { return s; }
  double clearance(const Vec3& p) const { return specimen_.clearance ? specimen_.clearance(p) : 0; }
  double farthest() const { return 1e12; }
  bool flies_free(const Vec3&, const Vec3&) const { return false; }

  Crossing crossing(const Vec3& start, const Vec3& direction, double length, State& state,
                    Surface& surface) const {
    const auto hit = specimen_.boundary(start, direction, length, state);
    if (!hit) return Crossing::none;
    if (!std::isfinite(hit->distance_nm) || hit->distance_nm < 0 ||
        hit->material_ahead >= static_cast<int>(specimen_.media.size()))
      throw InvalidInput(
          "boundary function",
          "it gave a distance that is negative or not finite, or an unknown material",
          "Return nothing where there is no boundary ahead");
    surface.distance = hit->distance_nm;
    surface.position = surface.position_ahead = start + direction * hit->distance_nm;
    surface.normal = hit->normal;
    surface.state_ahead = hit->material_ahead;
    return Crossing::surface;
  }

 private:
  const CustomSpecimen& specimen_;
};

}  // namespace

CustomResult simulate_custom(const CustomSpecimen& specimen, const Vec3& start,
                             const Vec3& direction, double energy_ev, int start_material,
                             BarrierModel barrier, std::uint64_t seed, std::int64_t electrons,
                             Observer* observer) {
  CustomResult out;
  CustomGeometry geometry(specimen);
  Detection detection(default_detectors(), {}, false);
  const auto send = [&](auto& watcher) {
    Transport transport(geometry, specimen.media, barrier, specimen.clearance && !observer, watcher,
                        detection, out.balance);
    for (std::int64_t e = 0; e < electrons; ++e) {
      RandomStream random(seed, 0, static_cast<std::uint64_t>(e));
      if (observer) observer->primary(0, e);
      const bool hit = transport.run(start, direction, energy_ev, start_material, random);
      ++out.tally.primaries;
      out.tally.hits += hit ? 1 : 0;
      out.se.add(detection.counts()[0]);
      out.bse.add(detection.counts()[1]);
      detection.end_primary();
    }
  };
  if (observer) {
    Forward forward{*observer};
    send(forward);
  } else {
    NoObserver nobody;
    send(nobody);
  }
  return out;
}

}  // namespace surf::mc
