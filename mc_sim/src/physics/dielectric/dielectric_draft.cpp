// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/dielectric_draft.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "physics/mechanisms.h"
#include "surf/core/error.h"

namespace surf::mc {
namespace {

constexpr double usual_speed_m_s = 5000;
constexpr double usual_mode_ev = 0.1, usual_permittivity_ratio = 1.6;
constexpr double moss_ev = 95;
constexpr double least_lattice_gap_ev = 1e-3;
constexpr double relative_width = 0.5;  // of a plasmon whose width is not known
constexpr int points_per_octave = 24;
constexpr double first_ev = 0.05, last_ev = 3e4;

double electrons_of(const Material& m) {
  double z = 0;
  for (const Constituent& c : m.constituents) z += c.atomic_number * atoms_per_formula_unit(m, c);
  return z;
}

// hbar^2 (3 pi^2 n)^(2/3) / 2 m.
double free_electron_fermi_ev(double electrons_per_nm3) {
  return 0.364627 * std::pow(electrons_per_nm3, 2.0 / 3);
}

double atoms_per_nm3(const Material& m) {
  double n = 0;
  for (const Constituent& c : m.constituents) n += number_density_per_nm3(m, c);
  return n;
}

class Completion {
 public:
  Completion(const DielectricDraft& draft, const Material& material)
      : draft_(draft),
        material_(material), data_{.elf = draft.elf ? *draft.elf
                                                    : estimated_energy_loss_function(material)} {}

  DielectricData run() {
    if (!draft_.elf)
      note("energy_loss_function",
           "a plasmon of the valence electrons and an edge for the others, by the f-sum and J");
    data_.sources = draft_.sources;
    data_.band.gap_ev =
        draft_.gap_ev.value_or(std::max(0.0, material_.work_function_ev - material_.barrier_ev));
    data_.vacuum_ev = draft_.vacuum_ev.value_or(material_.work_function_ev);
    check("gap_ev", data_.band.gap_ev, 0, 30);
    check("vacuum_ev", data_.vacuum_ev, data_.band.gap_ev, 60);
    set_filled_band();
    if (draft_.elf && draft_.elf_density_g_cm3) {
      check("energy_loss_density_g_cm3", *draft_.elf_density_g_cm3, 0.01, 100);
      data_.elf = data_.elf.times(material_.density_g_cm3 / *draft_.elf_density_g_cm3);
    }
    data_.exhausted_ev = data_.elf.above(data_.band.gap_ev)
                             .loss_of_electrons_ev(std::max(material_.valence_electrons, 1.0),
                                                   formula_units_per_nm3(material_));
    if (draft_.refractive_index) {
      check("refractive_index", *draft_.refractive_index, 1, 100);
      if (data_.band.gap_ev > 0)
        data_.expected_screening_sum =
            1 - 1 / (*draft_.refractive_index * *draft_.refractive_index);
    }
    set_acoustic();
    set_optical();
    data_.trap_per_nm = draft_.trap_per_nm;
    data_.trap_ev = draft_.trap_ev;
    check("trap_per_nm", data_.trap_per_nm, 0, 1000);
    if (data_.trap_per_nm > 0) check("trap_ev", data_.trap_ev, 0.01, 100);
    return data_;
  }

 private:
  void note(const char* field, std::string rule) {
    data_.estimates.push_back({field, std::move(rule)});
  }

  void check(const char* field, double value, double least, double most) const {
    if (value >= least && value <= most) return;
    throw InvalidInput(
        "material " + material_.name,
        fmt::format("dielectric.{} is {:g}, outside {:g} to {:g}", field, value, least, most),
        "Correct it");
  }

  void set_filled_band() {
    double& filled = data_.band.filled_ev;
    if (draft_.filled_band_ev) {
      filled = *draft_.filled_band_ev;
    } else if (data_.band.gap_ev > 0 || material_.barrier_ev <= material_.work_function_ev) {
      filled =
          free_electron_fermi_ev(material_.valence_electrons * formula_units_per_nm3(material_));
      note("filled_band_ev", fmt::format("a gas of {:g} free electrons per formula unit",
                                         material_.valence_electrons));
    } else {
      filled = material_.barrier_ev - material_.work_function_ev;  // as for the continuous loss
    }
    check("filled_band_ev", filled, 0.5, 100);
  }

  void set_acoustic() {
    data_.effective_mass = draft_.effective_mass.value_or(1);
    data_.density_of_states_mass = draft_.density_of_states_mass.value_or(1);
    check("effective_mass", data_.effective_mass, 0.01, 100);
    check("density_of_states_mass", data_.density_of_states_mass, 0.01, 100);
    if (draft_.lattice_nm) {
      data_.lattice_nm = *draft_.lattice_nm;
    } else {
      data_.lattice_nm = std::cbrt(4 / atoms_per_nm3(material_));
      note("lattice_nm", "a face-centred cubic lattice of its atoms");
    }
    check("lattice_nm", data_.lattice_nm, 0.05, 10);
    data_.resistivity_ohm_m = draft_.resistivity_ohm_m.value_or(0);
    check("resistivity_ohm_m", data_.resistivity_ohm_m, 0, 1);
    data_.acoustic = draft_.acoustic;
    if (data_.acoustic.empty()) {
      data_.acoustic = {{.speed_m_s = usual_speed_m_s, .count = 3}};
      note("sound_m_s", fmt::format("{:g} m/s, usual for solids", usual_speed_m_s));
    }
    bool missing = false;
    for (const AcousticBranch& b : data_.acoustic) {
      check("sound_m_s", b.speed_m_s, 100, 3e4);
      check("deformation_ev", b.deformation_ev, 0, 100);
      check("bend_m2_s", b.bend_m2_s, 0, 1e-5);
      missing |= !(b.deformation_ev > 0);
    }
    if (missing && !(data_.resistivity_ohm_m > 0))
      note("deformation_ev", "phonons at 100 eV turn electrons round as the atoms do");
  }

  void set_optical() {
    if (draft_.optical) {
      data_.optical = *draft_.optical;
    } else if (data_.band.gap_ev > least_lattice_gap_ev && material_.constituents.size() > 1) {
      const double high = std::max(1.5, std::sqrt(moss_ev / data_.band.gap_ev));
      data_.optical = {{usual_mode_ev, high, usual_permittivity_ratio * high}};
      note("optical_phonons",
           fmt::format(
               "one of {:g} eV, permittivity {:.3g} above it by Moss's rule, {:.3g} below it",
               usual_mode_ev, high, usual_permittivity_ratio * high));
    }
    for (const OpticalMode& m : data_.optical) {
      check("optical_phonons.energy_ev", m.energy_ev, 1e-3, 1);
      check("optical_phonons.high_permittivity", m.high_permittivity, 1, 1000);
      check("optical_phonons.low_permittivity", m.low_permittivity, m.high_permittivity, 1e5);
    }
  }

  const DielectricDraft& draft_;
  const Material& material_;
  DielectricData data_;
};

}  // namespace

std::shared_ptr<const DielectricData> complete(const DielectricDraft& draft,
                                               const Material& material) {
  return std::make_shared<const DielectricData>(Completion(draft, material).run());
}

EnergyLossFunction estimated_energy_loss_function(const Material& m) {
  constexpr double squared_plasma_ev2_nm3 = 1.378843;  // of one electron per nm^3
  const double units = formula_units_per_nm3(m), all = electrons_of(m);
  const double valence = std::min(std::max(m.valence_electrons, 1.0), all);
  const double squared_valence = squared_plasma_ev2_nm3 * units * valence;
  const double peak = std::max(m.plasmon_ev, std::sqrt(squared_valence)),
               width = relative_width * peak;
  double log_j = 0, charge = 0;
  for (const Constituent& c : m.constituents) {
    const double share = c.weight_fraction * c.atomic_number / c.atomic_weight;
    log_j += share * std::log(c.mean_ionization_ev);
    charge += share;
  }
  log_j /= charge;
  const double core = all - valence;
  // Of w^-4 above the edge, weighted with w, the mean logarithm is that of the edge and 1/2.
  const double edge =
      core > 0 ? std::exp(std::clamp((all * log_j - valence * std::log(peak)) / core - 0.5,
                                     std::log(peak), std::log(last_ev)))
               : last_ev;
  const double squared_core = squared_plasma_ev2_nm3 * units * core;
  std::vector<double> energies, values;
  const auto add = [&](double w, double above_edge) {
    const double d = w * w - peak * peak;
    energies.push_back(w);
    values.push_back(squared_valence * width * w / (d * d + width * width * w * w) +
                     above_edge * std::numbers::pi * squared_core * edge * edge / (w * w * w * w));
  };
  bool beyond = false;
  for (double w = first_ev; w < last_ev; w *= std::exp2(1.0 / points_per_octave)) {
    if (w >= edge && !beyond) {
      beyond = true;
      add(edge * (1 - 1e-6), 0);
      add(edge * (1 + 1e-6), 1);
    }
    if (w < edge * (1 - 2e-6) || w > edge * (1 + 2e-6)) add(w, beyond ? 1 : 0);
  }
  return EnergyLossFunction(std::move(energies), std::move(values),
                            core > 0 ? std::vector<double>{edge} : std::vector<double>{},
                            "estimated");
}

}  // namespace surf::mc
