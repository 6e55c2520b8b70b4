// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/geometry/beam.h"
#include "surf/mc/geometry/specimen.h"
#include "surf/mc/physics/medium.h"

namespace surf::mc {

/// How far, nm, a beam's electrons get in a medium at most, as far as surfaces are built for them:
/// their range, or a millimetre where that is longer.
double reach_nm(const Medium& medium, const Beam& beam);

/// A height field with its continuation (`HeightFieldBody::edge`) as far as a scene needs it:
/// `reach_nm` (>= 0) around the scanned region, wherever a tilted beam turns that to.
HeightField field_in_reach(const HeightFieldBody& body, const Scan& scan, double reach_nm);

}  // namespace surf::mc
