// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "afm_masks.h"
#include "afm_options.h"
#include "commands.h"
#include "common_options.h"
#include "noise_counts.h"
#include "noise_plot.h"
#include "noise_sem.h"
#include "options.h"
#include "surf/afm/noise_check.h"
#include "surf/afm/substrate_noise.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(INPUT is an AFM scan. The model is e(t) = alpha e(t - 1) + v(t) along scan lines, each line a new draw. It is estimated from the
substrate, the plane that most of the image lies on, or with --flat from all of it. 'differences' is the
estimate without levelling, from what neighbouring rows and columns do not share: it is too large on rough
surfaces. Whiteness and normality are those of what the model leaves; with many samples small deviations are
significant, so look at the correlations too.
--sem: an SEM image. The model is independent normal pixels whose variance is a line of their mean. Blocks
without structure are found, or given by --region; the test says whether their variances lie on a line.
--counts: a scene. Few primaries at one point, many times over; Poisson, log-normal and normal distributions
are fitted to the electrons counted and tested.

Examples:
  semsurf noise mica.gwy --flat --plot noise.svg
  semsurf noise scan.gsf --exclude particles.png
  semsurf noise --sem image.tif --plot noise.svg
  semsurf noise --sem image.tif --region 10,20,110,90 --region 300,40,380,120 --region 40,300,140,380
  semsurf noise --counts samples/rough.toml --at 20,-35 --electrons 1,20,100 --plot counts.svg --csv counts.csv)";

struct Options {
  ScanInput scan;
  MaskInput masks;
  SemNoiseInput sem;
  CountsInput counts;
  std::optional<std::string> plot, degree, lags;
  bool flat = false, quiet = false;
};

/// Everything about the noise of one scan.
struct Findings {
  NoiseEstimate estimate;
  Grid<unsigned char> samples;   // that the estimate rests on
  Grid<double> residual_nm;
};

Findings of_flat_scan(const HeightField& field, const FlatNoiseOptions& options, const Grid<unsigned char>& use) {
  Findings f;
  f.estimate = estimate_flat_noise(field, options, use);
  HeightField residual = field;
  subtract(residual, fit_polynomial(field, options.degree, use));
  f.residual_nm = residual.z_nm;
  f.samples = Grid<unsigned char>(field.z_nm.width(), field.z_nm.height(), 1);
  for (std::size_t i = 0; i < f.samples.size(); ++i)
    f.samples.data()[i] = (use.empty() || use.data()[i]) && (field.valid.empty() || field.valid.data()[i]);
  return f;
}

Findings of_substrate(const HeightField& field, const FlatNoiseOptions& options, const Grid<unsigned char>& use,
                      bool quiet, Watched& watched) {
  SubstrateNoise s = estimate_substrate_noise(field, options, use);
  watched.clear();
  if (!quiet)
    print("{:<12} {:.1f} % of the image; the next plane holds {:.1f} %\n", "substrate", 100 * s.substrate_share,
               100 * s.plane.runner_up_share);
  if (s.plane.verdict != HoughVerdict::clear)
    print_warning("no plane holds a clear majority of the image, so there may be no substrate to take the noise "
                  "from. Give --use or --exclude, or trust 'differences' instead");
  return {s.estimate, std::move(s.substrate), std::move(s.residual_nm)};
}

void print_model(const char* label, const NoiseEstimate& e) {
  print("{:<12} alpha {:.4f} ± {:.1g}, sigma {:.4g} ± {:.1g} nm, innovation {:.4g} ± {:.1g} nm^2\n", label,
             e.noise.alpha, e.alpha_stderr, e.sigma_nm(), e.sigma_stderr_nm, e.noise.innovation_nm2,
             e.innovation_stderr_nm2);
}

void print_differences(const HeightField& field) {
  try {
    const NoiseEstimate e = estimate_noise(field);
    print_model("differences", e);
    if (e.alpha_at_limit) print_note("differences: alpha is at its limit, so structure is likely to dominate them");
  } catch (const InvalidInput& error) {
    print_note(fmt::format("differences: {}", error.reason()));
  }
}

std::string largest(const std::vector<LagCorrelation>& lags) {
  const LagCorrelation* most = nullptr;
  for (const LagCorrelation& l : lags)
    if (!most || std::fabs(l.correlation) > std::fabs(most->correlation)) most = &l;
  return most ? fmt::format("largest correlation {:.4f} at lag {} (z {:.1f})", most->correlation, most->lag, most->z)
              : "no pairs";
}

std::string format_p(double p) { return p < 1e-4 ? "p < 0.0001" : fmt::format("p = {:.4f}", p); }

void print_check(const NoiseCheck& c) {
  print("{:<12} along rows {}: {}\n", "whiteness", format_p(c.along_p), largest(c.along));
  print("{:<12} across rows {}: {}\n", "", format_p(c.across_p), largest(c.across));
  print("{:<12} {}: skewness {:.3f}, excess kurtosis {:.3f}\n", "normality", format_p(c.normal_p), c.skewness,
             c.excess_kurtosis);
}

/// Which of its three uses the command has.
void refuse_mixtures(const Options& o) {
  const int uses = !o.scan.file.empty() + o.sem.image.has_value() + o.counts.scene.has_value();
  if (uses > 1)
    throw UsageError("noise", "more than one of INPUT, --sem and --counts is given", "Run it once for each");
  require_sem(o.sem);
  require_counts(o.counts);
  if (!o.sem.image && !o.counts.scene) return;
  const char* other = o.flat ? "--flat" : o.degree ? "--degree" : o.lags ? "--lags" : o.scan.channel ? "--channel"
                      : o.scan.z_unit ? "--z-unit" : o.masks.use ? "--use" : o.masks.exclude ? "--exclude"
                      : o.counts.scene && o.scan.pixel_size ? "--pixel-size" : nullptr;
  if (other) throw UsageError(other, "it is of AFM scans", "Leave it out, or name a scan");
}

int of_scan(const Options& o) {
  if (o.scan.file.empty()) throw UsageError("noise", "no scan is given", "Name a file to read");
  FlatNoiseOptions options;
  if (o.degree) options.degree = static_cast<int>(parse_whole(*o.degree, "--degree", 0, 6));
  const int lags = o.lags ? static_cast<int>(parse_whole(*o.lags, "--lags", 1, 1000)) : 10;
  if (o.plot) io::check_plot_target(*o.plot);
  const HeightField field = read_scan(o.scan, o.quiet).field;
  const Grid<unsigned char> use = read_masks(o.masks, field);
  Watched watched(!o.quiet);
  options.watch = watched.watch(0, 0.8);
  const Findings f = o.flat ? of_flat_scan(field, options, use) : of_substrate(field, options, use, o.quiet, watched);
  print_model("noise", f.estimate);
  if (!o.quiet) print_differences(field);
  if (!(f.estimate.noise.innovation_nm2 > 0)) {
    print_warning("there is no noise at all in these heights: they may be simulated or filtered");
    if (o.plot) throw InvalidInput("--plot", "there is no noise to draw", "Leave it out");
    return 0;
  }
  const Grid<double> white = whiten(f.residual_nm, f.estimate.noise, f.samples);
  const NoiseCheck check = check_noise(white, f.samples, {.lags = lags});
  print_check(check);
  if (o.plot) {
    io::write_plot(*o.plot, plot_noise(f.residual_nm, white, f.samples, f.estimate.noise, check));
    if (!o.quiet) print("{:<12} {}\n", "written", *o.plot);
  }
  return 0;
}

int work(const Options& o) {
  refuse_mixtures(o);
  if (o.counts.scene) return print_counts(o.counts, o.plot, o.quiet);
  if (!o.sem.image) return of_scan(o);
  SemNoiseInput sem = o.sem;
  sem.pixel_size = o.scan.pixel_size;
  return print_sem_noise(sem, o.plot, o.quiet);
}

}  // namespace

void add_noise(CLI::App& app, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("noise", "The noise of an AFM scan, an SEM image or simulated counts, and whether the model fits");
  sub->group("Commands");
  add_scan_input(*sub, o->scan);
  const char* noise = "AFM scan";
  sub->add_flag("--flat", o->flat, "All of the scan is flat: a calibration scan, as of mica")->group(noise);
  sub->add_option("--degree", o->degree, "Of the polynomial taken off first, 0 to 6 (2)")->type_name("N")->group(noise);
  sub->add_option("--lags", o->lags, "Whiteness is tested up to this distance (10)")->type_name("N")->group(noise);
  add_mask_input(*sub, o->masks);
  add_sem_noise_options(*sub, o->sem);
  add_counts_options(*sub, o->counts);
  const char* output = "Output";
  sub->add_option("--plot", o->plot, "What was found, as a chart: .svg .png")->type_name("FILE")->group(output);
  add_quiet_flag(*sub, o->quiet)->group(output);
  sub->footer(examples);
  sub->callback([o, &action] { action = [o] { return work(*o); }; });
}

}  // namespace surf::cli
