// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster_output.h"

#include <fmt/format.h>

#include <algorithm>

#include "surf/core/error.h"

namespace surf::io::openimageio {

void keep_quiet() { [[maybe_unused]] static const bool done = OIIO::attribute("debug", 0); }

std::unique_ptr<OIIO::ImageOutput> create_output(const char* format, const std::string& file) {
  keep_quiet();
  std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
  if (!output) {
    const std::string reason = OIIO::geterror();  // none where it could not start its threads
    throw Unsupported(file,
                      fmt::format("OpenImageIO cannot write {} here ({})", format,
                                  reason.empty() ? "threads or memory may be short" : reason),
                      "Raise their limits (ulimit -u, ulimit -v), or choose another format");
  }
  return output;
}

void leave_out_date(OIIO::ImageSpec& spec) { spec.attribute("DateTime", 0); }

void check_written(bool done, OIIO::ImageOutput& output, const std::string& file) {
  if (done) return;
  throw FileError(file, fmt::format("it cannot be written: {}", output.geterror()),
                  "Check the free space, or choose another format or place");
}

void set_resolution(OIIO::ImageSpec& spec, const Image& image, double highest) {
  constexpr double nm_per_cm = 1e7;
  const double x = nm_per_cm / image.pitch_x_nm;
  const double y = nm_per_cm / image.pitch_y_nm;
  if (std::min(x, y) < 1 || std::max(x, y) > highest) return;
  spec.attribute("ResolutionUnit", "cm");
  spec.attribute("XResolution", static_cast<float>(x));
  spec.attribute("YResolution", static_cast<float>(y));
  // Without it OpenImageIO makes both resolutions equal.
  spec.attribute("PixelAspectRatio", static_cast<float>(y) / static_cast<float>(x));
}

void close_output(OIIO::ImageOutput& output, const std::string& file) {
  check_written(output.close(), output, file);
}

}  // namespace surf::io::openimageio
