// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "exit_codes.h"
#include "library.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/workflow/libraries.h"
#include "surf/workflow/library_plot.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(What is missing is made, and kept in the cache. With several energies ranges and yields are
shown against the energy, else yields against the tilt. Error bars are one standard error.
There are 10240 cascades at least.
Measured yields come from tables (CSV) with the columns element, energy_keV, and delta (SE)
or eta (BSE).

Examples:
  semsurf library plot Si Au -o tilt.png
  semsurf library plot Si -o si.svg --energy 500eV,1keV,2keV,5keV,10keV \
      --measured data/reference/se_delta_joy2001.csv \
      --measured data/reference/bse_eta_joy2001.csv)";

struct PlotOptions {
  LibraryOptions library;
  std::string output;
  std::optional<std::string> tilt;
  std::vector<std::string> measured;
};

std::vector<double> parse_tilts_deg(const std::string& text) {
  std::vector<double> tilts;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    tilts.push_back(parse_angle_deg(text.substr(from, comma - from), "--tilt"));
    if (!(tilts.back() >= 0 && tilts.back() < 90))
      throw UsageError("--tilt", "it is outside 0 to below 90 degrees", "Write --tilt 0,30,60");
    from = comma + 1;
  }
  return tilts;
}

int plot(const PlotOptions& options) {
  if (options.output.empty())
    throw UsageError("--output", "no output file is given", "Add -o ranges.svg");
  const LibraryRequest request = read_library_options(options.library);
  workflow::LibraryPlotOptions o;
  for (std::size_t i = 0; i < request.libraries.size(); i += request.energies_ev.size())
    o.materials.push_back(request.libraries[i].material);
  o.energies_ev = request.energies_ev;
  if (options.tilt) o.tilts_deg = parse_tilts_deg(*options.tilt);
  o.physics = request.libraries.front().physics;
  o.seed = request.libraries.front().seed;
  o.cascades = request.cascades;
  o.threads = request.threads;
  for (const std::string& file : options.measured) {
    const auto yields = workflow::read_measured_yields(file);
    o.measured.insert(o.measured.end(), yields.begin(), yields.end());
  }
  io::check_plot_target(options.output);

  std::optional<io::Plot> plot;
  workflow::CachedLibraries libraries(request.cache);
  {
    InterruptGuard interrupts;
    ProgressBar bar(!options.library.quiet);
    const auto cascades = static_cast<double>(o.cascades);
    plot = workflow::plot_libraries(
        o, libraries,
        [&](double done, double total) { bar.show(done * cascades, total * cascades); },
        interrupts.token());
  }
  for (const std::string& note : libraries.take_notes()) print_warning(note);
  if (!plot) return exit_interrupted;
  io::write_plot(options.output, *plot);
  if (!options.library.quiet) print("written    {}\n", options.output);
  return 0;
}

}  // namespace

void add_library_plot(CLI::App& library, Action& action) {
  const auto options = std::make_shared<PlotOptions>();
  CLI::App* sub = library.add_subcommand("plot", "A chart of ranges and yields");
  add_library_options(*sub, options->library);
  sub->add_option("--tilt", options->tilt, "Angles that yields are shown for (0; with one energy\n"
                                           "0 to 75 degrees)")
      ->type_name("ANGLE,...");
  sub->add_option("--measured", options->measured, "Measured yields to show; may be repeated")
      ->type_name("FILE")->option_text("FILE")->allow_extra_args(false);
  sub->add_option("-o,--output", options->output, "Chart to write: .svg .png")
      ->type_name("FILE")->option_text("FILE");
  sub->group("Commands");
  sub->footer(examples);
  sub->callback([options, &action] { action = [options] { return plot(*options); }; });
}

}  // namespace surf::cli
