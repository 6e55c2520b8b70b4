// SPDX-License-Identifier: GPL-3.0-or-later
#include "specimens.h"

#include "surf/core/error.h"

namespace surf::python {

void add_specimen(py::handle part, io::SpecimenRequest& request, io::ShapesInMemory& shapes) {
  if (PyList_Check(part.ptr()) || PyTuple_Check(part.ptr())) {
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
