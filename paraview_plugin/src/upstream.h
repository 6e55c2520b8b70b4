// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/io/overlaps.h"

class vtkAlgorithm;

namespace surf::pv {

/// Throws UsageError where a file that is written is one that semsurf's readers, anywhere before
/// `self` in the pipeline, read. `more` are files that `self` reads on its own.
void refuse_overlaps(vtkAlgorithm* self, const std::vector<io::FileUse>& outputs,
                     std::vector<io::FileUse> more = {});

}  // namespace surf::pv
