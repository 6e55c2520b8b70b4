// SPDX-License-Identifier: GPL-3.0-or-later
#include "specimens.h"

#include "surf/core/error.h"

namespace surf::python {

void add_specimen(py::handle part, io::SpecimenRequest& request, io::ShapesInMemory& shapes) {
  const bool is_list = PyList_Check(part.ptr()) || PyTuple_Check(part.ptr());
  // Rows of numbers are heights.
  const auto first = [&] { return py::object(part[py::int_(0)]); };
  const bool is_rows = is_list && py::len(part) > 0 &&
                       (PyList_Check(first().ptr()) || PyTuple_Check(first().ptr())) &&
                       py::len(first()) > 0 &&
                       PyNumber_Check(py::object(first()[py::int_(0)]).ptr());
  if (is_list && !is_rows) {
    for (const py::handle one : part) add_specimen(one, request, shapes);
    return;
  }
  if (is_path(part)) {
    request.inputs.push_back(path_of(part));
    return;
  }
  if (py::isinstance<Mesh>(part)) {
    const Mesh mesh = mesh_of(part, {}, "specimen");
    shapes.meshes.push_back({mesh.name, mesh.material, mesh.mesh});
    return;
  }
  if (shapes.field) throw UsageError("specimen", "there are two height fields", "Give one at most");
  if (py::isinstance<Heights>(part) && request.heights.pitch_x_nm)
    throw UsageError("`scan.height_pitch`", "a HeightField has one already", "Leave it out");
  shapes.field = heights_of(part, request.heights, "specimen").field;
}

}  // namespace surf::python
