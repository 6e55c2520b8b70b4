// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "surf/core/height_field.h"
#include "surf/core/image.h"
#include "surf/core/image_rows.h"

namespace surf::io {

struct ImageSize {
  int width = 0, height = 0;
};

/// How EXR and TIFF store pixels. Tiles come with a pyramid for viewing: the image in half its
/// size, a quarter and so on. Each pyramid value is the mean of the four values below it. This
/// holds for standard errors too: a pyramid shows the mean standard error of the image's own
/// pixels.
enum class Layout {
  automatic,  ///< rows, which every program reads, up to `most_pixels_in_rows`; tiles above
  rows,
  tiles
};
inline constexpr std::int64_t most_pixels_in_rows = std::int64_t{1} << 26;

/// Whether EXR and TIFF are written in tiles.
bool in_tiles(Layout layout, const ImageSize& size);

/// Number of pixels stored in an EXR or TIFF file: with tiles, all smaller sizes are included, and
/// tiles at the edge are filled up.
std::int64_t stored_pixels(Layout layout, const ImageSize& size);

struct ImageWriteOptions {
  /// The channel shown by formats with a single picture (PNG); empty: the first.
  std::string channel;
  Layout layout = Layout::automatic;
  /// Channels whose numbers are labels (materials): a pyramid does not average them.
  std::vector<std::string> labels = {};
};

/// Writes in the format of the extension: EXR (named 32-bit float channels), TIFF (one 32-bit float
/// page per channel, its name in ImageDescription), PNG (8-bit grey, stretched between the 0.5 and
/// 99.5 percentiles; the range is in the metadata) and VTI (ParaView, inline binary, one array per
/// channel, placed in space). Row 0 of the file is the top. Pitch, origin, units and metadata are
/// stored if the format can hold them; an empty metadata value counts as none. The file appears
/// under its name only when it is complete. Throws FileError, UsageError for an unknown extension
/// or channel, Unsupported if this build lacks the format.
void write_image(const std::filesystem::path& path, const Image& image,
                 const ImageWriteOptions& options = {});

/// Writes the same bytes row by row. This takes the memory of 64 rows of all channels, or of 256
/// rows for tiles; VTI needs all values at once. A pyramid beyond some hundred MB is kept in
/// scratch files beside `path` while writing. PNG reads its channel three times, TIFF one channel
/// after the other.
void write_image(const std::filesystem::path& path, const ImageRows& rows,
                 const ImageWriteOptions& options = {});

/// Throws what `write_image` would throw for the name, folder or channel, before any work is spent.
void check_image_target(const std::filesystem::path& path, const Image* image = nullptr,
                        const ImageWriteOptions& options = {});

/// Reads the files of `write_image` (EXR, TIFF, PNG, VTI) and plain images of these formats.
/// Channels are named by the file, or "L", "R", "G", "B", "A". The pitch is 1 nm if the file states
/// none. Of a plain TIFF the first page is read. Whole numbers stay as they are stored (0 to 255
/// ...). A PNG written by semsurf is stretched back to its values, as well as 8 bits allow. Throws
/// FileError.
///
/// `level` applies to files with a pyramid: 0 is the image, 1 the image in half its size, and so
/// on. Throws UsageError if there is no such level.
Image read_image(const std::filesystem::path& path, int level = 0);

/// Whether the file that `image` was read from states its pixel size. Plain pictures do not, and
/// their pitch of 1 nm means nothing.
bool states_pixel_size(const Image& image);

/// One size of an image that has several.
struct ImageLevel {
  Image image;
  int level = 0, levels = 1;  ///< this level, and the number of levels; 0 is the image itself
  ImageSize whole;            ///< pixels of level 0
};

/// Reads the largest size of at most `most_pixels` pixels, or the smallest that the file holds.
ImageLevel read_image_within(const std::filesystem::path& path, std::int64_t most_pixels);

bool is_image_file(const std::filesystem::path& path);

/// Takes one channel of an image (empty: the first) as heights in nm: values times `z_unit_nm`.
/// Pixels that are not finite, or 0 in a channel "valid", become holes. Throws UsageError for an
/// unknown channel.
HeightField to_height_field(const Image& image, const std::string& channel, double z_unit_nm = 1);

/// The image libraries in use, as "OpenImageIO 2.4.7, VTK 9.1.0".
std::string image_library_versions();

}  // namespace surf::io
