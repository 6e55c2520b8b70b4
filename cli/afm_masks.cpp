// SPDX-License-Identifier: GPL-3.0-or-later
#include "afm_masks.h"

#include <fmt/format.h>

#include <algorithm>

#include "options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/image_file.h"

namespace surf::cli {
namespace {

Grid<float> read_mask(const std::string& path, const HeightField& field) {
  const Image image = io::read_image(path);
  const Grid<double>& z = field.z_nm;
  if (image.width() == z.width() && image.height() == z.height())
    return image.channels.front().values;
  throw InvalidInput(path,
                     fmt::format("it has {} x {} pixels, the scan {} x {}", image.width(),
                                 image.height(), z.width(), z.height()),
                     "Give a mask of the scan's size");
}

}  // namespace

std::vector<std::string> MaskInput::files() const {
  std::vector<std::string> files;
  for (const auto& file : {use, exclude})
    if (file) files.push_back(*file);
  return files;
}

void describe(ParameterVisitor& visit, MaskInput& input) {
  visit(input.use, {.name = "scan.use",
                    .help = "Mask, an image of the scan's size: only samples where it is not 0 are "
                            "used (.tif .png .exr .vti)",
                    .file = FileRole::read});
  visit(input.exclude,
        {.name = "scan.exclude",
         .help = "Mask, an image of the scan's size: samples where it is not 0 are left out",
         .file = FileRole::read});
}

Mask read_masks(const MaskInput& input, const HeightField& field) {
  if (!input.use && !input.exclude) return {};
  Mask mask(field.z_nm.width(), field.z_nm.height(), 1);
  const auto narrow = [&](const std::string& path, bool keep) {
    const Grid<float> values = read_mask(path, field);
    for (std::size_t i = 0; i < mask.size(); ++i) mask.data()[i] &= (values.data()[i] != 0) == keep;
  };
  if (input.use) narrow(*input.use, true);
  if (input.exclude) narrow(*input.exclude, false);
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask.data()[i] && field.valid.includes(i)) return mask;
  throw InvalidInput(input.use ? *input.use : *input.exclude,
                     "no sample of the scan remains to count",
                     "Check which of `scan.use` and `scan.exclude` is meant");
}

Mask parse_mask_region(const std::string& text, const char* subject, const HeightField& field) {
  const auto r = parse_region(text, subject);
  Mask mask(field.z_nm.width(), field.z_nm.height());
  bool any = false;
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      const double u = field.x_nm(x), v = field.y_nm(y);
      mask(x, y) = u >= r.x0_nm && u <= r.x1_nm && v >= r.y0_nm && v <= r.y1_nm;
      any |= mask(x, y) != 0;
    }
  }
  if (any) return mask;
  throw UsageError(
      subject, fmt::format("'{}' holds no sample of the scan", text),
      fmt::format("The scan reaches from {:.6g},{:.6g} to {:.6g},{:.6g} nm", field.origin_x_nm,
                  field.origin_y_nm, field.x_nm(mask.width() - 1), field.y_nm(mask.height() - 1)));
}

void write_mask(const std::string& path, const Mask& mask, const HeightField& field,
                const std::map<std::string, std::string>& made) {
  Image image;
  image.metadata = made;
  image.channels.push_back({"mask", "1", Grid<float>(mask.width(), mask.height())});
  std::copy(mask.data().begin(), mask.data().end(), image.channels.front().values.data().begin());
  image.placement() = field.placement();
  io::write_image(path, image);
}

}  // namespace surf::cli
