// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/affine.h"
#include "surf/core/placed_image.h"
#include "surf/io/plot.h"

namespace surf::workflow {

/// The SEM image, the simulated one as it lies under it, squares of both in turn, where edges that
/// go on say that the map is right, and the simulated image whole with the outline of the SEM
/// image.
io::Plot registration_picture(const PlacedImage& sem, const PlacedImage& simulated,
                              const Affine& sem_to_afm);

/// The four sides of the SEM image in the AFM's frame, as a closed line, in um.
io::PlotSeries outline_um(const PlacedImage& sem, const Affine& sem_to_afm);

/// An image for a panel, places in um; what is not valid stays blank.
io::PlotImage picture_um(const PlacedImage& image);

/// A panel of one image with axes in um.
io::PlotPanel image_panel(const std::string& title, io::PlotImage image);

}  // namespace surf::workflow
