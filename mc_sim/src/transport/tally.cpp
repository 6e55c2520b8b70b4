// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/transport/tally.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace surf::mc {

const char* name(LossCause cause) {
  switch (cause) {
    case LossCause::no_surface_ahead:
      return "no surface ahead";
    case LossCause::wrong_side:
      return "surface met from the wrong side";
    case LossCause::too_many_steps:
      return "too many steps";
    case LossCause::too_many_secondaries:
      return "too many secondaries";
  }
  return "unknown";
}

std::int64_t Balance::total_lost() const {
  return std::accumulate(lost.begin(), lost.end(), std::int64_t{0});
}

Balance& Balance::operator+=(const Balance& b) {
  incident += b.incident;
  missed += b.missed;
  generated += b.generated;
  se += b.se;
  bse += b.bse;
  transmitted += b.transmitted;
  absorbed += b.absorbed;
  dropped += b.dropped;
  for (std::size_t i = 0; i < lost.size(); ++i) lost[i] += b.lost[i];
  incident_energy += b.incident_energy;
  generated_energy += b.generated_energy;
  escaped_energy += b.escaped_energy;
  deposited_energy += b.deposited_energy;
  lost_energy += b.lost_energy;
  steps += b.steps;
  rays += b.rays;
  handed_over += b.handed_over;
  return *this;
}

PixelTally& PixelTally::operator+=(const PixelTally& b) {
  primaries += b.primaries;
  hits += b.hits;
  model = std::max(model, b.model);
  return *this;
}

Histogram& Histogram::operator+=(const Histogram& b) {
  for (std::size_t i = 0; i < bins.size(); ++i) bins[i] += b.bins[i];
  return *this;
}

Estimate estimate(std::int64_t primaries, const Counts& counts) {
  if (primaries < 1) return {};
  const double n = static_cast<double>(primaries);
  const double mean = static_cast<double>(counts.sum) / n;
  if (primaries < 2) return {mean, 0};
  const double variance = std::max(0.0, static_cast<double>(counts.squares) / n - mean * mean);
  return {mean, std::sqrt(variance / (n - 1))};
}

}  // namespace surf::mc
