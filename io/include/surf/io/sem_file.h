// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/placed_image.h"

namespace surf::io {

struct SemReadOptions {
  std::string channel;  ///< of files with several, by name; empty: the first
  std::optional<double> pixel_x_nm, pixel_y_nm;  ///< go before what the file says; > 0
  bool keep_databar = false;  ///< leave the strip of text below the image where it is
};

/// An SEM image and what its microscope noted.
struct SemFile {
  PlacedImage
      image;  ///< numbers as stored: 0 to 255 ...; invalid: annotations in colour, no numbers
  std::string format;      ///< "Thermo/FEI", "Zeiss SmartSEM", "semsurf" ... or "image"
  std::string channel;     ///< of files with several
  int bits = 0;            ///< of each number; 0: floats
  int databar_rows = 0;    ///< that the file has, below the image
  std::string pixel_from;  ///< where the pixel size is from: "Scan.PixelWidth", "given" ...
  std::optional<double> energy_ev;                      ///< of the beam, > 0
  std::optional<double> working_distance_nm, tilt_deg;  ///< the tilt is the stage's
  std::string detector, instrument;                     ///< empty where the file says nothing
  std::map<std::string, std::string> metadata;          ///< all that the file says of itself
  std::vector<std::string> notes;  ///< what had to be assumed or was left out, for the user
};

/// Reads an image of any format that OpenImageIO reads, and its pixel size from what Thermo/FEI,
/// Zeiss, TESCAN, JEOL, Hitachi, ImageJ, OME-TIFF or semsurf have written into it or beside it: see
/// docs/methods/sem_files.md. Row 0 of the file is the top; the lower-left pixel lies at (0, 0) but
/// in semsurf's own files, which say where it lies. Grey pictures stored as RGB or with a palette
/// become grey. Throws FileError; UsageError for an unknown channel, a pixel size out of range, or
/// where there is none at all; InvalidInput for pictures in colour and fewer than 2 x 2 pixels.
SemFile read_sem_image(const std::filesystem::path& path, const SemReadOptions& options = {});

/// Whether a microscope's maker has left its mark in the file or beside it.
bool is_sem_image_file(const std::filesystem::path& path);

/// Throws InvalidInput for such a file: its grey levels are no heights. Whoever names the length of
/// a grey level wants heights of it all the same, and is not to be asked.
void refuse_as_heights(const std::filesystem::path& path);

}  // namespace surf::io
