// SPDX-License-Identifier: GPL-3.0-or-later
// Specimens as arguments.
#pragma once

#include "data.h"
#include "surf/io/sim/specimen_in_memory.h"
#include "surf/io/sim/specimen_request.h"

namespace surf::python {

inline const Argument specimen_argument{
    "specimen", "PathLike | Mesh | HeightField | ArrayLike | Sequence",
    "A scene file (TOML); or meshes and at most one height field, as files, objects or an array of "
    "heights in nm.",
    true, false};

/// Files are named in the request, shapes in memory are taken over.
void add_specimen(py::handle part, io::SpecimenRequest& request, io::ShapesInMemory& shapes);

}  // namespace surf::python
