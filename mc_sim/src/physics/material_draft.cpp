// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/material_draft.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/mc/physics/element.h"

namespace surf::mc {

namespace {

constexpr double usual_work_function_ev = 4.5;  // metals: 4 to 5.5 eV
constexpr double wide_gap_ev = 4.0;
constexpr double affinity_of_narrow_gaps_ev = 4.0;  // Si 4.05, Ge 4.0, GaAs 4.07, TiO2 4
constexpr double affinity_of_wide_gaps_ev = 1.0;    // SiO2 0.9 to 1.1

// Plasmon energy and Fermi energy of a free-electron gas (Kittel, Introduction to Solid State
// Physics): 28.816 eV sqrt(n rho / M) with n electrons per formula unit.
double free_plasmon_ev(double electrons, const Material& m) {
  return 28.816 * std::sqrt(electrons * m.density_g_cm3 / m.formula_weight_g_mol);
}
double free_fermi_ev(double electrons, const Material& m) {
  return 0.29436 * std::pow(free_plasmon_ev(electrons, m), 4.0 / 3.0);
}

// Weight fractions and the formula unit's weight, from the formula or from the elements.
void compose(const MaterialDraft& draft, Material& m) {
  m.constituents = draft.constituents;
  if (!draft.formula.empty()) {
    m.constituents.clear();
    for (const FormulaPart& part : draft.formula)
      m.constituents.push_back({.atomic_number = part.atomic_number,
                                .atomic_weight = 0,
                                .weight_fraction = part.atoms,
                                .mean_ionization_ev = 0});
  }
  for (Constituent& c : m.constituents) {
    if (c.atomic_number < 1 || c.atomic_number > static_cast<int>(elements().size())) return;
    if (c.atomic_weight == 0) c.atomic_weight = element(c.atomic_number).atomic_weight;
    if (c.mean_ionization_ev == 0) c.mean_ionization_ev = mean_ionization_ev(c.atomic_number);
  }
  if (!draft.formula.empty()) {
    for (Constituent& c : m.constituents)
      m.formula_weight_g_mol += (c.weight_fraction *= c.atomic_weight);
    for (Constituent& c : m.constituents) c.weight_fraction /= m.formula_weight_g_mol;
  } else {
    double atoms_per_gram = 0;
    for (const Constituent& c : m.constituents)
      atoms_per_gram += c.weight_fraction / c.atomic_weight;
    if (atoms_per_gram > 0) m.formula_weight_g_mol = 1.0 / atoms_per_gram;
  }
}

// The known material that is this element alone, the first of them, or nullptr.
const Material* pure(int atomic_number, std::span<const Material> known) {
  for (const Material& k : known)
    if (k.constituents.size() == 1 && k.constituents[0].atomic_number == atomic_number) return &k;
  return nullptr;
}

// Mean over the atoms of a quantity of the pure materials; empty where one is unknown.
template <class Quantity>
std::optional<double> mean_over_atoms(const Material& m, std::span<const Material> known,
                                      const Quantity& quantity) {
  double sum = 0, atoms = 0;
  for (const Constituent& c : m.constituents) {
    const Material* k = pure(c.atomic_number, known);
    if (!k) return {};
    const double n = atoms_per_formula_unit(m, c);
    sum += n * quantity(*k);
    atoms += n;
  }
  return sum / atoms;
}

class Completion {
 public:
  Completion(const MaterialDraft& draft, std::span<const Material> known)
      : draft_(draft), known_(known) {
    m_.name = draft.name;
    m_.density_g_cm3 = draft.density_g_cm3;
    m_.loss_join_fitted = draft.loss_join_fitted;
    m_.sources = draft.sources;
    m_.taken_for_metal = !draft.band_gap_ev && !(draft.work_function_ev && draft.barrier_ev);
  }

  Material run() {
    compose(draft_, m_);
    check();
    set_valence_electrons();
    set_plasmon();
    set_work_function();
    set_barrier();
    if (draft_.loss_join_ev) m_.loss_join_ev = *draft_.loss_join_ev;
    else
      estimate(
          "loss_join_ev", m_.loss_join_ev,
          estimated_loss_join_ev(m_.barrier_ev, m_.work_function_ev),
          "6.72 U0 + 1.87 gap, the regression over the materials fitted to measured SE yields");
    validate(m_);
    m_.dielectric = complete(draft_.dielectric, m_);
    return m_;
  }

 private:
  // What the estimates divide by and look up has to make sense before `validate` sees the whole.
  void check() const {
    const auto refuse = [&](const std::string& reason, const std::string& remedy) {
      throw InvalidInput("material " + (m_.name.empty() ? "(no name)" : m_.name), reason, remedy);
    };
    if (!(m_.density_g_cm3 > 0) || !std::isfinite(m_.density_g_cm3))
      refuse(fmt::format("density_g_cm3 is {:g}", m_.density_g_cm3), "Give it in g/cm^3, above 0");
    if (m_.constituents.empty()) refuse("it has no elements", "Give a formula or elements");
    for (const Constituent& c : m_.constituents)
      if (c.atomic_number < 1 || c.atomic_number > static_cast<int>(elements().size()))
        refuse(fmt::format("there is no element {}", c.atomic_number), "Give a Z from 1 to 92");
    const double gap = draft_.band_gap_ev.value_or(0);
    if (!(gap >= 0) || !std::isfinite(gap))
      refuse(fmt::format("band_gap_ev is {:g}", gap), "Give it in eV, 0 for a metal");
    if (gap > 0 && draft_.work_function_ev && !(*draft_.work_function_ev >= gap))
      refuse(fmt::format("the band gap of {:g} eV is wider than the work function of {:g} eV", gap,
                         *draft_.work_function_ev),
             "Give the work function from the top of the valence band to the vacuum");
    if (gap > 0 && draft_.work_function_ev && draft_.barrier_ev &&
        std::fabs(*draft_.work_function_ev - gap - *draft_.barrier_ev) > 0.01)
      refuse(fmt::format("barrier_ev {:g} is not the work function {:g} less the band gap {:g}",
                         *draft_.barrier_ev, *draft_.work_function_ev, gap),
             "Leave one of the three out");
  }

  void estimate(const char* field, double& value, double estimated, const std::string& rule) {
    value = estimated;
    m_.estimates.push_back({field, rule});
  }

  void set_valence_electrons() {
    if (draft_.valence_electrons) {
      m_.valence_electrons = *draft_.valence_electrons;
      return;
    }
    double sum = 0;
    for (const Constituent& c : m_.constituents)
      sum += atoms_per_formula_unit(m_, c) * element(c.atomic_number).valence_electrons;
    estimate("valence_electrons", m_.valence_electrons, sum,
             "sum of the elements' outer electrons");
  }

  void set_plasmon() {
    if (draft_.plasmon_ev) m_.plasmon_ev = *draft_.plasmon_ev;
    else
      estimate("plasmon_ev", m_.plasmon_ev,
               free_plasmon_ev(std::max(m_.valence_electrons, 0.0), m_),
               "free-electron gas of the valence electrons, 28.816 eV sqrt(n rho / M)");
  }

  void set_work_function() {
    double& w = m_.work_function_ev;
    const double gap = draft_.band_gap_ev.value_or(0);
    if (draft_.work_function_ev) {
      w = *draft_.work_function_ev;
    } else if (gap > 0 && draft_.barrier_ev) {
      w = gap + *draft_.barrier_ev;
    } else if (gap > 0) {
      const double affinity =
          gap < wide_gap_ev ? affinity_of_narrow_gaps_ev : affinity_of_wide_gaps_ev;
      estimate(
          "work_function_ev", w, gap + affinity,
          fmt::format("band gap plus an electron affinity of {:g} eV, usual for gaps {} {:g} eV",
                      affinity, gap < wide_gap_ev ? "below" : "of or above", wide_gap_ev));
    } else if (const auto mean = mean_over_atoms(
                   m_, known_, [](const Material& k) { return k.work_function_ev; })) {
      estimate("work_function_ev", w, *mean, "mean of the pure elements', by atoms");
    } else {
      estimate("work_function_ev", w, usual_work_function_ev, "usual for metals");
    }
  }

  void set_barrier() {
    double& u0 = m_.barrier_ev;
    const double w = m_.work_function_ev, gap = draft_.band_gap_ev.value_or(0);
    if (draft_.barrier_ev) {
      u0 = *draft_.barrier_ev;
    } else if (gap > 0 && draft_.work_function_ev) {
      u0 = w - gap;
    } else if (gap > 0) {
      estimate("barrier_ev", u0, w - gap, "work function less the band gap");
    } else if (const auto mean = mean_over_atoms(m_, known_, [](const Material& k) {
                 return k.barrier_ev - k.work_function_ev;
               })) {
      estimate("barrier_ev", u0, std::max(w + *mean, 0.0),
               "work function plus the mean of the pure elements' U0 - W, by atoms");
    } else {
      double electrons = 0;
      for (const Constituent& c : m_.constituents)
        electrons += atoms_per_formula_unit(m_, c) * element(c.atomic_number).free_electrons;
      estimate(
          "barrier_ev", u0, w + free_fermi_ev(electrons, m_),
          fmt::format("a metal: work function plus the Fermi energy of {:.3g} free electrons per "
                      "formula unit; give band_gap_ev if it is none",
                      electrons));
    }
  }

  const MaterialDraft& draft_;
  std::span<const Material> known_;
  Material m_;
};

}  // namespace

Material complete(const MaterialDraft& draft, std::span<const Material> known) {
  return Completion(draft, known).run();
}

double estimated_loss_join_ev(double barrier_ev, double work_function_ev) {
  const double gap_ev = std::max(work_function_ev - barrier_ev, 0.0);
  return std::max(6.72 * barrier_ev + 1.87 * gap_ev, work_function_ev + 2.0);
}

}  // namespace surf::mc
