// SPDX-License-Identifier: GPL-3.0-or-later
// What functions of scans and tips share.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "data.h"
#include "surf/afm/roughness.h"

namespace surf::python {

inline const Argument scan_argument{
    "scan", "PathLike | HeightField | ArrayLike",
    "The scan: a file of any format, or heights; arrays are in nm, row 0 is the lowest row.", true,
    false};
inline const Argument tip_argument{"tip", "PathLike | Tip | HeightField",
                                   "The tip, as semsurf makes tips, or any file of heights.", true,
                                   false};
inline const Argument use_argument{"use", "PathLike | Image | ArrayLike",
                                   "Of the scan's size: only samples where it is not 0 count."};
inline const Argument exclude_argument{
    "exclude", "PathLike | Image | ArrayLike",
    "Of the scan's size: samples where it is not 0 do not count."};

py::dict found_of(const Roughness& roughness);

/// The files of those that came from files, for records.
std::vector<std::filesystem::path> files_of(std::initializer_list<const Made*> made);

/// The tip's file, or "tip".
std::string name_of(const TipShape& tip);

}  // namespace surf::python
