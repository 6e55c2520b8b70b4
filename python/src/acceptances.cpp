// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptances.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include <cmath>
#include <memory>
#include <string>

#include "surf/core/error.h"

namespace surf::python {
namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// 1 eV up to 50 eV, then 5 %, up to the highest energy of a beam.
std::vector<double> usual_edges() {
  constexpr double linear_to_ev = 50, step_ev = 1, ratio = 1.05, top_ev = 30'000;
  std::vector<double> edges;
  for (double e = 0; e <= linear_to_ev; e += step_ev) edges.push_back(e);
  while (edges.back() * ratio < top_ev) edges.push_back(edges.back() * ratio);
  edges.push_back(std::nextafter(top_ev * 1.001, 1e9));
  return edges;
}

std::vector<double> edges_of(py::handle values, const std::string& subject) {
  const Numbers array = Numbers::ensure(values);
  if (!array || array.ndim() != 1 || array.size() < 2) {
    PyErr_Clear();
    throw UsageError(subject, "the edges of its energies are no list of two numbers or more",
                     "Give numbers in eV that rise, as (function, [0, 50, 1000])");
  }
  return {array.data(), array.data() + array.size()};
}

/// The function at the middles of all bins.
void tabulate(const py::object& function, mc::Acceptance& a, const std::string& subject) {
  const auto energies = static_cast<py::ssize_t>(a.energy_bins());
  const py::ssize_t polar = a.polar_bins, azimuth = a.azimuth_bins;
  Numbers energy({energies, polar, azimuth}), direction({energies, polar, azimuth, py::ssize_t{3}});
  double* e = energy.mutable_data();
  double* d = direction.mutable_data();
  for (py::ssize_t i = 0; i < energies; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double middle = 0.5 * (a.energy_edges_ev[k] + a.energy_edges_ev[k + 1]);
    for (int p = 0; p < a.polar_bins; ++p)
      for (int t = 0; t < a.azimuth_bins; ++t) {
        const Vec3 to = mc::middle_direction(a, p, t);
        *e++ = middle, *d++ = to.x, *d++ = to.y, *d++ = to.z;
      }
  }
  const py::object result = function(energy, direction);
  const Numbers given = Numbers::ensure(result);
  if (!given) PyErr_Clear();
  const bool one = given && given.size() == 1;
  if (!one && (!given || given.ndim() != 3 || given.shape(0) != energies ||
               given.shape(1) != polar || given.shape(2) != azimuth))
    throw UsageError(subject, "it does not return a number for each energy",
                     fmt::format("Return an array of the shape of energy_ev, {} x {} x {}, of "
                                 "probabilities from 0 to 1",
                                 energies, polar, azimuth));
  a.probability.resize(static_cast<std::size_t>(energy.size()));
  for (std::size_t i = 0; i < a.probability.size(); ++i)
    a.probability[i] = static_cast<float>(given.data()[one ? 0 : i]);
}

}  // namespace

std::vector<mc::Detector> detectors_of(const py::object& functions) {
  if (!py::isinstance<py::dict>(functions))
    throw UsageError("acceptance", "it is no dictionary of functions",
                     "Write acceptance={'name': function}");
  std::vector<mc::Detector> detectors;
  for (const auto& [name, value] : py::dict(functions)) {
    mc::Detector detector;
    detector.name = py::str(name);
    const std::string subject = fmt::format("acceptance['{}']", detector.name);
    py::object function = py::reinterpret_borrow<py::object>(value);
    auto table = std::make_shared<mc::Acceptance>();
    table->energy_edges_ev = usual_edges();
    if (py::isinstance<py::tuple>(function) && py::len(function) == 2) {
      table->energy_edges_ev = edges_of(function[py::int_(1)], subject);
      function = function[py::int_(0)];
    }
    if (!PyCallable_Check(function.ptr()))
      throw UsageError(subject, "it is no function",
                       "Give a function of energy_ev and direction, or a pair of it and the edges "
                       "of energies");
    tabulate(function, *table, subject);
    mc::validate(*table, subject);
    detector.acceptance = std::move(table);
    detectors.push_back(std::move(detector));
  }
  return detectors;
}

}  // namespace surf::python
