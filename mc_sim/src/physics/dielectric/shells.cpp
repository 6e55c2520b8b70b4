// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/dielectric/shells.h"

#include <algorithm>
#include <cmath>

namespace surf::mc {
namespace {

constexpr double least_binding_ev = 20;  // less is of the valence band
constexpr double fall = -3.5;
constexpr double just_below = 0.97;

}  // namespace

Shells::Shells(const DielectricData& data)
    : elf_(data.elf), gap_ev_(data.band.gap_ev), exhausted_ev_(data.exhausted_ev) {
  std::vector<double> bindings = data.elf.shells_ev();
  std::ranges::sort(bindings);
  for (const double b : bindings)
    if (b >= std::max(least_binding_ev, data.band.filled_ev))
      shells_.push_back({b, elf_(just_below * b)});
}

double Shells::draw(double w0_ev, double loss_ev, double u) const {
  double above = elf_(w0_ev);  // of this shell and those bound less
  for (auto shell = shells_.rbegin(); shell != shells_.rend(); ++shell) {
    if (shell->binding_ev + gap_ev_ > std::min(w0_ev, loss_ev)) continue;
    const double below =
        std::min(above, shell->below * std::pow(w0_ev / (just_below * shell->binding_ev), fall));
    const double share = above > 0 ? 1 - below / above : 0;
    if (u < share) return shell->binding_ev;
    u = (u - share) / (1 - share);
    above = below;
  }
  return w0_ev > exhausted_ev_ ? deepest(loss_ev) : 0;
}

double Shells::deepest(double most_ev) const {
  double binding = 0;
  for (const Shell& s : shells_)
    if (s.binding_ev + gap_ev_ <= most_ev) binding = s.binding_ev;
  return binding;
}

double Shells::draw_inner(double loss_ev, double u) const {
  const double all = share(loss_ev, loss_ev);
  const double shell = all > 0 ? draw(loss_ev, loss_ev, u * all) : 0;
  return shell > 0 ? shell : deepest(loss_ev);
}

double Shells::share(double w0_ev, double loss_ev) const {
  if (w0_ev > exhausted_ev_ && deepest(loss_ev) > 0) return 1;
  const double whole = elf_(w0_ev);
  double rest = whole;
  for (auto shell = shells_.rbegin(); shell != shells_.rend(); ++shell)
    if (shell->binding_ev + gap_ev_ <= std::min(w0_ev, loss_ev))
      rest =
          std::min(rest, shell->below * std::pow(w0_ev / (just_below * shell->binding_ev), fall));
  return whole > 0 ? 1 - rest / whole : 0;
}

double Shells::next_ev(double binding_ev) const {
  double next = 0;
  for (const Shell& s : shells_)
    if (s.binding_ev < 0.5 * binding_ev) next = s.binding_ev;
  return next;
}

}  // namespace surf::mc
