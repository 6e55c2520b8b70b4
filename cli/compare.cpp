// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
#include "surf/io/scan_parameters.h"
#include "surf/io/sim/materials.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/workflow/compare_job.h"
#include "surf/workflow/picture_input.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* compare_examples =
    R"(Lays AFTER on BEFORE and says where they differ beyond their errors: a map of probabilities and a list of
places, strongest first. Where nothing changed, anything at all is listed in 5 of 100 comparisons (--false-alarms).
BEFORE and AFTER are scans, surfaces of 'semsurf reconstruct' (surface.vti brings its standard deviations), or one
of them a mesh of what is expected. With --material and --energy, or --model, AFTER is an SEM image.
Without deviations, those of the difference are estimated from it. FILE:CHANNEL names a channel.
Results: change.vti, places.csv, report.json and panel.png.
Exit code 4: the files could not be laid on each other, or differ nearly everywhere; the reasons are said.

Examples:
  semsurf compare monday.gwy tuesday.gwy -o change
  semsurf compare one/surface.vti two/surface.vti -o change --false-alarms 1%
  semsurf compare part.stl scan.gwy --unit um --after-deviation 0.3nm -o change
  semsurf compare surface.vti later.tif --material Si --energy 1keV -o change)";

struct CompareArguments {
  BoundParameters bound;
  std::string before, after;
  bool quiet = false;
};

workflow::ComparedSurface read_surface(const std::string& file, io::HeightReadOptions reading,
                                       const io::MeshUnit& unit, bool quiet,
                                       std::filesystem::path& path) {
  const workflow::FileChannel name = workflow::parse_file_channel(file);
  if (!name.channel.empty()) reading.channel = name.channel;
  path = name.file;
  std::vector<std::string> notes;
  workflow::ComparedSurface surface =
      workflow::read_compared_surface(name.file, reading, unit, notes);
  if (!quiet)
    for (const std::string& note : notes) print_note(note);
  return surface;
}

void take_image(const CompareArguments& o, const io::MaterialChoice& material,
                workflow::CompareJob& job) {
  io::SemReadOptions reading;
  o.bound.apply(reading);
  const workflow::FileChannel name = workflow::parse_file_channel(o.after);
  if (!name.channel.empty()) reading.channel = name.channel;
  job.after_file = name.file;
  job.after = read_sem_input(name.file.string(), reading, o.quiet);
  if (material.name.empty()) return;
  if (job.model.file.empty() && !o.bound.is_given("beam.energy"))
    throw UsageError("`beam.energy`", "it is missing",
                     "Say what the SEM image was taken with, as `beam.energy=1keV`");
  job.model.material = read_material(material, o.quiet);
}

workflow::CompareJob compare_job_of(const CompareArguments& o) {
  workflow::CompareJob job;
  io::MaterialChoice material;
  io::SpecimenRequest meshes;
  io::HeightReadOptions heights;
  o.bound.apply(material), o.bound.apply(meshes), o.bound.apply(heights), o.bound.apply(job);
  if (o.before.empty() || o.after.empty())
    throw UsageError(o.before.empty() ? "BEFORE" : "AFTER", "no file is given",
                     "Name two files: what was before, and what is after");
  if (job.folder.empty()) throw UsageError("`output`", "no folder is given", "Add `output=result`");
  if (!o.bound.is_given("job.cache")) {
    const std::filesystem::path cache = io::cache_folder();
    job.model.folder = cache.empty() ? cache : cache / "models";
  }
  job.model.threads = job.threads;
  const io::MeshUnit unit = mesh_unit_of(meshes);
  job.before = read_surface(o.before, heights, unit, o.quiet, job.before_file);
  if (!material.name.empty() || !job.model.file.empty()) {
    take_image(o, material, job);
    return job;
  }
  workflow::ComparedSurface after = read_surface(o.after, heights, unit, o.quiet, job.after_file);
  std::visit([&](auto& surface) { job.after = std::move(surface); }, after);
  return job;
}

void print_places(const workflow::CompareSummary& s) {
  constexpr std::size_t most = 20;
  const auto& places = s.changes.places;
  print_line("", fmt::format("{:>3} {:>10} {:>10} {:>11} {:>18} {:>10} {:>12}", "", "x/nm", "y/nm",
                             "area/nm2", "change/" + s.unit, "deviations", "probability"));
  for (std::size_t k = 0; k < std::min(most, places.size()); ++k) {
    const ChangedPlace& p = places[k];
    print_line("",
               fmt::format("{:>3} {:>10.1f} {:>10.1f} {:>11.4g} {:>+10.3g} ± {:<5.2g} {:>10.1f} "
                           "{:>10.2f} %",
                           k + 1, p.centre_nm.x, p.centre_nm.y, p.area_nm2, p.mean, p.mean_error,
                           p.score, 100 * p.probability));
  }
  if (places.size() > most)
    print_line("", fmt::format("and {} more, in places.csv", places.size() - most));
}

void print_summary(const workflow::CompareJob& job, const workflow::CompareSummary& s) {
  if (s.pose) {
    const Affine& a = s.pose->sem_to_afm;
    print_line("registered", fmt::format("by [{:.4f} {:.4f} {:.1f}; {:.4f} {:.4f} {:.1f}]", a.xx,
                                         a.xy, a.x0, a.yx, a.yy, a.y0));
  } else {
    const SurfaceAlignment& a = s.alignment;
    print_line("shift",
               fmt::format("({:.3f} ± {:.3f}, {:.3f} ± {:.3f}) nm; lift {:.3f} nm; "
                           "correlation {:.4f}, {:.0f} % overlap",
                           a.shift_nm.x, std::sqrt(a.covariance[0]), a.shift_nm.y,
                           std::sqrt(a.covariance[6]), a.lift_nm, a.correlation, 100 * a.overlap));
  }
  if (s.verdict != workflow::CompareVerdict::not_registered) {
    const Changes& c = s.changes;
    print_line("errors", c.spread > 0
                             ? fmt::format("{}; the difference spreads {:.2f} times as much",
                                           s.deviation_from, c.spread)
                             : fmt::format("a standard deviation of {:.3g} {}, from {}",
                                           c.estimated_deviation, s.unit, s.deviation_from));
    print_line("threshold", fmt::format("{:.2f} standard deviations, which noise exceeds anywhere "
                                        "in {:g} of 100 views",
                                        c.threshold, 100 * job.parameters.false_alarms));
    if (c.places.empty()) print_line("changes", "none beyond the errors");
    else {
      print_line("changes",
                 fmt::format("{} place{}", c.places.size(), c.places.size() == 1 ? "" : "s"));
      print_places(s);
    }
  }
  print_written(s.written);
}

int compare(const CompareArguments& o, const std::string& command_line) {
  workflow::CompareJob job = compare_job_of(o);
  job.command_line = command_line;
  workflow::CompareSummary s;
  {
    const JobReporter reporter(o.quiet);
    s = workflow::run(job, reporter);
  }
  if (!o.quiet) print_summary(job, s);
  return print_reasons(s.reasons);
}

}  // namespace

void add_compare(CLI::App& app, Action& action, const std::string& command_line) {
  const auto o = std::make_shared<CompareArguments>();
  CLI::App* sub =
      app.add_subcommand("compare", "Where a surface differs from another beyond their errors");
  with_role(sub->add_option("BEFORE", o->before, "A scan, a surface, or a mesh of what is expected")
                ->type_name("FILE"),
            FileRole::read);
  with_role(sub->add_option("AFTER", o->after,
                            "A scan, a surface, a mesh or an SEM image of the later state")
                ->type_name("FILE"),
            FileRole::read);
  o->bound.headings = {{"compare", "Comparison"},
                       {"scan", "Files"},
                       {"specimen", "SEM image"},
                       {"reconstruction", "SEM image"},
                       {"beam", "SEM image"},
                       {"compare.model_error", "SEM image"},
                       {"scan.sem_channel", "SEM image"},
                       {"scan.pixel_size", "SEM image"},
                       {"simulation", "SEM image"},
                       {"output", "Output"},
                       {"job", "Output"}};
  o->bound.looks["output"] = {.name = "-o,--output"};
  o->bound.add<workflow::CompareJob>(*sub, "");
  o->bound.add<io::MaterialChoice>(*sub, "SEM image");
  o->bound.add<io::SpecimenRequest>(*sub, "Files", {}, {"specimen.unit", "specimen.override_unit"});
  o->bound.add<io::HeightReadOptions>(*sub, "Files");
  o->bound.add<io::SemReadOptions>(*sub, "SEM image");
  add_quiet_flag(*sub, o->quiet)->group("Output");
  sub->footer(compare_examples);
  sub->callback([o, &action, command_line] {
    action = [o, command_line] { return compare(*o, command_line); };
  });
}

}  // namespace surf::cli
