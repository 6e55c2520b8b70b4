// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "commands.h"
#include "exit_codes.h"
#include "job_reporter.h"
#include "reconstruct_options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "terminal.h"

namespace surf::cli {
namespace {

using workflow::ReconstructionVerdict;

void line(const std::string& label, const std::string& text) { print("{:<10} {}\n", label, text); }

void print_residual(const char* label, const ResidualReport& r) {
  if (r.pixels == 0) return;
  line(label,
       fmt::format("residuals: mean {:.3f}, deviation {:.3f}, correlation {:.3f} along and {:.3f} "
                   "across rows{}",
                   r.mean, r.deviation, r.along, r.across, r.like_noise ? "" : ": not like noise"));
}

void print_scales(const std::vector<ScaleReport>& scales) {
  if (scales.empty()) return;
  line("scales", fmt::format("{:>9} {:>12} {:>12} {:>12} {:>6}  {}", "sigma/px", "-log L AFM",
                             "-log L SEM", "prior", "steps", "ended"));
  for (const ScaleReport& s : scales)
    line("", fmt::format("{:>9.3g} {:>12.5g} {:>12.5g} {:>12.5g} {:>6}  {}", s.sigma_px, s.afm,
                         s.sem, s.prior, s.iterations, s.ended));
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void print_surface(const Reconstruction& r) {
  const HeightField& f = r.surface;
  std::string text = fmt::format("{} x {} samples of {}", f.z_nm.width(), f.z_nm.height(),
                                 format_length(f.pitch_x_nm));
  if (!r.deviation_nm.empty())
    text += fmt::format("; standard deviation of a height {} (median)",
                        format_length(median(r.deviation_nm.data())));
  line("surface", text);
  if (r.data_support.empty()) return;
  const auto share = [&](unsigned char what) {
    return 100.0 * static_cast<double>(std::ranges::count(r.data_support.data(), what)) /
           static_cast<double>(r.data_support.size());
  };
  line("held by", fmt::format("AFM {:.0f} %, SEM {:.0f} %, both {:.0f} %, neighbours only {:.0f} %",
                              share(1), share(2), share(3), share(0)));
}

/// What the fit found besides the surface.
void print_unknowns(const Reconstruction& r, const workflow::ReconstructJob& job) {
  if (r.map_deviation) {
    const AffineParts map = parts_of(r.sem_to_afm);
    const MapDeviation& d = *r.map_deviation;
    const auto known = [](double deviation) {
      return std::isfinite(deviation) ? fmt::format("{:.2g}", deviation) : "(nothing holds it)";
    };
    line("at the end",
         fmt::format("turned by {:.2f} ± {} deg; the SEM's pixels are {:.2f} ± {} and {:.2f} "
                     "± {} % of what was told, by the scan",
                     map.rotation_rad / degrees_to_radians,
                     known(d.rotation_rad / degrees_to_radians), 100 * map.scale_x,
                     known(100 * d.scale_x), 100 * map.scale_y, known(100 * d.scale_y)));
    line("", fmt::format("the image's middle lies in the scan to ± {} and {} nm along x and y",
                         known(d.middle_x_nm), known(d.middle_y_nm)));
  }
  if (job.options.refine_spot)
    line("spot",
         fmt::format("{} than the model's, as by a blur of {}",
                     r.blur_px2 < 0 ? "narrower" : "wider",
                     format_length(std::sqrt(std::abs(r.blur_px2)) * r.surface.pitch_x_nm)));
  if (!job.film.empty()) line("film", fmt::format("{} of {}", format_length(r.film_nm), job.film));
  if (job.options.refine_drift)
    line("drift", fmt::format("the scan's ends are displaced by {:.2g}, {:.2g} SEM pixels against "
                              "its middle",
                              r.scan_drift_px.x, r.scan_drift_px.y));
  if (r.sem_row_jitter.empty()) return;
  double squares = 0;
  for (const double deviations : r.sem_row_jitter) squares += deviations * deviations;
  line("jitter",
       fmt::format("rows of the SEM image are displaced by {:.2g} pixels, rms",
                   job.line_jitter_px * std::sqrt(squares / double(r.sem_row_jitter.size()))));
}

void print_summary(const workflow::ReconstructSummary& s, const workflow::ReconstructJob& job) {
  if (s.pose) print_pose(*s.pose, job.sem->image.pitch_x_nm);
  if (s.verdict == ReconstructionVerdict::not_registered) return print_written(s.written);
  if (s.sem_noise)
    line("SEM noise", fmt::format("variance = {:.4g} level {:+.4g}, from {}", s.sem_noise->slope,
                                  s.sem_noise->intercept, s.sem_noise_from));
  if (job.sem) {
    std::string gains;
    for (std::size_t c = 0; c < s.result.gains.size(); ++c)
      gains += fmt::format("{}{} {:.5g}", c ? ", " : "", s.model->model->channels()[c],
                           s.result.gains[c]);
    line("gains", fmt::format("{}; offset {:.5g}", gains, s.result.offset));
  }
  print_unknowns(s.result, job);
  print_scales(s.result.scales);
  if (!s.result.scales.empty()) {
    print_residual("AFM", s.result.scales.back().afm_residual);
    print_residual("SEM", s.result.scales.back().sem_residual);
  }
  for (std::size_t k = 0; k < s.result.views.size(); ++k) {
    const ViewResult& view = s.result.views[k];
    const std::string name = fmt::format("view {}", k + 2);
    line(name, fmt::format("tilted by {:.2f} deg to {:.0f} deg, {:g} and {:g} as told",
                           view.pose.tilt_deg, view.pose.azimuth_deg, s.views[k].tilt_deg,
                           s.views[k].azimuth_deg));
    print_residual("", view.statistics);
  }
  if (s.result.sem_discrepancy_share > 0)
    line("model",
         fmt::format("off by {:.2g} % of the SEM image's contrast, as far as it is allowed "
                     "to be",
                     100 * s.result.sem_discrepancy_share));
  print_surface(s.result);
  for (const std::string& part : s.held) line("", part);
  if (s.truth) {
    line("truth",
         fmt::format("{:.3g} nm rms off, {:.3g} nm before ({:.3f} of the squared error); median "
                     "difference {:.3g} nm taken off",
                     s.truth->rms_nm, s.truth->start_rms_nm,
                     std::pow(s.truth->rms_nm / std::max(s.truth->start_rms_nm, 1e-300), 2),
                     s.truth->offset_nm));
    if (s.truth->coverage_2 > 0)
      line("", fmt::format("{:.1f} % within one, {:.1f} % within two standard deviations; {:.1f} % "
                           "within their 95 % interval",
                           100 * s.truth->coverage_1, 100 * s.truth->coverage_2,
                           100 * s.truth->in_interval));
    for (const workflow::RegionReport& region : s.truth->regions)
      line("", fmt::format(
                   "{:<9}  {:4.1f} %: {:.3g} nm off, {:.3g} nm stated; {:.1f} % within one, "
                   "{:.1f} % within two, {:.1f} % in the interval",
                   region.name,
                   100 * static_cast<double>(region.pixels) / static_cast<double>(s.truth->pixels),
                   region.rms_nm, region.stated_nm, 100 * region.coverage_1,
                   100 * region.coverage_2, 100 * region.in_interval));
  }
  print_written(s.written);
}

void explain(const workflow::ReconstructSummary& s, const workflow::ReconstructJob& job) {
  for (const std::string& reason : s.reasons) print_warning(reason);
  if (s.verdict == ReconstructionVerdict::not_registered)
    print_note(
        fmt::format("nothing was reconstructed. Look at {}, give --landmarks or --transform, or go "
                    "on all the same with "
                    "--accept-registration",
                    (job.folder / "registration.png").string()));
}

int reconstruct_work(const ChainOptions& o, const std::string& command_line) {
  workflow::ReconstructJob job = make_reconstruct_job(o);
  job.command_line = command_line;
  workflow::ReconstructSummary s;
  try {
    const JobReporter reporter(o.quiet);
    s = workflow::run(job, reporter);
  } catch (const Interrupted&) {
    print_note("stopped: there is no result yet. The same command goes on from what is done");
    return exit_interrupted;
  }
  if (!o.quiet) print_summary(s, job);
  explain(s, job);
  return s.verdict == ReconstructionVerdict::sound ? 0 : exit_untrustworthy;
}

}  // namespace

void add_reconstruct(CLI::App& app, Action& action, const std::string& command_line) {
  const auto o = std::make_shared<ChainOptions>();
  CLI::App* sub = app.add_subcommand(
      "reconstruct", "The surface that makes an AFM scan and an SEM image most likely");
  add_reconstruct_options(*sub, *o);
  sub->callback([o, &action, command_line] {
    action = [o, command_line] { return reconstruct_work(*o, command_line); };
  });
}

}  // namespace surf::cli
