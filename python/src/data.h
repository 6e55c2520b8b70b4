// SPDX-License-Identifier: GPL-3.0-or-later
// The objects that Python holds: semsurf's own data, how they were made, and what was found on the
// way.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "function.h"
#include "surf/afm/tip.h"
#include "surf/core/height_field.h"
#include "surf/core/image.h"
#include "surf/core/placed_image.h"
#include "surf/io/height_field_file.h"
#include "surf/io/mesh_file.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf::python {

using Metadata = std::map<std::string, std::string>;

/// What all of them have.
struct Made {
  Metadata record;                  ///< how it was made, as files store it
  py::object found = py::dict();    ///< numbers and arrays that were found on the way
  std::filesystem::path file = {};  ///< the file that it was read from, or empty
};

/// semsurf.HeightField.
struct Heights : Made {
  HeightField field;
  io::HeightReadOptions reading;
};

/// semsurf.Mesh.
struct Mesh : Made {
  TriangleMesh mesh;
  std::string name, material;
};

/// semsurf.Image.
struct Picture : Made {
  Image image;
};

/// semsurf.Tip.
struct TipShape : Made {
  Tip tip;
};

template <class T>
py::object object_of(T made) {
  return py::cast(std::make_shared<T>(std::move(made)));
}

/// A dictionary whose values are attributes, too (semsurf._results.Findings).
py::object findings(const py::dict& values);
/// Findings of `value` and `stderr`.
py::object measured(double value, double standard_error);
py::list list_of(const std::vector<std::string>& texts);
py::list list_of(const std::vector<std::filesystem::path>& files);

/// Parameters of a specimen but for the unit of its meshes, for functions of meshes.
inline const std::vector<std::string> all_but_units{
    "specimen.input",      "specimen.material",    "specimen.materials",
    "specimen.substrate",  "specimen.substrate_z", "specimen.edge",
    "scan.height_channel", "scan.height_unit",     "scan.height_pitch"};

/// "2nm", 2 or (2, 3). Throws UsageError.
Pitch pitch_of(py::handle value);
std::string path_of(py::handle value);
bool is_path(py::handle value);
py::dict record_of(const Metadata& metadata);
Metadata metadata_of(py::handle record);

// Arguments that are objects, arrays or files. Files are read as the call's keywords say, and notes
// about what had to be assumed are passed on.
Heights heights_of(const Call& call, const std::string& argument);
Heights heights_of(py::handle value, const io::HeightReadOptions& reading,
                   const std::string& argument);
Picture picture_of(py::handle value, const std::string& argument);
TipShape tip_of(py::handle value, const std::string& argument);

/// An image and one of its channels: an image or (image, channel).
struct ChosenChannel {
  Picture picture;
  std::string channel;
};
ChosenChannel channel_of(const py::object& value, const std::string& argument);
Mesh mesh_of(py::handle value, const io::MeshUnit& unit, const std::string& argument);

/// An image of the scan's size, in a file or an array, from which a mask is made: `use` and
/// `exclude`. Files are added to `inputs`.
Mask masks_of(const Call& call, const HeightField& field,
              std::vector<std::filesystem::path>& inputs);

void add_heights(py::module_& module);
void add_mesh(py::module_& module);
void add_image(py::module_& module);
void add_tip(py::module_& module);

// The functions.
void add_files(py::module_& module);
void add_simulate(py::module_& module);
void add_scans(py::module_& module);
void add_tips(py::module_& module);
void add_noise(py::module_& module);
void add_meshes(py::module_& module);
void add_models(py::module_& module);
void add_chain(py::module_& module);
void add_profile(py::module_& module);
void add_materials(py::module_& module);
void add_survey(py::module_& module);
void add_samples(py::module_& module);
void add_libraries(py::module_& module);
void add_calibrate(py::module_& module);
void add_sweep(py::module_& module);
void add_chart(py::module_& module);
void add_view(py::module_& module);
void add_compare(py::module_& module);
void add_refine(py::module_& module);
void add_surfaces(py::module_& module);

}  // namespace surf::python
