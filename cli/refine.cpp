// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "bound_parameters.h"
#include "commands.h"
#include "common_options.h"
#include "job_reporter.h"
#include "mesh_parameters.h"
#include "sem_input.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/cache.h"
#include "surf/io/sim/materials.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/workflow/refine_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* refine_examples =
    R"(START is a mesh that is about right: drawn, or a reconstruction (surface.vti). Its vertices move until
simulated images of it agree with the SEM images, undercuts included: first the whole shape (sizes, angles of
walls), then bumps. It is a closed body, or a sheet that goes on level beyond its rim.
FOLDER/surface.vtp holds the surface with its standard deviation, and what each image tells of each place:
where no image sees a wall, the deviation says so. Exit code 4: the result is not to be trusted, and why.

Examples:
  semsurf refine line.stl --sem left.exr:SE --sem right.exr:SE --tilt 15deg --azimuth 0deg --azimuth 180deg \
    --material Si --energy 1keV -o line
  semsurf refine result/surface.vti --sem up.tif --sem tilted.tif --tilt 0deg --tilt 20deg --material Si \
    --energy 1keV --bump-error 2nm -o refined)";

struct RefineFiles {
  std::vector<std::string> images;
};
void describe(ParameterVisitor& visit, RefineFiles& files) {
  visit(files.images, {.name = "reconstruction.sem",
                       .help = "An SEM image: FILE or FILE:CHANNEL; once for each",
                       .form = "FILE",
                       .file = FileRole::read});
}

struct RefineArguments {
  BoundParameters bound;
  std::string start;
  bool quiet = false;
};

workflow::RefineJob refine_job_of(const RefineArguments& o) {
  workflow::RefineJob job;
  io::MaterialChoice material;
  io::SpecimenRequest meshes;
  RefineFiles files;
  job.cache = io::cache_folder("");
  o.bound.apply(material), o.bound.apply(meshes), o.bound.apply(files), o.bound.apply(job);
  if (o.start.empty()) throw UsageError("START", "no mesh is given", "Name one to begin with");
  if (job.folder.empty()) throw UsageError("`output`", "no folder is given", "Add `output=result`");
  if (!material.name.empty()) job.material = read_material(material, o.quiet);
  if (!o.bound.is_given("beam.energy"))
    throw UsageError("`beam.energy`", "it is missing",
                     "Say what the images were taken with, as `beam.energy=1keV`");
  std::vector<std::string> notes;
  job.start = workflow::read_refined_start(o.start, mesh_unit_of(meshes), notes);
  if (!o.quiet)
    for (const std::string& note : notes) print_note(note);
  job.start_file = o.start;
  const io::SemReadOptions reading = job.images.front().reading;
  job.images.clear();
  for (const std::string& image : files.images)
    job.images.push_back(read_sem_channel(image, reading, o.quiet));
  return job;
}

void print_summary(const workflow::RefineSummary& s) {
  print_line("mesh", fmt::format("{} triangles, {}", s.mesh.triangles.size(),
                                 s.self_intersections == 0
                                     ? "no self-intersections"
                                     : fmt::format("{} self-intersections", s.self_intersections)));
  double most = 0;
  std::vector<double> deviations;  // of vertices that may move
  for (std::size_t v = 0; v < s.displacement_nm.size(); ++v) {
    most = std::max(most, std::abs(s.displacement_nm[v]));
    if (s.displacement_nm[v] != 0) deviations.push_back(s.deviation_nm[v]);
  }
  std::ranges::sort(deviations);
  if (!deviations.empty())
    print_line("moved",
               fmt::format("by up to {}; standard deviations {} to {} (10 and 90 %)",
                           format_length(most), format_length(deviations[deviations.size() / 10]),
                           format_length(deviations[deviations.size() * 9 / 10])));
  for (std::size_t v = 0; v < s.images.size(); ++v)
    print_line(fmt::format("image {}", v + 1),
               fmt::format("{:.1f} % of its contrast unexplained, {:.1f} % before; tilt {:.2f} deg",
                           100 * s.images[v].unexplained, 100 * s.images[v].unexplained_before,
                           s.images[v].tilt_deg));
  print_written(s.written);
}

int refine(const RefineArguments& o) {
  const workflow::RefineJob job = refine_job_of(o);
  workflow::RefineSummary s;
  {
    const JobReporter reporter(o.quiet);
    s = workflow::run(job, reporter);
  }
  if (!o.quiet) print_summary(s);
  return print_reasons(s.reasons);
}

}  // namespace

void add_refine(CLI::App& app, Action& action) {
  const auto o = std::make_shared<RefineArguments>();
  CLI::App* sub = app.add_subcommand(
      "refine", "Let a mesh, undercuts included, agree with SEM images from several sides");
  with_role(
      sub->add_option("START", o->start, "A mesh, or heights, to begin with")->type_name("FILE"),
      FileRole::read);
  o->bound.headings = {{"reconstruction", "SEM images"},
                       {"scan", "SEM images"},
                       {"beam", "SEM images"},
                       {"specimen", "Specimen"},
                       {"refinement.substrate", "Specimen"},
                       {"refinement", "Refinement"},
                       {"simulation", "Refinement"},
                       {"output", "Output"},
                       {"job", "Output"}};
  o->bound.looks["output"] = {.name = "-o,--output"};
  o->bound.add<io::MaterialChoice>(*sub, "");
  o->bound.add<io::SpecimenRequest>(*sub, "Specimen", {},
                                    {"specimen.unit", "specimen.override_unit"});
  o->bound.add<RefineFiles>(*sub, "");
  o->bound.add<workflow::RefineJob>(*sub, "");
  add_quiet_flag(*sub, o->quiet)->group("Output");
  sub->footer(refine_examples);
  sub->callback([o, &action] { action = [o] { return refine(*o); }; });
}

}  // namespace surf::cli
