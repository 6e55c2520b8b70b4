// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

class vtkPolyData;

namespace surf::io::vtk {

/// The content of a VTP file with inline binary data.
std::string vtp_content(const std::string& file, vtkPolyData* data);

}  // namespace surf::io::vtk
