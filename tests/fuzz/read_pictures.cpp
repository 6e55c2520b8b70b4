// SPDX-License-Identifier: GPL-3.0-or-later
// Targets that read images. OpenImageIO opens files itself, so these have a real one.
#include <algorithm>
#include <array>
#include <fstream>

#include "afm/tiff_tags.h"
#include "memory_files.h"
#include "sem/sem_header.h"
#include "sem/sem_pixels.h"
#include "surf/core/error.h"
#include "surf/io/image_file.h"
#include "surf/io/sem_file.h"
#include "target_lists.h"
#include "temporary_folder.h"

namespace surf::test {
namespace {

template <const char* Name>
Accepted picture(const std::string& content) {
  static const TemporaryFolder folder;
  const auto path = folder.path() / Name;
  std::ofstream(path, std::ios::binary) << content;
  put_memory_file(path, content);
  Accepted accepted;
  accepted.image = io::read_image(path);
  io::is_sem_image_file(path);
  io::SemReadOptions options;
  options.pixel_x_nm = 1;
  validate(io::read_sem_image(path, options).image);
  return accepted;
}

constexpr char exr[] = "input.exr", tif[] = "input.tif", png[] = "input.png";

Accepted vti(const std::string& content) {
  put_memory_file("input.vti", content);
  Accepted accepted;
  accepted.image = io::read_image("input.vti");
  return accepted;
}

void read_makers(const std::string& text, io::SemSize size) {
  using Parse = io::SemHeader (*)(std::string_view, io::SemSize);
  constexpr std::array<Parse, 6> parsers{io::parse_fei,        io::parse_zeiss,
                                         io::parse_tescan_tag, io::parse_tescan_text,
                                         io::parse_jeol,       io::parse_hitachi};
  for (const Parse parse : parsers) parse(text, size);
}

/// What makers of microscopes write beside images.
Accepted sem_text(const std::string& content) {
  const std::string text = io::decoded_text(content);
  const bool known =
      io::is_jeol_text(text) || io::is_hitachi_text(text) || text.find('=') != std::string::npos;
  read_makers(text, {4, 4});
  read_makers(io::decoded_utf16(content), {4, 4});
  if (!known)
    throw InvalidInput("input", "it has no settings", "Give the text of a microscope's maker");
  return {};
}

/// The tags of TIFF files, without OpenImageIO.
Accepted sem_tags(const std::string& content) {
  if (!io::is_tiff(content)) throw InvalidInput("input", "it is no TIFF file", "Give one");
  constexpr std::array makers{34682, 34680, 34118, 50431, 40092};
  const io::Bytes bytes("input", content);
  for (const io::TiffPage& page : io::parse_tiff_pages(bytes)) {
    io::described_pixel(page);
    for (const auto& [number, tag] : page.tags) {
      page.number(number);
      page.text(number);
      if (std::ranges::find(makers, number) != makers.end())
        read_makers(std::string(tag.bytes().text()), {4, 4});
    }
    io::palette_pixels(page, bytes);
  }
  return {};
}

}  // namespace

std::vector<FuzzTarget> picture_targets() {
  return {{"exr", picture<exr>, mutate_numbers}, {"tif", picture<tif>, mutate_numbers},
          {"png", picture<png>, mutate_numbers}, {"vti", vti, mutate_counted_text},
          {"sem_text", sem_text, mutate_text},   {"sem_tags", sem_tags, mutate_numbers}};
}

}  // namespace surf::test
