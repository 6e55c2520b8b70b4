// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/core/progress.h"
#include "surf/registration/landmarks.h"
#include "surf/workflow/register_job.h"

class vtkPolyData;

namespace surf::pv {

/// A fast model: its file, or for a material and an energy one that was kept, else it is trained and kept.
workflow::ModelRequest model_request(const std::string& file, const std::string& material, double energy_ev, double spot_nm);

/// Points that were picked in both views, in the same order; either may be nullptr. Throws UsageError where there are
/// not as many of both.
std::vector<LandmarkPair> landmarks_of(vtkPolyData* sem, vtkPolyData* afm);

/// Tells a watch of a chain's stages, of which there are about `stages`, and collects the warnings.
workflow::Reporter listen(const Watch& watch, int stages, std::vector<std::string>& warnings);

}  // namespace surf::pv
