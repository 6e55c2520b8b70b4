// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampler.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "afm/normal_numbers.h"
#include "chain.h"
#include "compare_truth.h"
#include "drawn_scene.h"
#include "reconstruction/gauss_newton.h"
#include "reconstruction/posterior.h"
#include "surf/core/parallel.h"

namespace surf::bench {
namespace {

using namespace reconstruction;
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

constexpr int few = affine_numbers + 2 + tip_numbers;
constexpr int chains = 4, margin_px = 6;

Vector vector_of(const Step& s) {
  const auto heights = static_cast<Eigen::Index>(s.z_nm.size());
  Vector v(heights + few);
  v.head(heights) = Eigen::Map<const Vector>(s.z_nm.data().data(), heights);
  v.segment(heights, affine_numbers) = Eigen::Map<const Vector>(s.map.data(), affine_numbers);
  v.segment(heights + affine_numbers, 2) = Eigen::Map<const Vector>(s.mixture.data(), 2);
  v.tail(tip_numbers) = Eigen::Map<const Vector>(s.tip.data(), tip_numbers);
  return v;
}

Step step_of(const Objective& o, const Vector& v) {
  Step s = o.zero();
  const double* from = v.data();
  std::copy_n(from, s.z_nm.size(), s.z_nm.data().begin());
  from += s.z_nm.size();
  std::copy_n(from, affine_numbers, s.map.begin());
  std::copy_n(from + affine_numbers, 2, s.mixture.begin());
  std::copy_n(from + affine_numbers + 2, tip_numbers, s.tip.begin());
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

/// The posterior about the optimum. Student's t with one degree of freedom is a normal
/// distribution whose precision w is drawn from an exponential one, of rate (curvature^2 + scale^2)
/// / 2 given the heights. So the prior, which no step of a Hamiltonian sampler could follow (it is
/// stiff by eight orders of magnitude, and contacts of the tip and the model have kinks), is
/// sampled exactly (Gibbs), and given w only the images are not normal.
class Target {
 public:
  Target(const Objective& o, const Unknowns& optimum) : o_(o), optimum_(optimum) {
    Objective::State state = o.evaluate(optimum);
    Step g = o.gradient(optimum, state), prior = o.zero();
    o.prior.evaluate(optimum.z_nm, &prior.z_nm, nullptr);
    add(g, -1, prior);
    gradient_ = vector_of(g);
    for (double& w : state.prior_weights.data()) w = 0;
    images_ = second_derivative(o, optimum, state);
    least_ = of_images(o.zero());
  }

  Eigen::Index unknowns() const { return gradient_.size(); }

  /// A draw of the weights given the unknowns.
  Grid<double> draw_weights(const Vector& x, RandomStream& random) const {
    Grid<double> w = o_.prior.squared_curvature(o_.moved(optimum_, step_of(o_, x)).z_nm);
    const double scale = std::pow(o_.prior.curvature_per_nm(), 2);
    for (double& v : w.data()) v = -2 * std::log(random.uniform()) / (scale + v);
    return w;
  }

  /// The normal distribution of the unknowns given the weights, if the images were linear.
  struct Normal {
    Eigen::LLT<Matrix> factor;
    Vector mean;
    Vector draw(NormalNumbers& normal) const {
      Vector n(mean.size());
      for (double& v : n) v = normal();
      return factor.matrixU().solve(n);
    }
  };
  Normal normal(const Grid<double>& weights) const {
    Matrix a = images_;
    const int w = weights.width();
    o_.prior.for_each_difference(weights, [&](int x, int y, int count, const int* dx, const int* dy,
                                              const double* c, double weight) {
      for (int i = 0; i < count; ++i)
        for (int k = 0; k < count; ++k)
          a((y + dy[i]) * w + x + dx[i], (y + dy[k]) * w + x + dx[k]) += weight * c[i] * c[k];
    });
    Step pull = o_.zero();
    o_.prior.add_product(weights, optimum_.z_nm, pull.z_nm);
    Normal out{Eigen::LLT<Matrix>(a), {}};
    out.mean = out.factor.solve(-gradient_ - vector_of(pull));
    return out;
  }

  /// How much less likely the images and the tip are than if they were linear.
  double beyond_linear(const Vector& x) const {
    const Vector ax = images_.selfadjointView<Eigen::Lower>() * x;
    return of_images(step_of(o_, x)) - least_ - gradient_.dot(x) - 0.5 * x.dot(ax);
  }

 private:
  double of_images(const Step& step) const {
    const Unknowns at = o_.moved(optimum_, step);
    const Objective::State s = o_.evaluate(at);
    double value = s.afm_value + s.sem_value;
    for (const double t : at.tip) value += 0.5 * o_.tip_precision * t * t;
    return value;
  }

  const Objective& o_;
  const Unknowns& optimum_;
  Vector gradient_;
  Matrix images_;
  double least_ = 0;
};

/// `exact`: with the images' own likelihood, by proposals that leave the normal distribution as it
/// is (Cotter et al. 2013, doi:10.1214/13-STS421, section 4.2), accepted by `beyond_linear`.
Chain sample(const Target& target, bool exact, std::uint64_t seed, std::uint64_t number) {
  const int warm_up = exact ? 250 : 50, draws = exact ? 600 : 250, proposals = exact ? 25 : 1;
  NormalNumbers normal(seed, 100 + number);
  RandomStream random(seed, 200 + number, 0);
  Vector x = Vector::Zero(target.unknowns());
  double beyond = 0;
  Chain chain;
  chain.draws.resize(x.size(), draws);
  chain.step = exact ? 0.1 : 1;
  int accepted = 0;
  for (int i = 0; i < warm_up + draws; ++i) {
    if (i % 50 == 0) fmt::print(stderr, "chain {}, draw {}, step {:.3f}\n", number, i, chain.step);
    const Target::Normal given = target.normal(target.draw_weights(x, random));
    for (int k = 0; k < proposals; ++k) {
      const double keep = std::sqrt(1 - chain.step * chain.step);
      const Vector next = given.mean + keep * (x - given.mean) + chain.step * given.draw(normal);
      const double there = exact ? target.beyond_linear(next) : 0;
      const double acceptance = std::min(1.0, std::exp(beyond - there));
      if (random.uniform() < acceptance) {
        x = next;
        beyond = there;
        accepted += i >= warm_up;
      }
      if (exact && i < warm_up)
        chain.step = std::min(1.0, chain.step * std::exp(0.03 * (acceptance - 0.3)));
    }
    if (i >= warm_up) chain.draws.col(i - warm_up) = x;
  }
  chain.acceptance = accepted / static_cast<double>(draws * proposals);
  return chain;
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

void print_comparison(const DrawnScene& scene, const Fitted& f, const Posterior& said,
                      const Matrix& covariance, const std::vector<Chain>& all) {
  fmt::print(
      "  Medians and 10 to 90 % ranges over unknowns. Deviations: the sampler's over the root of\n"
      "  the diagonal of A^-1, and over the stated deviation, which has few draws and the prior's\n"
      "  bias. Quantiles: 2.5 and 97.5 % about the mean over 1.96 deviations, expected -1 and 1.\n"
      "  Mean: the sampler's less the optimum over the stated deviation, expected 0.\n"
      "  {:12} {:4}   {:19}   {:19}   {:11}   mean\n",
      "", "", "over A^-1", "over stated", "quantiles");
  const auto linear = [&](Eigen::Index k) { return std::sqrt(covariance(k, k)); };
  for (const workflow::PixelRegion& region :
       workflow::pixel_regions(scene.truth, f.inner(said.data_support))) {
    std::vector<Compared> compare;
    std::vector<double> stated;
    for (int y = 0; y < region.pixels.height(); ++y)
      for (int x = 0; x < region.pixels.width(); ++x) {
        if (!region.pixels(x, y)) continue;
        const int u = x + f.margin_px, v = y + f.margin_px;
        const Eigen::Index k = static_cast<Eigen::Index>(v) * f.objective.frame.width + u;
        compare.push_back(compared(all, k, linear(k)));
        stated.push_back(said.deviation_nm(u, v));
      }
    print_line(region.name, compare, stated);
  }
  const Eigen::Index heights = covariance.rows() - few;
  const auto print_few = [&](const char* name, Eigen::Index from, Eigen::Index count) {
    std::vector<Compared> compare;
    std::vector<double> stated;
    for (Eigen::Index k = from; k < from + count; ++k) {
      compare.push_back(compared(all, heights + k, linear(heights + k)));
      stated.push_back(compare.back().linear);
    }
    print_line(name, compare, stated);
  };
  print_few("map", 0, affine_numbers);
  print_few("gain", affine_numbers, 1);
  print_few("offset", affine_numbers + 1, 1);
  print_few("tip", affine_numbers + 2, tip_numbers);
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
  const Posterior said =
      posterior(o, optimum, {}, 6, seed, 1, Precision::single_where_it_holds, {});

  const Matrix second = second_derivative(o, optimum, a.state);
  const auto n = second.rows(), heights = n - few;
  const Matrix covariance = second.llt().solve(Matrix::Identity(n, n));
  fmt::print(
      "A case of {} x {} pixels, seed {}: {} unknowns, {} of them heights; the optimum {} "
      "after {} iterations\n",
      size.width, size.height, seed, n, heights, ended.ended, ended.iterations);
  std::fflush(stdout);
  const Target target(o, optimum);
  for (const bool exact : {false, true}) {
    std::vector<Chain> all(chains);
    parallel_for(chains, 0, [&](std::size_t k, int) { all[k] = sample(target, exact, seed, k); });
    fmt::print(
        "\n{}: {} chains of {} draws, {:.1f} minutes\n",
        exact ? "The exact posterior" : "The prior exact, the images linear", chains,
        all[0].draws.cols(),
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / 60);
    print_mixing(all);
    print_comparison(scene, f, said, covariance, all);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace surf::bench
