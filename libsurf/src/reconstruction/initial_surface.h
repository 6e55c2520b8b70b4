// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/reconstruction/reconstruct.h"
#include "surface_frame.h"

namespace surf::reconstruction {

/// The samples of the surface: those of the SEM image with `margin` more on every side, or those of
/// the AFM image.
SurfaceFrame frame_of(const AfmData* afm, const SemData* sem, int margin);

/// The eroded scan on the AFM's samples; holes are filled with the nearest heights.
HeightField eroded(const AfmData& afm, int threads);

/// Heights of a field without holes on the surface's samples; beyond the field its outermost
/// heights are used.
Grid<double> on_frame(const HeightField& field, const SurfaceFrame& frame,
                      const Affine& surface_to_field);

/// The part of `width` x `height` samples from (`left`, `below`).
template <class T>
Grid<T> cut_out(const Grid<T>& from, int left, int below, int width, int height) {
  Grid<T> out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) out(x, y) = from(x + left, y + below);
  return out;
}

}  // namespace surf::reconstruction
