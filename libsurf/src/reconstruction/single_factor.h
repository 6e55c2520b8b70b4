// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "cholmod_library.h"

namespace surf::reconstruction {

/// A factor in single precision: a multifrontal Cholesky factorisation (Duff and Reid 1983,
/// doi:10.1145/356044.356047) on OpenBLAS. CHOLMOD 5.12 has none.
std::unique_ptr<Factor> make_single_factor(std::shared_ptr<const Dissection> order);

}  // namespace surf::reconstruction
