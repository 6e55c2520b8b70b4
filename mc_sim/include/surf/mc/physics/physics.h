// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/mc/physics/material.h"

namespace surf {
class ParameterVisitor;
}

namespace surf::mc {

enum class InelasticTier { monsel, dielectric };
enum class InelasticModel { full_penn, single_pole };
enum class ElasticModel { mott, mott_phonon, browning };
enum class MottAtoms { free, solid };
enum class LossModel { joy_luo, none };
enum class BarrierModel { quantum, classical, off };

/// Which physics is at work, chosen at run time. Defaults come first everywhere; for what follows
/// the tier see parse_physics.
struct Physics {
  /// Losses: continuous, as MONSEL has them, or event by event from the energy-loss function.
  InelasticTier inelastic = InelasticTier::monsel;
  InelasticModel inelastic_model = InelasticModel::full_penn;  ///< of `dielectric`
  bool auger = false;  ///< likewise: electrons that fill holes of inner shells free one
  ElasticModel elastic = ElasticModel::mott;
  MottAtoms atoms = MottAtoms::free;  ///< which Mott tables: of free atoms, or of atoms in a solid
  LossModel loss = LossModel::joy_luo;  ///< of `monsel`
  bool secondaries = true;
  BarrierModel barrier = BarrierModel::quantum;

  /// Where tracking stops, as energy inside the material in eV, 0.5 to below the beam's energy. 0:
  /// at the barrier (electrons below cannot leave), or at 50 eV where secondaries or the barrier
  /// are off.
  double cutoff_ev = 0;
};

inline constexpr double se_bse_split_ev = 50.0;  ///< SE below, BSE at or above (energy in vacuum)
inline constexpr double min_beam_energy_ev = 100.0;
inline constexpr double max_beam_energy_ev = 30000.0;

inline constexpr double min_cutoff_ev = 0.5;  ///< where a Medium's tables begin

/// Throws UsageError where the cutoff is out of range for a beam of this energy.
void validate(const Physics& physics, double beam_energy_ev = max_beam_energy_ev);

/// Whether losses are paid event by event.
inline bool is_dielectric(const Physics& physics) {
  return physics.inelastic == InelasticTier::dielectric;
}

/// From the zero of energies inside to the vacuum: 0 where the barrier is off.
double effective_barrier_ev(const Physics& physics, const Material& material);

/// The cutoff that holds for a material: `cutoff_ev` or its default. It asks for no more of a
/// material than its barrier.
double effective_cutoff_ev(const Physics& physics, const Material& material);
double effective_cutoff_ev(const Physics& physics, double effective_barrier_ev);

/// Reads "elastic=mott,secondaries=off" over the given settings. Keys: inelastic = monsel |
/// dielectric, inelastic-model = full-penn | single-pole, auger = off | on, elastic = mott |
/// mott-phonon | browning, atoms = free | solid, loss = joy-luo | none, secondaries = on | off,
/// barrier = quantum | classical | off. Where `inelastic` is said and changes, elastic and atoms
/// become what is usual with it unless they are said too: mott and free, mott-phonon and solid.
/// Throws UsageError naming the word and the choices.
void parse_physics(const std::string& text, Physics& physics,
                   const std::string& subject = "`simulation.physics`");

/// The settings as `parse_physics` reads them, every key given that matters.
std::string format_physics(const Physics& physics);

void describe(ParameterVisitor& visit, Physics& physics);

/// What is active for a material, a line per mechanism with formula's source and range.
std::vector<std::string> describe(const Physics& physics, const Material& material);

}  // namespace surf::mc
