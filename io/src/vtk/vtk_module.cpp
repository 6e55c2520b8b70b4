// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtk_functions.h"
#include "vtk_library.h"

namespace {

using namespace surf::io;

constexpr VtkLibrary table{vtk::write_vti, vtk::vti_content, vtk::format_vtp, vtk::format_tracks,
                           vtk::write_volume};

}  // namespace

SEMSURF_MODULE(vtk, table)
