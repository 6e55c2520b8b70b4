// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/stopping_point.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sem/model/ring_shares.h"
#include "sem/model/window_model.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr int most_bins = 4096;

[[noreturn]] void refuse(const std::string& reason, const char* remedy) {
  throw InvalidInput("stopping-point model", reason, remedy);
}

void check(const ModelScope& scope, const StoppingPointParameters& p) {
  const auto positive = [](double v) { return std::isfinite(v) && v > 0; };
  if (!positive(scope.pixel_nm))
    refuse("it has no pixel size", "Give one: columns are as wide as pixels");
  if (!positive(p.ring_nm) || !positive(p.height_step_nm) || !std::isfinite(p.lowest_nm))
    refuse("a step of its table is not above 0 or its lowest height not finite",
           "Make the table again");
  if (p.rings < 1 || p.rings > most_bins || p.heights < 2 || p.heights > most_bins)
    refuse(fmt::format("its table has {} rings of {} heights", p.rings, p.heights),
           "Make the table again");
  for (const StoppingPointChannel& c : p.channels) {
    if (c.density_per_nm.size() !=
        static_cast<std::size_t>(p.rings) * static_cast<std::size_t>(p.heights))
      refuse(fmt::format("channel '{}' has {} numbers, not {} x {}", c.name,
                         c.density_per_nm.size(), p.rings, p.heights),
             "Make the table again");
    if (!std::ranges::all_of(c.density_per_nm, [](double d) { return std::isfinite(d) && d >= 0; }))
      refuse(fmt::format("channel '{}' has densities below 0 or not finite", c.name),
             "Make the table again");
    // Otherwise the density would jump, and the image would have a kink.
    for (std::size_t k = 0; k < static_cast<std::size_t>(p.rings); ++k) {
      const auto heights = static_cast<std::size_t>(p.heights);
      if (c.density_per_nm[k * heights] != 0 || c.density_per_nm[(k + 1) * heights - 1] != 0)
        refuse(fmt::format("channel '{}' does not begin and end with 0 in each ring", c.name),
               "Make the table wider");
    }
  }
  const double reach = p.rings * p.ring_nm / scope.pixel_nm;
  if (reach > most_stopping_columns)
    refuse(fmt::format("its electrons reach {:.0f} pixels of {:g} nm", reach, scope.pixel_nm),
           "Use pixels that are larger, or another model");
}

/// For each surrounding pixel: the number of stopping points in its column above a height. The
/// density is linear between heights, so this number is quadratic with a continuous derivative.
class Columns {
 public:
  Columns(const ModelScope& scope, const StoppingPointParameters& p)
      : reach_(ring_reach(p.rings, p.ring_nm, scope.pixel_nm)), lowest_(p.lowest_nm),
        step_(p.height_step_nm), heights_(static_cast<std::size_t>(p.heights)) {
    for (const StoppingPointChannel& c : p.channels) add(scope, p, c);
  }

  int reach() const { return reach_; }
  std::size_t channels() const { return tables_.size(); }

  WindowTerm term(std::size_t channel, int dx, int dy, double dz_nm, double, double) const {
    const Node* node = tables_[channel].nodes.data() + column(dx, dy) * heights_;
    const double t = (dz_nm - lowest_) / step_;
    if (t <= 0) return {node[0].above, 0, 0, 0};
    if (t >= static_cast<double>(heights_ - 1)) return {};
    const auto i = static_cast<std::size_t>(t);
    const double u = t - static_cast<double>(i), from = node[i].density,
                 change = node[i + 1].density - from;
    return {node[i].above - step_ * u * (from + 0.5 * u * change), -(from + u * change), 0, 0};
  }

  WindowSignal signal(std::size_t channel, double sum) const {
    if (tables_[channel].rule == StoppingRule::counted) return {sum, 1};
    if (sum > 0.5) return {4 * sum - 1, 4};
    return {sum / (1 - sum), 1 / ((1 - sum) * (1 - sum))};
  }

 private:
  struct Node {
    double density = 0, above = 0;  // per nm; number of stopping points above
  };
  struct Table {
    StoppingRule rule;
    std::vector<Node> nodes;  // [column][height]
  };

  std::size_t column(int dx, int dy) const {
    return static_cast<std::size_t>((dy + reach_) * (2 * reach_ + 1) + dx + reach_);
  }

  void add(const ModelScope& scope, const StoppingPointParameters& p,
           const StoppingPointChannel& channel) {
    const auto across = static_cast<std::size_t>(2 * reach_ + 1);
    Table table{channel.rule, std::vector<Node>(across * across * heights_)};
    for (int k = 0; k < p.rings; ++k) {
      const auto points = ring_points(k, p.ring_nm, scope.pixel_nm);
      const double share = 1.0 / static_cast<double>(points.size());
      std::vector<double> shares(across * across, 0);
      for (const RingPoint& point : points) shares[column(point.dx, point.dy)] += share;
      const double* density =
          channel.density_per_nm.data() + static_cast<std::size_t>(k) * heights_;
      for (std::size_t c = 0; c < shares.size(); ++c)
        for (std::size_t i = 0; shares[c] > 0 && i < heights_; ++i)
          table.nodes[c * heights_ + i].density += shares[c] * density[i];
    }
    for (std::size_t c = 0; c < across * across; ++c) {
      Node* node = table.nodes.data() + c * heights_;
      for (std::size_t i = heights_ - 1; i-- > 0;)
        node[i].above = node[i + 1].above + 0.5 * step_ * (node[i].density + node[i + 1].density);
    }
    tables_.push_back(std::move(table));
  }

  int reach_;
  double lowest_, step_;
  std::size_t heights_;
  std::vector<Table> tables_;
};

}  // namespace

std::shared_ptr<const ImageModel> make_stopping_point(const ModelScope& scope,
                                                      const StoppingPointParameters& parameters) {
  std::vector<std::string> names;
  for (const StoppingPointChannel& c : parameters.channels) names.push_back(c.name);
  check_channels(names, "stopping-point model");
  check(scope, parameters);
  return std::make_shared<WindowModel<Columns>>(scope, std::move(names),
                                                std::make_shared<const Columns>(scope, parameters));
}

}  // namespace surf
