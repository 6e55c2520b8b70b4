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

/// How EXR and TIFF hold pixels. Tiles come with a pyramid: the image in half its size, a quarter
/// and so on, for viewing. Each value there is the mean of the four below it; of standard errors
/// too: they are those of the image's own pixels.
enum class Layout {
  automatic,  ///< rows, which everybody reads, up to `most_pixels_in_rows`; tiles above
  rows,
  tiles
};
inline constexpr std::int64_t most_pixels_in_rows = std::int64_t{1} << 26;

/// Whether EXR and TIFF are written in tiles.
bool in_tiles(Layout layout, const ImageSize& size);

/// Pixels of an EXR or TIFF file: in tiles with all smaller sizes, tiles at the edge filled up.
std::int64_t stored_pixels(Layout layout, const ImageSize& size);

struct ImageWriteOptions {
  /// The channel that formats with a single picture (PNG) show; empty: the first.
  std::string channel;
  Layout layout = Layout::automatic;
  /// Channels of numbers that stand for something (materials): in a pyramid no means are made of
  /// them.
  std::vector<std::string> labels = {};
};

/// Writes by extension: EXR (named 32-bit float channels), TIFF (one 32-bit float page per channel,
/// its name in ImageDescription), PNG (8-bit grey, stretched between the 0.5 and 99.5 percentiles;
/// the range is in the metadata) and VTI (ParaView, inline binary, one array per channel, placed in
/// space). Row 0 of the file is the top. Pitch, origin, units and metadata go along where the
/// format can hold them (an empty value counts as none). The file appears under its name only when
/// it is complete. Throws FileError, UsageError for an unknown extension or channel, Unsupported
/// where this build lacks the format.
void write_image(const std::filesystem::path& path, const Image& image,
                 const ImageWriteOptions& options = {});

/// The same, with the same bytes, row by row: but for VTI, which needs all values at once, it takes
/// the memory of 64 rows of all channels, or of 256 for tiles; a pyramid beyond some hundred MB is
/// in scratch files beside `path` on the way. PNG reads its channel three times, TIFF one channel
/// after the other.
void write_image(const std::filesystem::path& path, const ImageRows& rows,
                 const ImageWriteOptions& options = {});

/// Throws what `write_image` would for the name, folder or channel, before any work is spent.
void check_image_target(const std::filesystem::path& path, const Image* image = nullptr,
                        const ImageWriteOptions& options = {});

/// Reads what `write_image` wrote (EXR, TIFF, PNG, VTI) and plain images of these formats: channels
/// named by the file or "L", "R", "G", "B", "A"; pitch 1 nm where the file has none; of a plain
/// TIFF the first page. Whole numbers stay as they are stored (0 to 255 ...); a PNG of ours is
/// stretched back to values, as well as 8 bits allow. Throws FileError.
///
/// `level` is for files with a pyramid: 0 the image, 1 in half its size, and so on. Throws
/// UsageError where there is no such level.
Image read_image(const std::filesystem::path& path, int level = 0);

/// Whether the file that `image` was read from says how large its pixels are. Plain pictures do
/// not, and their pitch of 1 nm means nothing.
bool states_pixel_size(const Image& image);

/// One size of an image that has several.
struct ImageLevel {
  Image image;
  int level = 0, levels = 1;  ///< levels of the file; 0 is the image itself
  ImageSize whole;            ///< pixels of level 0
};

/// The largest size of at most `most_pixels` pixels, or the smallest there is.
ImageLevel read_image_within(const std::filesystem::path& path, std::int64_t most_pixels);

bool is_image_file(const std::filesystem::path& path);

/// One channel of an image (empty: the first) as heights in nm: values times `z_unit_nm`. Pixels
/// that are not finite, or 0 in a channel "valid", are holes. Throws UsageError for an unknown
/// channel.
HeightField to_height_field(const Image& image, const std::string& channel, double z_unit_nm = 1);

/// The image libraries at work, as "OpenImageIO 2.4.7, VTK 9.1.0".
std::string image_library_versions();

}  // namespace surf::io
