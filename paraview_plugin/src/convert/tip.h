// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

#include "convert/image.h"
#include "surf/afm/tip.h"

namespace surf::pv {

/// Any image of heights whose highest place is the apex; what files say of tips counts
/// (surf/io/tip_file.h).
Tip to_tip(vtkImageData* image, vtkDataArray* heights, const char* subject);
/// The same as it meets a scan (`workflow::tip_for`), whose warnings are added to `warnings`.
Tip to_tip_for(vtkImageData* image, vtkDataArray* heights, const HeightField& scan,
               const char* subject, std::vector<std::string>& warnings);

/// The structuring function about (0, 0), NaN where the tip has no sample.
vtkSmartPointer<vtkImageData> to_vtk(const Tip& tip);

}  // namespace surf::pv
