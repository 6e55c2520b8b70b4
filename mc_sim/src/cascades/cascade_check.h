// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/cascades/cascade_library.h"

namespace surf::mc {

/// Whether a page is made as cascade_format.h says. Every node is looked at: its parts fill it
/// exactly and lie inside it, its counts are those of what it holds, and energies never rise along
/// a track. So whatever the words are, replaying a page that passes never reads outside it and
/// always ends. Spheres and positions may be anything.
bool is_page(const CascadePage& page);

}  // namespace surf::mc
