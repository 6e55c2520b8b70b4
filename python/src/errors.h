// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

namespace surf::python {

/// Makes semsurf's errors Python's: semsurf.UsageError and so on (semsurf/_errors.py), with the
/// attributes field, subject, reason and remedy. Fields are called by their keywords.
void translate_errors();

/// An exception of semsurf/_errors.py.
pybind11::object error_class(const char* name);

}  // namespace surf::python
