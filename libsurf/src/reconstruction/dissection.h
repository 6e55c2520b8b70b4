// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stencil_matrix.h"

namespace surf::reconstruction {

/// A part of the elimination: samples that are eliminated together, and the later ones which that
/// couples.
struct Front {
  int first = 0, own = 0;   ///< the places [first, first + own) are eliminated
  std::vector<int> border;  ///< later places that these and their descendants couple; they rise
  int parent = -1;          ///< the front that takes over what is left; -1 at the root
  int depth = 0;            ///< 0 at the root
  /// Where each place of `border` lies among the rows of the parent: its own, then its border.
  std::vector<int> in_parent;

  int rows() const { return own + static_cast<int>(border.size()); }
};

/// The order in which the samples of an area are eliminated (George 1973, doi:10.1137/0710032):
/// both halves first, then the two rows or columns between them, which is the reach of the stencil.
/// METIS finds no better order for a field, takes longer, and gives different orders if two threads
/// call it at once. Since all parts are rectangles, what couples is known without any search.
struct Dissection {
  int width = 0, height = 0;
  std::vector<int> sample;    ///< the sample at each place of the order; samples count row by row
  std::vector<int> place;     ///< the inverse
  std::vector<Front> fronts;  ///< children before their parents

  Dissection(int width, int height);
  int samples() const { return width * height; }
  double flops() const;  ///< additions and multiplications of a factorisation
};

}  // namespace surf::reconstruction
