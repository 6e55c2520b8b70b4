// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/dielectric/kept_tables.h"

#include <map>
#include <mutex>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "physics/dielectric/measured_reach.h"

namespace surf::mc {
namespace {

// Data are told by where they are; each table keeps its own alive, so that nothing else comes to
// lie there.
struct Kept {
  std::shared_ptr<const DielectricData> data;
  std::shared_ptr<const LossSampler> losses;
  std::vector<double> reach_nm;
};

std::mutex& mutex() {
  static std::mutex m;
  return m;
}

Kept& kept(const Material& material, const std::string& what) {
  static std::map<std::pair<const void*, std::string>, Kept> all;
  Kept& entry = all[{material.dielectric.get(), what}];
  entry.data = material.dielectric;
  return entry;
}

}  // namespace

std::shared_ptr<const LossSampler> kept_losses(const Material& material, const Physics& physics) {
  const bool full = physics.inelastic_model == InelasticModel::full_penn;
  const std::lock_guard lock(mutex());
  Kept& entry = kept(material, full ? "full Penn" : "single pole");
  if (!entry.losses)
    entry.losses = full ? make_full_penn_sampler(*material.dielectric)
                        : make_single_pole_sampler(*material.dielectric);
  return entry.losses;
}

std::vector<double> kept_reach_nm(const Medium& medium, const Material& material,
                                  const Physics& physics) {
  const auto losses = kept_losses(material, physics);
  const std::lock_guard lock(mutex());
  Kept& entry =
      kept(material, fmt::format("reach {} {:.17g}", format_physics(physics), medium.cutoff_ev()));
  if (entry.reach_nm.empty())
    entry.reach_nm = measured_reach_nm(
        medium, [&](double energy_ev) { return losses->stopping_power_ev_per_nm(energy_ev); });
  return entry.reach_nm;
}

}  // namespace surf::mc
