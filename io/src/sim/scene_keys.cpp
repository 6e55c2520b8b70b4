// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/sim/scene_keys.h"

#include <stdexcept>

namespace surf::io {
namespace {

using Keys = std::vector<SceneKey>;

Keys operator+(Keys a, const Keys& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

const char* const required = "required";

const SceneKey material{"material", "MATERIAL",
                        "Material of the solid: a built-in one, or a [[material]] of the "
                        "scene",
                        required};
const SceneKey edge{"edge", "mirror|flat|periodic",
                    "Continuation of the height field outside its samples", "mirror"};
const SceneKey wall_run{"wall_run", "LENGTH",
                        "Horizontal length of a wall; 0 is one sample distance", "0nm"};

Keys field(const char* shape) {
  return {{"shape", shape, "Kind of surface", required},
          material,
          edge,
          {"width", "LENGTH",
           "Extent along x, from the middle of the first sample to that of the last", "400nm"},
          {"depth", "LENGTH", "Extent along y", "as width"},
          {"pitch", "LENGTH", "Distance of neighbouring samples", "2nm"}};
}

Keys raised(const char* what, const char* top) {
  return {{"height", "LENGTH", what, required}, {"top_width", "LENGTH", top, required}, wall_run};
}

Keys sunk(const char* key, const char* what) {
  return {{key, "LENGTH", what, required},
          {"bottom_width", "LENGTH", "Width at the bottom", required},
          wall_run};
}

const Keys& placing() {
  static const Keys keys{
      {"scale", "NUMBER", "Factor of the body's size, about the origin", "1"},
      {"rotate_x", "ANGLE",
       "Turn about the x axis, counter-clockwise seen from its positive end; "
       "after scale",
       "0deg"},
      {"rotate_y", "ANGLE", "Turn about the y axis, after the one about x", "0deg"},
      {"rotate_z", "ANGLE", "Turn about the z axis, after the one about y", "0deg"},
      {"move", "X,Y,Z", "Shift of the body, after all turns", "0,0,0"}};
  return keys;
}

Keys body(const char* shape) {
  return {{"shape", shape, "Kind of body", required},
          material,
          {"name", "TEXT", "Name in records and messages", "the shape"}};
}

std::vector<SceneTable> make_tables() {
  return {
      {"substrate",
       "",
       "A half-space that fills everything below a height.",
       {material, {"z", "LENGTH", "Height of its top", "0nm"}},
       "[substrate]\nmaterial = \"Si\"\n"},
      {"height_field",
       "file",
       "A surface read from a scan or an image.",
       {{"file", "FILE", "An AFM scan, EXR, TIFF, PNG or VTI, relative to the scene file",
         required},
        material,
        edge,
        {"channel", "NAME", "Channel of heights in the file", "its first of heights"},
        {"pixel_size", "LENGTH", "Distance of neighbouring samples of files that do not say",
         "1nm"},
        {"z_unit", "LENGTH", "Height of one unit of files that do not say", "1nm"}},
       "[height_field]\nfile = \"scan.txt\"\nmaterial = \"Si\"\npixel_size = \"2nm\"\nedge = "
       "\"mirror\"\n"},
      {"height_field", "mesa", "A square, flat-topped hill on a plane.",
       field("mesa") + raised("Height above the plane", "Width of the flat top"),
       "[height_field]\nshape = \"mesa\"\nmaterial = \"Si\"\nheight = \"200nm\"\ntop_width = "
       "\"80nm\"\nwall_run = "
       "\"20nm\"\n"},
      {"height_field", "line", "A line along y on a plane.",
       field("line") + raised("Height above the plane", "Width of the flat top"),
       "[height_field]\nshape = \"line\"\nmaterial = \"Si\"\nheight = \"50nm\"\ntop_width = "
       "\"30nm\"\n"},
      {"height_field", "grating", "Equal lines along y, one of them in the middle.",
       field("grating") +
           Keys{{"period", "LENGTH",
                 "Distance of neighbouring lines, above their width at the "
                 "foot",
                 required}} +
           raised("Height of the lines", "Width of their flat tops"),
       "[height_field]\nshape = \"grating\"\nmaterial = \"Si\"\nheight = \"50nm\"\nperiod = "
       "\"100nm\"\ntop_width = "
       "\"30nm\"\n"},
      {"height_field", "step", "A step along y: low on the left, high on the right.",
       field("step") + Keys{{"height", "LENGTH", "Height of the step", required}, wall_run},
       "[height_field]\nshape = \"step\"\nmaterial = \"Si\"\nheight = \"20nm\"\n"},
      {"height_field", "trench", "A trench along y in a plane.",
       field("trench") + sunk("trench_depth", "Depth below the plane"),
       "[height_field]\nshape = \"trench\"\nmaterial = \"Si\"\ntrench_depth = "
       "\"100nm\"\nbottom_width = \"40nm\"\n"},
      {"height_field", "via", "A round hole in a plane.",
       field("via") + sunk("via_depth", "Depth below the plane"),
       "[height_field]\nshape = \"via\"\nmaterial = \"SiO2\"\nvia_depth = \"100nm\"\nbottom_width "
       "= \"60nm\"\n"},
      {"height_field", "rough", "A random rough surface that repeats without a seam.",
       field("rough") +
           Keys{{"rms", "LENGTH", "Root mean square of the heights", required},
                {"correlation", "LENGTH", "Correlation length", required},
                {"hurst", "NUMBER",
                 "Hurst exponent of a self-affine surface, above 0 to "
                 "1",
                 "a Gaussian correlation"},
                {"seed", "N", "Seed of the random numbers: the same seed gives the same surface",
                 "1"}},
       "[height_field]\nshape = \"rough\"\nmaterial = \"Si\"\nrms = \"10nm\"\ncorrelation = "
       "\"25nm\"\nedge = "
       "\"periodic\"\n"},
      {"body", "file", "One body or several from a mesh file.",
       Keys{{"mesh", "FILE",
             "STL, OBJ, PLY, OFF, glTF, 3MF, VTP or VTM, relative to the scene file", required},
            material,
            {"materials", "TABLE",
             "Materials of the file's parts by the names that the file gives "
             "them",
             "`material` for all"},
            {"name", "TEXT", "Name in records and messages", "the file's"},
            {"unit", "nm|um|mm|m|pm|A|in", "Length of one unit of the file",
             "as it says, else nm; glTF: m"},
            {"override_unit", "true|false", "Take `unit` even where the file says another",
             "false"}} +
           placing(),
       "[[body]]\nmesh = \"cube.off\"\nmaterial = \"Si\"\nunit = \"nm\"\nmove = \"0,0,50nm\"\n"},
      {"body", "box", "A box between two corners.",
       body("box") +
           Keys{{"lower", "X,Y,Z", "Lower corner", required},
                {"upper", "X,Y,Z", "Upper corner", required},
                {"subdivisions", "N", "Pieces that each edge is split into", "1"}} +
           placing(),
       "[[body]]\nshape = \"box\"\nmaterial = \"Si\"\nlower = \"-50,-50,0\"\nupper = "
       "\"50,50,100\"\n"},
      {"body", "sphere", "A sphere of flat triangles.",
       body("sphere") +
           Keys{{"radius", "LENGTH", "Radius", required},
                {"center", "X,Y,Z", "Centre", "0,0,0"},
                {"subdivisions", "N",
                 "Times that an icosahedron's triangles are split, 0 to "
                 "9",
                 "4"}} +
           placing(),
       "[[body]]\nshape = \"sphere\"\nmaterial = \"Au\"\nradius = \"40nm\"\ncenter = "
       "\"0,0,39.5\"\n"},
      {"body", "cone", "A cone on its base, whole or cut off at the top.",
       body("cone") +
           Keys{{"bottom_radius", "LENGTH", "Radius of the base", required},
                {"top_radius", "LENGTH", "Radius at the top; 0 is a tip", "0nm"},
                {"height", "LENGTH", "Height", required},
                {"base", "X,Y,Z", "Centre of the base", "0,0,0"},
                {"segments", "N", "Flat sides, 3 to 100000", "64"}} +
           placing(),
       "[[body]]\nshape = \"cone\"\nmaterial = \"Si\"\nbottom_radius = \"50nm\"\ntop_radius = "
       "\"20nm\"\nheight = "
       "\"80nm\"\n"},
      {"material",
       "",
       "A material of your own. It goes before a built-in one of the same name.",
       {{"name", "TEXT", "Name that solids call it by", required},
        {"density_g_cm3", "NUMBER", "Density in g/cm3", required},
        {"formula", "TEXT", "Chemical formula, as SiO2; either this or `elements`", "`elements`"},
        {"elements", "TABLES", "Elements of the material, each with the keys below", "`formula`"},
        {"band_gap_ev", "ENERGY", "Band gap; 0 for metals", "a metal"},
        {"work_function_ev", "ENERGY", "Work function", "estimated"},
        {"barrier_ev", "ENERGY", "Surface barrier: from the bottom of the band to the vacuum level",
         "estimated"},
        {"valence_electrons", "NUMBER", "Valence electrons of a formula unit", "estimated"},
        {"plasmon_ev", "ENERGY", "Energy of a plasmon", "estimated"},
        {"loss_join_ev", "ENERGY", "Energy below which the continuous loss falls as E^(5/2)",
         "estimated"},
        {"loss_join_fitted", "true|false",
         "State of loss_join_ev: fitted to measured yields, or not", "false"},
        {"dielectric", "TABLE", "Data for `inelastic=dielectric`", "estimated"},
        {"sources", "TEXT", "Sources of the numbers", "nothing"}},
       "[[material]]\nname = \"nitride\"\nformula = \"Si3N4\"\ndensity_g_cm3 = 3.17\nband_gap_ev = "
       "5.3\n"},
      {"dielectric",
       "",
       "What simulations with `inelastic=dielectric` need of the [[material]] before it.",
       {{"energy_loss_function", "FILE",
         "Im(-1/eps) for light: lines of energy in eV, value; relative to this file", "estimated"},
        {"energy_loss_density_g_cm3", "NUMBER", "Density of what that was measured on",
         "the material's"},
        {"filled_band_ev", "ENERGY", "Fermi energy of a metal, width of the valence band of others",
         "estimated"},
        {"gap_ev", "ENERGY", "Band gap; 0 for metals", "the material's"},
        {"vacuum_ev", "ENERGY",
         "From the highest filled state to the vacuum: work function, or gap and affinity",
         "the work function"},
        {"refractive_index", "NUMBER",
         "Refractive index of visible light, to judge an insulator's loss function by", "none"},
        {"lattice_nm", "NUMBER", "Lattice constant in nm", "estimated"},
        {"sound_m_s", "NUMBERS",
         "Speed of sound in m/s: all branches alike, or longitudinal and transverse", "5000"},
        {"deformation_ev", "NUMBERS", "Deformation potentials, as many as speeds",
         "by the resistivity, or estimated"},
        {"bend_m2_s", "NUMBERS", "alpha of w = c k - alpha k^2 in m2/s, as many as speeds",
         "estimated"},
        {"resistivity_ohm_m", "NUMBER", "Resistivity of a metal in ohm m", "none"},
        {"effective_mass", "NUMBER", "Mass of electrons in acoustic scattering, in electron masses",
         "1"},
        {"density_of_states_mass", "NUMBER",
         "Effective mass for the density of states, over that of the electron", "1"},
        {"optical_phonons", "TABLES",
         "{ energy_ev, high_permittivity, low_permittivity } of each optical mode",
         "estimated for compounds with a gap"},
        {"trap_per_nm", "NUMBER", "Polaron traps: 1/path at rest, per nm", "0"},
        {"trap_ev", "ENERGY", "Energy over which that falls by e", "none"},
        {"sources", "TEXT", "Sources of the numbers", "nothing"}},
       "[[material]]\nname = \"nitride\"\nformula = \"Si3N4\"\ndensity_g_cm3 = 3.17\nband_gap_ev = "
       "5.3\n\n"
       "[material.dielectric]\nfilled_band_ev = 8\noptical_phonons = [{ energy_ev = 0.11, "
       "high_permittivity = 4, "
       "low_permittivity = 7.5 }]\n"},
      {"optical_phonons",
       "",
       "An optical mode of a [material.dielectric].",
       {{"energy_ev", "ENERGY", "Energy of its quantum", required},
        {"high_permittivity", "NUMBER", "Permittivity above the mode", required},
        {"low_permittivity", "NUMBER", "Permittivity below it", required}},
       "[[material]]\nname = \"oxide\"\nformula = \"SiO2\"\ndensity_g_cm3 = 2.2\nband_gap_ev = "
       "9\n\n"
       "[material.dielectric]\nfilled_band_ev = 20\n\n"
       "[[material.dielectric.optical_phonons]]\nenergy_ev = 0.153\nhigh_permittivity = "
       "2.25\nlow_permittivity = 3.05\n"},
      {"elements",
       "",
       "An element of a [[material]].",
       {{"symbol", "TEXT", "Symbol, as \"Si\"; either this or `Z`", "`Z`"},
        {"Z", "N", "Atomic number, 1 to 92", "`symbol`"},
        {"A", "NUMBER", "Atomic weight", "the element's"},
        {"weight_fraction", "NUMBER", "Share of the weight", "1"},
        {"J_ev", "ENERGY", "Mean ionization energy", "the element's"}},
       "[[material]]\nname = \"alloy\"\ndensity_g_cm3 = 19.3\n"
       "elements = [{ symbol = \"Au\", weight_fraction = 0.9 }, { Z = 29, weight_fraction = 0.1 "
       "}]\n"},
  };
}

}  // namespace

const std::vector<SceneTable>& scene_tables() {
  static const std::vector<SceneTable> tables = make_tables();
  return tables;
}

std::vector<std::string> keys_of(std::string_view heading, std::string_view shape) {
  std::vector<std::string> names;
  for (const SceneTable& table : scene_tables())
    if (table.heading == heading && table.shape == shape)
      for (const SceneKey& key : table.keys) names.push_back(key.name);
  if (names.empty())
    throw std::invalid_argument("no table " + std::string(heading) + " " + std::string(shape));
  return names;
}

const std::vector<SceneKey>& top_scene_keys() {
  static const std::vector<SceneKey> keys{
      {"title", "TEXT", "Title of the scene; images record it", "nothing"},
      {"beam", "TABLE", "The electron beam", "defaults"},
      {"scan", "TABLE", "Field of view and pixels", "the specimen's extent, 256 pixels"},
      {"simulation", "TABLE", "Settings of the simulation", "defaults"},
      {"substrate", "TABLE", "A half-space below", "none"},
      {"height_field", "TABLE", "A surface of heights", "none"},
      {"body", "TABLES", "Closed bodies", "none"},
      {"material", "TABLES", "Materials of your own", "none"}};
  return keys;
}

}  // namespace surf::io
