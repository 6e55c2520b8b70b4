// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "exit_codes.h"
#include "library.h"
#include "surf/core/error.h"
#include "surf/workflow/libraries.h"
#include "surf/workflow/library_plot.h"
#include "surf/workflow/step_record.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* library_plot_examples =
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

struct PlotFiles {
  std::string output;
  std::vector<std::string> measured;
};

void describe(ParameterVisitor& visit, PlotFiles& files) {
  visit(files.measured, {.name = "library.measured",
                         .help = "Measured yields to show",
                         .form = "FILE",
                         .file = FileRole::read});
  visit(files.output, {.name = "output",
                       .help = "Chart to write: .svg .png",
                       .form = "FILE",
                       .file = FileRole::written});
}

int plot(const LibraryOptions& options) {
  PlotFiles files;
  workflow::LibraryPlotOptions o;
  options.bound.apply(files), options.bound.apply(o);
  if (files.output.empty())
    throw UsageError("`output`", "no output file is given", "Add `output=ranges.svg`");
  const LibraryRequest request = read_library_options(options);
  const workflow::LibraryParameters& parameters = request.parameters;
  for (std::size_t i = 0; i < request.libraries.size(); i += parameters.energies_ev.size())
    o.materials.push_back(request.libraries[i].material);
  o.energies_ev = parameters.energies_ev;
  o.physics = parameters.simulation.physics;
  o.seed = parameters.simulation.seed;
  o.cascades = request.cascades;
  o.threads = parameters.threads;
  for (const std::string& file : files.measured) {
    const auto yields = workflow::read_measured_yields(file);
    o.measured.insert(o.measured.end(), yields.begin(), yields.end());
  }
  io::check_plot_target(files.output);

  io::Plot plot;
  workflow::CachedLibraries libraries(parameters.cache);
  {
    InterruptGuard interrupts;
    ProgressBar bar(!options.quiet);
    const double cascades =
        static_cast<double>(o.cascades * o.materials.size() * o.energies_ev.size());
    o.watch = {[&](double done, double total) { bar.show(done * cascades, total * cascades); },
               interrupts.token()};
    plot = workflow::plot_libraries(o, libraries);
  }
  for (const std::string& note : libraries.take_notes()) print_warning(note);
  LibraryMaterials materials;
  options.bound.apply(materials);
  plot.metadata =
      workflow::step_record("library plot", workflow::records_of(materials, parameters, o),
                            {files.measured.begin(), files.measured.end()});
  io::write_plot(files.output, plot);
  if (!options.quiet) print("written    {}\n", files.output);
  return 0;
}

}  // namespace

void add_library_plot(CLI::App& library, Action& action) {
  const auto options = std::make_shared<LibraryOptions>();
  CLI::App* sub = library.add_subcommand("plot", "A chart of ranges and yields");
  add_library_options(*sub, *options);
  options->bound.looks["output"] = {.name = "-o,--output"};
  options->bound.add<workflow::LibraryPlotOptions>(*sub, "Options");
  options->bound.add<PlotFiles>(*sub, "Options");
  sub->group("Commands");
  sub->footer(library_plot_examples);
  sub->callback([options, &action] { action = [options] { return plot(*options); }; });
}

}  // namespace surf::cli
