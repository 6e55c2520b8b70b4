// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "scan_formats.h"
#include "surf/core/units.h"

namespace surf::io {

std::string format_text_field(const HeightField& field,
                              const std::map<std::string, std::string>& metadata) {
  const int w = field.z_nm.width(), h = field.z_nm.height();
  std::string text =
      fmt::format("# Channel: z_nm\n# Width: {} nm\n# Height: {} nm\n# Value units: nm\n",
                  format_exact(w * field.pitch_x_nm), format_exact(h * field.pitch_y_nm));
  for_each_text_line(description_of(field, metadata),
                     [&](std::string_view line) { text += fmt::format("# {}\n", line); });
  for (int y = h - 1; y >= 0; --y) {
    for (int x = 0; x < w; ++x) {
      if (x > 0) text += '\t';
      text += field.is_valid(x, y) ? format_exact(field.z_nm(x, y)) : "nan";
    }
    text += '\n';
  }
  return text;
}

}  // namespace surf::io
