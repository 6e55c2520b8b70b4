// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/energy_loss_function.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "surf/core/error.h"

namespace surf::mc {
namespace {

constexpr double steepest_slope =
    -2.5;  // at least so steep beyond the last energy: sums stay finite
constexpr int steps_per_interval = 16;

/// The square of the plasma energy of one electron per nm^3, eV^2: hbar^2 e^2 / (epsilon_0 m).
constexpr double squared_plasma_ev2_nm3 = 1.378843;

// The integral of f(w) over the logarithm of w, between the energies of a table.
template <class F>
double integrate(const std::vector<double>& energies, double from, const F& f) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < energies.size(); ++i) {
    const double a = std::log(std::max(energies[i], from)), b = std::log(energies[i + 1]);
    if (!(b > a)) continue;
    const double h = (b - a) / steps_per_interval;
    for (int k = 0; k < steps_per_interval; ++k) sum += h * f(std::exp(a + (k + 0.5) * h));
  }
  return sum;
}

[[noreturn]] void refuse(const std::string& name, int line, const std::string& what) {
  throw InvalidInput(
      name, fmt::format("line {}: {}", line, what),
      "Write two comment lines (source, binding energies in eV), then lines of energy_eV,ELF");
}

double number(std::string_view text, const std::string& name, int line) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value))
    refuse(name, line, fmt::format("'{}' is not a number", text));
  for (const char* c = end; c != text.data() + text.size(); ++c)
    if (*c != ' ' && *c != '\t' && *c != '\r')
      refuse(name, line, fmt::format("'{}' is not a number", text));
  return value;
}

std::vector<double> shells_of(std::string_view text, const std::string& name, int line) {
  std::vector<double> shells;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = text.find_first_not_of(" \t\r", at);
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(text.find_first_of(" \t\r", begin), text.size());
    const double shell = number(text.substr(begin, end - begin), name, line);
    if (shell < 0) break;  // -1 ends the list
    shells.push_back(shell);
    at = end;
  }
  return shells;
}

}  // namespace

EnergyLossFunction::EnergyLossFunction(std::vector<double> energies_ev, std::vector<double> values,
                                       std::vector<double> shells_ev, std::string source)
    : energies_(std::move(energies_ev)), values_(std::move(values)), shells_(std::move(shells_ev)),
      source_(std::move(source)) {
  const auto refuse = [](const std::string& what) {
    throw InvalidInput("energy-loss function", what,
                       "Give energies that rise, in eV, and values of 0 or more");
  };
  if (energies_.size() != values_.size() || energies_.size() < 3)
    refuse("it has fewer than three points");
  for (std::size_t i = 0; i < energies_.size(); ++i) {
    if (!(energies_[i] > (i == 0 ? 0 : energies_[i - 1])) || !std::isfinite(energies_[i]))
      refuse(fmt::format("point {}: the energy {} eV is not above the one before", i + 1,
                         energies_[i]));
    if (!(values_[i] >= 0) || !std::isfinite(values_[i]))
      refuse(fmt::format("point {}: the value is {}", i + 1, values_[i]));
  }
  const double last = energies_.back(), decade = std::max(last / 10, energies_.front());
  const double from = (*this)(decade), to = values_.back();
  slope_ = from > 0 && to > 0
               ? std::min(steepest_slope, std::log(to / from) / std::log(last / decade))
               : steepest_slope;
}

double EnergyLossFunction::operator()(double w) const {
  if (!(w > cut_ev_)) return 0;
  if (w <= energies_.front()) return values_.front() * w / energies_.front();
  if (w >= energies_.back()) return values_.back() * std::pow(w / energies_.back(), slope_);
  const auto above = std::ranges::upper_bound(energies_, w);
  const auto i = static_cast<std::size_t>(above - energies_.begin()) - 1;
  const double share = std::log(w / energies_[i]) / std::log(energies_[i + 1] / energies_[i]);
  if (!(values_[i] > 0 && values_[i + 1] > 0))
    return values_[i] + share * (values_[i + 1] - values_[i]);
  return values_[i] * std::pow(values_[i + 1] / values_[i], share);
}

EnergyLossFunction EnergyLossFunction::above(double gap_ev) const {
  EnergyLossFunction cut = *this;
  cut.cut_ev_ = std::max(0.0, gap_ev);
  return cut;
}

EnergyLossFunction EnergyLossFunction::times(double factor) const {
  EnergyLossFunction denser = *this;
  for (double& value : denser.values_) value *= factor;
  return denser;
}

double EnergyLossFunction::loss_of_electrons_ev(double electrons,
                                                double formula_units_per_nm3) const {
  const double wanted =
      electrons * formula_units_per_nm3 * squared_plasma_ev2_nm3 * std::numbers::pi / 2;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < energies_.size(); ++i) {
    const double a = std::log(std::max(energies_[i], cut_ev_)), b = std::log(energies_[i + 1]);
    if (!(b > a)) continue;
    const double h = (b - a) / steps_per_interval;
    for (int k = 0; k < steps_per_interval; ++k) {
      const double w = std::exp(a + (k + 0.5) * h);
      sum += h * w * w * (*this)(w);
      if (sum >= wanted) return w;
    }
  }
  return std::numeric_limits<double>::infinity();
}

double EnergyLossFunction::screening_sum() const {
  const double inside = integrate(energies_, cut_ev_, *this);
  const double below =
      cut_ev_ < energies_.front() ? values_.front() * (1 - cut_ev_ / energies_.front()) : 0;
  return 2 / std::numbers::pi * (inside + below + values_.back() / -slope_);
}

double EnergyLossFunction::electron_sum(double formula_units_per_nm3) const {
  const double last = energies_.back();
  const double sum = integrate(energies_, cut_ev_, [&](double w) { return w * w * (*this)(w); }) +
                     values_.back() * last * last / -(slope_ + 2);
  return 2 / std::numbers::pi * sum / (squared_plasma_ev2_nm3 * formula_units_per_nm3);
}

EnergyLossFunction parse_energy_loss_function(std::string_view text, const std::string& name) {
  std::vector<double> energies, values, shells;
  std::string source;
  int line = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view row = text.substr(at, end - at);
    at = end + 1;
    ++line;
    while (!row.empty() && (row.back() == '\r' || row.back() == ' ')) row.remove_suffix(1);
    if (row.empty()) continue;
    if (row.front() == '#') {
      row.remove_prefix(1);
      if (line == 2) shells = shells_of(row, name, line);
      else if (const auto colon = row.find("source"); colon != std::string_view::npos)
        source = row.substr(std::min(row.size(), row.find_first_not_of(" :", colon + 6)));
      continue;
    }
    const std::size_t comma = row.find(',');
    if (comma == std::string_view::npos) refuse(name, line, "there is no comma");
    energies.push_back(number(row.substr(0, comma), name, line));
    values.push_back(number(row.substr(comma + 1), name, line));
    if (!(energies.back() > 0) ||
        (energies.size() > 1 && !(energies.back() > energies[energies.size() - 2])))
      refuse(name, line,
             fmt::format("the energy {} eV is not above the one before", energies.back()));
    if (values.back() < 0)
      refuse(name, line, fmt::format("the value {} is negative", values.back()));
  }
  if (energies.size() < 3) refuse(name, line, "there are fewer than three points");
  return EnergyLossFunction(std::move(energies), std::move(values), std::move(shells),
                            std::move(source));
}

}  // namespace surf::mc
