// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "convert/image.h"

class vtkAlgorithm;
class vtkInformation;
class vtkInformationVector;
class vtkPolyData;
class vtkTable;

namespace surf::pv {

// In parallel every rank asks for the whole of its inputs and computes the same result; then an
// image is cut to the piece that was asked for, and surfaces and tables come from the first piece
// alone. So the bytes are those of one rank, whatever the number: many of the algorithms depend on
// the whole image (its range, its commonest plane), and each uses all cores of its rank as it is.

/// For RequestUpdateExtent: all of every input, images, surfaces and tables alike.
void request_whole(vtkInformationVector** inputs, int ports);

/// For RequestInformation: what an image output is going to be.
void announce(vtkInformation* output, const Frame& frame);

/// For RequestInformation: a surface or table that knows of pieces, so that it is made anew when
/// another is asked for.
int announce_pieces(vtkInformation* output);

/// The piece of `whole` that was asked for, as the output. Field data goes along.
void give(vtkInformation* output, vtkImageData* whole);
/// All of it to the first piece, nothing to the others.
void give(vtkInformation* output, vtkPolyData* whole);
void give(vtkInformation* output, vtkTable* whole);
/// Whether this is the first piece: else there is no need to compute what only that one gives.
bool is_first_piece(vtkInformation* output);

/// An input of a port, or nullptr if nothing is connected. Throws InvalidInput if an image is not
/// whole.
vtkImageData* image_input(vtkInformationVector** inputs, int port, const char* subject,
                          int which = 0);
vtkPolyData* surface_input(vtkInformationVector** inputs, int port);

/// The array that was chosen; the only one there is; or else the one that is shown, where none was
/// chosen, as a filter made before its input was read has not. Nullptr if there is none with one
/// number per point. Throws InvalidInput where the chosen one is not among several.
vtkDataArray* chosen_array(vtkAlgorithm* self, int index, vtkImageData* image);

}  // namespace surf::pv
