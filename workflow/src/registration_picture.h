// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/affine.h"
#include "surf/core/placed_image.h"
#include "surf/io/plot.h"

namespace surf::workflow {

/// Pictures of a registration: the SEM image; the part of the simulated image under it; a
/// checkerboard of both, in which continuous edges show that the map is right; and the whole
/// simulated image with the outline of the SEM image.
io::Plot registration_picture(const PlacedImage& sem, const PlacedImage& simulated,
                              const Affine& sem_to_afm);

/// The four sides of the SEM image in the AFM's frame, as a closed line, in um.
io::PlotSeries outline_um(const PlacedImage& sem, const Affine& sem_to_afm);

/// An image for a panel, with places in um; invalid pixels stay blank.
io::PlotImage picture_um(const PlacedImage& image);

/// A panel of one image with axes in um.
io::PlotPanel image_panel(const std::string& title, io::PlotImage image);

}  // namespace surf::workflow
