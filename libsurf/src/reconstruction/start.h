// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/reconstruction/reconstruct.h"
#include "surface_frame.h"

namespace surf::reconstruction {

/// The samples of the surface: those of the SEM image and `margin` more on every side, or the
/// AFM's.
SurfaceFrame frame_of(const AfmData* afm, const SemData* sem, int margin);

/// The eroded scan, its holes filled with the nearest heights, on the AFM's samples.
HeightField eroded(const AfmData& afm, int threads);

/// Heights of a field without holes on the surface's samples; beyond it the outermost go on.
Grid<double> on_frame(const HeightField& field, const SurfaceFrame& frame,
                      const Affine& surface_to_field);

/// The middle `width` x `height` samples from (`left`, `below`).
template <class T>
Grid<T> cut_out(const Grid<T>& from, int left, int below, int width, int height) {
  Grid<T> out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) out(x, y) = from(x + left, y + below);
  return out;
}

}  // namespace surf::reconstruction
