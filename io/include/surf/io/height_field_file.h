// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/error.h"
#include "surf/core/height_field.h"

namespace surf::io {

/// Neither a reader of semsurf nor Gwyddion, if installed, recognises the file as a scan.
class UnknownScan : public FileError {
  using FileError::FileError;
};

/// A channel of a scan file.
struct HeightChannel {
  std::string name;    ///< as the file calls it
  std::string z_unit;  ///< as the file calls it; empty if the file names no unit
  int width = 0, height = 0;
  /// the unit is a length or not stated; false: amplitude, phase, volts ...
  bool is_height = true;
};

struct HeightReadOptions {
  std::string channel;  ///< by name, or by number from 1; empty: the first height channel
  std::optional<double> z_unit_nm;               ///< for files that state no unit; default 1
  std::optional<double> pitch_x_nm, pitch_y_nm;  ///< for files that state no pitch; default 1
};

/// One channel read from a scan file.
struct HeightFieldFile {
  HeightField field;
  std::string channel;
  std::string format;  ///< "Gwyddion", "Bruker Nanoscope" ...
  /// what the file says about itself; for a file of semsurf, how it was made
  std::map<std::string, std::string> metadata;
  std::vector<std::string> notes;  ///< assumptions that were made, for the user
};

/// Reads a height image. The format is recognised by content, then by name, then through Gwyddion
/// if it is installed: see docs/reference/afm_files.md. Row 0 is the lowest. The lower-left sample
/// lies at (0, 0), except in semsurf's own files, which state its place. Missing samples are holes.
/// A channel that is not a height is read only by name and with `z_unit_nm`. A unit or pitch stated
/// in the file overrides `z_unit_nm` and the pitch given here. Throws FileError (UnknownScan for an
/// unknown format), Unsupported; InvalidInput if the file holds no heights, for an SEM image
/// without `z_unit_nm` (`refuse_as_heights`), or for fewer than 2 x 2 samples; UsageError for an
/// unknown channel.
HeightFieldFile read_height_field(const std::filesystem::path& path,
                                  const HeightReadOptions& options = {});

/// A scan file that is read and parsed once. Any number of its channels can then be taken from it.
class HeightFile {
 public:
  /// Throws what `read_height_field` does.
  explicit HeightFile(const std::filesystem::path& path);
  ~HeightFile();
  HeightFile(HeightFile&&) noexcept;
  HeightFile& operator=(HeightFile&&) noexcept;

  std::vector<HeightChannel> channels() const;
  HeightFieldFile read(const HeightReadOptions& options = {}) const;

 private:
  struct Content;
  std::unique_ptr<const Content> content_;
};

/// All channels of a file, in the file's order, heights or not.
std::vector<HeightChannel> height_channels(const std::filesystem::path& path);

/// Whether a file is a scan by its content or has the name of a text file (.txt, .xyz ...). Images
/// in general formats (surf/io/image_file.h) count only if they come from an instrument.
bool is_height_field_file(const std::filesystem::path& path);

/// Whether the name's extension is one that only instruments give their scans (.mi, .sdf, .h5-jpk
/// ...). The content is not looked at: the file may still be unreadable, or need Gwyddion.
bool has_scan_name(const std::filesystem::path& path);

/// Writes in the format of the extension: GSF (32-bit floats), TIFF and VTI (channel z_nm, 32-bit
/// floats), text (.txt, a matrix, every digit). Placement and metadata are stored too. Holes are
/// NaN.
void write_height_field(const std::filesystem::path& path, const HeightField& field,
                        const std::map<std::string, std::string>& metadata = {});

/// Throws what `write_height_field` would throw for the name or folder, before any work is spent.
void check_height_field_target(const std::filesystem::path& path);

}  // namespace surf::io
