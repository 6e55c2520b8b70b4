// SPDX-License-Identifier: GPL-3.0-or-later
// semsurf.HeightField and semsurf.Tip.
#include <fmt/format.h>

#include "arrays.h"
#include "data.h"
#include "made.h"
#include "surf/io/tip_file.h"

namespace surf::python {
namespace {

constexpr const char* of_heights =
    R"(Heights on a regular grid, in nm.

``heights[row, column]`` is an array of float64 that shares the object's memory. Row 0 is the
lowest row: x runs to the right with the columns, y runs up with the rows. (Image files and
matplotlib begin at the top; semsurf turns them over when it reads and writes.)

HeightField(heights, pitch=1, origin=(0, 0), valid=None, record=None)

heights : array of two dimensions
    In nm. What is NaN or infinite is a hole.
pitch : float, str or pair of them
    Distance of neighbouring samples, in nm or as '2nm'; a pair is (x, y).
origin : pair of float
    Place of the lowest left sample, in nm.
valid : array of bool
    False where there is no height.
record : dict
    How the heights were made; files store it.)";

constexpr const char* of_tips =
    R"(The tip of an AFM, as semsurf computes with it: the structuring function
T(x, y) = -tip(-x, -y), in nm, whose apex is 0. ``heights`` is its array; row 0 is the lowest row,
and what the tip does not have is -inf.

Tip(heights, pitch=1, record=None)
    The largest height becomes the apex.)";

Heights make_heights(py::handle values, py::handle pitch, std::pair<double, double> origin,
                     py::handle valid, py::handle record) {
  Heights h = heights_of(values, {}, "heights");
  h.field.pitch() = pitch_of(pitch);
  h.field.origin_x_nm = origin.first, h.field.origin_y_nm = origin.second;
  if (!valid.is_none()) {
    const Mask mask = mask_of(valid, h.field.z_nm.width(), h.field.z_nm.height(), "valid");
    if (h.field.valid.empty()) h.field.valid = mask;
    for (std::size_t i = 0; i < mask.size(); ++i) h.field.valid.data()[i] &= mask.data()[i];
  }
  h.record = metadata_of(record);
  validate(h.field, "heights");
  return h;
}

std::pair<double, double> pair_of(const Pitch& pitch) {
  return {pitch.pitch_x_nm, pitch.pitch_y_nm};
}

/// Left, right, lower and upper edge of the outermost samples, as matplotlib's `extent`.
py::tuple extent_of(const Placement& p, int width, int height) {
  return py::make_tuple(p.x_nm(-0.5), p.x_nm(width - 0.5), p.y_nm(-0.5), p.y_nm(height - 0.5));
}

py::object valid_of(const Mask& mask, int width, int height) {
  if (!mask.empty()) return array_of(mask);
  const py::object everywhere = py::module_::import("numpy").attr("broadcast_to");
  return everywhere(true, py::make_tuple(height, width));
}

TipShape make_tip(py::handle values, py::handle pitch, py::handle record) {
  TipShape tip;
  Heights h = heights_of(values, {}, "heights");
  h.field.pitch() = pitch_of(pitch);
  tip.record = metadata_of(record);
  tip.tip = io::to_tip(h.field, tip.record, "heights");
  return tip;
}

}  // namespace

void add_heights(py::module_& module) {
  py::class_<Heights, std::shared_ptr<Heights>> type(module, "HeightField", of_heights);
  type.def(py::init(&make_heights), py::arg("heights"), py::arg("pitch") = 1,
           py::arg("origin") = std::pair(0.0, 0.0), py::arg("valid") = py::none(),
           py::arg("record") = py::none());
  type.def_property_readonly(
      "heights", [](py::object self) { return view_of(self.cast<Heights&>().field.z_nm, self); },
      "Array of the heights in nm, which shares the object's memory; row 0 is the lowest row.");
  type.def_property_readonly(
      "valid",
      [](const Heights& h) {
        return valid_of(h.field.valid, h.field.z_nm.width(), h.field.z_nm.height());
      },
      "Array that is False at holes.");
  type.def_property_readonly(
      "shape",
      [](const Heights& h) { return std::pair(h.field.z_nm.height(), h.field.z_nm.width()); },
      "Rows and columns.");
  type.def_property_readonly(
      "pitch", [](const Heights& h) { return pair_of(h.field); }, "Distances along x and y in nm.");
  type.def_property_readonly(
      "origin",
      [](const Heights& h) { return std::pair(h.field.origin_x_nm, h.field.origin_y_nm); },
      "Place of the lowest left sample in nm.");
  type.def_property_readonly(
      "extent",
      [](const Heights& h) {
        return extent_of(h.field, h.field.z_nm.width(), h.field.z_nm.height());
      },
      "Left, right, lower and upper edge in nm, for matplotlib's imshow(..., origin='lower').");
  type.def(
      "__array__",
      [](py::object self, py::args args) {
        const py::array view = view_of(self.cast<Heights&>().field.z_nm, self);
        return args.empty() ? py::object(view) : view.attr("astype")(*args);
      },
      "The heights, for numpy.");
  add_pickling(
      type,
      [](const Heights& h) {
        return py::make_tuple(
            array_of(h.field.z_nm),
            h.field.valid.empty() ? py::object(py::none()) : py::object(array_of(h.field.valid)),
            pair_of(h.field), std::pair(h.field.origin_x_nm, h.field.origin_y_nm));
      },
      [](const py::tuple& data) {
        Heights h;
        h.field.z_nm = grid_of<double>(data[0], "heights");
        if (!data[1].is_none())
          h.field.valid = mask_of(data[1], h.field.z_nm.width(), h.field.z_nm.height(), "valid");
        std::tie(h.field.pitch_x_nm, h.field.pitch_y_nm) =
            data[2].cast<std::pair<double, double>>();
        std::tie(h.field.origin_x_nm, h.field.origin_y_nm) =
            data[3].cast<std::pair<double, double>>();
        return h;
      });
  add_made(type, "heights");
}

void add_tip(py::module_& module) {
  py::class_<TipShape, std::shared_ptr<TipShape>> type(module, "Tip", of_tips);
  type.def(py::init(&make_tip), py::arg("heights"), py::arg("pitch") = 1,
           py::arg("record") = py::none());
  type.def_property_readonly(
      "heights", [](py::object self) { return view_of(self.cast<TipShape&>().tip.z_nm, self); },
      "Array of the structuring function in nm, which shares the object's memory.");
  type.def_property_readonly(
      "shape", [](const TipShape& t) { return std::pair(t.tip.z_nm.height(), t.tip.z_nm.width()); },
      "Rows and columns.");
  type.def_property_readonly(
      "pitch", [](const TipShape& t) { return pair_of(t.tip); }, "Distances along x and y in nm.");
  type.def_property_readonly(
      "apex", [](const TipShape& t) { return std::pair(t.tip.apex_y, t.tip.apex_x); },
      "Row and column of the apex.");
  type.def_property_readonly(
      "doubt", [](const TipShape& t) { return with_keywords(t.tip.doubt); },
      "Why the tip is not to be trusted; empty: there is no known reason.");
  type.def(
      "__array__",
      [](py::object self, py::args args) {
        const py::array view = view_of(self.cast<TipShape&>().tip.z_nm, self);
        return args.empty() ? py::object(view) : view.attr("astype")(*args);
      },
      "The structuring function, for numpy.");
  add_pickling(
      type,
      [](const TipShape& t) {
        return py::make_tuple(array_of(t.tip.z_nm), pair_of(t.tip), t.tip.apex_x, t.tip.apex_y,
                              t.tip.doubt);
      },
      [](const py::tuple& data) {
        TipShape t;
        t.tip.z_nm = grid_of<double>(data[0], "heights");
        std::tie(t.tip.pitch_x_nm, t.tip.pitch_y_nm) = data[1].cast<std::pair<double, double>>();
        t.tip.apex_x = data[2].cast<int>(), t.tip.apex_y = data[3].cast<int>();
        t.tip.doubt = data[4].cast<std::string>();
        return t;
      });
  add_made(type, "tip");
}

}  // namespace surf::python
