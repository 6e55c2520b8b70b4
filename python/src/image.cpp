// SPDX-License-Identifier: GPL-3.0-or-later
// semsurf.Image.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "arrays.h"
#include "data.h"
#include "made.h"
#include "surf/core/error.h"

namespace surf::python {
namespace {

constexpr const char* of_images =
    R"(Named channels of one size: ``image['SE']`` is an array of float32 that shares the object's
memory. Row 0 is the lowest row: y runs up. ``image.stderr('SE')`` are the standard errors.

Image(channels, pitch=1, origin=(0, 0), units=None, record=None)

channels : dict of arrays
    By name, of one size.
pitch : float, str or pair of them
    Distance of neighbouring pixels, in nm or as '2nm'; a pair is (x, y).
origin : pair of float
    Place of the lowest left pixel, in nm.
units : dict
    Of channels, by name; '1' for plain numbers.
record : dict
    How the image was made; files store it.)";

const Channel& channel_of(const Picture& picture, const std::string& name) {
  if (const Channel* channel = picture.image.find(name)) return *channel;
  std::vector<std::string> names;
  for (const Channel& c : picture.image.channels) names.push_back(c.name);
  throw py::key_error(fmt::format("no channel '{}'; there are {}", name, fmt::join(names, ", ")));
}

Picture make_picture(const py::dict& channels, py::handle pitch, std::pair<double, double> origin,
                     const py::object& units, py::handle record) {
  Picture picture;
  Image& image = picture.image;
  for (const auto& [name, values] : channels) {
    const std::string text = py::str(name);
    std::string unit = "1";
    if (!units.is_none() && units.contains(name)) unit = py::str(units[name]);
    image.channels.push_back({text, unit, grid_of<float>(values, text)});
  }
  image.pitch() = pitch_of(pitch);
  image.origin_x_nm = origin.first, image.origin_y_nm = origin.second;
  picture.record = image.metadata = metadata_of(record);
  validate(image);
  return picture;
}

py::list names_of(const Picture& picture) {
  py::list names;
  for (const Channel& channel : picture.image.channels) names.append(channel.name);
  return names;
}

py::array values_of(const py::object& self, const std::string& name) {
  return view_of(channel_of(self.cast<Picture&>(), name).values, self);
}

}  // namespace

void add_image(py::module_& module) {
  py::class_<Picture, std::shared_ptr<Picture>> type(module, "Image", of_images);
  type.def(py::init(&make_picture), py::arg("channels"), py::arg("pitch") = 1,
           py::arg("origin") = std::pair(0.0, 0.0), py::arg("units") = py::none(),
           py::arg("record") = py::none());
  type.def("__getitem__", &values_of, py::arg("channel"),
           "Array of a channel, which shares the image's memory; row 0 is the lowest row.");
  type.def("__contains__",
           [](const Picture& p, const std::string& name) { return p.image.find(name) != nullptr; });
  type.def("__len__", [](const Picture& p) { return p.image.channels.size(); });
  type.def("__iter__", [](const Picture& p) { return py::iter(names_of(p)); });
  type.def("keys", &names_of, "Names of the channels, as `channels`.");
  type.def(
      "stderr",
      [](const py::object& self, const std::string& name) {
        return values_of(self, name + ".stderr");
      },
      py::arg("channel"), "Array of the standard errors of a channel.");
  type.def_property_readonly("channels", &names_of, "Names of the channels.");
  type.def_property_readonly(
      "units",
      [](const Picture& p) {
        py::dict units;
        for (const Channel& channel : p.image.channels) units[py::str(channel.name)] = channel.unit;
        return units;
      },
      "Units of the channels, by name.");
  type.def_property_readonly(
      "shape", [](const Picture& p) { return std::pair(p.image.height(), p.image.width()); },
      "Rows and columns.");
  type.def_property_readonly(
      "pitch", [](const Picture& p) { return std::pair(p.image.pitch_x_nm, p.image.pitch_y_nm); },
      "Distances along x and y in nm.");
  type.def_property_readonly(
      "origin",
      [](const Picture& p) { return std::pair(p.image.origin_x_nm, p.image.origin_y_nm); },
      "Place of the lowest left pixel in nm.");
  type.def_property_readonly(
      "extent",
      [](const Picture& p) {
        const Image& i = p.image;
        return py::make_tuple(i.x_nm(-0.5), i.x_nm(i.width() - 0.5), i.y_nm(-0.5),
                              i.y_nm(i.height() - 0.5));
      },
      "Left, right, lower and upper edge in nm, for matplotlib's imshow(..., origin='lower').");
  add_pickling(
      type,
      [](const Picture& p) {
        py::list channels;
        for (const Channel& c : p.image.channels)
          channels.append(py::make_tuple(c.name, c.unit, array_of(c.values)));
        return py::make_tuple(channels, std::pair(p.image.pitch_x_nm, p.image.pitch_y_nm),
                              std::pair(p.image.origin_x_nm, p.image.origin_y_nm),
                              record_of(p.image.metadata));
      },
      [](const py::tuple& data) {
        Picture p;
        for (const py::handle one : data[0]) {
          const auto channel = one.cast<py::tuple>();
          const auto name = channel[0].cast<std::string>();
          p.image.channels.push_back(
              {name, channel[1].cast<std::string>(), grid_of<float>(channel[2], name)});
        }
        std::tie(p.image.pitch_x_nm, p.image.pitch_y_nm) =
            data[1].cast<std::pair<double, double>>();
        std::tie(p.image.origin_x_nm, p.image.origin_y_nm) =
            data[2].cast<std::pair<double, double>>();
        p.image.metadata = metadata_of(data[3]);
        return p;
      });
  add_made(type, "image");
}

}  // namespace surf::python
