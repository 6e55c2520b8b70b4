// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/transport/acceptance.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "surf/core/error.h"

namespace surf::mc {
namespace {

/// Mixes a number into a hash (the finaliser of SplitMix64, doi:10.1145/2714064.2660195).
std::uint64_t mixed(std::uint64_t hash, std::uint64_t number) {
  std::uint64_t z = (hash ^ number) + 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

std::uint64_t mixed(std::uint64_t hash, double number) {
  return mixed(hash, std::bit_cast<std::uint64_t>(number));
}

}  // namespace

Vec3 middle_direction(const Acceptance& a, int polar_bin, int azimuth_bin) {
  const double half = (polar_bin + 0.5) / a.polar_bins;  // sine of half the polar angle
  const double cosine = 1 - 2 * half * half, sine = std::sqrt(1 - cosine * cosine);
  const double turn = 2 * std::numbers::pi * (azimuth_bin + 0.5) / a.azimuth_bins;
  return {sine * std::cos(turn), sine * std::sin(turn), cosine};
}

double probability(const Acceptance& a, double energy_ev, const Vec3& direction) {
  const auto above = std::ranges::upper_bound(a.energy_edges_ev, energy_ev);
  if (above == a.energy_edges_ev.begin() || above == a.energy_edges_ev.end()) return 0;
  const auto e = static_cast<std::size_t>(above - a.energy_edges_ev.begin() - 1);
  const double half = std::sqrt(std::max(0.0, 0.5 * (1 - direction.z)));
  const int p = std::min(static_cast<int>(half * a.polar_bins), a.polar_bins - 1);
  double turn = std::atan2(direction.y, direction.x) / (2 * std::numbers::pi);
  if (turn < 0) turn += 1;
  const int t = std::min(static_cast<int>(turn * a.azimuth_bins), a.azimuth_bins - 1);
  return a.probability[(e * static_cast<std::size_t>(a.polar_bins) + static_cast<std::size_t>(p)) *
                           static_cast<std::size_t>(a.azimuth_bins) +
                       static_cast<std::size_t>(t)];
}

bool is_counted(double probability, double energy_ev, const Vec3& d, std::uint64_t stream) {
  if (probability <= 0) return false;
  if (probability >= 1) return true;
  const std::uint64_t hash = mixed(mixed(mixed(mixed(stream, energy_ev), d.x), d.y), d.z);
  return static_cast<double>(hash >> 11) * 0x1p-53 < probability;
}

std::string hash_of(const Acceptance& a) {
  std::uint64_t hash =
      mixed(static_cast<std::uint64_t>(a.polar_bins), static_cast<std::uint64_t>(a.azimuth_bins));
  for (const double edge : a.energy_edges_ev) hash = mixed(hash, edge);
  for (const float p : a.probability) hash = mixed(hash, static_cast<double>(p));
  return fmt::format("{:016x}", hash);
}

void validate(const Acceptance& a, const std::string& subject) {
  const std::vector<double>& edges = a.energy_edges_ev;
  if (edges.size() < 2 || !(edges.front() >= 0) || !std::isfinite(edges.back()) ||
      std::ranges::adjacent_find(edges, [](double low, double high) { return !(low < high); }) !=
          edges.end())
    throw UsageError(subject, "the edges of its energies do not rise from 0 eV or more",
                     "Give two or more, each above the one before");
  if (a.polar_bins < 1 || a.azimuth_bins < 1 ||
      a.probability.size() != a.energy_bins() * static_cast<std::size_t>(a.polar_bins) *
                                  static_cast<std::size_t>(a.azimuth_bins))
    throw UsageError(subject, "its table is not of the size of its bins",
                     "Give a probability for each bin of energy, polar angle and azimuth");
  for (const float p : a.probability)
    if (!(p >= 0 && p <= 1))
      throw UsageError(subject, fmt::format("a probability of {:g} is outside 0 to 1", p),
                       "Give the share of electrons that is counted");
}

}  // namespace surf::mc
