// SPDX-License-Identifier: GPL-3.0-or-later
// Detectors that are functions in Python.
#pragma once

#include <pybind11/pybind11.h>

#include <vector>

#include "surf/mc/transport/detector.h"

namespace surf::python {

namespace py = pybind11;

/// Calls each function of a dictionary of names, once, and tabulates what it returns. A value is a
/// function or a pair of a function and the edges of the bins of energy. Throws UsageError naming
/// `acceptance` and the detector; what a function throws goes on.
std::vector<mc::Detector> detectors_of(const py::object& functions);

}  // namespace surf::python
