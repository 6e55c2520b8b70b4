// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "physics/dielectric/phonons.h"

namespace surf::mc {
namespace {

constexpr double slow_ev = 100, fast_ev = 200;

// Elastic scattering of slow electrons by phonons and of fast ones by atoms. In between the rate is
// the geometric mean of both, weighted with the place on the logarithmic scale, and that is also
// how likely an event is of either kind.
struct Parts {
  std::unique_ptr<const Scattering> slow;
  std::vector<std::unique_ptr<const Scattering>> fast;

  static double share_of_fast(double energy_ev) {
    if (energy_ev <= slow_ev) return 0;
    return energy_ev >= fast_ev ? 1.0 : std::log(energy_ev / slow_ev) / std::log(fast_ev / slow_ev);
  }
  double slow_rate(double energy_ev) const {
    return slow->inverse_mean_free_path_per_nm(energy_ev);
  }
  double fast_rate(double energy_ev) const {
    double sum = 0;
    for (const auto& f : fast) sum += f->inverse_mean_free_path_per_nm(energy_ev);
    return sum;
  }
  double mean_rate(double energy_ev, double x) const {
    return std::pow(slow_rate(energy_ev), 1 - x) * std::pow(fast_rate(energy_ev), x);
  }
};

class Slow final : public Scattering {
 public:
  explicit Slow(std::shared_ptr<const Parts> parts) : parts_(std::move(parts)) {}
  std::string describe() const override { return parts_->slow->describe(); }
  double inverse_mean_free_path_per_nm(double energy_ev) const override {
    const double x = Parts::share_of_fast(energy_ev);
    if (x <= 0) return parts_->slow_rate(energy_ev);
    return x >= 1 ? 0 : (1 - x) * parts_->mean_rate(energy_ev, x);
  }
  bool debits() const override { return parts_->slow->debits(); }
  void scatter(double energy_ev, RandomStream& random, ScatterEvent& event) const override {
    parts_->slow->scatter(energy_ev, random, event);
  }

 private:
  std::shared_ptr<const Parts> parts_;
};

class Fast final : public Scattering {
 public:
  Fast(std::shared_ptr<const Parts> parts, std::size_t i)
      : parts_(std::move(parts)), mechanism_(*parts_->fast[i]) {}
  std::string describe() const override {
    return fmt::format("{}; fading from 200 eV to 100 eV", mechanism_.describe());
  }
  double inverse_mean_free_path_per_nm(double energy_ev) const override {
    const double x = Parts::share_of_fast(energy_ev),
                 rate = mechanism_.inverse_mean_free_path_per_nm(energy_ev);
    if (x >= 1) return rate;
    return x <= 0 ? 0 : x * parts_->mean_rate(energy_ev, x) * rate / parts_->fast_rate(energy_ev);
  }
  bool debits() const override { return mechanism_.debits(); }
  void scatter(double energy_ev, RandomStream& random, ScatterEvent& event) const override {
    mechanism_.scatter(energy_ev, random, event);
  }

 private:
  std::shared_ptr<const Parts> parts_;
  const Scattering& mechanism_;
};

}  // namespace

std::vector<std::unique_ptr<const Scattering>> fade(
    std::unique_ptr<const Scattering> phonons,
    std::vector<std::unique_ptr<const Scattering>> fast) {
  const auto parts = std::make_shared<const Parts>(Parts{std::move(phonons), std::move(fast)});
  std::vector<std::unique_ptr<const Scattering>> out;
  for (std::size_t i = 0; i < parts->fast.size(); ++i)
    out.push_back(std::make_unique<Fast>(parts, i));
  out.push_back(std::make_unique<Slow>(parts));
  return out;
}

}  // namespace surf::mc
