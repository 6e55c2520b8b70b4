// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/sem_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "files/lower_extension.h"
#include "raster/image_formats.h"
#include "sem_header.h"
#include "sem_pixels.h"
#include "sem_settings.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"

namespace surf::io {
namespace {

namespace fs = std::filesystem;

constexpr int tag_comment = 40092;  // Windows' "XPComment", in UTF-16
constexpr std::array tags_fei{34682, 34680};
constexpr int tag_zeiss = 34118, tag_tescan = 50431;
constexpr std::size_t most_text = std::size_t{1} << 20;  // of a file beside an image

/// The pages of a TIFF file; none for others.
std::vector<TiffPage> pages_of(const std::string& file, const std::string& content) {
  if (!is_tiff(content)) return {};
  return parse_tiff_pages(Bytes(file, content));
}

std::optional<SemHeader> header_in(const TiffPage& page, SemSize size) {
  for (const int tag : tags_fei)
    if (const TiffTag* const found = page.find(tag)) return parse_fei(found->bytes().text(), size);
  if (const TiffTag* const found = page.find(tag_zeiss))
    return parse_zeiss(found->bytes().text(), size);
  if (const TiffTag* const found = page.find(tag_tescan))
    return parse_tescan_tag(found->bytes().text(), size);
  return std::nullopt;
}

std::string text_at(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored) || fs::file_size(path, ignored) > most_text) return {};
  return decoded_text(read_file(path, most_text));
}

bool is_tescan_text(std::string_view text) { return text.find("PixelSizeX") != text.npos; }

std::vector<fs::path> text_names(const fs::path& image) {
  fs::path small = image, capital = image;
  return {small.replace_extension(".txt"), capital.replace_extension(".TXT")};
}

// image.tif has image-tif.hdr.
fs::path header_name(const fs::path& image) {
  std::string extension = image.extension().string();
  if (!extension.empty()) extension.front() = '-';
  return image.parent_path() / (image.stem().string() + extension + ".hdr");
}

std::optional<SemHeader> header_beside(const fs::path& path, SemSize size) {
  for (const fs::path& beside : text_names(path)) {
    const std::string text = text_at(beside);
    if (is_jeol_text(text)) return parse_jeol(text, size);
    if (is_hitachi_text(text)) return parse_hitachi(text, size);
  }
  const std::string text = text_at(header_name(path));
  if (is_tescan_text(text)) return parse_tescan_text(text, size);
  return std::nullopt;
}

std::optional<SemHeader> header_in_comment(const TiffPage& page, SemSize size) {
  const TiffTag* const comment = page.find(tag_comment);
  if (!comment) return std::nullopt;
  SemHeader header = parse_hitachi(decoded_utf16(comment->bytes().text()), size);
  return header.pixel_x_nm > 0 ? std::optional(header) : std::nullopt;
}

std::optional<SemHeader> find_header(const fs::path& path, const std::vector<TiffPage>& pages,
                                     SemSize size) {
  std::optional<SemHeader> header;
  if (!pages.empty()) header = header_in(pages.front(), size);
  if (!header) header = header_beside(path, size);
  if (!header && !pages.empty()) header = header_in_comment(pages.front(), size);
  return header;
}

std::optional<double> number_in(const std::map<std::string, std::string>& metadata,
                                const char* key) {
  const auto found = metadata.find(key);
  if (found == metadata.end()) return std::nullopt;
  double value = 0;
  const std::string& text = found->second;
  const bool good =
      std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc{};
  return good && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Of an image that this program, or another user of this library, has written.
std::optional<SemHeader> header_of_ours(const Image& image) {
  const bool ours =
      image.metadata.contains("semsurf.version") || image.pitch_x_nm != 1 || image.pitch_y_nm != 1;
  if (!ours) return std::nullopt;
  SemHeader header;
  header.format = "semsurf";
  set_pixel(header, image.pitch_x_nm, image.pitch_y_nm, "the file");
  header.energy_ev = positive(number_in(image.metadata, "beam.energy_ev"));
  header.tilt_deg = number_in(image.metadata, "beam.tilt_deg");
  header.metadata = image.metadata;
  return header;
}

template <class T>
void cut_rows(Grid<T>& grid, int rows) {
  if (grid.empty()) return;
  Grid<T> rest(grid.width(), grid.height() - rows);
  std::copy(grid.data().begin() + std::ptrdiff_t{rows} * grid.width(), grid.data().end(),
            rest.data().begin());
  grid = std::move(rest);
}

void check(const SemReadOptions& options) {
  for (const auto& size : {options.pixel_x_nm, options.pixel_y_nm})
    if (size && !(*size > 0 && std::isfinite(*size)))
      throw UsageError("SEM pixel size", fmt::format("{:g} nm", *size), "It has to be above 0");
}

void set_pitch(SemFile& out, const SemHeader& header, const SemReadOptions& options,
               const std::string& file) {
  const auto given = [](const std::optional<double>& a, const std::optional<double>& b) {
    return a ? a : b;
  };
  const auto x = given(options.pixel_x_nm, options.pixel_y_nm),
             y = given(options.pixel_y_nm, options.pixel_x_nm);
  if (!x && !(header.pixel_x_nm > 0))
    throw UsageError(file,
                     header.format.empty()
                         ? "nothing in it, or beside it, says how large its pixels are"
                         : fmt::format("what {} wrote of it does not say how large its pixels are",
                                       header.format),
                     "Add `sem_pixel_size=2nm`, with the size at the specimen");
  out.image.pitch_x_nm = x.value_or(header.pixel_x_nm);
  out.image.pitch_y_nm = y.value_or(header.pixel_y_nm);
  out.pixel_from = x ? "given" : header.pixel_from;
  constexpr double same = 1e-3;
  if (x && header.pixel_x_nm > 0 && std::abs(*x / header.pixel_x_nm - 1) > same)
    out.notes.push_back(
        fmt::format("the pixel size given, {:.6g} nm, goes before the file's own, {:.6g} nm", *x,
                    header.pixel_x_nm));
}

}  // namespace

std::vector<fs::path> sem_settings_beside(const fs::path& image) {
  std::vector<fs::path> files;
  for (fs::path& beside : text_names(image)) {
    if (beside == image) continue;
    const std::string text = text_at(beside);
    if (is_jeol_text(text) || is_hitachi_text(text)) files.push_back(std::move(beside));
  }
  if (fs::path beside = header_name(image); is_tescan_text(text_at(beside)))
    files.push_back(std::move(beside));
  return files;
}

SemFile read_sem_image(const fs::path& path, const SemReadOptions& options) {
  check(options);
  const std::string file = path.string();
  const bool vti = lower_extension(path) == ".vti";
  const std::string content = vti ? std::string() : read_file(path);
  const std::vector<TiffPage> pages = pages_of(file, content);

  SemPixels pixels;
  Image image;
  if (!pages.empty() && options.channel.empty())
    pixels = palette_pixels(pages.front(), Bytes(file, content));
  if (pixels.values.empty()) {
    image = vti ? read_image(path) : read_raster(path);
    pixels = grey_pixels(image, options.channel, file);
    if (!vti) pixels.bits = raster_bits(path);
  }
  const SemSize size{pixels.values.width(), pixels.values.height()};

  std::optional<SemHeader> header = find_header(path, pages, size);
  if (!header && !pages.empty()) header = described_pixel(pages.front());
  if (!header && image.width() > 0) header = header_of_ours(image);
  if (!header) header.emplace();

  SemFile out;
  out.format = header->format.empty() ? "image" : header->format;
  out.channel = pixels.channel;
  out.bits = pixels.bits;
  out.notes = header->notes;
  out.notes.insert(out.notes.end(), pixels.notes.begin(), pixels.notes.end());
  set_pitch(out, *header, options, file);
  out.image.values = std::move(pixels.values);
  out.image.valid = std::move(pixels.valid);
  out.image.origin_x_nm = image.origin_x_nm;
  out.image.origin_y_nm = image.origin_y_nm;
  out.databar_rows = header->databar_rows;
  if (out.databar_rows > 0 && !options.keep_databar) {
    cut_rows(out.image.values, out.databar_rows);
    cut_rows(out.image.valid, out.databar_rows);
    out.notes.push_back(
        fmt::format("the databar, the lowest {} rows, is left out", out.databar_rows));
  }
  out.energy_ev = header->energy_ev;
  out.working_distance_nm = header->working_distance_nm;
  out.tilt_deg = header->tilt_deg;
  out.detector = header->detector;
  out.instrument = header->instrument;
  out.metadata = std::move(header->metadata);
  validate(out.image, file.c_str());
  return out;
}

namespace {

/// What a microscope's maker says of the image, if anything. The image itself is not read.
std::optional<SemHeader> header_of_maker(const fs::path& path) {
  constexpr std::array extensions{".tif", ".tiff", ".png", ".jpg", ".jpeg", ".bmp"};
  std::error_code ignored;
  if (std::find(extensions.begin(), extensions.end(), lower_extension(path)) == extensions.end())
    return {};
  if (!fs::is_regular_file(path, ignored)) return {};
  try {
    const std::string content = read_file(path);
    return find_header(path, pages_of(path.string(), content), {2, 2});
  } catch (const FileError&) {
    return {};  // whoever reads it says why
  }
}

}  // namespace

bool is_sem_image_file(const fs::path& path) { return header_of_maker(path).has_value(); }

void refuse_as_heights(const fs::path& path) {
  const auto header = header_of_maker(path);
  if (!header) return;
  throw InvalidInput(
      path.string(),
      fmt::format("it is an SEM image ({}), and its grey levels are no heights", header->format),
      "Give a scan; an SEM image's noise is found with 'semsurf noise sem'. If it does hold "
      "heights, say "
      "what one grey level is with `scan.height_unit`");
}

}  // namespace surf::io
