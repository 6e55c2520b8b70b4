// SPDX-License-Identifier: GPL-3.0-or-later
#include "hdf5_library.h"

#include "files/module_for.h"

namespace surf::io {

const Hdf5Library& hdf5_library(const std::string& file) { return module_for<Hdf5Library>(file); }

}  // namespace surf::io
