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

/// Neither a reader of semsurf nor Gwyddion, where it is installed, knows the file as a scan.
class UnknownScan : public FileError {
  using FileError::FileError;
};

/// A channel of a scan file.
struct HeightChannel {
  std::string name;    ///< as the file calls it
  std::string z_unit;  ///< as the file calls it; empty where it says nothing
  int width = 0, height = 0;
  bool is_height = true;  ///< a length or not said; false: amplitude, phase, volts ...
};

struct HeightReadOptions {
  std::string channel;  ///< by name, or by its number from 1; empty: the first of heights
  std::optional<double> z_unit_nm;               ///< of files that do not say: default 1
  std::optional<double> pitch_x_nm, pitch_y_nm;  ///< of files that do not say: default 1
};

/// What a scan file holds of one channel.
struct HeightFieldFile {
  HeightField field;
  std::string channel;
  std::string format;  ///< "Gwyddion", "Bruker Nanoscope" ...
  std::map<std::string, std::string>
      metadata;                    ///< what the file says of itself; of ours, what made it
  std::vector<std::string> notes;  ///< what had to be assumed, for the user
};

/// Reads a height image by content, then by name, then through Gwyddion where it is installed: see
/// docs/methods/afm_files.md. Row 0 is the lowest; the lower-left sample lies at (0, 0) but in
/// files of semsurf's own, which say where it lies. Missing samples are holes. A channel that is no
/// height is read only by name and with `z_unit_nm`. What the file says goes before `z_unit_nm` and
/// the pitch. Throws FileError (UnknownScan for a format that is not known), Unsupported;
/// InvalidInput where nothing in the file is a height, for an SEM image without `z_unit_nm`
/// (`refuse_as_heights`), or where fewer than 2 x 2 samples are there; UsageError for an unknown
/// channel.
HeightFieldFile read_height_field(const std::filesystem::path& path,
                                  const HeightReadOptions& options = {});

/// A scan file that is read and understood once, however many of its channels are asked for.
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

/// All channels of a file, in its order, heights or not.
std::vector<HeightChannel> height_channels(const std::filesystem::path& path);

/// Whether a file is a scan by its content or has a name of text (.txt, .xyz ...). Images of
/// general formats (surf/io/image_file.h) count only where they are an instrument's.
bool is_height_field_file(const std::filesystem::path& path);

/// Whether the name is one that only instruments give their scans (.mi, .sdf, .h5-jpk ...). The
/// content is not looked at: such a file may still be unreadable, or need Gwyddion.
bool has_scan_name(const std::filesystem::path& path);

/// Writes by extension: GSF (32-bit floats), TIFF and VTI (channel z_nm, 32-bit floats), text
/// (.txt, a matrix, every digit). Placement and metadata go along; holes are NaN.
void write_height_field(const std::filesystem::path& path, const HeightField& field,
                        const std::map<std::string, std::string>& metadata = {});

/// Throws what `write_height_field` would for the name or folder, before any work is spent.
void check_height_field_target(const std::filesystem::path& path);

}  // namespace surf::io
