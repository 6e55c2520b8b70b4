// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>

#include "arrays.h"
#include "data.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/image_file.h"
#include "surf/io/scan_parameters.h"
#include "surf/io/tip_file.h"

namespace surf::python {
namespace {

template <class T>
std::shared_ptr<T> held(py::handle value) {
  return py::isinstance<T>(value) ? value.cast<std::shared_ptr<T>>() : nullptr;
}

Grid<float> mask_values(py::handle value, const std::string& argument,
                        std::vector<std::filesystem::path>& inputs) {
  if (!is_path(value) && !held<Picture>(value)) return grid_of<float>(value, argument);
  const Picture picture = picture_of(value, argument);
  if (!picture.file.empty()) inputs.push_back(picture.file);
  return picture.image.channels.front().values;
}

}  // namespace

py::object findings(const py::dict& values) {
  return py::module_::import("semsurf._results").attr("Findings")(values);
}

py::object measured(double value, double standard_error) {
  py::dict d;
  d["value"] = value;
  d["stderr"] = standard_error;
  return findings(d);
}

py::list list_of(const std::vector<std::string>& texts) {
  py::list all;
  for (const std::string& text : texts) all.append(text);
  return all;
}

py::list list_of(const std::vector<std::filesystem::path>& files) {
  py::list all;
  for (const auto& file : files) all.append(file.string());
  return all;
}

bool is_path(py::handle value) {
  return PyUnicode_Check(value.ptr()) || py::hasattr(value, "__fspath__");
}

std::string path_of(py::handle value) {
  if (PyUnicode_Check(value.ptr())) return value.cast<std::string>();
  if (py::hasattr(value, "__fspath__")) return py::str(value.attr("__fspath__")());
  throw UsageError("path", "it is no name of a file", "Give a text or a pathlib.Path");
}

Pitch pitch_of(py::handle value) {
  Keyword keyword;
  keyword.parameter = "pitch";
  keyword.form = "WxH";
  const std::vector<std::string> texts = texts_of(value, keyword);
  if (texts.empty()) return {};
  const auto [x, y] = parse_two_lengths_nm(texts.front(), "`pitch`");
  return {x, y};
}

py::dict record_of(const Metadata& metadata) {
  py::dict record;
  for (const auto& [key, value] : metadata) record[py::str(key)] = value;
  return record;
}

Metadata metadata_of(py::handle record) {
  Metadata metadata;
  if (record.is_none()) return metadata;
  for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(record))
    metadata[py::str(key)] = py::str(value);
  return metadata;
}

Heights heights_of(py::handle value, const io::HeightReadOptions& reading,
                   const std::string& argument) {
  if (const auto there = held<Heights>(value)) return *there;
  Heights heights;
  heights.reading = reading;
  if (is_path(value)) {
    heights.file = path_of(value);
    io::HeightFieldFile file;
    {
      const py::gil_scoped_release unlocked;
      file = io::read_height_field(heights.file, reading);
    }
    heights.field = std::move(file.field);
    heights.record = std::move(file.metadata);
    Call::notes(file.notes, heights.file.string());
    return heights;
  }
  HeightField& f = heights.field;
  // What is masked in numpy's masked arrays is a hole.
  const py::object plain = py::hasattr(value, "mask") && py::hasattr(value, "filled")
                               ? value.attr("astype")("float64").attr("filled")(std::nan(""))
                               : py::reinterpret_borrow<py::object>(value);
  f.z_nm = grid_of<double>(plain, argument);
  f.pitch_x_nm = reading.pitch_x_nm.value_or(1);
  f.pitch_y_nm = reading.pitch_y_nm.value_or(f.pitch_x_nm);
  for (double& z : f.z_nm.data()) {
    z *= reading.z_unit_nm.value_or(1);
    if (std::isfinite(z)) continue;
    z = std::nan("");
    if (f.valid.empty()) f.valid = Mask(f.z_nm.width(), f.z_nm.height(), 1);
    f.valid.data()[static_cast<std::size_t>(&z - f.z_nm.data().data())] = 0;
  }
  validate(f, argument.c_str());
  return heights;
}

Heights heights_of(const Call& call, const std::string& argument) {
  return heights_of(call[argument], call.told<io::HeightReadOptions>(), argument);
}

Picture picture_of(py::handle value, const std::string& argument) {
  if (const auto there = held<Picture>(value)) return *there;
  Picture picture;
  if (is_path(value)) {
    picture.file = path_of(value);
    const py::gil_scoped_release unlocked;
    picture.image = io::read_image(picture.file);
    picture.record = picture.image.metadata;
    return picture;
  }
  picture.image.channels = {{"signal", "1", grid_of<float>(value, argument)}};
  return picture;
}

ChosenChannel channel_of(const py::object& value, const std::string& argument) {
  const bool is_pair = PyTuple_Check(value.ptr()) && py::len(value) == 2;
  const auto pair = is_pair ? value.cast<py::tuple>() : py::tuple();
  ChosenChannel chosen;
  chosen.picture = picture_of(is_pair ? py::object(pair[0]) : value, argument);
  const Image& image = chosen.picture.image;
  chosen.channel = is_pair ? std::string(py::str(pair[1])) : image.channels.front().name;
  if (!image.find(chosen.channel))
    throw UsageError(argument, fmt::format("the image has no channel '{}'", chosen.channel),
                     "Choose one of image.channels");
  return chosen;
}

TipShape tip_of(py::handle value, const std::string& argument) {
  if (const auto there = held<TipShape>(value)) return *there;
  TipShape tip;
  if (is_path(value)) {
    tip.file = path_of(value);
    const py::gil_scoped_release unlocked;
    tip.tip = io::read_tip(tip.file);
    return tip;
  }
  const Heights heights = heights_of(value, {}, argument);
  tip.tip = io::to_tip(heights.field, heights.record, argument);
  return tip;
}

Mesh mesh_of(py::handle value, const io::MeshUnit& unit, const std::string& argument) {
  if (const auto there = held<Mesh>(value)) return *there;
  Mesh mesh;
  if (!is_path(value))
    throw UsageError(argument, "it is no mesh",
                     "Give a semsurf.Mesh(vertices, triangles) or the name of a file");
  mesh.file = path_of(value);
  mesh.name = mesh.file.stem().string();
  const py::gil_scoped_release unlocked;
  mesh.mesh = io::read_mesh(mesh.file, unit);
  return mesh;
}

Mask masks_of(const Call& call, const HeightField& field,
              std::vector<std::filesystem::path>& inputs) {
  if (!call.has("use") && !call.has("exclude")) return {};
  const int width = field.z_nm.width(), height = field.z_nm.height();
  Mask mask(width, height, 1);
  for (const auto& [argument, keep] : {std::pair{"use", true}, std::pair{"exclude", false}}) {
    if (!call.has(argument)) continue;
    const Grid<float> values = mask_values(call[argument], argument, inputs);
    if (values.width() != width || values.height() != height)
      throw InvalidInput(argument,
                         fmt::format("it has {} x {} pixels, the scan {} x {}", values.width(),
                                     values.height(), width, height),
                         "Give a mask of the scan's size");
    for (std::size_t i = 0; i < mask.size(); ++i) mask.data()[i] &= (values.data()[i] != 0) == keep;
  }
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask.data()[i] && field.valid.includes(i)) return mask;
  throw InvalidInput(call.has("use") ? "use" : "exclude", "no sample of the scan remains to count",
                     "Check which of use and exclude is meant");
}

}  // namespace surf::python
