// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampler.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "compare_truth.h"
#include "drawn_scene.h"
#include "hamiltonian.h"
#include "reconstruction/gauss_newton.h"
#include "reconstruction/posterior.h"
#include "surf/core/parallel.h"

namespace surf::bench {
namespace {

using namespace reconstruction;
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

constexpr int few = map_numbers + 2 + tip_numbers;
constexpr int chains = 4, margin_px = 6;

Vector vector_of(const Step& s) {
  const auto heights = static_cast<Eigen::Index>(s.z_nm.size());
  Vector v(heights + few);
  v.head(heights) = Eigen::Map<const Vector>(s.z_nm.data().data(), heights);
  v.segment(heights, map_numbers) = Eigen::Map<const Vector>(s.map.data(), map_numbers);
  v.segment(heights + map_numbers, 2) = Eigen::Map<const Vector>(s.mixture.data(), 2);
  v.tail(tip_numbers) = Eigen::Map<const Vector>(s.tip.data(), tip_numbers);
  return v;
}

Step step_of(const Objective& o, const Vector& v) {
  Step s = o.zero();
  const double* from = v.data();
  std::copy_n(from, s.z_nm.size(), s.z_nm.data().begin());
  from += s.z_nm.size();
  std::copy_n(from, map_numbers, s.map.begin());
  std::copy_n(from + map_numbers, 2, s.mixture.begin());
  std::copy_n(from + map_numbers + 2, tip_numbers, s.tip.begin());
  return s;
}

/// A by its columns, with the SEM's exact J.
Matrix second_derivative(const Objective& o, const Unknowns& at, const Objective::State& state) {
  const auto n = static_cast<Eigen::Index>(o.frame.width) * o.frame.height + few;
  Matrix a(n, n);
  parallel_for(static_cast<std::size_t>(n), 0, [&](std::size_t k, int) {
    const auto column = static_cast<Eigen::Index>(k);
    a.col(column) = vector_of(o.product(at, state, step_of(o, Vector::Unit(n, column))));
  });
  return 0.5 * (a + a.transpose());
}

double quantile(std::vector<double> v, double share) {
  if (v.empty()) return std::nan("");
  const auto at =
      v.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(v.size() - 1));
  std::ranges::nth_element(v, at);
  return *at;
}

/// One unknown, by the sampler and by the linearised posterior about the optimum, which is 0.
struct Compared {
  double mean = 0, deviation = 0, low = 0, high = 0;  // by draws; 2.5 and 97.5 % quantiles
  double linear = 0;                                  // the root of the diagonal of A^-1
};

Compared compared(const std::vector<Chain>& all, Eigen::Index number, double linear) {
  std::vector<double> draws;
  for (const Chain& c : all)
    for (Eigen::Index k = 0; k < c.draws.cols(); ++k) draws.push_back(c.draws(number, k));
  Compared out;
  out.linear = linear;
  const auto n = static_cast<double>(draws.size());
  for (const double d : draws) out.mean += d / n;
  for (const double d : draws) out.deviation += (d - out.mean) * (d - out.mean) / (n - 1);
  out.deviation = std::sqrt(out.deviation);
  out.low = quantile(draws, 0.025);
  out.high = quantile(draws, 0.975);
  return out;
}

void print_line(const std::string& name, const std::vector<Compared>& all,
                const std::vector<double>& stated) {
  if (all.empty()) return;
  std::vector<double> ratio, by_stated, low, high, off, covered;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Compared& c = all[i];
    ratio.push_back(c.deviation / c.linear);
    by_stated.push_back(c.deviation / stated[i]);
    low.push_back((c.low - c.mean) / (1.96 * c.deviation));
    high.push_back((c.high - c.mean) / (1.96 * c.deviation));
    off.push_back(c.mean / stated[i]);
  }
  fmt::print(
      "  {:12} {:4}   {:4.2f} ({:4.2f} to {:4.2f})   {:4.2f} ({:4.2f} to {:4.2f})   {:5.2f} "
      "{:5.2f}   "
      "{:5.2f} ({:5.2f} to {:5.2f})\n",
      name, all.size(), quantile(ratio, 0.5), quantile(ratio, 0.1), quantile(ratio, 0.9),
      quantile(by_stated, 0.5), quantile(by_stated, 0.1), quantile(by_stated, 0.9),
      quantile(low, 0.5), quantile(high, 0.5), quantile(off, 0.5), quantile(off, 0.1),
      quantile(off, 0.9));
}

void print_mixing(const std::vector<Chain>& all) {
  for (const Chain& c : all) fmt::print("  acceptance {:.2f}, step {:.3f}\n", c.acceptance, c.step);
  std::vector<double> r_hat, effective;
  for (Eigen::Index k = 0; k < all.front().draws.rows(); ++k) {
    const Mixing m = mixing_of(all, k);
    r_hat.push_back(m.r_hat);
    effective.push_back(m.effective);
  }
  fmt::print(
      "  split R-hat: median {:.3f}, 95 % below {:.3f}, largest {:.3f}\n"
      "  effective draws: median {:.0f}, 5 % below {:.0f}, fewest {:.0f}\n\n",
      quantile(r_hat, 0.5), quantile(r_hat, 0.95), quantile(r_hat, 1), quantile(effective, 0.5),
      quantile(effective, 0.05), quantile(effective, 0));
}

}  // namespace

int compare_with_sampler(const std::shared_ptr<const ImageModel>& model, std::uint64_t seed) {
  const auto begin = std::chrono::steady_clock::now();
  SceneOptions size;
  size.width = 24;
  size.height = 18;
  size.features = false;
  const DrawnScene scene = draw_scene(model, seed, size);
  Fitted f = fit_scene(scene, Start::given, false, margin_px);
  const Objective& o = f.objective;
  DescentOptions descent;
  descent.tolerance = 1e-4;
  descent.iterations = 200;
  descent.threads = 1;
  descent.precision = Precision::double_always;
  const DescentReport ended = gauss_newton(o, f.at, descent);
  const Unknowns optimum = f.at;
  const Curvature a = expected_curvature(o, optimum, seed, 1, Precision::double_always, {});
  const Posterior said = posterior(o, optimum, 6, seed, 1, Precision::single_where_it_holds, {});

  const Matrix second = second_derivative(o, optimum, a.state);
  const Eigen::LLT<Matrix> factor(second);
  const auto n = second.rows(), heights = n - few;
  const Matrix covariance = factor.solve(Matrix::Identity(n, n));
  // Coordinates in which the linearised posterior is standard normal: x = L^-T q, A = L L^T.
  const Matrix root = Matrix(factor.matrixU()).inverse();
  const double least = o.evaluate(optimum).value();
  const Energy energy = [&](const Vector& q, Vector& gradient) {
    const Step step = step_of(o, root * q);
    const Unknowns at = o.moved(optimum, step);
    const Objective::State s = o.evaluate(at);
    Step g = o.gradient(at, s);
    g.mixture[0] /= 1 + step.mixture[0];  // it is by the change of the changed gains
    gradient = root.transpose() * vector_of(g);
    return s.value() - least;
  };
  fmt::print(
      "A case of {} x {} pixels, seed {}: {} unknowns, {} of them heights; the optimum {} "
      "after {} iterations\n",
      size.width, size.height, seed, n, heights, ended.ended, ended.iterations);
  std::vector<Chain> all(chains);
  parallel_for(chains, 0, [&](std::size_t k, int) {
    HamiltonianOptions options;
    options.seed = seed;
    options.chain = k;
    all[k] = hamiltonian(
        energy, static_cast<int>(n), [&](const Vector& q) -> Vector { return root * q; }, options);
  });
  fmt::print("Hamiltonian Monte Carlo, {} chains of {} draws, {:.1f} minutes\n", chains,
             all[0].draws.cols(),
             std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / 60);
  print_mixing(all);
  fmt::print(
      "Medians and 10 to 90 % ranges over unknowns. Deviations: the sampler's over the root of "
      "the\n"
      "diagonal of A^-1, and over the stated deviation, which has few draws and the bias by the\n"
      "prior. Quantiles: 2.5 and 97.5 % about the mean over 1.96 deviations, expected -1 and 1.\n"
      "Mean: the sampler's less the optimum over the stated deviation, expected 0.\n"
      "  {:12} {:4}   {:19}   {:19}   {:11}   mean\n",
      "", "", "over A^-1", "over stated", "quantiles");
  const auto linear = [&](Eigen::Index k) { return std::sqrt(covariance(k, k)); };
  for (const workflow::PixelRegion& region :
       workflow::pixel_regions(scene.truth, f.inner(said.data_support))) {
    std::vector<Compared> compare;
    std::vector<double> stated;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        if (!region.pixels(x, y)) continue;
        const int u = x + margin_px, v = y + margin_px;
        const Eigen::Index k = static_cast<Eigen::Index>(v) * o.frame.width + u;
        compare.push_back(compared(all, k, linear(k)));
        stated.push_back(said.deviation_nm(u, v));
      }
    print_line(region.name, compare, stated);
  }
  const auto print_few = [&](const char* name, Eigen::Index from, Eigen::Index count) {
    std::vector<Compared> compare;
    std::vector<double> stated;
    for (Eigen::Index k = from; k < from + count; ++k) {
      compare.push_back(compared(all, heights + k, linear(heights + k)));
      stated.push_back(compare.back().linear);
    }
    print_line(name, compare, stated);
  };
  print_few("map", 0, map_numbers);
  print_few("gain", map_numbers, 1);
  print_few("offset", map_numbers + 1, 1);
  print_few("tip", map_numbers + 2, tip_numbers);
  return 0;
}

}  // namespace surf::bench
