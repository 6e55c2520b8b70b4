// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate_options.h"

#include "common_options.h"
#include "scene_groups.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(Units: bare lengths are nm, bare energies eV, bare angles degrees;
suffixes are allowed everywhere (pm A nm um mm m, eV keV MeV, deg rad mrad).

Any two of --size, --pixel-size and --region define the scan. With one the specimen's
extent gives the rest; with none it is 256 pixels across the longer side. Numbers given
here go before those of the scene file.

Channels of --channels: 'electrons' are the primaries that a pixel's value is the mean of.
'model' is how it got it: 1 direct, 2 replay, 3 difference (replay, as the difference to the
same cascades on a plane), 4 plane (proved to be flat as far as electrons reach: nothing is
left to simulate), 0 none. NAME.variance_left is the share of the scatter that is left by 3
and 4.

Examples:
  semsurf simulate cube.stl --substrate Si --tilt 40 -o cube.exr -o cube.png
  semsurf simulate grain.ply --unit um --material Au --energy 5keV --pixel-size 5nm -o grain.tif
  semsurf simulate samples/mesa80.toml --electrons 1000 --seed 2 -o mesa.vti
  semsurf simulate samples/mesa80.toml --accuracy 2% --channels model,electrons -o mesa.exr
  semsurf simulate samples/mesa80.toml --time 30s -o mesa.exr
  semsurf simulate cube.stl --materials mine.toml --material nitride -o nitride.exr
  semsurf simulate scan.gwy --height-channel ZSensor -o sem.exr
  semsurf simulate afm.tif --pitch 2nm --z-unit 0.1nm --edge mirror -o sem.exr
  semsurf simulate cube.stl --size 64x64 --region -96,-96,96,96 \
      --physics elastic=browning,secondaries=off -o bse.exr)";

constexpr const char* detectors = "Detectors, besides SE and BSE";

void add_detector_option(CLI::App& app, SimulateOptions& o) {
  app.add_option("--detector", o.scene.detectors,
                 "One of these, changed after a colon (side:axis=60deg/90deg), or one\n"
                 "of your own (loss:energy=900eV..,cone=30deg); may be repeated")
      ->type_name("SE1|SE2|quadrants|annular|in-lens|side")->allow_extra_args(false)->group(detectors);
}

void add_record_options(CLI::App& app, SimulateOptions& o) {
  const char* group = detectors;
  app.add_flag("--spectra", o.spectra, "Energies and angles per detector: NAME.spectra.csv")
      ->group(group);
  app.add_option("--deposit", o.deposit,
                 "Deposited energy on a grid of N cells along its longest side:\n"
                 "NAME.deposit.vti")
      ->type_name("N")->group(group);
  app.add_option("--trajectories", o.trajectories,
                 "Tracks of N primaries: NAME.tracks.vtp and a side view, NAME.tracks.png")
      ->type_name("N")->group(group);
  app.add_option("--trajectories-at", o.trajectories_at, "Where they land (the scan's middle)")
      ->type_name("X,Y")->group(group);
}

void add_simulation_options(CLI::App& app, SimulateOptions& o) {
  const char* group = "Simulation";
  app.add_option("--electrons", o.electrons, "Primaries per pixel (200)")
      ->type_name("N")->group(group);
  app.add_option("--accuracy", o.accuracy,
                 "Instead: as many as each pixel needs to bring the standard error of\n"
                 "all detectors down to this share of its mean, as 1% or 0.01")
      ->type_name("SHARE")->group(group);
  app.add_option("--accuracy-floor", o.accuracy_floor,
                 "No standard error below this is asked for, counts per primary (0.002)")
      ->type_name("NUMBER")->group(group);
  app.add_option("--time", o.time,
                 "Instead: the accuracy that fits in this time, as 30s; says which, and\n"
                 "--accuracy with that gives the same bytes")
      ->type_name("TIME")->group(group);
  app.add_option("--mesh-tolerance", o.mesh_tolerance,
                 "Leave out detail of meshes and height fields, moving no surface by more\n"
                 "than this; says what is gained (0nm: all detail is simulated)")
      ->type_name("LENGTH")->group(group);
  app.add_option("--method", o.method,
                 "Follow each electron (direct), or retrace stored cascades (replay); both\n"
                 "have the same statistics (auto: whichever is less work)")
      ->type_name("auto|direct|replay")->group(group);
  app.add_option("--cache", o.cache,
                 "Where libraries of cascades are kept for other runs, or off\n"
                 "($SEMSURF_CACHE, ~/.cache/semsurf)")
      ->type_name("FOLDER|off")->group(group);
  add_physics_options(app, o.scene);
  app.add_option("--seed", o.seed, "The same seed gives the same bytes (1)")
      ->type_name("N")->group(group);
  add_threads_option(app, o.threads)->group(group);
}

void add_long_job_options(CLI::App& app, SimulateOptions& o) {
  const char* group = "Long jobs: the same command goes on from where it was stopped";
  app.add_option("--checkpoint", o.checkpoint,
                 "Where unfinished work is kept (NAME.XXXXXXXX.checkpoint beside the\n"
                 "first output, X standing for the job), or off")
      ->type_name("FILE")->group(group);
  app.add_option("--checkpoint-every", o.checkpoint_every,
                 "Time between writes (30s); the first is after 10s or less")
      ->type_name("TIME")->group(group);
  app.add_flag("--restart", o.restart, "Begin anew, whatever was done before")->group(group);
  app.add_flag("--dry-run", o.dry_run,
               "Simulate a part for ten seconds, and tell what the whole will take: rays,\n"
               "time, memory and disk. Writes nothing but libraries")
      ->group(group);
}

void add_channel_options(CLI::App& app, SimulateOptions& o) {
  const char* group = "Output";
  app.add_option("--channel", o.channel, "What PNG files show (SE)")
      ->type_name("SE|SE.stderr|BSE|...|valid")->group(group);
  app.add_option("--channels", o.channels, "Also what the beam sees: z_nm, normal, material; and how it was simulated:\n"
                 "electrons, model, variance_left (see below)")
      ->type_name("NAME,...")->group(group);
}

void add_output_options(CLI::App& app, SimulateOptions& o) {
  const char* group = "Output";
  app.add_option("-o,--output", o.outputs, "Image to write: .exr .tif .png .vti; may be repeated")
      ->type_name("FILE")->option_text("FILE")->allow_extra_args(false)->group(group);
  add_channel_options(app, o);
  app.add_option("--layout", o.layout,
                 "EXR and TIFF in rows, or in tiles with smaller sizes for viewing (auto:\n"
                 "tiles above 64 million pixels)")
      ->type_name("auto|rows|tiles")->check(CLI::IsMember({"auto", "rows", "tiles"}))->group(group);
  add_quiet_flag(app, o.quiet)->group(group);
}

}  // namespace

void add_simulate_settings(CLI::App& app, SimulateOptions& options) {
  add_specimen_options(app, options.scene);
  add_beam_options(app, options.scene);
  add_dose_options(app, options.scene);
  add_scan_options(app, options.scene);
  add_simulation_options(app, options);
  add_detector_option(app, options);
  add_channel_options(app, options);
  add_quiet_flag(app, options.quiet)->group("Output");
}

void add_simulate_options(CLI::App& app, SimulateOptions& options) {
  add_specimen_options(app, options.scene);
  add_beam_options(app, options.scene);
  add_dose_options(app, options.scene);
  add_scan_options(app, options.scene);
  add_simulation_options(app, options);
  add_detector_option(app, options);
  add_record_options(app, options);
  add_long_job_options(app, options);
  add_output_options(app, options);
  app.footer(examples);
}

}  // namespace surf::cli
