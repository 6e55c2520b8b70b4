// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "physics/mechanisms.h"
#include "physics/mott_data.h"
#include "surf/core/error.h"
#include "surf/mc/physics/element.h"
#include "surf/mc/physics/medium.h"

namespace surf::mc {

const MottElement* find_mott_element(int atomic_number, MottAtoms atoms) {
  for (const MottElement& element :
       atoms == MottAtoms::free ? free_mott_elements() : solid_mott_elements())
    if (element.atomic_number == atomic_number) return &element;
  return nullptr;
}

bool has_mott_table(int atomic_number) { return find_mott_element(atomic_number) != nullptr; }

namespace {

std::string symbols_with_tables() {
  std::string symbols;
  for (const MottElement& e : free_mott_elements())
    symbols += fmt::format("{}{}", symbols.empty() ? "" : ", ", element(e.atomic_number).symbol);
  return symbols;
}

// Elastic scattering by one element from partial-wave tables. Cross-sections are interpolated
// log-log. For the angle one of the two neighbouring tables is drawn, with the probability of the
// position between them on the logarithmic scale.
// Below the lowest table (50 eV) free-atom calculations mean little in a solid; what counts there
// is the transport cross-section. It is taken from the table's end with the energy dependence of
// Browning's fit, and scattering is isotropic, as in that fit's low-energy limit.
class Mott final : public Scattering {
 public:
  Mott(const MottElement& element, double atoms_per_nm3, MottAtoms atoms)
      : element_(element), atoms_per_nm3_(atoms_per_nm3), atoms_(atoms),
        lowest_ev_(element.rows.front().energy_ev) {
    for (int i = 0; i < EnergyBins::count; ++i) {
      const double middle = 0.5 * (EnergyBins::lower_ev(i) + EnergyBins::lower_ev(i + 1));
      const auto [row, fraction] = locate(middle);
      choices_[static_cast<std::size_t>(i)] = {row, fraction};
    }
  }

  std::string describe() const override {
    return fmt::format(
        "elastic, Z = {}: Mott tables, ELSEPA {}, {:g} "
        "eV to {:g} eV (doi:10.1016/j.cpc.2004.09.006); below, isotropic",
        element_.atomic_number,
        atoms_ == MottAtoms::free
            ? "with the settings of NIST SRD 64"
            : "for atoms in a solid: muffin-tin, correlation and polarisation",
        element_.rows.front().energy_ev, element_.rows.back().energy_ev);
  }

  double inverse_mean_free_path_per_nm(double energy_ev) const override {
    return atoms_per_nm3_ * cross_section_nm2(energy_ev);
  }

  bool debits() const override { return false; }

  void scatter(double energy_ev, RandomStream& random, ScatterEvent& event) const override {
    if (energy_ev < lowest_ev_) {
      event.cos_theta = 1.0 - 2.0 * random.uniform();
      event.turn = random.uniform();
      event.isotropic = true;
      return;
    }
    const Choice& choice = choices_[static_cast<std::size_t>(EnergyBins::bin(energy_ev))];
    // The azimuth's low bits choose the table: one word serves both.
    const std::uint32_t word = random.bits();
    const bool upper = static_cast<float>(word & 0xffff) * 0x1p-16f < choice.fraction;
    const MottRow& row = element_.rows[static_cast<std::size_t>(choice.row + (upper ? 1 : 0))];
    const double u = (1.0 - std::sqrt(random.uniform())) * (MottRow::points - 1);
    const int i = static_cast<int>(u);
    const double f = u - i;
    const double x = row.x[i] + f * (row.x[i + 1] - row.x[i]);
    const double mu = row.a * x / (1.0 + row.a - x);
    event.cos_theta = 1.0 - 2.0 * mu;
    event.turn = static_cast<double>(word >> 16) * 0x1p-16;
  }

 private:
  struct Choice {
    int row;
    float fraction;
  };

  // The row below and the logarithmic position towards the next, in [0, 1].
  Choice locate(double energy_ev) const {
    const auto& rows = element_.rows;
    const auto above =
        std::upper_bound(rows.begin(), rows.end(), energy_ev,
                         [](double e, const MottRow& row) { return e < row.energy_ev; });
    if (above == rows.begin()) return {0, 0.0f};
    if (above == rows.end()) return {static_cast<int>(rows.size()) - 2, 1.0f};
    const int row = static_cast<int>(above - rows.begin()) - 1;
    const double e0 = rows[static_cast<std::size_t>(row)].energy_ev;
    const double e1 = rows[static_cast<std::size_t>(row) + 1].energy_ev;
    return {row, static_cast<float>(std::log(energy_ev / e0) / std::log(e1 / e0))};
  }

  double cross_section_nm2(double energy_ev) const {
    const auto& rows = element_.rows;
    const MottRow& lowest = rows.front();
    if (energy_ev < lowest.energy_ev) {
      const int z = element_.atomic_number;
      return lowest.transport_cross_section_nm2 * browning_cross_section_nm2(z, energy_ev) /
             browning_cross_section_nm2(z, lowest.energy_ev);
    }
    const Choice c = locate(energy_ev);
    const MottRow& a = rows[static_cast<std::size_t>(c.row)];
    const MottRow& b = rows[static_cast<std::size_t>(c.row) + 1];
    return a.cross_section_nm2 *
           std::pow(b.cross_section_nm2 / a.cross_section_nm2, static_cast<double>(c.fraction));
  }

  const MottElement& element_;
  double atoms_per_nm3_;
  MottAtoms atoms_;
  double lowest_ev_;
  std::array<Choice, EnergyBins::count> choices_;
};

}  // namespace

std::unique_ptr<const Scattering> make_mott(const Material& material, const Constituent& c,
                                            MottAtoms atoms) {
  const MottElement* tables = find_mott_element(c.atomic_number, atoms);
  if (!tables)
    throw InvalidInput(
        "material " + material.name,
        fmt::format("there is no Mott table for {} (Z = {}), only for {}",
                    element(c.atomic_number).symbol, c.atomic_number, symbols_with_tables()),
        "Use `simulation.physics=elastic=browning`, which needs none");
  return std::make_unique<Mott>(*tables, number_density_per_nm3(material, c), atoms);
}

double inverse_transport_path_per_nm(const Material& material, double energy_ev) {
  double sum = 0;
  for (const Constituent& c : material.constituents) {
    const MottElement* const tables = find_mott_element(c.atomic_number);
    double transport_nm2 = browning_transport_cross_section_nm2(c.atomic_number, energy_ev);
    if (tables) {
      std::size_t i = 0;
      while (i + 2 < tables->rows.size() && tables->rows[i + 1].energy_ev <= energy_ev) ++i;
      const MottRow &a = tables->rows[i], &b = tables->rows[i + 1];
      const double share = std::log(energy_ev / a.energy_ev) / std::log(b.energy_ev / a.energy_ev);
      transport_nm2 =
          a.transport_cross_section_nm2 *
          std::pow(b.transport_cross_section_nm2 / a.transport_cross_section_nm2, share);
    }
    sum += number_density_per_nm3(material, c) * transport_nm2;
  }
  return sum;
}

}  // namespace surf::mc
