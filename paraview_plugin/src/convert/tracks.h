// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <vector>

#include "surf/core/track.h"

namespace surf::pv {

/// Polylines with the arrays of the files that `semsurf simulate --trajectories` writes: energy_ev
/// and material at points; kind, secondary, generation, electron, number and parent of lines.
vtkSmartPointer<vtkPolyData> to_vtk(const std::vector<Track>& tracks);

}  // namespace surf::pv
