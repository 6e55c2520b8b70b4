// SPDX-License-Identifier: GPL-3.0-or-later
#include "tip_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "surf/afm/resample.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/tip_file.h"
#include "terminal.h"

namespace surf::cli {

void add_tip_input(CLI::App& app, std::optional<std::string>& file) {
  app.add_option("--tip", file, "The tip, as semsurf writes tips or any file of heights")->type_name("FILE");
}

namespace {

void warn_of_doubt(const std::string& file, const Tip& tip) {
  if (!tip.doubt.empty())
    print_warning(fmt::format("{}: it says that this tip is not to be trusted: {}. What is made with it is not either", file,
                              tip.doubt));
}

}  // namespace

Tip read_tip_for(const std::optional<std::string>& file, const HeightField& field, bool quiet) {
  if (!file) throw UsageError("--tip", "no tip is given", "Add --tip tip.gsf");
  Tip tip = io::read_tip(*file);
  warn_of_doubt(*file, tip);
  const auto differ = [](double a, double b) { return std::abs(a - b) > 1e-6 * std::max(a, b); };
  if (differ(tip.pitch_x_nm, field.pitch_x_nm) || differ(tip.pitch_y_nm, field.pitch_y_nm)) {
    const Tip as_read = std::move(tip);
    tip = resampled(as_read, field.pitch_x_nm, field.pitch_y_nm);
    if (!quiet)
      print_note(fmt::format("{}: resampled from {} x {} pixels of {} to {} x {} of {}, as the scan has them", *file,
                             as_read.z_nm.width(), as_read.z_nm.height(), format_length(as_read.pitch_x_nm),
                             tip.z_nm.width(), tip.z_nm.height(), format_length(field.pitch_x_nm)));
  }
  if (tip.z_nm.width() > field.z_nm.width() || tip.z_nm.height() > field.z_nm.height())
    print_warning(fmt::format("{}: {} x {} pixels, more than the scan has; what cannot meet it plays no part", *file,
                              tip.z_nm.width(), tip.z_nm.height()));
  return tip;
}

}  // namespace surf::cli
