// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

class vtkDataObject;

namespace surf::pv {

/// A number that tells data of other points, cells, extents or arrays apart, blocks included. Times
/// do not serve: ParaView runs what lies upstream again without any change.
std::uint64_t digest(vtkDataObject* data);

}  // namespace surf::pv
