// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <tuple>

#include "bound_parameters.h"
#include "commands.h"
#include "common_options.h"
#include "job_reporter.h"
#include "mesh_parameters.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/web_page.h"
#include "surf/workflow/step_record.h"
#include "surf/workflow/view_page.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* view_examples =
    R"(One HTML file that any browser shows, from disk and without a network: surfaces in 3D, colours by height
or any scalar, cross-sections with their profiles in nm, SEM images beside and laid on.
Meshes, scans of every format that semsurf reads, images (EXR, TIFF, PNG, VTI); an image with a channel in nm
is a surface. FILE:CHANNEL chooses a channel.

Examples:
  semsurf view scan.gwy -o page.html
  semsurf view scan.gsf eroded.gsf tip.gsf --scalar certainty.tif:certain -o page.html
  semsurf view specimen.ply --drape simulated.exr:SE --title "Mesa, 80 deg" -o page.html
  semsurf view large.gsf --mesh-tolerance 0.1nm -o page.html)";

constexpr double heavy_page_bytes = 50e6;

struct ViewArguments {
  std::vector<std::string> files;
  std::optional<std::string> output, title, drape;
  std::vector<std::string> scalars;
  BoundParameters bound;
  bool quiet = false;
};

workflow::ViewReading make_reading(const ViewArguments& o, const io::SpecimenRequest& given) {
  workflow::ViewReading r;
  o.bound.apply(static_cast<workflow::ViewParameters&>(r));
  o.bound.apply(r.pitch);
  r.unit = mesh_unit_of(given);
  r.heights = given.heights;
  return r;
}

std::string describe(const io::WebSurface& surface) {
  std::string text;
  if (const auto* field = std::get_if<HeightField>(&surface.shape))
    text = fmt::format("{} x {} samples, {} x {}", field->z_nm.width(), field->z_nm.height(),
                       format_length((field->z_nm.width() - 1) * field->pitch_x_nm),
                       format_length((field->z_nm.height() - 1) * field->pitch_y_nm));
  else text = fmt::format("{} triangles", std::get<TriangleMesh>(surface.shape).triangles.size());
  for (const io::WebScalar& scalar : surface.scalars) text += ", " + scalar.name;
  return text;
}

void report(const io::WebPage& page, const io::WebPageSummary& summary, const std::string& output) {
  for (const io::WebSurface& surface : page.surfaces)
    print("{:<10} {}: {}\n", "surface", surface.name, describe(surface));
  for (const io::WebImage& image : page.images)
    print("{:<10} {}: {} x {} pixels{}\n", "image", image.name, image.image.width(),
          image.image.height(), image.has_scale ? "" : ", size not known (--pixel-size)");
  print("{:<10} {}, {}, of these {} the viewer\n", "written", output,
        format_bytes(double(summary.bytes)), format_bytes(double(summary.viewer_bytes)));
}

int view_work(const ViewArguments& o) {
  if (o.files.empty())
    throw UsageError("view", "no file is given", "Name scans, meshes or images to show");
  if (!o.output) throw UsageError("--output", "no output file is given", "Add -o page.html");
  io::SpecimenRequest given;
  o.bound.apply(given);
  const workflow::ViewReading reading = make_reading(o, given);
  io::check_web_page_target(*o.output);
  std::vector<workflow::FileChannel> inputs, scalars;
  for (const std::string& file : o.files) inputs.push_back(workflow::parse_file_channel(file));
  for (const std::string& file : o.scalars) scalars.push_back(workflow::parse_file_channel(file));
  std::optional<workflow::FileChannel> drape;
  if (o.drape) drape = workflow::parse_file_channel(*o.drape);

  JobReporter reporter(o.quiet);
  const double steps = 2 * double(inputs.size() + scalars.size());  // reading, then writing
  double done = 0;
  const auto next = [&] {
    reporter->progress(done++, steps, "files");
    reporter->watch().check();
  };
  workflow::ViewPage made(reading, reporter);
  io::WebPage& page = made.page();
  page.title = o.title.value_or(inputs.front().file.stem().string());
  for (const workflow::FileChannel& input : inputs) {
    next();
    made.add(input);
  }
  for (const workflow::FileChannel& scalar : scalars) {
    next();
    made.add_scalar(scalar);
  }
  if (drape) made.drape(*drape);

  std::vector<std::string> read;
  for (const workflow::FileChannel& input : inputs) read.push_back(input.file.string());
  for (const workflow::FileChannel& scalar : scalars) read.push_back(scalar.file.string());
  if (drape) read.push_back(drape->file.string());
  page.metadata = workflow::step_record(
      "view",
      workflow::records_of(given, reading.pitch,
                           static_cast<const workflow::ViewParameters&>(reading)),
      {read.begin(), read.end()});

  const auto summary =
      io::write_web_page(*o.output, page,
                         {[&](double part, double total) {
                            reporter->progress(steps / 2 * (1 + part / total), steps, "files");
                          },
                          reporter->cancel});
  reporter.clear();
  if (!o.quiet) report(page, summary, *o.output);
  if (double(summary.bytes) > heavy_page_bytes)
    print_warning(fmt::format(
        "a page of {} opens slowly. --mesh-tolerance 0.1nm leaves out what is flat, --every 2 "
        "takes "
        "every second sample",
        format_bytes(double(summary.bytes))));
  return 0;
}

}  // namespace

void add_view(CLI::App& app, Action& action) {
  const auto o = std::make_shared<ViewArguments>();
  CLI::App* sub =
      app.add_subcommand("view", "One web page that shows surfaces and images to anybody");
  with_role(
      sub->add_option("FILES", o->files, "Scans, meshes, images; FILE:CHANNEL chooses a channel")
          ->type_name("FILE"),
      FileRole::read);
  const char* shown = "Shown";
  sub->add_option("--title", o->title, "Title of the page (the first file's name)")
      ->type_name("TEXT")
      ->group(shown);
  with_role(
      sub->add_option("--drape", o->drape, "An image to lay on the surfaces, FILE or FILE:CHANNEL")
          ->type_name("FILE")
          ->group(shown),
      FileRole::read);
  with_role(sub->add_option("--scalar", o->scalars,
                            "A map to colour them by, FILE or FILE:CHANNEL; may be repeated")
                ->type_name("FILE")
                ->option_text("FILE")
                ->allow_extra_args(false)
                ->group(shown),
            FileRole::read);
  const char* reading = "Reading";
  o->bound.looks["view.mesh_tolerance"].former = {"--tolerance"};
  o->bound.looks["view.every"].former = {"--step"};
  o->bound.add<io::SpecimenRequest>(*sub, reading, {}, surface_readings);
  o->bound.add<workflow::GivenPitch>(*sub, reading);
  o->bound.add<workflow::ViewParameters>(*sub, "Size");
  const char* output = "Output";
  with_role(sub->add_option("-o,--output", o->output, "The page: .html")
                ->type_name("FILE")
                ->group(output),
            FileRole::written);
  add_quiet_flag(*sub, o->quiet)->group(output);
  sub->footer(view_examples);
  sub->callback([o, &action] { action = [o] { return view_work(*o); }; });
}

}  // namespace surf::cli
