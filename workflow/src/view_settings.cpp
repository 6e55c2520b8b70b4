// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/view_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common_parameters.h"
#include "surf/core/error.h"
#include "surf/core/words.h"
#include "surf/mc/physics/physics.h"
#include "surf/reconstruction/view.h"

namespace surf::workflow {

void refuse_length(std::size_t given, std::size_t views, const std::string& subject) {
  throw UsageError(subject,
                   fmt::format("{} values are given, and there {}", given,
                               views == 0   ? "is one SEM image only"
                               : views == 1 ? "is 1 further SEM image"
                                            : fmt::format("are {} further SEM images", views)),
                   "Give one for each SEM image in turn, or one for each after the first");
}

void describe(ParameterVisitor& visit, ViewSettings& views) {
  describe_numbers(visit, views.tilts_deg,
                   {.name = "beam.tilt",
                    .help = "Angle of the beam from straight down in each SEM image in turn, or in "
                            "each after the first, whose is 0",
                    .unit = Unit::deg,
                    .limits = within(0, largest_view_tilt_deg),
                    .otherwise = "straight down",
                    .form = "ANGLE"});
  describe_numbers(
      visit, views.azimuths_deg,
      {.name = "beam.azimuth",
       .help = "Direction in which the tilted beam travels in each SEM image, or in each "
               "after the first: 0 is +x, 90deg is +y",
       .unit = Unit::deg,
       .limits = within(-360, 360),
       .otherwise = "to +x",
       .form = "ANGLE"});
  describe_numbers(visit, views.energies_ev,
                   {.name = "reconstruction.view_energy",
                    .help = "Energy of the beam in each SEM image, or in each after the first",
                    .unit = Unit::ev,
                    .limits = within(mc::min_beam_energy_ev, mc::max_beam_energy_ev),
                    .otherwise = "as of the first",
                    .form = "ENERGY"});
  visit.form(
      {.name = "reconstruction.view_signal",
       .help = "Signal of each SEM image, or of each after the first, separated by semicolons",
       .otherwise = "as the first",
       .form = "SIGNAL"},
      [&] { return fmt::format("{}", fmt::join(views.signals, ";")); },
      [&](std::string_view text, const std::string&) {
        for (const std::string_view one : split(text, ";"))
          if (const auto first = one.find_first_not_of(' '); first != std::string_view::npos)
            views.signals.emplace_back(one.substr(first, one.find_last_not_of(' ') + 1 - first));
      },
      FieldKind::list);
  visit(views.tilt_error_deg, {.name = "reconstruction.tilt_error",
                               .help = "Standard error of the tilts, which are fitted within it",
                               .unit = Unit::deg,
                               .limits = within(0.001, 10)});
}

std::vector<ViewAngles> angles_of(const ViewSettings& s, std::size_t views, double energy_ev) {
  const auto tilts = for_each_view(s.tilts_deg, views, 0.0, "`beam.tilt`"),
             azimuths = for_each_view(s.azimuths_deg, views, 0.0, "`beam.azimuth`"),
             energies =
                 for_each_view(s.energies_ev, views, energy_ev, "`reconstruction.view_energy`");
  if (s.tilts_deg.size() == views + 1 && s.tilts_deg.front() != 0)
    throw UsageError("`beam.tilt`",
                     fmt::format("the first SEM image's is {:g} degrees", s.tilts_deg.front()),
                     "Give the image that looks straight down first: the surface is in its frame");
  std::vector<ViewAngles> out;
  for (std::size_t k = 0; k < views; ++k) {
    if (!(tilts[k] >= 0 && tilts[k] <= largest_view_tilt_deg))
      throw UsageError("`beam.tilt`", fmt::format("{:g} degrees are out of range", tilts[k]),
                       fmt::format("Give 0 to {:g}deg; `beam.azimuth` says to which side",
                                   largest_view_tilt_deg));
    out.push_back({tilts[k], azimuths[k], energies[k]});
  }
  return out;
}

std::string first_signal(const ViewSettings& s, std::size_t views, const std::string& own) {
  return own.empty() && s.signals.size() == views + 1 ? s.signals.front() : own;
}

std::vector<std::string> signals_of(const ViewSettings& s, std::size_t views,
                                    const std::string& first) {
  const char* subject = "`reconstruction.view_signal`";
  if (s.signals.size() == views + 1 && s.signals.front() != first)
    throw UsageError(subject,
                     fmt::format("it says '{}' of the first SEM image, whose own option says '{}'",
                                 s.signals.front(), first),
                     "Say it once, and give one here for each image after the first");
  return for_each_view(s.signals, views, first, subject);
}

}  // namespace surf::workflow
