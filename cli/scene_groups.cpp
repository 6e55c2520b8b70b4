// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_groups.h"

#include "common_options.h"

namespace surf::cli {

void add_specimen_options(CLI::App& app, SceneOptions& o) {
  app.add_option("INPUT", o.inputs,
                 "Meshes (STL, OBJ, PLY, OFF, glTF, 3MF, VTP, VTM), a height field (an AFM\n"
                 "scan, EXR, TIFF, PNG, VTI) or one scene file (TOML)")
      ->type_name("FILE");
  const char* group = "Specimen";
  app.add_option("--material", o.material, "What meshes and height field are made of (Si)")
      ->type_name("MATERIAL")->group(group);
  add_materials_option(app, o.materials)->group(group);
  add_unit_options(app, o.unit, o.override_unit, group);
  app.add_option("--substrate", o.substrate, "Add a half-space below the bodies")
      ->type_name("MATERIAL")->group(group);
  app.add_option("--substrate-z", o.substrate_z, "Height of its top (0nm)")
      ->type_name("LENGTH")->group(group);
  app.add_option("--edge", o.edge, "How a height field goes on outside (mirror)")
      ->type_name("mirror|flat|periodic")->group(group);
  app.add_option("--pitch", o.pitch, "Sample distance of a height field (as its file says, or 1nm)")
      ->type_name("LENGTH")->group(group);
  app.add_option("--z-unit", o.z_unit, "Height of one grey level of a height field (1nm)")
      ->type_name("LENGTH")->group(group);
  app.add_option("--height-channel", o.height_channel,
                 "Channel of a height field, by name or number of 'semsurf info' (the first of heights)")
      ->type_name("NAME")->group(group);
}

void add_beam_options(CLI::App& app, SceneOptions& o) {
  const char* group = "Beam";
  app.add_option("--energy", o.energy, "100eV to 30keV (1keV)")->type_name("ENERGY")->group(group);
  app.add_option("--tilt", o.tilt, "Angle of the beam from straight down, below 90deg (0deg)")
      ->type_name("ANGLE")->group(group);
  app.add_option("--azimuth", o.azimuth, "Where the tilt turns to: 0 is +x, 90deg is +y (0deg)")
      ->type_name("ANGLE")->group(group);
  app.add_option("--spot", o.spot, "Standard deviation of the Gaussian spot (0nm)")
      ->type_name("LENGTH")->group(group);
  app.add_option("--convergence", o.convergence, "Half angle of the beam's cone, as 5mrad (0)")
      ->type_name("ANGLE")->group(group);
  app.add_option("--focus", o.focus, "How far above the scan plane the cone's tip is (0nm)")
      ->type_name("LENGTH")->group(group);
  app.add_option("--working-distance", o.working_distance,
                 "From the scan plane to the lens, for perspective (parallel beams)")
      ->type_name("LENGTH")->group(group);
}

void add_dose_options(CLI::App& app, SceneOptions& o) {
  const char* group = "Beam";
  app.add_option("--current", o.current,
                 "With --dwell instead of --electrons: the shot noise of a microscope,\n"
                 "in channels NAME.shot")
      ->type_name("CURRENT")->group(group);
  app.add_option("--dwell", o.dwell, "Time spent on a pixel, as 1us")
      ->type_name("TIME")->group(group);
}

void add_scan_options(CLI::App& app, SceneOptions& o) {
  const char* group = "Scan";
  app.add_option("--size", o.size, "Pixels, as 256x192")->type_name("WxH")->group(group);
  app.add_option("--pixel-size", o.pixel_size, "Width and height of a pixel, as 2nm")
      ->type_name("LENGTH")->group(group);
  app.add_option("--region", o.region, "Outer pixel edges, as -96,-96,96,96")
      ->type_name("X0,Y0,X1,Y1")->group(group);
}

void add_physics_options(CLI::App& app, SceneOptions& o) {
  const char* group = "Simulation";
  app.add_option("--physics", o.physics,
                 "elastic=mott|browning, loss=joy-luo|none, secondaries=on|off,\n"
                 "barrier=quantum|classical|off; any of them, first ones default")
      ->type_name("KEY=VALUE,...")->group(group);
  app.add_option("--cutoff", o.cutoff,
                 "Where tracking stops, 0.5eV to below the beam's energy (0: the surface barrier;\n"
                 "50eV without secondaries)")
      ->type_name("ENERGY")->group(group);
}

}  // namespace surf::cli
