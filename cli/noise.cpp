// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <set>

#include "afm_masks.h"
#include "afm_options.h"
#include "commands.h"
#include "common_options.h"
#include "job_reporter.h"
#include "noise_counts.h"
#include "noise_plot.h"
#include "noise_sem.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/sem/estimate_sem_noise.h"
#include "surf/workflow/count_job.h"
#include "surf/workflow/noise_job.h"
#include "surf/workflow/step_record.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* of_all = R"(Examples:
  semsurf noise scan mica.gwy --flat --plot noise.svg
  semsurf noise sem image.tif --plot noise.svg
  semsurf noise counts samples/rough.toml --at 20,-35 --electrons 1,20,100 --plot counts.svg)";

constexpr const char* of_scans =
    R"(The model is e(t) = alpha e(t - 1) + v(t) along scan lines, each line a new draw. It is estimated from the
substrate, the plane that most of the image lies on, or with --flat from all of it. 'differences' is the
estimate without levelling, from what neighbouring rows and columns do not share: it is too large on rough
surfaces. Whiteness and normality are those of what the model leaves; with many samples small deviations are
significant, so look at the correlations too.

Examples:
  semsurf noise scan mica.gwy --flat --plot noise.svg
  semsurf noise scan scan.gsf --exclude particles.png)";

constexpr const char* of_sem_images =
    R"(The model is independent normal pixels whose variance is a line of their mean. Blocks without structure are
found, or given by --flat-region; the test says whether their variances lie on a line.

Examples:
  semsurf noise sem image.tif --plot noise.svg
  semsurf noise sem image.tif --flat-region 4,4,24,20 --flat-region 36,28,60,44 --flat-region 8,50,28,66)";

constexpr const char* of_counts =
    R"(Few primaries at one point, many times over; Poisson, log-normal and normal distributions are fitted to the
electrons counted and tested.

Examples:
  semsurf noise counts samples/rough.toml --at 20,-35 --electrons 1,20,100 --plot counts.svg --csv counts.csv)";

struct NoiseArguments {
  BoundParameters bound;
  std::string scan;
  std::optional<std::string> plot;
  bool quiet = false;
};

void print_model(const char* label, const NoiseEstimate& e) {
  print("{:<12} alpha {:.4f} ± {:.1g}, sigma {:.4g} ± {:.1g} nm, innovation {:.4g} ± {:.1g} nm^2\n",
        label, e.noise.alpha, e.alpha_stderr, e.sigma_nm(), e.sigma_stderr_nm,
        e.noise.innovation_nm2, e.innovation_stderr_nm2);
}

void print_differences(const HeightField& field) {
  try {
    const NoiseEstimate e = estimate_noise(field);
    print_model("differences", e);
    if (e.alpha_at_limit)
      print_note("differences: alpha is at its limit, so structure is likely to dominate them");
  } catch (const InvalidInput& error) {
    print_note(fmt::format("differences: {}", error.reason()));
  }
}

std::string largest(const std::vector<LagCorrelation>& lags) {
  const LagCorrelation* most = nullptr;
  for (const LagCorrelation& l : lags)
    if (!most || std::fabs(l.correlation) > std::fabs(most->correlation)) most = &l;
  return most ? fmt::format("largest correlation {:.4f} at lag {} (z {:.1f})", most->correlation,
                            most->lag, most->z)
              : "no pairs";
}

std::string format_p(double p) { return p < 1e-4 ? "p < 0.0001" : fmt::format("p = {:.4f}", p); }

void print_check(const NoiseCheck& c) {
  print("{:<12} along rows {}: {}\n", "whiteness", format_p(c.along_p), largest(c.along));
  print("{:<12} across rows {}: {}\n", "", format_p(c.across_p), largest(c.across));
  print("{:<12} {}: skewness {:.3f}, excess kurtosis {:.3f}\n", "normality", format_p(c.normal_p),
        c.skewness, c.excess_kurtosis);
}

int of_scan(const NoiseArguments& o) {
  if (o.scan.empty()) throw UsageError("noise", "no scan is given", "Name a file to read");
  workflow::ScanNoiseParameters parameters;
  io::HeightReadOptions reading;
  MaskInput masks;
  o.bound.apply(parameters), o.bound.apply(reading), o.bound.apply(masks);
  if (o.plot) io::check_plot_target(*o.plot);
  const HeightField scan = read_scan(o.scan, reading, o.quiet).field;
  const workflow::ScanNoise noise =
      workflow::noise_of_scan(scan, parameters, read_masks(masks, scan), JobReporter(o.quiet));
  if (noise.plane && !o.quiet)
    print("{:<12} {:.1f} % of the image; the next plane holds {:.1f} %\n", "substrate",
          100 * noise.substrate_share, 100 * noise.plane->runner_up_share);
  print_model("noise", noise.estimate);
  if (!o.quiet) print_differences(scan);
  if (!noise.check) {
    if (o.plot) throw InvalidInput("--plot", "there is no noise to draw", "Leave it out");
    return 0;
  }
  print_check(*noise.check);
  if (!o.plot) return 0;
  std::vector<std::filesystem::path> inputs{o.scan};
  for (const std::string& mask : masks.files()) inputs.emplace_back(mask);
  io::Plot plot =
      plot_noise(noise.residual_nm, noise.white, noise.samples, noise.estimate.noise, *noise.check);
  plot.metadata =
      workflow::step_record("noise scan", workflow::records_of(parameters, reading, masks), inputs);
  io::write_plot(*o.plot, plot);
  if (!o.quiet) print("{:<12} {}\n", "written", *o.plot);
  return 0;
}

int of_sem_image(const NoiseArguments& o) {
  return print_sem_noise(o.bound.given(), o.plot, o.quiet);
}
int of_scene(const NoiseArguments& o) { return print_counts(o.bound, o.plot, o.quiet); }

void add_scan_options(CLI::App& app, NoiseArguments& o, bool hidden) {
  add_scan_input(app, o.bound, o.scan, hidden ? "" : "Options");
  o.bound.add<workflow::ScanNoiseParameters>(app, hidden ? "" : "Noise");
  o.bound.add<MaskInput>(app, hidden ? "" : "Samples that decide");
}

void add_outputs(CLI::App& app, NoiseArguments& o, bool hidden) {
  const char* group = hidden ? "" : "Output";
  with_role(app.add_option("--plot", o.plot, "Chart of the results to write: .svg .png")
                ->type_name("FILE")
                ->group(group),
            FileRole::written);
  add_quiet_flag(app, o.quiet)->group(group);
}

template <class... Struct>
std::set<std::string> names_of(Struct... of) {
  std::set<std::string> names;
  (for_each_parameter(of, [&](const Parameter& about, Field&) { names.insert(about.name); }), ...);
  return names;
}

/// What `noise` was before it had commands of its own: `noise SCAN`, `noise --sem IMAGE`, `noise
/// --counts SCENE`.
int as_before(const NoiseArguments& o) {
  const bool sem = o.bound.is_given("noise.image"), counts = o.bound.is_given("counts.scene");
  const int uses = !o.scan.empty() + sem + counts;
  if (uses > 1)
    throw UsageError("noise", "more than one of a scan, --sem and --counts is given",
                     "Run it once for each");
  if (uses == 0) throw UsageError("noise", "of what is not given", "Choose scan, sem or counts");
  const auto sem_names = names_of(SemNoiseInput{}, SemNoiseOptions{}),
             count_names = names_of(CountsFiles{}, workflow::CountJob{});
  for (const auto& [name, texts] : o.bound.given()) {
    const bool is_sem = sem_names.contains(name) || (sem && name == "scan.height_pitch"),
               is_count = count_names.contains(name);
    if (is_sem == sem && is_count == counts) continue;
    throw UsageError(fmt::format("`{}`", name),
                     fmt::format("it is of {}", is_sem     ? "SEM images"
                                                : is_count ? "simulated counts"
                                                           : "AFM scans"),
                     "Leave it out");
  }
  if (!sem) return counts ? of_scene(o) : of_scan(o);
  GivenTexts given = o.bound.given();
  if (const auto pitch = given.find("scan.height_pitch"); pitch != given.end())
    given["scan.pixel_size"] = pitch->second;
  return print_sem_noise(given, o.plot, o.quiet);
}

using Work = int (*)(const NoiseArguments&);

CLI::App* add(CLI::App& app, const char* name, const char* title, const char* footer, Work work,
              const std::function<void(CLI::App&, NoiseArguments&)>& declare, Action& action) {
  const auto o = std::make_shared<NoiseArguments>();
  CLI::App* sub = app.add_subcommand(name, title);
  sub->group("Commands");
  declare(*sub, *o);
  sub->footer(footer);
  sub->callback([sub, o, work, &action] {
    if (sub->get_subcommands().empty()) action = [o, work] { return work(*o); };
  });
  return sub;
}

}  // namespace

void add_noise(CLI::App& app, Action& action) {
  CLI::App* sub = add(
      app, "noise",
      "The noise of an AFM scan, an SEM image or simulated counts, and whether the model fits",
      of_all, as_before,
      [](CLI::App& noise, NoiseArguments& o) {
        add_scan_options(noise, o, true);
        o.bound.looks["noise.image"] = {.name = "--sem"};
        o.bound.looks["counts.scene"] = {.name = "--counts"};
        o.bound.add<SemNoiseInput>(noise, "", {}, {"noise.image"});
        o.bound.add<CountsFiles>(noise, "", {}, {"counts.scene"});
        add_sem_noise_options(noise, o.bound, "");
        add_counts_options(noise, o.bound, "");
        add_outputs(noise, o, true);
      },
      action);
  add(
      *sub, "scan", "The noise of an AFM scan", of_scans, of_scan,
      [](CLI::App& scan, NoiseArguments& o) {
        add_scan_options(scan, o, false);
        add_outputs(scan, o, false);
      },
      action);
  add(
      *sub, "sem", "The noise of an SEM image", of_sem_images, of_sem_image,
      [](CLI::App& sem, NoiseArguments& o) {
        o.bound.looks["noise.image"] = {.name = "IMAGE", .positional = true};
        o.bound.looks["scan.pixel_size"] = {
            .help = "Width and height of the pixels, as 2nm or 2nmx3nm: for regions with lengths"};
        o.bound.add<SemNoiseInput>(sem, "Noise", {}, {"noise.image"});
        add_sem_noise_options(sem, o.bound, "Noise");
        o.bound.add<io::SemReadOptions>(sem, "Noise", {}, {"scan.pixel_size"});
        add_outputs(sem, o, false);
      },
      action);
  add(
      *sub, "counts", "The electrons from a stationary beam", of_counts, of_scene,
      [](CLI::App& counts, NoiseArguments& o) {
        o.bound.looks["counts.scene"] = {.name = "SCENE", .positional = true};
        o.bound.add<CountsFiles>(counts, "Counts", {}, {"counts.scene"});
        add_counts_options(counts, o.bound, "Counts");
        add_outputs(counts, o, false);
      },
      action);
}

}  // namespace surf::cli
