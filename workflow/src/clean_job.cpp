// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/clean_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "surf/afm/certainty.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::workflow {
namespace {

constexpr double spike_sigmas = 6;  // noise alone exceeds it once in a billion samples
constexpr Limits widths = within(1, 2001);

int odd(int width, const std::string& subject) {
  if (widths.holds(width) && width % 2 == 1) return width;
  if (width % 2 == 0 && width > 1 && width < widths.high)
    throw UsageError(subject, fmt::format("{} is even: such a neighbourhood has no middle", width),
                     fmt::format("Give {} or {}", width - 1, width + 1));
  throw UsageError(subject, fmt::format("{} is no odd number from 1 to {}", width, widths.high),
                   fmt::format("Give {}", width < 1 ? 3 : static_cast<int>(widths.high)));
}

/// Reads "3:0.5nm" or "3".
Spikes read_spikes(std::string_view text, const std::string& subject) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  Spikes spikes;
  Parameter width{.name = subject, .help = "", .limits = widths};
  const double number = parse_value(text.substr(0, colon), width, subject);
  if (number != static_cast<int>(number))
    throw UsageError(subject, fmt::format("'{}' is no whole number of samples", text),
                     "Write a width and a limit, as 3:0.5nm");
  spikes.width = odd(static_cast<int>(number), subject);
  if (colon == text.size()) return spikes;
  spikes.limit_nm = parse_length_nm(text.substr(colon + 1), subject);
  if (!(*spikes.limit_nm > 0))
    throw UsageError(subject, "the limit is not above 0", "Write a width and a limit, as 3:0.5nm");
  return spikes;
}

}  // namespace

void describe(ParameterVisitor& visit, CleanParameters& p) {
  visit.form(
      {.name = "clean.spikes",
       .help =
           "Replace a height by the median of WIDTH x WIDTH samples where it differs from that by "
           "more than LENGTH; without LENGTH, by more than six standard deviations of the noise",
       .form = "WIDTH[:LENGTH]"},
      [&p] {
        if (!p.spikes) return std::string();
        return fmt::format("{}{}", p.spikes->width,
                           p.spikes->limit_nm ? ":" + format_exact(*p.spikes->limit_nm) : "");
      },
      [&p](std::string_view text, const std::string& subject) {
        p.spikes = read_spikes(text, subject);
      });
  visit(p.median, {.name = "clean.median",
                   .help = "Replace each height by the median of WIDTH x WIDTH samples",
                   .limits = widths,
                   .form = "WIDTH"});
  visit(p.closing, {.name = "clean.closing",
                    .help = "Fill pits narrower than this many samples",
                    .limits = widths,
                    .form = "WIDTH"});
  visit(p.disc, {.name = "clean.disc", .help = "Medians of discs instead of squares"});
  visit(p.fill_holes,
        {.name = "clean.fill_holes", .help = "Give holes a height from around them, too"});
}

void check(const CleanParameters& p) {
  check_parameters(p);
  if (p.spikes) odd(p.spikes->width, "`clean.spikes`");
  if (p.median) odd(*p.median, "`clean.median`");
  if (p.closing) odd(*p.closing, "`clean.closing`");
}

CleanResult clean(const HeightField& scan, const CleanParameters& p, const Reporter& reporter) {
  check(p);
  CleanResult result;
  result.field = scan;
  result.used = p;
  const int steps = p.spikes.has_value() + p.median.has_value() + p.closing.has_value();
  double done = 0;
  const auto next = [&] {
    const double from = done++;
    return reporter.watch(from / steps, done / steps);
  };
  const auto neighbourhood = p.disc ? Neighbourhood::disc : Neighbourhood::square;
  const auto median = [&](int width, double limit_nm) {
    Cleaned cleaned = median_filter(result.field, {.radius = width / 2,
                                                   .neighbourhood = neighbourhood,
                                                   .limit_nm = limit_nm,
                                                   .fill_holes = p.fill_holes,
                                                   .threads = p.threads,
                                                   .watch = next()});
    result.field = std::move(cleaned.field);
    return cleaned.summary;
  };
  if (p.spikes) {
    const double limit_nm = p.spikes->limit_nm.value_or(spike_sigmas * pixel_noise_nm(scan));
    if (limit_nm > 0) {
      result.used.spikes->limit_nm = limit_nm;
      result.spikes = median(p.spikes->width, limit_nm);
    } else {
      reporter.note(
          "the scan has no noise of single pixels, so that nothing is a spike for sure: say in "
          "`clean.spikes` what is");
    }
  }
  if (p.median) result.median = median(*p.median, 0);
  if (p.closing) {
    Cleaned closed = flat_closing(
        result.field,
        {.width = *p.closing, .fill_holes = p.fill_holes, .threads = p.threads, .watch = next()});
    result.field = std::move(closed.field);
    result.closing = closed.summary;
  }
  return result;
}

}  // namespace surf::workflow
