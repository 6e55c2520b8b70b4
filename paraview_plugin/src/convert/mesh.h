// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "surf/mesh/surface.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf::pv {

/// The polygons and strips, fanned into triangles; lines and points are left out. Points keep their
/// order, none is merged. Throws InvalidInput, naming `subject`, where nothing or damaged triangles
/// are left.
TriangleMesh to_mesh(vtkPolyData* data, const char* subject);

/// The same with every array of its points that has one finite number for each, names made fit
/// (`scalar_name`).
Surface to_surface(vtkPolyData* data, const char* subject);

/// Vertices and triangles without a copy.
vtkSmartPointer<vtkPolyData> to_vtk(TriangleMesh mesh);
/// With scalars, "height" or else the first being shown.
vtkSmartPointer<vtkPolyData> to_vtk(Surface surface);

}  // namespace surf::pv
