// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/certainty.h"

#include <fmt/format.h>

#include <memory>

#include "afm_options.h"
#include "commands.h"
#include "common_options.h"
#include "exit_codes.h"
#include "options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/image_file.h"
#include "terminal.h"
#include "tip_options.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(The map is 1 where the tip touched the surface and nothing else could have made the scan what it is
there, to within the noise: there the eroded scan is the surface. 0 elsewhere: an upper bound.
Channels: certain; radius_px, in how large a neighbourhood the contact lies (-1: uncertain); surface.

Examples:
  semsurf certainty scan.gsf --tip tip.gsf -o map.png
  semsurf certainty scan.gsf --tip tip.gsf --noise 0.1nm -o map.vti --surface surface.gsf)";

struct Options {
  ScanInput input;
  std::optional<std::string> tip, noise, sigmas, neighbourhood, distance, output, surface, threads;
  bool quiet = false;
};

double parse_not_below_0(const std::string& text, const char* subject) {
  const double nm = parse_length_nm(text, subject);
  if (nm >= 0) return nm;
  throw UsageError(subject, fmt::format("'{}' is below 0", text), "Give a length, as 0.1nm");
}

CertaintyOptions plan(const Options& o) {
  if (!o.output) throw UsageError("--output", "no output file is given", "Add -o map.png");
  io::check_image_target(*o.output);
  if (o.surface) io::check_height_field_target(*o.surface);
  if (!o.tip) throw UsageError("--tip", "no tip is given", "Add --tip tip.gsf");
  CertaintyOptions c;
  if (o.noise) c.noise_nm = parse_not_below_0(*o.noise, "--noise");
  if (o.distance) c.distance_nm = parse_not_below_0(*o.distance, "--distance");
  if (o.sigmas) c.sigmas = static_cast<double>(parse_whole(*o.sigmas, "--sigmas", 1, 100));
  if (o.neighbourhood)
    c.neighbourhood = static_cast<int>(parse_whole(*o.neighbourhood, "--neighbourhood", 0, 100));
  c.threads = parse_threads(o.threads);
  return c;
}

Image to_image(const CertaintyMap& map) {
  const int w = map.level.width(), h = map.level.height();
  Image image;
  image.pitch_x_nm = map.surface.pitch_x_nm;
  image.pitch_y_nm = map.surface.pitch_y_nm;
  image.origin_x_nm = map.surface.origin_x_nm;
  image.origin_y_nm = map.surface.origin_y_nm;
  Grid<float> certain(w, h), radius(w, h), surface(w, h);
  for (std::size_t i = 0; i < certain.size(); ++i) {
    const bool is_certain = map.level.data()[i] != CertaintyMap::uncertain;
    certain.data()[i] = is_certain ? 1.0f : 0.0f;
    radius.data()[i] = is_certain ? static_cast<float>(map.level.data()[i]) : -1.0f;
    surface.data()[i] = static_cast<float>(map.surface.z_nm.data()[i]);
  }
  image.channels = {{"certain", "1", certain}, {"radius_px", "1", radius}, {"surface", "nm", surface}};
  return image;
}

void report(const CertaintyMap& map, const Options& o) {
  const auto percent = [](std::size_t part, std::size_t whole) {
    return whole ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  };
  print("{:<10} contacts within {} of the scan, at most {} pixels from each other's middle\n", "tolerance",
             format_length(map.tolerance_nm), map.neighbourhood);
  print("{:<10} {:.1f} % of the scan touched in one place, {:.1f} % possibly in several\n", "contacts",
             percent(map.single, map.image_pixels), percent(map.ambiguous, map.image_pixels));
  print("{:<10} {:.1f} % of the surface{}\n", "certain", percent(map.certain, map.surface_samples),
        map.unexplained > 0 ? fmt::format(", by the {:.1f} % of the scan that this tip can have made",
                                          100 - percent(map.unexplained, map.image_pixels))
                            : "");
  print("{:<10} {}\n", "written", *o.output);
  if (o.surface) print("{:<10} {}\n", "written", *o.surface);
}

int work(const Options& o) {
  CertaintyOptions options = plan(o);
  const io::HeightFieldFile scan = read_scan(o.input, o.quiet);
  const Tip tip = read_tip_for(o.tip, scan.field, o.quiet);
  if (!o.noise) {
    options.noise_nm = pixel_noise_nm(scan.field);
    if (!o.quiet)
      print_note(fmt::format("a noise of {} is taken from neighbouring pixels (their second differences); --noise says otherwise",
                             format_length(options.noise_nm)));
  }
  Watched watched(!o.quiet);
  options.watch = watched.watch();
  const CertaintyMap map = certainty_map(scan.field, tip, options);
  watched.clear();
  std::map<std::string, std::string> made{{"noise_nm", fmt::format("{}", options.noise_nm)},
                                          {"sigmas", fmt::format("{}", options.sigmas)},
                                          {"neighbourhood_px", fmt::format("{}", map.neighbourhood)},
                                          {"distance_nm", fmt::format("{}", options.distance_nm)}};
  if (!scan.channel.empty()) made["channel"] = scan.channel;
  const auto provenance = provenance_of("certainty", made, {o.input.file, *o.tip});
  Image image = to_image(map);
  image.metadata = provenance;
  io::write_image(*o.output, image);
  if (o.surface) io::write_height_field(*o.surface, map.surface, provenance);
  if (!o.quiet) report(map, o);
  if (20 * map.unexplained <= map.image_pixels) return 0;
  const bool most = 2 * map.unexplained > map.image_pixels;
  print_warning(fmt::format("{:.0f} % of the scan cannot have been made by this tip with this noise: the tip may be "
                            "sharper than its file says, or --noise larger{}",
                            100.0 * static_cast<double>(map.unexplained) / static_cast<double>(map.image_pixels),
                            most ? ". A map of so little of the scan is not to be trusted" : ""));
  return most ? exit_untrustworthy : 0;
}

}  // namespace

void add_certainty(CLI::App& app, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("certainty", "Where an eroded scan is the surface");
  sub->group("Commands");
  add_scan_input(*sub, o->input);
  add_tip_input(*sub, o->tip);
  sub->add_option("--noise", o->noise, "Standard deviation of the scan's noise (from neighbouring pixels)")
      ->type_name("LENGTH");
  sub->add_option("--sigmas", o->sigmas, "The noise is within so many standard deviations (3)")->type_name("N");
  sub->add_option("--neighbourhood", o->neighbourhood,
                  "How many pixels contacts may lie apart (as flat as the apex is within the noise)")
      ->type_name("PIXELS");
  sub->add_option("--distance", o->distance, "That the tip keeps from the surface, of non-contact scans (0nm)")
      ->type_name("LENGTH");
  sub->add_option("-o,--output", o->output, "The map: .png, .tif, .exr or .vti")->type_name("FILE");
  sub->add_option("--surface", o->surface, "Also the eroded scan: .gsf, .tif, .txt or .vti")->type_name("FILE");
  add_threads_option(*sub, o->threads);
  add_quiet_flag(*sub, o->quiet);
  sub->footer(examples);
  sub->callback([o, &action] { action = [o] { return work(*o); }; });
}

}  // namespace surf::cli
