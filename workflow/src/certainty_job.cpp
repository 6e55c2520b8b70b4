// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/certainty_job.h"

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::workflow {

void describe(ParameterVisitor& visit, CertaintyParameters& p) {
  static const Parameter noise{.name = "scan.height_noise",
                               .help = "Standard deviation of the scan's noise",
                               .unit = Unit::nm,
                               .limits = at_least(0),
                               .otherwise = "from neighbouring pixels",
                               .form = "LENGTH"};
  visit.form(
      noise, [&p] { return p.noise_nm ? format_exact(*p.noise_nm) : std::string(); },
      [&p](std::string_view text, const std::string& subject) {
        if (text.find(',') != std::string_view::npos)
          throw UsageError(
              subject, fmt::format("'{}' has a correlation, which certainty does not go by", text),
              "Give the standard deviation alone, as 0.1nm");
        p.noise_nm = parse_value(text, noise, subject);
      });
  visit(p.sigmas, {.name = "certainty.sigmas",
                   .help = "Number of standard deviations that bound the noise",
                   .limits = above(0, 1e6),
                   .level = Level::advanced});
  visit(p.neighbourhood,
        {.name = "certainty.neighbourhood",
         .help = "Largest distance in pixels between contacts that count as one place",
         .limits = within(0, 100),
         .otherwise = "as flat as the apex is within the noise",
         .form = "PIXELS",
         .level = Level::advanced});
  visit(p.distance_nm, {.name = "certainty.distance",
                        .help = "Distance between tip and surface in non-contact scans",
                        .unit = Unit::nm,
                        .limits = at_least(0),
                        .level = Level::advanced});
}

CertaintyResult certainty(const HeightField& scan, const Tip& tip, const CertaintyParameters& p,
                          const Reporter& reporter) {
  check_parameters(p);
  CertaintyResult result;
  result.used = p;
  if (!p.noise_nm) {
    result.used.noise_nm = pixel_noise_nm(scan);
    reporter.note(
        fmt::format("a noise of {} is taken from neighbouring pixels (their second differences); "
                    "`scan.height_noise` says otherwise",
                    format_length(*result.used.noise_nm)));
  }
  result.map =
      certainty_map(scan, tip,
                    {.noise_nm = *result.used.noise_nm,
                     .sigmas = p.sigmas,
                     .neighbourhood = p.neighbourhood.value_or(CertaintyOptions{}.neighbourhood),
                     .distance_nm = p.distance_nm,
                     .threads = p.threads,
                     .watch = reporter.watch()});
  result.used.neighbourhood = result.map.neighbourhood;
  const std::size_t unexplained = result.map.unexplained, pixels = result.map.image_pixels;
  result.trustworthy = 2 * unexplained <= pixels;
  if (20 * unexplained > pixels)
    reporter.warn(fmt::format(
        "{:.0f} % of the scan cannot have been made by this tip with this noise: the tip may be "
        "sharper than its file says, or `scan.height_noise` larger{}",
        100.0 * static_cast<double>(unexplained) / static_cast<double>(pixels),
        result.trustworthy ? "" : ". A map of so little of the scan is not to be trusted"));
  return result;
}

}  // namespace surf::workflow
