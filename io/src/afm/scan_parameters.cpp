// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/scan_parameters.h"

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::io {

void describe(ParameterVisitor& visit, HeightReadOptions& o) {
  visit(o.channel,
        {.name = "scan.height_channel",
         .help = "Channel of the scan file, by name or number; 'semsurf info' lists them",
         .otherwise = "the first of heights",
         .form = "NAME"});
  visit.form(
      {.name = "scan.height_unit",
       .help = "Length of one unit of height, for files that do not state it",
       .unit = Unit::nm,
       .otherwise = "nm",
       .form = "LENGTH"},
      [&o] { return o.z_unit_nm ? format_exact(*o.z_unit_nm) : std::string(); },
      [&o](std::string_view text, const std::string& subject) {
        o.z_unit_nm = parse_unit_nm(text, subject);
      });
  visit.form(
      {.name = "scan.height_pitch",
       .help = "Distance of neighbouring heights, 2nm or 2nmx3nm, of files that do not say",
       .unit = Unit::nm,
       .otherwise = "1 nm",
       .form = "LENGTH"},
      [&o] {
        if (!o.pitch_x_nm) return std::string();
        const double y = o.pitch_y_nm.value_or(*o.pitch_x_nm);
        return format_exact(*o.pitch_x_nm) + (y == *o.pitch_x_nm ? "" : "x" + format_exact(y));
      },
      [&o](std::string_view text, const std::string& subject) {
        const auto [x, y] = parse_pitch_nm(text, subject);
        o.pitch_x_nm = x, o.pitch_y_nm = y;
      });
}

void describe(ParameterVisitor& visit, SemReadOptions& o) {
  visit(o.channel, {.name = "scan.sem_channel",
                    .help = "Channel of the SEM image, by name",
                    .otherwise = "the first",
                    .form = "NAME"});
  visit.form(
      {.name = "scan.pixel_size",
       .help = "Width and height of the SEM image's pixels, as 2nm or 2nmx3nm",
       .unit = Unit::nm,
       .otherwise = "from the microscope's metadata",
       .form = "LENGTH"},
      [&o] {
        if (!o.pixel_x_nm) return std::string();
        const double y = o.pixel_y_nm.value_or(*o.pixel_x_nm);
        return format_exact(*o.pixel_x_nm) + (y == *o.pixel_x_nm ? "" : "x" + format_exact(y));
      },
      [&o](std::string_view text, const std::string& subject) {
        const auto [x, y] = parse_pitch_nm(text, subject);
        o.pixel_x_nm = x, o.pixel_y_nm = y;
      });
}

std::pair<double, double> parse_pitch_nm(std::string_view text, std::string_view subject) {
  return parse_two_lengths_nm(text, subject);
}

double parse_unit_nm(std::string_view text, std::string_view subject) {
  const bool named = text.find_first_of("0123456789") == std::string_view::npos;
  const double unit_nm = named ? unit_length_nm(text, subject) : parse_length_nm(text, subject);
  if (!(unit_nm > 0))
    throw UsageError(std::string(subject), "it must be above zero",
                     "Write a length, as um or 25.4mm");
  return unit_nm;
}

}  // namespace surf::io
