// SPDX-License-Identifier: GPL-3.0-or-later
// One web page that shows surfaces and images.
#include <fmt/format.h>

#include <algorithm>

#include "data.h"
#include "surf/core/error.h"
#include "surf/io/scan_parameters.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/workflow/step_record.h"
#include "surf/workflow/view_page.h"

namespace surf::python {
namespace {

const std::vector<std::string> all_but_reading{
    "specimen.input",       "specimen.material", "specimen.materials", "specimen.substrate",
    "specimen.substrate_z", "specimen.edge",     "scan.height_channel"};

/// An object with the name it has on the page.
struct Shown {
  py::object what;
  std::string name;
};

std::vector<Shown> shown_of(const py::object& given) {
  std::vector<Shown> all;
  if (given.is_none()) return all;
  if (PyDict_Check(given.ptr())) {
    for (const auto& [name, what] : py::reinterpret_borrow<py::dict>(given))
      all.push_back({py::reinterpret_borrow<py::object>(what), py::str(name)});
  } else if (PyList_Check(given.ptr()) || PyTuple_Check(given.ptr())) {
    for (const py::handle one : given) all.push_back({py::reinterpret_borrow<py::object>(one), {}});
  } else {
    all.push_back({given, {}});
  }
  return all;
}

std::string named(const Shown& shown, const char* otherwise) {
  return shown.name.empty() ? otherwise : shown.name;
}

void add(const Shown& shown, const io::HeightReadOptions& reading, workflow::ViewPage& page) {
  const py::object& what = shown.what;
  if (py::isinstance<Mesh>(what)) {
    const Mesh mesh = mesh_of(what, {}, "items");
    page.add(mesh.mesh, named(shown, mesh.name.empty() ? "mesh" : mesh.name.c_str()), mesh.record);
  } else if (py::isinstance<Picture>(what)) {
    Picture picture = picture_of(what, "items");
    picture.image.metadata = picture.record;
    page.add(std::move(picture.image), named(shown, "image"));
  } else if (py::isinstance<TipShape>(what)) {
    HeightField field;
    const TipShape tip = tip_of(what, "items");
    field.z_nm = tip.tip.z_nm;
    field.pitch_x_nm = tip.tip.pitch_x_nm, field.pitch_y_nm = tip.tip.pitch_y_nm;
    field.valid = Mask(field.z_nm.width(), field.z_nm.height(), 1);
    for (std::size_t i = 0; i < field.z_nm.size(); ++i)
      if (!std::isfinite(field.z_nm.data()[i])) field.valid.data()[i] = 0;
    page.add(std::move(field), named(shown, "tip"), tip.record);
  } else {
    const Heights heights = heights_of(what, reading, "items");
    page.add(heights.field, named(shown, "heights"), heights.record);
  }
}

struct Inputs {
  std::vector<std::filesystem::path> files;

  workflow::FileChannel file(const py::object& named_file) {
    workflow::FileChannel input = workflow::parse_file_channel(path_of(named_file));
    files.push_back(input.file);
    return input;
  }
};

py::object view(const Call& call) {
  const std::filesystem::path output = path_of(call["output"]);
  io::check_web_page_target(output);
  const auto given = call.told<io::SpecimenRequest>();
  workflow::ViewReading reading;
  call.apply(static_cast<workflow::ViewParameters&>(reading));
  call.apply(reading.pitch);
  reading.unit = {given.mesh_unit_nm, given.override_unit};
  reading.heights = given.heights;
  const std::vector<Shown> items = shown_of(call["items"]);
  if (items.empty()) throw UsageError("items", "there is none", "Give scans, meshes or images");

  workflow::Reporter listener;
  listener.on_note = [](const std::string& text) { Call::note(text); };
  workflow::ViewPage page(reading, listener);
  Inputs inputs;
  for (const Shown& shown : items) {
    if (is_path(shown.what)) page.add(inputs.file(shown.what));
    else add(shown, reading.heights, page);
  }
  for (const Shown& scalar : shown_of(call["scalar"])) {
    if (is_path(scalar.what)) {
      page.add_scalar(inputs.file(scalar.what));
      continue;
    }
    const ChosenChannel map = channel_of(scalar.what, "scalar");
    page.add_scalar(map.picture.image, map.channel, named(scalar, "scalar"));
  }
  if (const py::object drape = call["drape"]; is_path(drape)) {
    page.drape(inputs.file(drape));
  } else if (!drape.is_none()) {
    const bool is_pair = PyTuple_Check(drape.ptr()) != 0;
    const py::object image = is_pair ? drape.cast<py::tuple>()[0].cast<py::object>() : drape;
    const auto item = std::ranges::find_if(
        items, [&](const Shown& shown) { return shown.what.is(image); });  // shown once
    ChosenChannel map = channel_of(drape, "drape");
    page.drape(std::move(map.picture.image), map.channel,
               item == items.end() ? "drape" : named(*item, "image"));
  }
  const std::string first = page.page().surfaces.empty() ? page.page().images.front().name
                                                         : page.page().surfaces.front().name;
  page.page().title = call.has("title") ? std::string(py::str(call["title"])) : first;
  page.page().metadata = workflow::step_record(
      "view",
      workflow::records_of(given, reading.pitch,
                           static_cast<const workflow::ViewParameters&>(reading)),
      inputs.files);
  io::WebPageSummary summary;
  call.work([&](const workflow::Reporter& reporter) {
    summary = io::write_web_page(output, page.page(), reporter.watch());
  });
  py::dict d;
  d["file"] = output.string();
  d["bytes"] = summary.bytes;
  d["surfaces"] = page.page().surfaces.size();
  d["images"] = page.page().images.size();
  return findings(d);
}

}  // namespace

void add_view(py::module_& module) {
  Function f{.name = "view", .summary = "One web page that shows surfaces and images to anybody."};
  f.details =
      "An HTML file that any browser shows, from disk and without a network: surfaces in 3D,\n"
      "colours, cross-sections, images beside and laid on. An image with a channel in nm is a\n"
      "surface.";
  f.arguments = {
      {"items", "PathLike | HeightField | Mesh | Image | Tip | ArrayLike | Sequence | dict",
       "What is shown: one, a list, or a dictionary with names for the page. Files as the "
       "program takes them, FILE or 'FILE:CHANNEL'.",
       true, false},
      {"output", "PathLike", "The page: .html", true, false},
      {"title", "str", "Title of the page; the first item's name."},
      {"drape", "PathLike | Image | tuple[Image, str]", "An image to lay on the surfaces."},
      {"scalar", "PathLike | Image | tuple[Image, str] | list | dict",
       "Maps to colour the surfaces by."}};
  f.takes<workflow::ViewParameters>().takes<workflow::GivenPitch>().takes<io::SpecimenRequest>(
      {}, all_but_reading);
  f.result_type = "Findings";
  f.result = "The `file`, its `bytes`, and how many surfaces and images it shows.";
  f.example = ">>> semsurf.view({'scan': scan, 'eroded': surface}, 'page.html')";
  define(module, f, view);
}

}  // namespace surf::python
