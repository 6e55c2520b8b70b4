// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "markdown.h"
#include "pages.h"
#include "surf/core/parameters.h"
#include "surf/io/sim/scene_keys.h"
#include "surf/mc/request/simulation_request.h"

namespace surf::cli::reference {
namespace {

constexpr const char* example = R"(title = "a line of photoresist on silicon"

[beam]
energy = "800eV"
tilt = "10deg"

[scan]
size = "160x160"
pixel_size = "2nm"

[simulation]
electrons = 50
detectors = ["in-lens", "side:axis=60deg/90deg"]

[height_field]
shape = "line"
material = "resist"
height = "60nm"
top_width = "40nm"
wall_run = "5nm"

[[material]]
name = "resist"
formula = "C5H8O2"
density_g_cm3 = 1.19
band_gap_ev = 5.6
)";

const char* unit_word(Unit unit) {
  switch (unit) {
    case Unit::none:
      return "";
    case Unit::share:
      return "share or %";
    case Unit::nm:
      return "nm";
    case Unit::ev:
      return "eV";
    case Unit::deg:
      return "deg";
    case Unit::pa:
      return "pA";
    case Unit::us:
      return "us";
    case Unit::s:
      return "s";
  }
  return "";
}

std::string usual(const Parameter& about, const Field& field) {
  if (!about.otherwise.empty()) return about.otherwise;
  if (field.kind() == FieldKind::flag) return field.text() == "on" ? "true" : "false";
  if (!field.given()) return "none";
  return field.kind() == FieldKind::number ? format_value(std::stod(field.text()), about.unit)
                                           : field.text();
}

/// The parameters of a request by their tables.
std::string described(const std::string& heading) {
  std::vector<std::vector<std::string>> rows;
  mc::SimulationRequest request;
  for_each_parameter(request, [&](const Parameter& about, Field& field) {
    if (!about.name.starts_with(heading + ".")) return;
    rows.push_back({code(std::string(about.last_name())), code(form_of(about, field)),
                    unit_word(about.unit),
                    cell(field.kind() == FieldKind::choice ? "" : format_limits(about)),
                    cell(usual(about, field)), cell(about.help)});
  });
  return table({"Key", "Form", "Unit of bare numbers", "Range", "Where it is missing", "Meaning"},
               rows);
}

std::string keys_table(const std::vector<io::SceneKey>& keys) {
  std::vector<std::vector<std::string>> rows;
  for (const io::SceneKey& key : keys)
    rows.push_back({code(key.name), code(key.form),
                    key.otherwise == "required" ? "**required**" : cell(key.otherwise),
                    cell(key.help)});
  return table({"Key", "Form", "Where it is missing", "Meaning"}, rows);
}

std::string title_of(const io::SceneTable& t) {
  const bool many = t.heading == "body" || t.heading == "material";
  if (t.heading == "elements") return "elements of [[material]]";
  const std::string brackets =
      many ? fmt::format("[[{}]]", t.heading) : fmt::format("[{}]", t.heading);
  if (t.shape.empty()) return brackets;
  return brackets + (t.shape == "file" ? " from a file" : fmt::format(", {}", t.shape));
}

}  // namespace

std::string scene_files_page() {
  std::string text = page_head("Scene files",
                               "A scene file says in [TOML](https://toml.io) what is imaged and "
                               "how: `semsurf simulate scene.toml -o "
                               "image.exr`.\n"
                               "Options of the command line go before what the file says. Names of "
                               "files are relative to the scene file.\n"
                               "Lengths, energies, angles, currents and times are bare numbers "
                               "(nm, eV, degrees, pA, us) or texts with a unit\n"
                               "(`\"1um\"`, `\"5keV\"`, `\"5mrad\"`); points are texts with commas "
                               "or arrays. Unknown keys are errors.");
  text += fmt::format("```toml\n{}```\n\n`samples/` holds more of them.\n\n", example);
  text += "## Top of the file\n\n" + keys_table(io::top_scene_keys());
  text += "\n## [beam]\n\n```toml\n[beam]\nenergy = \"1keV\"\ntilt = \"40deg\"\n```\n\n" +
          described("beam");
  text += "\nA dose is `current` and `dwell` together.\n";
  text +=
      "\n## [scan]\n\nAny two of the three keys say which points the beam visits; with one of them "
      "the specimen's "
      "extent says the rest.\n\n"
      "```toml\n[scan]\nsize = \"256x192\"\npixel_size = \"2nm\"\n```\n\n" +
      described("scan");
  text +=
      "\n## [simulation]\n\nOne of `electrons`, `accuracy`, `time` and a dose says how much is "
      "simulated.\n\n"
      "```toml\n[simulation]\naccuracy = \"5%\"\nseed = 7\n```\n\n" +
      described("simulation");
  for (const io::SceneTable& t : io::scene_tables())
    text += fmt::format("\n## {}\n\n{}\n\n```toml\n{}```\n\n{}", title_of(t), t.help, t.example,
                        keys_table(t.keys));
  text +=
      "\nA file of `[[material]]` tables alone is what `--materials` takes. "
      "[Materials](../explanation/materials.md) tells how missing numbers are estimated.\n";
  return text;
}

}  // namespace surf::cli::reference
