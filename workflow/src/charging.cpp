// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/charging.h"

#include <cmath>
#include <variant>

#include <fmt/format.h>

namespace surf::workflow {
namespace {

constexpr double insulating_gap_ev = 2.5;
constexpr double balanced = 0.005;  // below this net charge per primary there is no charging

}  // namespace

std::optional<Charging> charging_of(const std::vector<mc::Material>& materials,
                                    const mc::SimulationResult& result, const mc::Scan& scan) {
  Charging c;
  for (const mc::Material& m : materials) {
    if (m.dielectric->band.gap_ev >= insulating_gap_ev)
      c.materials += (c.materials.empty() ? "" : ", ") + m.name;
    else c.all = false;
  }
  const mc::Balance& b = result.balance;
  const std::int64_t hits = b.incident - b.missed;
  if (c.materials.empty() || hits <= 0) return std::nullopt;
  c.leaving =
      static_cast<double>(b.se + b.bse + b.transmitted - b.missed) / static_cast<double>(hits);
  if (const auto* const dose = std::get_if<mc::Dose>(&result.budget);
      dose && dose->current_pa > 0) {
    c.current_pa = dose->current_pa;
    c.per_nm2 = dose->electrons * c.net() / (scan.pixel_x_nm * scan.pixel_y_nm);
  }
  return c;
}

std::string describe(const Charging& c) {
  std::string text = fmt::format("{} insulate{}{}: {:.3f} electrons leave for each primary{}",
                                 c.materials, c.materials.find(',') == std::string::npos ? "s" : "",
                                 c.all ? "" : " among the materials", c.leaving,
                                 c.all ? "" : " of the whole image");
  if (std::fabs(c.net()) < balanced) return text + ", so that hardly any charge stays";
  text += fmt::format(", so that {} charge stays, {:.3f} a primary",
                      c.net() > 0 ? "positive" : "negative", std::fabs(c.net()));
  if (c.current_pa > 0)
    text += fmt::format(": {:.3g} pA of {:g} pA, {:.3g} per nm2 in an image",
                        std::fabs(c.net()) * c.current_pa, c.current_pa, std::fabs(c.per_nm2));
  return text + " (fields are not simulated)";
}

}  // namespace surf::workflow
