// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "bound_parameters.h"
#include "commands.h"
#include "common_options.h"
#include "job_reporter.h"
#include "sem_input.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/cache.h"
#include "surf/io/height_field_file.h"
#include "surf/io/sim/materials.h"
#include "surf/workflow/picture_input.h"
#include "surf/workflow/profile_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* profile_examples =
    R"(How wide lines, trenches and holes are, how steep their walls, and how rough their edges, with standard
errors: profiles of such shapes are simulated and compared with the image. The threshold method stands beside.
Lines run along y, or along x with --along-x. How high walls are no upright view shows: say it, give a scan
(--afm), or further images from other sides (--sem, --tilt). FOLDER/surface.vti is the surface.
Exit code 4: the result is not to be trusted, and the reasons are said.

Examples:
  semsurf profile lines.tif --height 80nm --material Si --energy 1keV --spot 2nm -o lines
  semsurf profile trench.tif --kind trench --height 120nm --angle 88deg --material SiO2 --energy 800eV -o trench
  semsurf profile up.tif --sem tilted.tif --tilt 3deg --height 100nm --height-error 20nm --material Si --energy 1keV -o lines
  semsurf profile lines.tif --afm scan.gwy --material Si --energy 1keV -o lines
  semsurf profile via.png --pixel-size 2nm --kind hole --height 100nm --material Si --energy 1keV -o via
  semsurf profile via.tif --sem right.tif --sem left.tif --tilt 35deg --azimuth 0deg --azimuth 180deg --kind hole
                  --height 100nm --height-error 25nm --material Si --energy 1keV -o via    how deep it is, too)";

/// Files besides the image.
struct ProfileFiles {
  std::vector<std::string> views;
  std::string afm;
};
void describe(ParameterVisitor& visit, ProfileFiles& files) {
  visit(files.views, {.name = "reconstruction.sem",
                      .help = "A further SEM image of such features, from another side or by "
                              "another detector",
                      .form = "FILE",
                      .file = FileRole::read});
  visit(files.afm, {.name = "reconstruction.afm",
                    .help = "An AFM scan that shows how high walls are, levelled",
                    .form = "FILE",
                    .file = FileRole::read});
}

struct ProfileArguments {
  BoundParameters bound;
  std::string image;
  bool quiet = false;
};

workflow::ProfileJob profile_job_of(const ProfileArguments& o) {
  workflow::ProfileJob job;
  io::MaterialChoice material;
  ProfileFiles files;
  job.cache = io::cache_folder("");
  o.bound.apply(material), o.bound.apply(files), o.bound.apply(job);
  if (o.image.empty()) throw UsageError("IMAGE", "no image is given", "Name an SEM image");
  if (job.folder.empty()) throw UsageError("`output`", "no folder is given", "Add `output=result`");
  if (!material.name.empty()) job.material = read_material(material, o.quiet);
  if (!o.bound.is_given("beam.energy"))
    throw UsageError("`beam.energy`", "it is missing",
                     "Say what the image was taken with, as `beam.energy=1keV`");
  job.sem.image = read_sem_input(o.image, job.sem.reading, o.quiet);
  job.sem.file = o.image;
  for (const std::string& view : files.views)
    job.views.push_back(read_sem_channel(view, job.sem.reading, o.quiet));
  if (!files.afm.empty()) {
    job.scan = io::read_height_field(files.afm).field;
    job.scan_file = files.afm;
  }
  return job;
}

std::string length(const Measured& m) {
  return fmt::format("{:.2f} ± {:.2f} nm", m.value, m.standard_error);
}

void print_wall(const char* label, const std::array<Measured, profile_numbers>& wall) {
  print_line(label, fmt::format("{:.2f} ± {:.2f} deg; top rounded by {}, foot by {}",
                                wall[profile_angle].value, wall[profile_angle].standard_error,
                                length(wall[profile_top]), length(wall[profile_foot])));
}

void print_roughness(const char* label, const EdgeRoughness& r) {
  if (!r.found) {
    print_line(label,
               fmt::format("no more than the noise of finding edges, {:.2f} nm a row", r.noise_nm));
    return;
  }
  print_line(label, fmt::format("3 sigma {:.2f} ± {:.2f} nm, correlation length {:.3g} nm, "
                                "exponent {:.2f}; with the noise of finding edges {:.2f} nm",
                                3 * r.sigma_nm, 3 * r.sigma_error_nm, r.correlation_nm, r.hurst,
                                3 * r.biased_sigma_nm));
}

void print_summary(const workflow::ProfileJob& job, const workflow::ProfileSummary& s) {
  print_line("found", fmt::format("{} edges by thresholds", s.threshold.edges.size()));
  if (s.hole)
    print_line("hole", fmt::format("about ({:.2f}, {:.2f}) nm", s.hole->x_nm, s.hole->y_nm));
  if (job.kind != FeatureKind::edge) {
    print_line("width", fmt::format("{} at half the height{}", length(s.fit.left[profile_width]),
                                    s.fit.widths_nm.size() > 1
                                        ? fmt::format(", mean of {}", s.fit.widths_nm.size())
                                        : ""));
    Measured threshold{0, 0};
    for (const Measured& w : s.threshold_widths_nm)
      threshold.value += w.value / static_cast<double>(s.threshold_widths_nm.size());
    print_line("", fmt::format("{:.2f} nm by the threshold method", threshold.value));
  }
  if (job.height_error_nm > 0 || s.scan_height_nm)
    print_line("height", length(s.fit.left[profile_height]));
  for (std::size_t k = 1; k < s.fit.sights.size(); ++k)
    if (s.fit.sights[k].tilt_deg.value != 0)
      print_line(
          fmt::format("view {}", k + 1),
          fmt::format("tilted by {:.3f} ± {:.3f} deg; {:.1f} % of its contrast unexplained",
                      s.fit.sights[k].tilt_deg.value, s.fit.sights[k].tilt_deg.standard_error,
                      100 * s.fit.sights[k].discrepancy_share));
  if (s.measured_pitch_nm) print_line("pitch", length(*s.measured_pitch_nm));
  print_wall(job.walls_apart ? "left wall" : "wall", s.fit.left);
  if (job.walls_apart) print_wall("right wall", s.fit.right);
  if (!s.fit.edge_spectrum.density_nm3.empty()) print_roughness("edges", s.fit.edge_roughness);
  if (!s.fit.width_spectrum.density_nm3.empty()) print_roughness("widths", s.fit.width_roughness);
  print_line("profiles", fmt::format("{} simulated; {:.1f} % of the contrast unexplained",
                                     s.simulated, 100 * s.discrepancy_share));
  print_written(s.written);
}

int profile(const ProfileArguments& o) {
  const workflow::ProfileJob job = profile_job_of(o);
  workflow::ProfileSummary s;
  {
    const JobReporter reporter(o.quiet);
    s = workflow::run(job, reporter);
  }
  if (!o.quiet) print_summary(job, s);
  return print_reasons(s.reasons);
}

}  // namespace

void add_profile(CLI::App& app, Action& action) {
  const auto o = std::make_shared<ProfileArguments>();
  CLI::App* sub = app.add_subcommand(
      "profile", "Widths, wall angles and edge roughness of lines, trenches and holes");
  with_role(sub->add_option("IMAGE", o->image, "The SEM image")->type_name("FILE"), FileRole::read);
  o->bound.headings = {{"profile", "Shape"},
                       {"scan", "SEM image"},
                       {"specimen", "SEM image"},
                       {"reconstruction", "Further images"},
                       {"reconstruction.afm", "Shape"},
                       {"beam.tilt", "Further images"},
                       {"beam.azimuth", "Further images"},
                       {"reconstruction.view_signal", "Further images"},
                       {"beam", "SEM image"},
                       {"simulation", "SEM image"},
                       {"output", "Output"},
                       {"job", "Output"}};
  o->bound.looks["output"] = {.name = "-o,--output"};
  o->bound.add<io::MaterialChoice>(*sub, "");
  o->bound.add<ProfileFiles>(*sub, "");
  o->bound.add<workflow::ProfileJob>(*sub, "");
  add_quiet_flag(*sub, o->quiet)->group("Output");
  sub->footer(profile_examples);
  sub->callback([o, &action] { action = [o] { return profile(*o); }; });
}

}  // namespace surf::cli
