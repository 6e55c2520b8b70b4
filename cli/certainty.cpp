// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/certainty_job.h"

#include <fmt/format.h>

#include <memory>

#include "afm_options.h"
#include "commands.h"
#include "common_options.h"
#include "exit_codes.h"
#include "job_reporter.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/image_file.h"
#include "terminal.h"
#include "tip_options.h"

namespace surf::cli {
namespace {

constexpr const char* certainty_examples =
    R"(The map is 1 where the tip touched the surface and nothing else could have made the scan what it is
there, to within the noise: there the eroded scan is the surface. 0 elsewhere: an upper bound.
Channels: certain; radius_px, in how large a neighbourhood the contact lies (-1: uncertain); surface.

Examples:
  semsurf certainty scan.gsf --tip tip.gsf -o map.png
  semsurf certainty scan.gsf --tip tip.gsf --height-noise 0.1nm -o map.vti --eroded surface.gsf)";

struct CertaintyArguments {
  BoundParameters bound;
  std::string input;
  std::optional<std::string> tip, output, eroded;
  bool quiet = false;
};

Image to_image(const CertaintyMap& map) {
  const int w = map.level.width(), h = map.level.height();
  Image image;
  image.placement() = map.surface.placement();
  Grid<float> certain(w, h), radius(w, h), surface(w, h);
  for (std::size_t i = 0; i < certain.size(); ++i) {
    const bool is_certain = map.level.data()[i] != CertaintyMap::uncertain;
    certain.data()[i] = is_certain ? 1.0f : 0.0f;
    radius.data()[i] = is_certain ? static_cast<float>(map.level.data()[i]) : -1.0f;
    surface.data()[i] = static_cast<float>(map.surface.z_nm.data()[i]);
  }
  image.channels = {
      {"certain", "1", certain}, {"radius_px", "1", radius}, {"surface", "nm", surface}};
  return image;
}

void report(const CertaintyMap& map, const CertaintyArguments& o) {
  const auto percent = [](std::size_t part, std::size_t whole) {
    return whole ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  };
  print("{:<10} contacts within {} of the scan, at most {} pixels from each other's middle\n",
        "tolerance", format_length(map.tolerance_nm), map.neighbourhood);
  print("{:<10} {:.1f} % of the scan touched in one place, {:.1f} % possibly in several\n",
        "contacts", percent(map.single, map.image_pixels),
        percent(map.ambiguous, map.image_pixels));
  print("{:<10} {:.1f} % of the surface{}\n", "certain", percent(map.certain, map.surface_samples),
        map.unexplained > 0
            ? fmt::format(", by the {:.1f} % of the scan that this tip can have made",
                          100 - percent(map.unexplained, map.image_pixels))
            : "");
  print("{:<10} {}\n", "written", *o.output);
  if (o.eroded) print("{:<10} {}\n", "written", *o.eroded);
}

int certainty_work(const CertaintyArguments& o) {
  if (!o.output) throw UsageError("--output", "no output file is given", "Add -o map.png");
  io::check_image_target(*o.output);
  if (o.eroded) io::check_height_field_target(*o.eroded);
  if (!o.tip) throw UsageError("--tip", "no tip is given", "Add --tip tip.gsf");
  workflow::CertaintyParameters parameters;
  io::HeightReadOptions reading;
  o.bound.apply(parameters), o.bound.apply(reading);
  parameters.threads = threads_of(o.bound);
  const HeightField scan = read_scan(o.input, reading, o.quiet).field;
  const Tip tip = read_tip_for(o.tip, scan, o.quiet);
  const workflow::CertaintyResult certain =
      workflow::certainty(scan, tip, parameters, JobReporter(o.quiet));
  const auto record = workflow::step_record(
      "certainty", workflow::records_of(certain.used, reading), {o.input, *o.tip});
  Image image = to_image(certain.map);
  image.metadata = record;
  io::write_image(*o.output, image);
  if (o.eroded) io::write_height_field(*o.eroded, certain.map.surface, record);
  if (!o.quiet) report(certain.map, o);
  return certain.trustworthy ? 0 : exit_untrustworthy;
}

}  // namespace

void add_certainty(CLI::App& app, Action& action) {
  const auto o = std::make_shared<CertaintyArguments>();
  CLI::App* sub = app.add_subcommand("certainty", "Where an eroded scan is the surface");
  add_scan_input(*sub, o->bound, o->input);
  add_tip_input(*sub, o->tip);
  o->bound.looks["scan.height_noise"].former = {"--noise"};
  o->bound.add<workflow::CertaintyParameters>(*sub, "Options");
  with_role(sub->add_option("-o,--output", o->output, "The map: .png, .tif, .exr or .vti")
                ->type_name("FILE"),
            FileRole::written);
  with_role(sub->add_option("--eroded", o->eroded, "The eroded scan: .gsf, .tif, .txt or .vti")
                ->type_name("FILE"),
            FileRole::written);
  with_role(sub->add_option("--surface", o->eroded)->type_name("FILE")->group(""),
            FileRole::written);  // its former name
  add_threads_option(*sub, o->bound, "Options");
  add_quiet_flag(*sub, o->quiet);
  sub->footer(certainty_examples);
  sub->callback([o, &action] { action = [o] { return certainty_work(*o); }; });
}

}  // namespace surf::cli
