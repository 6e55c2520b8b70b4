// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "physics/dielectric/phonons.h"
#include "physics/mechanisms.h"
#include "surf/mc/physics/medium.h"

namespace surf::mc {
namespace {

// In eV, nm and s.
constexpr double hbar = 6.582119569e-16;
constexpr double hbar2_per_mass = 0.0761996423;                 // hbar^2 / m, eV nm^2
constexpr double electron_mass = hbar * hbar / hbar2_per_mass;  // eV s^2 / nm^2
constexpr double dalton = electron_mass * 1822.888486;
constexpr double avogadro_cm3_per_nm3 = 602.214076;
constexpr double speed_nm_per_m = 1e9;

constexpr double join_ev =
    100;  // where what has no measured deformation potential turns electrons round as atoms do
constexpr int points = 129;      // of a table of angles
constexpr int steps = 1024;      // in making it
constexpr double screening = 5;  // A over the energy at the zone's edge

// Scattering by acoustic phonons at room temperature (Kieft and Bosch, J. Phys. D 41, 215310
// (2008), doi:10.1088/0022-3727/41/21/215310, after Fitting and Schreiber). With mu = (1 - cos
// theta) / 2, E above the bottom of the band in which the electron moves, and per branch:
//   d(1/lambda)/dOmega = sqrt(m* md^3) Xi^2 kT / (4 pi^2 hbar^4 c^2 rho) g / (1 + mu E / A)^2,   A
//   = 5 E_BZ,
// g = 1 below E_BZ / 4 and (n_BZ + 1/2) 8 md c^2 mu E / (hw_BZ kT) above E_BZ, which umklapp makes
// scatter backwards, and in between a smooth mean of their logarithms. An electron loses what is
// emitted more than absorbed, hw tanh(hw / 2 kT).
class AcousticPhonons final : public Scattering {
 public:
  AcousticPhonons(const Material& material, const DielectricData& data, bool in_events = true)
      : in_events_(in_events),
        zero_ev_(in_events && data.band.gap_ev > 0 ? data.band.free_ev() : 0),
        edge_(2 * std::numbers::pi / data.lattice_nm),
        edge_ev_(0.5 * hbar2_per_mass * edge_ * edge_), zone_energy_ev_(0.25 * edge_ev_),
        mass_(data.density_of_states_mass) {
    const double density =
        material.density_g_cm3 * avogadro_cm3_per_nm3 * dalton;  // of mass, eV s^2 / nm^5
    for (const AcousticBranch& b : data.acoustic) {
      Branch branch;
      branch.speed = b.speed_m_s * speed_nm_per_m;
      const double bend = b.bend_m2_s > 0 ? b.bend_m2_s * speed_nm_per_m * speed_nm_per_m
                                          : branch.speed * (1 - 2 / std::numbers::pi) / edge_;
      branch.bend = bend;
      const double masses = std::sqrt(data.effective_mass * mass_ * mass_ * mass_);
      branch.strength = b.count * masses * b.deformation_ev * b.deformation_ev *
                        room_temperature_ev /
                        (std::numbers::pi * hbar2_per_mass * hbar2_per_mass * branch.speed *
                         branch.speed * density);
      const double quantum = hbar * edge_ * (branch.speed - bend * edge_);
      for (int i = 0; i <= loss_points; ++i) {
        const double k = edge_ * i / loss_points, ev = hbar * k * (branch.speed - bend * k);
        branch.loss_ev[static_cast<std::size_t>(i)] =
            static_cast<float>(ev * std::tanh(ev / (2 * room_temperature_ev)));
      }
      branch.umklapp = (1 / std::expm1(quantum / room_temperature_ev) + 0.5) * 8 * mass_ *
                       electron_mass * branch.speed * branch.speed /
                       (quantum * room_temperature_ev);
      branches_.push_back(branch);
    }
    tables_.resize(EnergyBins::count);
    for (int i = 0; i < EnergyBins::count; ++i)
      make_table(0.5 * (EnergyBins::lower_ev(i) + EnergyBins::lower_ev(i + 1)),
                 tables_[static_cast<std::size_t>(i)]);
  }

  std::string describe() const override {
    return fmt::format(
        "elastic below 100 eV: acoustic phonons at room temperature, zone edge at {:.3g} eV, {} "
        "(doi:10.1088/0022-3727/41/21/215310)",
        edge_ev_, branches_.size() > 1 ? "longitudinal and transverse" : "all branches alike");
  }

  double inverse_mean_free_path_per_nm(double energy_ev) const override {
    double sum = 0;
    for (const Branch& b : branches_) sum += moment(b, energy_ev - zero_ev_, 0);
    return sum;
  }

  /// Weighted with 1 - cos theta.
  double inverse_transport_path_per_nm(double energy_ev) const {
    double sum = 0;
    for (const Branch& b : branches_) sum += 2 * moment(b, energy_ev - zero_ev_, 1);
    return sum;
  }

  bool debits() const override { return in_events_; }

  void scatter(double energy_ev, RandomStream& random, ScatterEvent& event) const override {
    const double energy = energy_ev - zero_ev_;
    if (!(energy > 0)) return;
    const Table& table = tables_[static_cast<std::size_t>(EnergyBins::bin(energy))];
    const double place = random.uniform() * (points - 1);
    const int i = std::min(static_cast<int>(place), points - 2);
    const auto k = static_cast<std::size_t>(i);
    const double mu = table.mu[k] + (place - i) * (table.mu[k + 1] - table.mu[k]);
    event.cos_theta = 1 - 2 * mu;
    // One word serves the azimuth and the branch.
    const std::uint32_t word = random.bits();
    event.turn = static_cast<double>(word >> 16) * 0x1p-16;
    if (!in_events_) return;
    std::size_t b = 0;
    for (float u = static_cast<float>(word & 0xffff) * 0x1p-16f;
         b + 1 < branches_.size() && u >= table.share[b]; ++b)
      u -= table.share[b];
    event.energy_loss_ev =
        std::min(energy, loss_ev(branches_[b], std::sqrt(energy * mu / zone_energy_ev_)));
  }

 private:
  static constexpr int loss_points = 128;
  struct Branch {
    double speed, bend, strength, umklapp;
    std::array<float, loss_points + 1> loss_ev;  // by the momentum, in parts of the zone's
  };

  // At a momentum, in parts of that at the zone's edge: beyond it, umklapp.
  static double loss_ev(const Branch& b, double momentum) {
    const double place = std::min(momentum, 1.0) * loss_points;
    const auto i = static_cast<std::size_t>(std::min(place, loss_points - 1.0));
    return b.loss_ev[i] + (place - static_cast<double>(i)) * (b.loss_ev[i + 1] - b.loss_ev[i]);
  }
  struct Table {
    std::array<float, points> mu{};
    std::array<float, 4> share{};
  };

  double density(const Branch& b, double energy, double mu) const {  // of 1 / lambda over mu
    const double x = std::clamp(std::log(4 * energy / edge_ev_) / std::log(4.0), 0.0, 1.0);
    const double h = (3 - 2 * x) * x * x;
    const double g = h > 0 ? std::pow(b.umklapp * mu * energy, h) : 1.0;
    const double screened = 1 + mu * energy / (screening * edge_ev_);
    return b.strength * g / (screened * screened);
  }

  double moment(const Branch& b, double energy, int power) const {
    if (!(energy > 0)) return 0;
    double sum = 0;
    constexpr int n = 256;
    for (int i = 0; i < n; ++i) {
      const double mu = (i + 0.5) / n;
      sum += density(b, energy, mu) * (power > 0 ? mu : 1);
    }
    return sum / n;
  }

  void make_table(double energy, Table& table) const {
    std::vector<double> sums(steps + 1);
    double total = 0;
    for (std::size_t b = 0; b < branches_.size() && b < table.share.size(); ++b) {
      const double rate = moment(branches_[b], energy, 0);
      table.share[b] = static_cast<float>(rate);
      total += rate;
    }
    for (float& s : table.share) s = total > 0 ? static_cast<float>(s / total) : 1.0f;
    for (int i = 0; i < steps; ++i) {
      double sum = 0;
      for (const Branch& b : branches_) sum += density(b, energy, (i + 0.5) / steps);
      sums[static_cast<std::size_t>(i) + 1] = sums[static_cast<std::size_t>(i)] + sum;
    }
    int k = 0;
    for (int i = 0; i < points; ++i) {
      const double wanted = sums.back() * i / (points - 1);
      while (k + 1 < steps && sums[static_cast<std::size_t>(k) + 1] <= wanted) ++k;
      const double from = sums[static_cast<std::size_t>(k)],
                   width = sums[static_cast<std::size_t>(k) + 1] - from;
      table.mu[static_cast<std::size_t>(i)] = static_cast<float>(
          (k + (width > 0 ? std::min((wanted - from) / width, 1.0) : 0)) / steps);
    }
  }

  bool in_events_;
  double zero_ev_;         // E counts from here
  double edge_;            // of the Brillouin zone, per nm
  double edge_ev_;         // a free electron's energy there
  double zone_energy_ev_;  // of one that hands over that momentum where it turns round
  double mass_;
  std::vector<Branch> branches_;
  std::vector<Table> tables_;
};

// The deformation potential of all branches that gives this transport path at an energy.
double deformation_ev(const Material& material, const DielectricData& data, double energy_ev,
                      double inverse_path_per_nm) {
  DielectricData unit = data;
  for (AcousticBranch& b : unit.acoustic) b.deformation_ev = 1;
  return std::sqrt(inverse_path_per_nm /
                   AcousticPhonons(material, unit).inverse_transport_path_per_nm(energy_ev));
}

// The one with which electrons at the Fermi energy lose their direction as fast as the resistivity
// says: 1 / tau = n e^2 rho / m.
double deformation_by_resistivity_ev(const Material& material, const DielectricData& data) {
  constexpr double e2_per_mass = 2.81794e-8;                              // e^2 / m, C^2 / kg
  const double kf = std::sqrt(2 * data.band.filled_ev / hbar2_per_mass);  // per nm
  const double electrons =
      kf * kf * kf / (3 * std::numbers::pi * std::numbers::pi) * 1e27;   // per m^3
  const double rate = electrons * e2_per_mass * data.resistivity_ohm_m;  // per s
  const double speed = hbar * kf / electron_mass;                        // nm / s
  return deformation_ev(material, data, data.band.filled_ev, rate / speed);
}

}  // namespace

std::unique_ptr<const Scattering> make_acoustic_phonons(const Material& material,
                                                        const DielectricData& data,
                                                        bool in_events) {
  DielectricData d = data;
  if (std::ranges::any_of(d.acoustic,
                          [](const AcousticBranch& b) { return !(b.deformation_ev > 0); })) {
    const double estimate = data.resistivity_ohm_m > 0
                                ? deformation_by_resistivity_ev(material, data)
                                : deformation_ev(material, data, join_ev,
                                                 inverse_transport_path_per_nm(material, join_ev));
    for (AcousticBranch& b : d.acoustic)
      if (!(b.deformation_ev > 0)) b.deformation_ev = estimate;
  }
  return std::make_unique<AcousticPhonons>(material, d, in_events);
}

}  // namespace surf::mc
