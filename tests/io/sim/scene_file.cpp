// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/sim/scene_file.h"

#include <numbers>

#include "../io_test.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/mesh/shapes.h"

namespace surf::io {
namespace {

using test::complaint;
using test::write;
using testing::HasSubstr;

class SceneFileTest : public testing::Test {
 protected:
  SceneFile read(const std::string& text) { return read_scene(write(path_, text)); }

  template <class E>
  std::string refused(const std::string& text) {
    return complaint<E>([&] { read(text); });
  }

  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "scene.toml";
};

const char* const substrate = "[substrate]\nmaterial = \"Si\"\n";

TEST_F(SceneFileTest, ReadsEverything) {
  write(folder_.path() / "tetra.off",
        "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n");
  const SceneFile scene = read(R"(
    title = "all of it"
    [beam]
    energy = "2keV"
    tilt = "0.5rad"
    azimuth = 90
    spot = "1pm"
    convergence = "10mrad"
    focus = -5
    working_distance = "4mm"
    [scan]
    size = "64x32"
    pixel_size = "1nm x 0.5nm"
    region = "-32,-8nm,32,0.008um"
    [simulation]
    electrons = 1e6
    seed = 9223372036854775807
    physics = "elastic=browning,secondaries=off"
    cutoff = "5eV"
    detectors = ["quadrants", "loss:energy=900eV.."]
    [substrate]
    material = "Si"
    z = "-1nm"
    [height_field]
    material = "Si"
    edge = "periodic"
    shape = "mesa"
    width = 100
    depth = 60
    pitch = 2
    height = "10nm"
    top_width = 20
    wall_run = 4
    [[body]]
    material = "Si"
    mesh = "tetra.off"
    unit = "um"
    scale = 2
    rotate_z = "90deg"
    move = [1, "2nm", 0]
    [[body]]
    material = "Si"
    name = "ball"
    shape = "sphere"
    radius = 5
    center = [0, 0, 20]
    subdivisions = 1
    [[body]]
    material = "Si"
    shape = "box"
    lower = [0, 0, 0]
    upper = "1,2,3")");
  EXPECT_EQ(scene.title, "all of it");
  EXPECT_EQ(scene.beam.energy_ev, 2000);
  EXPECT_NEAR(scene.beam.tilt_deg, 90 / std::numbers::pi, 1e-12);
  EXPECT_EQ(scene.beam.azimuth_deg, 90);
  EXPECT_EQ(scene.beam.spot_nm, 0.001);
  EXPECT_NEAR(scene.beam.convergence_deg, 1.8 / std::numbers::pi, 1e-12);
  EXPECT_EQ(scene.beam.focus_nm, -5);
  EXPECT_EQ(scene.beam.working_distance_nm, 4e6);
  ASSERT_EQ(scene.detectors.size(), 5u);
  EXPECT_EQ(scene.detectors[4].min_energy_ev, 900);
  EXPECT_EQ(scene.scan.width, 64);
  EXPECT_EQ(scene.scan.height, 32);
  EXPECT_EQ(scene.scan.pixel_x_nm, 1);
  EXPECT_EQ(scene.scan.pixel_y_nm, 0.5);
  ASSERT_TRUE(scene.scan.region);
  EXPECT_EQ(scene.scan.region->x0_nm, -32);
  EXPECT_EQ(scene.scan.region->y1_nm, 8);
  EXPECT_EQ(mc::electrons_of(scene.budget), 1'000'000);
  EXPECT_EQ(scene.seed, 9223372036854775807u);
  EXPECT_EQ(scene.physics.elastic, mc::ElasticModel::browning);
  EXPECT_FALSE(scene.physics.secondaries);
  EXPECT_EQ(scene.physics.cutoff_ev, 5);

  const mc::Specimen& specimen = scene.specimen;
  ASSERT_EQ(specimen.materials.size(), 1u);
  EXPECT_EQ(specimen.materials[0].name, "Si");
  EXPECT_EQ(specimen.substrate->top_nm, -1);
  EXPECT_EQ(specimen.height_field->edge, Edge::periodic);
  EXPECT_EQ(specimen.height_field->field.z_nm, make_mesa({100, 60, 2}, 10, 20, 4).z_nm);
  ASSERT_EQ(specimen.bodies.size(), 3u);
  EXPECT_EQ(specimen.bodies[0].name, "tetra.off");
  EXPECT_EQ(specimen.bodies[0].mesh.triangles.size(), 4u);
  EXPECT_THAT(specimen.bodies[0].mesh.vertices_nm, testing::Contains(Vec3{1, 2002, 0}));
  EXPECT_THAT(specimen.bodies[0].mesh.vertices_nm, testing::Contains(Vec3{-1999, 2, 0}));
  EXPECT_EQ(specimen.bodies[1].name, "ball");
  EXPECT_EQ(specimen.bodies[1].mesh.triangles.size(), 80u);
  EXPECT_NEAR(bounds(specimen.bodies[1].mesh).center_nm().z, 20, 0.01);
  EXPECT_EQ(specimen.bodies[2].name, "box");
  EXPECT_EQ(bounds(specimen.bodies[2].mesh).size_nm(), (Vec3{1, 2, 3}));
  EXPECT_EQ(scene.inputs, (std::vector{path_, folder_.path() / "tetra.off"}));
}

TEST_F(SceneFileTest, TurnsBodiesAboutEachAxis) {
  const auto corner = [&](const char* turns) {
    return read(std::string("[[body]]\nmaterial = \"Si\"\nshape = \"box\"\nlower = [0, 0, 0]\n"
                            "upper = [1, 2, 3]\n") +
                turns)
        .specimen.bodies[0]
        .mesh;
  };
  const auto box = [&](const char* turns) { return bounds(corner(turns)); };
  // x to y to z to x, a quarter turn each.
  EXPECT_EQ(box("rotate_x = 90\n").upper_nm, (Vec3{1, 0, 2}));
  EXPECT_EQ(box("rotate_y = 90\n").upper_nm, (Vec3{3, 2, 0}));
  EXPECT_EQ(box("rotate_z = 90\n").upper_nm, (Vec3{0, 1, 3}));
  EXPECT_EQ(box("rotate_x = 90\nrotate_z = 90\n").upper_nm, (Vec3{3, 1, 2}));
}

TEST_F(SceneFileTest, DefaultsAreThoseOfTheLibraries) {
  const SceneFile scene = read(substrate);
  EXPECT_EQ(scene.beam.energy_ev, mc::Beam{}.energy_ev);
  EXPECT_FALSE(scene.scan.width || scene.scan.pixel_x_nm || scene.scan.region);
  EXPECT_EQ(mc::electrons_of(scene.budget), mc::ElectronsPerPixel{}.count);
  EXPECT_EQ(scene.seed, mc::SimulationRequest{}.seed);
  EXPECT_TRUE(scene.physics.secondaries);
  EXPECT_EQ(scene.specimen.substrate->top_nm, 0);
  EXPECT_EQ(scene.inputs.size(), 1u);
}

TEST_F(SceneFileTest, ReadsShapesOfFields) {
  const auto field = [&](const std::string& keys) {
    return read("[height_field]\nmaterial = \"Si\"\nwidth = 40\n" + keys)
        .specimen.height_field->field;
  };
  EXPECT_EQ(field("shape = \"trench\"\ntrench_depth = 5\nbottom_width = 10").z_nm,
            make_trench({40, 40, 2}, 5, 10, 0).z_nm);
  EXPECT_EQ(field("shape = \"rough\"\nrms = 1\ncorrelation = 6\nseed = 3").z_nm,
            make_rough({40, 40, 2}, 1, 6, 3).z_nm);
  EXPECT_EQ(field("shape = \"rough\"\nrms = 1\ncorrelation = 6\nhurst = 0.8\nseed = 3").z_nm,
            make_self_affine({40, 40, 2}, 1, 6, 0.8, 3).z_nm);
  EXPECT_EQ(field("shape = \"line\"\nheight = 5\ntop_width = 8\nwall_run = 4").z_nm,
            make_line({40, 40, 2}, 5, 8, 4).z_nm);
  EXPECT_EQ(field("shape = \"via\"\nvia_depth = 5\nbottom_width = 8\nwall_run = 4").z_nm,
            make_via({40, 40, 2}, 5, 8, 4).z_nm);
  EXPECT_EQ(field("shape = \"step\"\nheight = 5\nwall_run = 4").z_nm,
            make_step({40, 40, 2}, 5, 4).z_nm);
  EXPECT_EQ(field("shape = \"grating\"\nheight = 5\nperiod = 20\ntop_width = 6\nwall_run = 4").z_nm,
            make_grating({40, 40, 2}, 5, 20, 6, 4).z_nm);
}

TEST_F(SceneFileTest, ReadsCones) {
  const mc::Body body = read(
                            "[[body]]\nmaterial = \"Si\"\nshape = \"cone\"\nbase = [1, 2, 3]\n"
                            "bottom_radius = 5\ntop_radius = 2\nheight = 7\nsegments = 12")
                            .specimen.bodies.at(0);
  EXPECT_EQ(body.name, "cone");
  EXPECT_EQ(body.mesh.vertices_nm, make_cone({1, 2, 3}, 5, 2, 7, 12).vertices_nm);
}

TEST_F(SceneFileTest, ReadsFieldsFromImages) {
  write_image(folder_.path() / "f.exr", test::image_of_f());
  const auto read_field = [&](const std::string& keys) {
    return read("[height_field]\nmaterial = \"Si\"\nfile = \"f.exr\"\n" + keys)
        .specimen.height_field->field;
  };
  const HeightField plain = read_field("");
  EXPECT_EQ(plain.z_nm(2, 3), 1);  // the F's middle stroke
  EXPECT_EQ(plain.pitch_x_nm, 1.25);
  EXPECT_EQ(plain.origin_x_nm, -100.0 / 3);
  const HeightField other = read_field("channel = \"A_z\"\nz_unit = \"um\"\npixel_size = \"2nm\"");
  EXPECT_NEAR(other.z_nm(2, 3), -1999, 1e-3);
  EXPECT_EQ(other.pitch_y_nm, 2);
  EXPECT_EQ(other.origin_x_nm, -4);
  EXPECT_EQ(other.origin_y_nm, -6);
  EXPECT_EQ(read_field("z_unit = \"0.5nm\"").z_nm(2, 3), 0.5);
  EXPECT_EQ(read("[height_field]\nmaterial = \"Si\"\nfile = \"f.exr\"").inputs.size(), 2u);
}

TEST_F(SceneFileTest, HoldsItsOwnMaterialsAndFilesGoBeforeThem) {
  const std::string text =
      "[substrate]\nmaterial = \"nitride\"\n[[material]]\nname = \"nitride\"\n"
      "formula = \"Si3N4\"\ndensity_g_cm3 = 3.17\nband_gap_ev = 5.3\n";
  const SceneFile scene = read(text);
  ASSERT_EQ(scene.specimen.materials.size(), 1u);
  EXPECT_EQ(scene.specimen.materials[0].density_g_cm3, 3.17);
  EXPECT_EQ(scene.materials.find("nitride", "test").density_g_cm3, 3.17);
  EXPECT_TRUE(scene.notes.empty());

  const auto file = write(folder_.path() / "mine.toml",
                          "[[material]]\nname = \"nitride\"\nformula = \"Si3N4\"\n"
                          "density_g_cm3 = 2.5\nband_gap_ev = 5.3\n");
  const SceneFile other = read_scene(path_, {file});
  EXPECT_EQ(other.specimen.materials[0].density_g_cm3, 2.5);
  EXPECT_EQ(other.inputs, (std::vector{path_, file}));
  ASSERT_EQ(other.notes.size(), 1u);
  EXPECT_THAT(other.notes[0], testing::AllOf(HasSubstr("mine.toml"), HasSubstr("scene.toml")));
}

TEST_F(SceneFileTest, SaysHowMuchIsSimulatedAndHow) {
  const std::string scene = "[substrate]\nmaterial = \"Si\"\n[simulation]\n";
  SceneFile s = read(scene + "accuracy = \"1.3%\"\naccuracy_floor = 0\nmethod = \"replay\"");
  EXPECT_EQ(mc::accuracy_of(s.budget), 0.013);
  EXPECT_EQ(mc::floor_of(s.budget), 0);
  EXPECT_EQ(s.method, mc::Method::replay);
  s = read(scene + "accuracy = 0.02\nmethod = \"auto\"");
  EXPECT_EQ(mc::accuracy_of(s.budget), 0.02);
  EXPECT_EQ(mc::floor_of(s.budget), mc::Accuracy{}.floor);
  EXPECT_FALSE(s.method);
  EXPECT_EQ(s.mesh_tolerance_nm, 0);
  s = read("[substrate]\nmaterial = \"Si\"\n[beam]\ncurrent = \"0.1nA\"\ndwell = 2\n");
  const auto* const dose = std::get_if<mc::Dose>(&s.budget);
  ASSERT_TRUE(dose);
  EXPECT_EQ(dose->current_pa, 100);
  EXPECT_EQ(dose->dwell_us, 2);
  s = read(scene + "time = \"2min\"");
  EXPECT_EQ(std::get<mc::TimeLimit>(s.budget).seconds, 120);
  EXPECT_EQ(read(scene + "mesh_tolerance = \"0.5nm\"").mesh_tolerance_nm, 0.5);
}

TEST_F(SceneFileTest, SyntaxErrorsHaveLineAndColumn) {
  EXPECT_THAT(refused<FileError>("title = \"a\"\n[beam\n"),
              HasSubstr("scene.toml, line 2, column"));
}

TEST_F(SceneFileTest, UnknownKeysAreErrorsWithASuggestion) {
  EXPECT_THAT(
      refused<FileError>("[beam]\nenergie = 1000\n"),
      testing::AllOf(HasSubstr("line 2, column 1"), HasSubstr("'energie' is not known in beam"),
                     HasSubstr("Did you mean 'energy'?")));
  const std::string material = "[[material]]\nname = \"x\"\nformula = \"Si3N4\"\n";
  for (const auto& [key, meant] : {std::pair{"density", "density_g_cm3"},
                                   {"densty", "density_g_cm3"},
                                   {"band_gap", "band_gap_ev"},
                                   {"plasmon", "plasmon_ev"},
                                   {"nam", "name"}})
    EXPECT_THAT(refused<FileError>(material + key + " = 3\n"),
                HasSubstr(std::string("Did you mean '") + meant + "'?"));
  EXPECT_THAT(refused<FileError>("[Beam]\n"), HasSubstr("Did you mean 'beam'?"));
  EXPECT_THAT(refused<FileError>(std::string(substrate) +
                                 "[[body]]\nmaterial = \"Si\"\n"
                                 "shape = \"sphere\"\nradius = 1\ncentre = [0, 0, 0]\n"),
              testing::AllOf(HasSubstr("line 7"), HasSubstr("in body[1]"),
                             HasSubstr("Did you mean 'center'?")));
  EXPECT_THAT(refused<FileError>("[height_field]\nmaterial = \"Si\"\nshape = \"mesa\"\nheight = 1\n"
                                 "top_width = 2\nrms = 1\n"),
              HasSubstr("'rms' is not known in height_field"));
}

TEST_F(SceneFileTest, MissingPartsAreNamed) {
  EXPECT_THAT(refused<FileError>("title = \"nothing\""), HasSubstr("nothing to look at"));
  EXPECT_THAT(refused<FileError>("[substrate]\n"), HasSubstr("'material' is missing"));
  EXPECT_THAT(refused<FileError>("[[body]]\nmaterial = \"Si\"\n"),
              HasSubstr("either 'mesh' or 'shape'"));
  EXPECT_THAT(refused<FileError>("[[body]]\nmaterial = \"Si\"\nmesh = \"a\"\nshape = \"box\"\n"),
              HasSubstr("not both"));
  EXPECT_THAT(refused<FileError>("[height_field]\nmaterial = \"Si\"\nshape = \"mesa\"\n"),
              HasSubstr("'height' is missing"));
  EXPECT_THAT(refused<FileError>("[[body]]\nmaterial = \"Si\"\nmesh = \"none.stl\"\n"),
              HasSubstr("none.stl: there is no such file"));
  complaint<FileError>([&] { read_scene(folder_.path() / "none.toml"); });
}

TEST_F(SceneFileTest, WrongValuesAreNamedWithTheirPlace) {
  const auto expect = [&](const std::string& text, const char* place, const char* reason) {
    EXPECT_THAT(refused<UsageError>(text + "\n" + substrate),
                testing::AllOf(HasSubstr(place), HasSubstr(reason)));
  };
  expect("[beam]\nenergy = \"1 kV\"", "line 2, beam.energy", "kV");
  expect("[beam]\nenergy = true", "line 2, beam.energy", "neither");
  expect("[beam]\nenergy = 1e3\ntilt = 91", "line 3, beam.tilt: '91' is out of range",
         "below 90deg");
  expect("[beam]\nenergy = nan", "line 2, beam.energy", "neither");
  expect("[beam]\ntilt = 95", "line 2, beam.tilt", "95");
  expect("beam = 3", "line 1, beam", "not a table");
  expect("[scan]\nsize = \"256x256x256\"", "scan.size", "not a size");
  expect("[scan]\nsize = \"1um\"", "scan.size", "whole number");
  expect("[scan]\nsize = 2.5", "scan.size", "whole number");
  expect("[scan]\nsize = 0", "scan.size", "out of range");
  expect("[scan]\npixel_size = -1", "scan.pixel_size", "not above zero");
  expect("[scan]\nregion = [0, 0, 1]", "scan.region", "3 numbers");
  expect("[scan]\nregion = [0, 0, 0, 1]", "scan.region", "empty");
  expect("[simulation]\nelectrons = 0", "simulation.electrons", "0");
  expect("[simulation]\nmethod = \"fast\"", "simulation.method", "auto, direct or replay");
  expect("[simulation]\naccuracy = \"1%\"\nelectrons = 3", "simulation.electrons", "Leave out");
  expect("[simulation]\nmesh_tolerance = -1", "simulation.mesh_tolerance", "0nm or more");
  expect("[simulation]\naccuracy = 2", "simulation.accuracy", "100%");
  expect("[simulation]\naccuracy_floor = 0.1", "simulation.accuracy_floor", "no accuracy");
  expect("[simulation]\nelectrons = 2.5", "simulation.electrons", "whole");
  expect("[simulation]\ncutoff = \"-5eV\"", "simulation.cutoff", "-5 eV is outside 0.5 eV to");
  expect("[simulation]\ncutoff = \"40keV\"", "simulation.cutoff", "40000 eV is outside 0.5 eV to");
  expect("[simulation]\nseed = -1", "simulation.seed", "whole number");
  expect("[simulation]\nphysics = \"elastic=mot\"",
         "line 2, simulation.physics: 'mot' is no choice", "mott");
  const std::string field = "[height_field]\nmaterial = \"Si\"\n";
  expect(field + "shape = \"mesh\"", "height_field.shape", "Choose one of: mesa");
  expect(field + "shape = \"mesa\"\nedge = \"mirrored\"", "edge", "of: mirror");
  expect(field + "shape = \"mesa\"\nheight = -5\ntop_width = 1", "line 1, height_field", "-5");
  expect("[[body]]\nmaterial = \"Sj\"\nshape = \"box\"", "line 2, body[1].material", "of: Si");
  expect("[[body]]\nmaterial = \"Si\"\nshape = \"cube\"", "body[1].shape", "'cube'");
  expect("[[body]]\nmaterial = \"Si\"\nshape = \"box\"\nlower = [0, 0]\nupper = [1, 1, 1]",
         "body[1].lower", "not three");
  expect("[[body]]\nmaterial = \"Si\"\nshape = \"box\"\nlower = [0, 0, 0]\nupper = [1, 0, 1]",
         "body[1]", "box along y");
  const std::string sphere = "[[body]]\nmaterial = \"Si\"\nshape = \"sphere\"\n";
  expect(sphere + "radius = 1\nscale = 0", "body[1]", "scale");
  expect(sphere + "radius = 1\nsubdivisions = 1e10", "body[1]", "too large");
  expect("[[body]]\nmaterial = \"Si\"\nmesh = \"a.stl\"\nunit = \"km\"", "body[1].unit", "km");
  expect("[body]\nmaterial = \"Si\"", "body", "[[body]]");
}

TEST(SceneFileName, EndsInToml) {
  EXPECT_TRUE(is_scene_file("a.toml"));
  EXPECT_TRUE(is_scene_file("a.TOML"));
  EXPECT_FALSE(is_scene_file("toml"));
  EXPECT_FALSE(is_scene_file("a.stl"));
}

TEST_F(SceneFileTest, OverridesAUnitOnlyWhereItSaysSo) {
  const std::filesystem::path mesh = folder_.path() / "cube.stl";
  write_mesh(mesh, make_box({0, 0, 0}, {40, 40, 40}));
  const std::string body = "[[body]]\nmaterial = \"Si\"\nmesh = \"cube.stl\"\n";
  EXPECT_TRUE(read(body + "unit = \"nm\"\n").unit_overrides.empty());
  EXPECT_THAT(refused<UsageError>(body + "unit = \"um\"\n"),
              AllOf(HasSubstr("cube.stl"), HasSubstr("override_unit = true")));
  const SceneFile scene = read(body + "unit = \"um\"\noverride_unit = true\n");
  EXPECT_NEAR(mc::extent(scene.specimen).size_nm().x, 40e3, 0.1);
  ASSERT_EQ(scene.unit_overrides.size(), 1u);
  EXPECT_EQ(scene.unit_overrides[0], std::pair(std::string("cube.stl"), 1000.0));
  EXPECT_THAT(refused<UsageError>(body + "override_unit = true\n"), HasSubstr("there is no unit"));
}

TEST_F(SceneFileTest, TellsItsFilesUnread) {
  write(path_,
        "[height_field]\nfile = \"a.gsf\"\n[[body]]\nmesh = \"sub/b.off\"\n[[body]]\nmesh = "
        "\"c.gltf\"\n");
  write(folder_.path() / "c.gltf",
        R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":1,"uri":"d.bin"}]})");
  const auto here = folder_.path();
  EXPECT_THAT(scene_input_files(path_),
              testing::ElementsAre(path_, here / "a.gsf", here / "sub/b.off", here / "c.gltf",
                                   here / "d.bin"));
}

}  // namespace
}  // namespace surf::io
