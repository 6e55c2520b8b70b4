// SPDX-License-Identifier: GPL-3.0-or-later
#include <numbers>

#include "sem_header.h"

namespace surf::io {

SemHeader parse_fei(std::string_view text, SemSize size) {
  constexpr double metre = 1e9, degrees = 180 / std::numbers::pi;
  SemHeader header;
  header.format = "Thermo/FEI";
  header.metadata = parse_settings(text);
  const Settings& s = header.metadata;
  // An ion beam's image has the block of its own column.
  const std::string beam = setting(s, "Beam.Beam").empty() ? "EBeam" : setting(s, "Beam.Beam");
  const std::string scan = setting(s, "Beam.Scan").empty() ? "EScan" : setting(s, "Beam.Scan");
  for (const std::string& block : {std::string("Scan"), scan})
    if (header.pixel_x_nm == 0)
      set_pixel(header, number_of(s, block + ".PixelWidth", metre),
                number_of(s, block + ".PixelHeight", metre), block + ".PixelWidth");
  header.energy_ev = positive(number_of(s, "Beam.HV"));
  if (!header.energy_ev) header.energy_ev = positive(number_of(s, beam + ".HV"));
  header.working_distance_nm = positive(number_of(s, beam + ".WD", metre));
  if (!header.working_distance_nm)
    header.working_distance_nm = positive(number_of(s, "Stage.WorkingDistance", metre));
  header.tilt_deg = number_of(s, "Stage.StageT", degrees);
  header.detector = setting(s, "Detectors.Name");
  header.instrument = setting(s, "System.SystemType");
  // With a databar the file is higher than what was scanned.
  header.databar_rows = rows_below(size, number_of(s, "Image.ResolutionY"));
  if (number_of(s, "Image.ResolutionX") != double(size.width) && header.pixel_x_nm > 0 &&
      number_of(s, "Image.ResolutionX"))
    header.notes.push_back("it was scanned with " + setting(s, "Image.ResolutionX") +
                           " pixels across, and has " + std::to_string(size.width) +
                           ": cropped or resampled since. Check the pixel size");
  return header;
}

}  // namespace surf::io
