// SPDX-License-Identifier: GPL-3.0-or-later
// Readers and writers.
#include <fmt/format.h>

#include "data.h"
#include "surf/core/error.h"
#include "surf/io/image_file.h"
#include "surf/io/scan_parameters.h"
#include "surf/io/sem_file.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/io/tip_file.h"
#include "surf/workflow/describe_file.h"

namespace surf::python {
namespace {

const Argument file_to_read{"path", "PathLike", "The file to read.", true, false};

Argument file_to_write(const char* formats) {
  return {"path", "PathLike", fmt::format("The file to write: {}.", formats), true, false};
}

const Argument record{"record", "Mapping[str, str]",
                      "How it was made, for the file; the object's own record if it is not given."};

Metadata record_for(const Call& call, const Made& made) {
  return call.has("record") ? metadata_of(call["record"]) : made.record;
}

py::object read_heights(const Call& call) {
  const auto reading = call.told<io::HeightReadOptions>();
  Heights heights;
  heights.file = path_of(call["path"]);
  heights.reading = reading;
  io::HeightFieldFile file;
  {
    const py::gil_scoped_release unlocked;
    file = io::read_height_field(heights.file, reading);
  }
  heights.field = std::move(file.field);
  Call::notes(file.notes, heights.file.string());
  // Files of semsurf say how they were made; what others note is no record that can be written.
  if (file.metadata.contains("semsurf.version")) heights.record = file.metadata;
  py::dict found;
  found["format"] = file.format;
  found["channel"] = file.channel;
  found["metadata"] = record_of(file.metadata);
  heights.found = findings(found);
  return object_of(std::move(heights));
}

py::object write_heights(const Call& call) {
  const Heights heights = heights_of(call, "heights");
  const std::string path = path_of(call["path"]);
  const Metadata made = record_for(call, heights);
  const py::gil_scoped_release unlocked;
  io::write_height_field(path, heights.field, made);
  return py::none();
}

py::object read_tip(const Call& call) { return object_of(tip_of(call["path"], "path")); }

py::object write_tip(const Call& call) {
  const TipShape tip = tip_of(call["tip"], "tip");
  const std::string path = path_of(call["path"]);
  const Metadata made = record_for(call, tip);
  const py::gil_scoped_release unlocked;
  io::write_tip(path, tip.tip, made);
  return py::none();
}

py::object read_image(const Call& call) { return object_of(picture_of(call["path"], "path")); }

py::object write_image(const Call& call) {
  Picture picture = picture_of(call["image"], "image");
  if (call.has("record")) picture.image.metadata = metadata_of(call["record"]);
  else picture.image.metadata = picture.record;
  const std::string path = path_of(call["path"]);
  io::ImageWriteOptions options;
  if (call.has("channel")) options.channel = py::str(call["channel"]);
  const py::gil_scoped_release unlocked;
  io::write_image(path, picture.image, options);
  return py::none();
}

py::object read_sem_image(const Call& call) {
  const auto reading = call.told<io::SemReadOptions>();
  Picture picture;
  picture.file = path_of(call["path"]);
  io::SemFile file;
  {
    const py::gil_scoped_release unlocked;
    file = io::read_sem_image(picture.file, reading);
  }
  Call::notes(file.notes, picture.file.string());
  const Grid<double>& values = file.image.values;
  Grid<float> signal(values.width(), values.height()), valid(values.width(), values.height(), 1);
  std::copy(values.data().begin(), values.data().end(), signal.data().begin());
  for (std::size_t i = 0; i < valid.size(); ++i)
    if (!file.image.valid.includes(i)) valid.data()[i] = 0;
  picture.image.placement() = file.image.placement();
  picture.image.channels = {{"signal", "1", std::move(signal)}, {"valid", "1", std::move(valid)}};
  py::dict found;
  found["format"] = file.format;
  found["pixel_from"] = file.pixel_from;
  found["detector"] = file.detector;
  found["instrument"] = file.instrument;
  found["databar_rows"] = file.databar_rows;
  if (file.energy_ev) found["energy_ev"] = *file.energy_ev;
  if (file.tilt_deg) found["tilt_deg"] = *file.tilt_deg;
  if (file.working_distance_nm) found["working_distance_nm"] = *file.working_distance_nm;
  found["metadata"] = record_of(file.metadata);
  picture.found = findings(found);
  return object_of(std::move(picture));
}

py::object read_mesh(const Call& call) {
  const auto request = call.told<io::SpecimenRequest>();
  return object_of(mesh_of(call["path"], {request.mesh_unit_nm, request.override_unit}, "path"));
}

py::object info(const Call& call) {
  const auto request = call.told<io::SpecimenRequest>();
  const auto materials = call.told<io::MaterialChoice>();
  const std::string path = path_of(call["path"]);
  std::string text;
  {
    const py::gil_scoped_release unlocked;
    text = workflow::describe_file(path, {request.mesh_unit_nm, request.override_unit},
                                   {materials.files.begin(), materials.files.end()});
  }
  const py::object findings = py::module_::import("semsurf._results").attr("Findings");
  return py::module_::import("json").attr("loads")(text, py::arg("object_hook") = findings);
}

Function reader(const char* name, const char* summary, const char* type, const char* result) {
  Function f{.name = name, .summary = summary, .arguments = {file_to_read}};
  f.result_type = type, f.result = result;
  f.is_long = false;
  return f;
}

Function writer(const char* name, const char* summary, const char* formats, Argument what) {
  what.required = true, what.by_name = false;
  Function f{.name = name, .summary = summary, .arguments = {file_to_write(formats), what}};
  f.result_type = "None", f.result = "Nothing.";
  f.is_long = false;
  return f;
}

}  // namespace

void add_files(py::module_& module) {
  define(module,
         reader("read_heights", "Read an AFM scan of any format, or an image of heights.",
                "HeightField",
                "The heights; `found` has the format, the channel and what the file says.")
             .takes<io::HeightReadOptions>(),
         read_heights);
  Function to_heights = writer("write_heights", "Write heights to a file.", ".gsf .tif .txt .vti",
                               {"heights", "HeightField | ArrayLike", "The heights."});
  to_heights.arguments.push_back(record);
  define(module, to_heights.takes<io::HeightReadOptions>({}, {"scan.height_channel"}),
         write_heights);

  define(module,
         reader("read_tip", "Read a tip: a file of semsurf, or any file of heights.", "Tip",
                "The tip."),
         read_tip);
  Function to_tip = writer("write_tip", "Write a tip to a file.", ".gsf .tif .txt .vti",
                           {"tip", "Tip", "The tip."});
  to_tip.arguments.push_back(record);
  define(module, to_tip, write_tip);

  define(module,
         reader("read_image", "Read an image with all its channels: EXR, TIFF, PNG, VTI.", "Image",
                "The image."),
         read_image);
  Function to_image =
      writer("write_image", "Write an image to a file.", ".exr .tif .png .vti .hspy",
             {"image", "Image | ArrayLike", "The image."});
  to_image.arguments.push_back(
      {"channel", "str", "The channel that a PNG shows; the first if it is not given."});
  to_image.arguments.push_back(record);
  define(module, to_image, write_image);

  define(module,
         reader("read_sem_image",
                "Read a microscope's image, with its pixel size, without its strip of text.",
                "Image", "The image, with the channels 'signal' and 'valid'.")
             .takes<io::SemReadOptions>(),
         read_sem_image);

  define(module,
         reader("read_mesh", "Read a mesh: STL, OBJ, PLY, OFF, glTF, 3MF, VTP, VTM.", "Mesh",
                "The bodies of the file, joined.")
             .takes<io::SpecimenRequest>({}, all_but_units),
         read_mesh);
  define(module,
         reader("info", "What is in a mesh, an image, a scan, a model or a scene file.", "Findings",
                "Numbers with their units in their names: `kind`, sizes, channels, bounds, and "
                "what the file says of itself, `metadata`. `semsurf info --json` prints the same.")
             .takes<io::SpecimenRequest>({}, all_but_units)
             .takes<io::MaterialChoice>(),
         info);
}

}  // namespace surf::python
