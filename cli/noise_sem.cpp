// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_sem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "options.h"
#include "sem_noise_plot.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/scan_parameters.h"
#include "surf/io/sem_file.h"
#include "surf/sem/estimate_sem_noise.h"
#include "surf/workflow/picture_input.h"
#include "surf/workflow/step_record.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* region_subject = "`noise.flat_region`";

struct SemPicture {
  PlacedImage image;
  bool has_scale = false;
};

/// Noise is the same for pixels of any size, so that pictures need not say theirs.
SemPicture read_sem_picture(const SemNoiseInput& input, io::SemReadOptions options, bool quiet) {
  const workflow::FileChannel name = workflow::parse_file_channel(input.image);
  options.channel = name.channel;
  io::SemFile file;
  bool has_scale = true;
  try {
    file = io::read_sem_image(name.file, options);
  } catch (const UsageError&) {
    if (options.pixel_x_nm) throw;
    has_scale = false;
    options.pixel_x_nm = options.pixel_y_nm = 1;
    file = io::read_sem_image(name.file, options);  // says again what else is wrong
  }
  if (!quiet)
    for (const std::string& note : file.notes)
      print_note(fmt::format("{}: {}", name.file.string(), note));
  return {std::move(file.image), has_scale};
}

bool has_unit(const std::string& text) {
  return std::ranges::any_of(
      text, [](unsigned char c) { return std::isalpha(c) && c != 'e' && c != 'E'; });
}

/// Bare numbers are pixels from the upper-left corner, as image viewers show them; with a unit they
/// are lengths from the image's origin, up.
PixelRectangle parse_rectangle(const std::string& text, const SemPicture& picture) {
  const PlacedImage& image = picture.image;
  const mc::ScanRequest::Region r = parse_region(text, region_subject);
  const auto whole = [](double v) {
    return static_cast<int>(std::clamp(std::round(v), -1e9, 1e9));
  };
  if (!has_unit(text)) {
    const int height = image.values.height();
    return {whole(r.x0_nm), height - whole(r.y1_nm), whole(r.x1_nm), height - whole(r.y0_nm)};
  }
  if (!picture.has_scale)
    throw UsageError(region_subject, "the image does not say how large its pixels are",
                     "Add `scan.pixel_size=2nm`, or give the region in pixels");
  const auto column = [&](double x) {
    return whole((x - image.origin_x_nm) / image.pitch_x_nm + 0.5);
  };
  const auto row = [&](double y) {
    return whole((y - image.origin_y_nm) / image.pitch_y_nm + 0.5);
  };
  return {column(r.x0_nm), row(r.y0_nm), column(r.x1_nm), row(r.y1_nm)};
}

void print_estimate(const SemNoiseEstimate& e) {
  if (e.slope_known)
    print("{:<12} variance = ({:.4g} ± {:.1g}) mean {} ({:.4g} ± {:.1g})\n", "noise", e.noise.slope,
          e.slope_stderr(), e.noise.intercept < 0 ? "-" : "+", std::fabs(e.noise.intercept),
          e.intercept_stderr());
  else
    print("{:<12} variance = {:.4g} ± {:.1g}\n", "noise", e.noise.intercept, e.intercept_stderr());
  for (const double mean : {e.least_mean, e.largest_mean})
    print("{:<12} at mean {:.4g}: {:.4g} ± {:.1g}, signal to noise {:.3g}\n", "", mean,
          std::sqrt(e.noise.variance(mean)),
          e.variance_stderr(mean) / (2 * std::sqrt(e.noise.variance(mean))),
          mean / std::sqrt(e.noise.variance(mean)));
  const auto used = std::ranges::count_if(e.points, [](const NoisePoint& p) { return p.used; });
  print("{:<12} {} used, {} left out{}; {} pixels\n", "flat places", used,
        static_cast<std::int64_t>(e.points.size()) - used,
        e.blocks ? fmt::format(", of {} blocks", e.blocks) : "", e.pixels);
  if (e.degrees > 0)
    print("{:<12} chi-squared {:.4g} with {} degrees of freedom, {}; bend {:.1f} % (z = {:.1f})\n",
          "line", e.chi_squared, e.degrees,
          e.p < 1e-4 ? "p < 0.0001" : fmt::format("p = {:.4f}", e.p), 100 * e.bend, e.curvature_z);
  print(
      "{:<12} {:.3f} along rows, {:.3f} across; a mean counts 1 pixel in {:.3g}, a variance 1 in "
      "{:.3g}\n",
      "correlation", e.correlation_x, e.correlation_y, e.correlation_sum, e.correlation_squares);
  print("{:<12} excess kurtosis {:.3f}\n", "normality", e.excess_kurtosis);
  if (e.quantum > 0)
    print("{:<12} in steps of {:g}, which is {:.2g} of the variance\n", "grey levels", e.quantum,
          e.quantum * e.quantum / 12);
}

}  // namespace

void describe(ParameterVisitor& visit, SemNoiseInput& input) {
  visit(input.image, {.name = "noise.image",
                      .help = "An SEM image, FILE or FILE:CHANNEL",
                      .form = "FILE",
                      .file = FileRole::read});
  describe_texts(
      visit, input.regions,
      {.name = "noise.flat_region",
       .help = "A flat place X0,Y0,X1,Y1: pixels from the upper left, or lengths with units",
       .otherwise = "flat blocks are found",
       .form = "RECTANGLE"});
}

void add_sem_noise_options(CLI::App& app, BoundParameters& bound, const std::string& group) {
  bound.looks["noise.flat_region"].former = {"--region"};
  bound.add<SemNoiseInput>(app, group, {}, {"noise.flat_region"});
  bound.add<SemNoiseOptions>(app, group);
}

int print_sem_noise(const GivenTexts& given, const std::optional<std::string>& plot, bool quiet) {
  SemNoiseInput input;
  SemNoiseOptions options;
  io::SemReadOptions reading;
  BoundParameters::apply(input, given), BoundParameters::apply(options, given),
      BoundParameters::apply(reading, given);
  if (input.image.empty()) throw UsageError("noise", "no image is given", "Name a file to read");
  if (plot) io::check_plot_target(*plot);
  const SemPicture picture = read_sem_picture(input, reading, quiet);
  for (const std::string& text : input.regions)
    options.regions.push_back(parse_rectangle(text, picture));
  const SemNoiseEstimate e = estimate_sem_noise(picture.image, options);
  print_estimate(e);
  for (const std::string& warning : e.warnings) print_warning(warning);
  if (!plot) return 0;
  io::Plot drawn = plot_sem_noise(e, picture.image.values.width(), picture.image.values.height());
  drawn.metadata = workflow::step_record("noise sem", workflow::records_of(input, options, reading),
                                         {workflow::parse_file_channel(input.image).file});
  io::write_plot(*plot, drawn);
  if (!quiet) print("{:<12} {}\n", "written", *plot);
  return 0;
}

}  // namespace surf::cli
