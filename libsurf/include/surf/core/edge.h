// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace surf {

/// How a height field is continued beyond its samples.
enum class Edge {
  mirror,    ///< reflected about its outermost samples
  flat,      ///< continued with the outermost height
  periodic,  ///< repeated; the period is the number of samples times the pitch
};

}  // namespace surf
