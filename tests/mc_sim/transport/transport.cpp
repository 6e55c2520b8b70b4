// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/transport.h"

#include <algorithm>
#include <cmath>

#include "csv.h"
#include "physics/mechanism_test.h"
#include "surf/core/error.h"
#include "surf/mc/transport/boundary.h"

namespace surf::mc {

namespace {

// Scatters into all directions alike with probability `albedo`, else stops the electron.
class GreyScatterer final : public Scattering {
 public:
  explicit GreyScatterer(double albedo) : albedo_(albedo) {}
  std::string describe() const override { return "isotropic with absorption"; }
  double inverse_mean_free_path_per_nm(double) const override { return 1; }
  bool debits() const override { return false; }
  void scatter(double energy, RandomStream& random, ScatterEvent& event) const override {
    if (random.uniform() >= albedo_) event.energy_loss_ev = energy;
    event.cos_theta = 1 - 2 * random.uniform();
    event.turn = random.uniform();
  }

 private:
  double albedo_;
};

std::optional<BoundaryHit> half_space(const Vec3& start, const Vec3& direction, double length,
                                      int material) {
  const double distance = -start.z / direction.z;
  if ((material < 0) == (direction.z > 0) || !(distance <= length)) return std::nullopt;
  return BoundaryHit{std::max(0.0, distance), {0, 0, 1}, material < 0 ? 0 : -1};
}

CustomResult reflect(double albedo, double cos_incidence, std::int64_t electrons) {
  std::vector<std::unique_ptr<const Scattering>> s;
  s.push_back(std::make_unique<GreyScatterer>(albedo));
  const Medium medium(std::move(s), nullptr, 0, 50);
  CustomSpecimen specimen{{&medium}, half_space, [](const Vec3& p) { return std::fabs(p.z); }};
  const Vec3 direction{std::sqrt(1 - cos_incidence * cos_incidence), 0, -cos_incidence};
  return simulate_custom(specimen, direction * -10, direction, 1000, -1, BarrierModel::off, 1,
                         electrons);
}

}  // namespace

TEST(SinCosTurn, IsAccurate) {
  for (double t = 0; t < 3; t += 0.001237) {
    double s, c;
    sin_cos_turn(t, s, c);
    EXPECT_NEAR(s, std::sin(2 * M_PI * t), 1e-8) << t;
    EXPECT_NEAR(c, std::cos(2 * M_PI * t), 1e-8) << t;
  }
}

TEST(Deflected, TurnsByTheAngleAndAroundTheAxis) {
  RandomStream random(1, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 d =
        i == 0 ? Vec3{0, 0, 1}
        : i == 1
            ? Vec3{0, 0, -1}
            : normalized({random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5});
    const double cosine = 1 - 2 * random.uniform(), turn = random.uniform();
    const Vec3 a = deflected(d, cosine, turn), b = deflected(d, cosine, turn + 0.25);
    EXPECT_NEAR(length(a), 1, 1e-9);
    EXPECT_NEAR(dot(a, d), cosine, 1e-8);
    EXPECT_NEAR(dot(a - d * dot(a, d), b - d * dot(b, d)), 0, 1e-8);
  }
}

// Chandrasekhar's half-space: isotropic scattering with single-scattering albedo c.
TEST(Transport, ReflectsAsChandrasekharComputed) {
  const std::int64_t n = 40000;
  const auto rows = test::read_reference("halfspace_isotropic_albedo.csv");
  for (const auto& row : rows) {
    if (row.at("mu0_incidence") == "diffuse") continue;
    const double truth = test::number(row, "reflectance_R");
    const CustomResult r = reflect(test::number(row, "single_scatter_albedo_c"),
                                   test::number(row, "mu0_incidence"), n);
    const double share = static_cast<double>(r.bse.sum) / static_cast<double>(n);
    test::expect_mean(share, std::sqrt(truth * (1 - truth) / static_cast<double>(n)), truth,
                      rows.size());
  }
}

TEST(Transport, BalancesElectronsAndEnergy) {
  for (const double albedo : {0.5, 0.95}) {
    const CustomResult r = reflect(albedo, 0.7, 5000);
    const Balance& b = r.balance;
    EXPECT_EQ(b.incident + b.generated, b.se + b.bse + b.transmitted + b.absorbed + b.total_lost());
    EXPECT_NEAR(b.incident_energy.ev() + b.generated_energy.ev(),
                b.escaped_energy.ev() + b.deposited_energy.ev() + b.lost_energy.ev(), 0.1);
  }
}

namespace {

// Where and in which direction primaries are when their energy falls below a mark.
class AtEnergy final : public Observer {
 public:
  explicit AtEnergy(double mark_ev) : mark_ev_(mark_ev) {}
  void begin_track(int, int, int, const Vec3&, const Vec3&, double) override { done_ = false; }
  void segment(const Vec3& from, const Vec3& to, double e0, double e1, int) override {
    if (done_ || e1 > mark_ev_) return;
    done_ = true;
    const double f = (e0 - mark_ev_) / (e0 - e1);  // the loss is nearly constant over a step
    const Vec3 p = from + (to - from) * f, d = normalized(to - from);
    cosine.add(d.z);
    cosine_squared.add(d.z * d.z);
    z.add(p.z);
    z_squared.add(p.z * p.z);
    r_squared.add(p.x * p.x + p.y * p.y);
  }
  test::Sample cosine, cosine_squared, z, z_squared, r_squared;

 private:
  double mark_ev_;
  bool done_ = false;
};

struct TransportRates {
  std::vector<double> log_e, log_1, log_2;  // of sigma_tr1 and sigma_tr2 in nm^2

  explicit TransportRates(int z) {
    for (const auto& row : test::read_reference("elsepa_totals.csv")) {
      if (row.at("Z") != std::to_string(z)) continue;
      log_e.push_back(std::log(test::number(row, "E_eV")));
      log_1.push_back(std::log(test::number(row, "sigma_tr1_cm2") * 1e14));
      log_2.push_back(std::log(test::number(row, "sigma_tr2_cm2") * 1e14));
    }
    std::vector<std::size_t> order(log_e.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return log_e[a] < log_e[b]; });
    const auto apply = [&](std::vector<double>& v) {
      std::vector<double> out;
      for (const auto i : order) out.push_back(v[i]);
      v = out;
    };
    apply(log_1);
    apply(log_2);
    apply(log_e);
  }
  double at(const std::vector<double>& v, double e) const {
    const double x = std::log(e);
    std::size_t i = 1;
    while (i + 1 < log_e.size() && log_e[i] < x) ++i;
    const double f = (x - log_e[i - 1]) / (log_e[i] - log_e[i - 1]);
    return std::exp(v[i - 1] + f * (v[i] - v[i - 1]));
  }
};

}  // namespace

// Lewis' moments (Phys. Rev. 78, 526 (1950)) in an infinite medium, with continuous loss.
TEST(Transport, HasLewisMoments) {
  for (const char* name : {"Si", "Au"}) {
    const Material& m = material(name);
    Physics physics;
    parse_physics("secondaries=off,barrier=off", physics);
    const Medium medium = make_medium(m, physics);
    const double start = 4000, mark = 2500;
    AtEnergy observer(mark);
    const CustomSpecimen everywhere{
        {&medium},
        [](const Vec3&, const Vec3&, double, int) { return std::optional<BoundaryHit>(); },
        {}};
    simulate_custom(everywhere, {}, {0, 0, 1}, start, 0, BarrierModel::off, 1, 20000, &observer);

    const TransportRates rates(m.constituents[0].atomic_number);
    const double density = number_density_per_nm3(m, m.constituents[0]);
    double k1 = 0, k2 = 0, z = 0, z2_inner = 0, z2 = 0, r2_inner = 0, r2 = 0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double e = start + (mark - start) * (i + 0.5) / n;
      const double ds = (start - mark) / n / medium.stopping_power_ev_per_nm(e);
      k1 += 0.5 * ds * density * rates.at(rates.log_1, e);
      k2 += 0.5 * ds * density * rates.at(rates.log_2, e);
      z += std::exp(-k1) * ds;
      z2_inner += std::exp(k1) * (1 + 2 * std::exp(-k2)) * ds;
      r2_inner += std::exp(k1) * (1 - std::exp(-k2)) * ds;
      z2 += 2.0 / 3 * std::exp(-k1) * z2_inner * ds;
      r2 += 4.0 / 3 * std::exp(-k1) * r2_inner * ds;
      k1 += 0.5 * ds * density * rates.at(rates.log_1, e);
      k2 += 0.5 * ds * density * rates.at(rates.log_2, e);
    }
    // 0.5 %: tables against the partial-wave sums and their interpolation in energy.
    const auto expect = [](const test::Sample& s, double truth) {
      test::expect_mean(s.mean(), s.standard_error(), truth, 10, 0.007 * truth);
    };
    expect(observer.cosine, std::exp(-k1));
    expect(observer.cosine_squared, (1 + 2 * std::exp(-k2)) / 3);
    expect(observer.z, z);
    expect(observer.z_squared, z2);
    expect(observer.r_squared, r2);
  }
}

TEST(Transport, TakesACallersOwnBoundary) {
  // A film of silicon between z = -5 and 0 in vacuum: some electrons come out below.
  const Medium medium = make_medium(material("Si"), {});
  const auto film = [](const Vec3& p, const Vec3& d, double length,
                       int inside) -> std::optional<BoundaryHit> {
    double best = HUGE_VAL;
    for (const double plane : {0.0, -5.0}) {
      const bool entering = (plane == 0.0) == (d.z < 0);
      const double t = (plane - p.z) / d.z;
      if (entering == (inside < 0) && t > -1e-9) best = std::min(best, std::max(0.0, t));
    }
    if (!(best <= length) || std::isinf(best)) return std::nullopt;
    return BoundaryHit{best, {0, 0, 1}, inside < 0 ? 0 : -1};
  };
  const CustomSpecimen specimen{{&medium}, film, {}};
  const CustomResult r =
      simulate_custom(specimen, {0, 0, 10}, {0, 0, -1}, 1000, -1, BarrierModel::quantum, 1, 3000);
  EXPECT_GT(r.balance.transmitted, 1000);
  EXPECT_GT(r.balance.se, 1000);
  EXPECT_EQ(r.balance.total_lost(), 0);
}

TEST(Transport, RefusesABoundaryFunctionsNonsense) {
  const Medium medium = make_medium(material("Si"), {});
  const CustomSpecimen specimen{{&medium},
                                [](const Vec3&, const Vec3&, double, int) {
                                  return std::optional(BoundaryHit{HUGE_VAL, {0, 0, 1}, 0});
                                },
                                {}};
  EXPECT_THROW(simulate_custom(specimen, {0, 0, 10}, {0, 0, -1}, 1000, -1, BarrierModel::off, 1, 1),
               InvalidInput);
}

}  // namespace surf::mc
