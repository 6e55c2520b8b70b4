// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <pybind11/stl.h>
#include "data.h"

namespace surf::python {

/// What all objects have: `record`, `found`, and how they show themselves (semsurf/_show.py, whose
/// functions end in `what`).
template <class Type>
void add_made(Type& type, const std::string& what) {
  using T = typename Type::type;
  type.def_property(
      "record", [](const T& made) { return record_of(made.record); },
      [](T& made, py::handle record) { made.record = metadata_of(record); },
      "How it was made, as files store it: version, parameters, inputs with their hashes.");
  type.def_property_readonly(
      "found", [](const T& made) { return made.found; },
      "Numbers and arrays that were found on the way, with standard errors.");
  const auto show = [&type](const char* name, const std::string& function, const char* help) {
    type.def(
        name,
        [function](const py::object& self, const py::args& args, const py::kwargs& keywords) {
          return py::module_::import("semsurf._show")
              .attr(function.c_str())(self, *args, **keywords);
        },
        help);
  };
  show("__repr__", "text_of_" + what, "One line.");
  show("_repr_html_", "html_of_" + what, "A small picture and a table, for notebooks.");
  show("plot", "plot_" + what, "Draws it with matplotlib, into `axes` if given; returns the axes.");
}

/// Copies and pickles: `data` gives a tuple of the object's own data, `make` the object from it.
template <class Type, class Data, class Make>
void add_pickling(Type& type, Data data, Make make) {
  using T = typename Type::type;
  type.def(py::pickle(
      [data](const T& made) {
        return py::make_tuple(data(made), record_of(made.record), made.found, made.file.string());
      },
      [make](const py::tuple& state) {
        auto made = std::make_shared<T>(make(state[0].template cast<py::tuple>()));
        made->record = metadata_of(state[1]);
        made->found = state[2];
        made->file = state[3].template cast<std::string>();
        return made;
      }));
}

}  // namespace surf::python
