// SPDX-License-Identifier: GPL-3.0-or-later
// semsurf.Mesh.
#include <fmt/format.h>

#include <limits>

#include "arrays.h"
#include "data.h"
#include "made.h"
#include "surf/core/error.h"

namespace surf::python {
namespace {

constexpr const char* of_meshes =
    R"(Triangles over shared vertices, in nm. Seen from outside the corners of a triangle run
counter-clockwise.

Mesh(vertices, triangles, name='', material='', record=None)

vertices : array of shape (n, 3)
triangles : array of shape (m, 3)
    Rows of `vertices`.
name, material : str
    As a specimen has them.

``vertices`` (float64) and ``triangles`` (uint32) share the object's memory. Other libraries take
them as they are:

>>> trimesh.Trimesh(mesh.vertices, mesh.triangles)
>>> pyvista.PolyData.from_regular_faces(mesh.vertices, mesh.triangles)
>>> semsurf.Mesh(other.vertices, other.faces)                            # of trimesh
>>> semsurf.Mesh(other.points, other.faces.reshape(-1, 4)[:, 1:])        # of PyVista)";

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Triangle) == 3 * sizeof(std::uint32_t));

template <class T>
py::array_t<T, py::array::c_style | py::array::forcecast> triples(py::handle values,
                                                                  const char* subject) {
  using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;
  const Array array = Array::ensure(values);
  if (!array) PyErr_Clear();
  if (!array || array.ndim() != 2 || array.shape(1) != 3)
    throw InvalidInput(subject, "it is no array of three columns",
                       fmt::format("Give an array of the shape (n, 3)"));
  return array;
}

Mesh make_mesh(py::handle vertices, py::handle triangles, const std::string& name,
               const std::string& material, py::handle record) {
  Mesh made;
  made.name = name, made.material = material;
  made.record = metadata_of(record);
  const auto places = triples<double>(vertices, "vertices");
  const auto corners = triples<std::int64_t>(triangles, "triangles");
  const auto as_given = triples<double>(triangles, "triangles");
  for (py::ssize_t i = 0; i < corners.size(); ++i)
    if (static_cast<double>(corners.data()[i]) != as_given.data()[i])
      throw InvalidInput("triangles", fmt::format("{} is no vertex", as_given.data()[i]),
                         "Give whole numbers");
  made.mesh.vertices_nm.resize(static_cast<std::size_t>(places.shape(0)));
  for (py::ssize_t i = 0; i < places.shape(0); ++i)
    made.mesh.vertices_nm[static_cast<std::size_t>(i)] = {places.at(i, 0), places.at(i, 1),
                                                          places.at(i, 2)};
  made.mesh.triangles.resize(static_cast<std::size_t>(corners.shape(0)));
  for (py::ssize_t i = 0; i < corners.shape(0); ++i)
    for (py::ssize_t c = 0; c < 3; ++c) {
      const std::int64_t vertex = corners.at(i, c);
      if (vertex < 0 || vertex > std::numeric_limits<std::uint32_t>::max())
        throw InvalidInput("triangles", fmt::format("triangle {} has the vertex {}", i, vertex),
                           fmt::format("Vertices count from 0 to {}", places.shape(0) - 1));
      made.mesh.triangles[static_cast<std::size_t>(i)][static_cast<std::size_t>(c)] =
          static_cast<std::uint32_t>(vertex);
    }
  validate(made.mesh);
  return made;
}

template <class Scalar, class Row>
py::array rows_of(const std::vector<Row>& rows, py::handle owner) {
  constexpr auto size = static_cast<py::ssize_t>(sizeof(Scalar));
  return py::array(py::dtype::of<Scalar>(), {static_cast<py::ssize_t>(rows.size()), py::ssize_t{3}},
                   {3 * size, size}, reinterpret_cast<const Scalar*>(rows.data()), owner);
}

}  // namespace

void add_mesh(py::module_& module) {
  py::class_<Mesh, std::shared_ptr<Mesh>> type(module, "Mesh", of_meshes);
  type.def(py::init(&make_mesh), py::arg("vertices"), py::arg("triangles"), py::arg("name") = "",
           py::arg("material") = "", py::arg("record") = py::none());
  type.def_property_readonly(
      "vertices",
      [](const py::object& self) {
        return rows_of<double>(self.cast<Mesh&>().mesh.vertices_nm, self);
      },
      "Array (n, 3) of float64 in nm, which shares the object's memory.");
  type.def_property_readonly(
      "triangles",
      [](const py::object& self) {
        return rows_of<std::uint32_t>(self.cast<Mesh&>().mesh.triangles, self);
      },
      "Array (m, 3) of uint32: rows of `vertices`. It shares the object's memory.");
  type.def_property_readonly(
      "bounds",
      [](const Mesh& m) {
        const Box box = bounds(m.mesh);
        return py::make_tuple(py::make_tuple(box.lower_nm.x, box.lower_nm.y, box.lower_nm.z),
                              py::make_tuple(box.upper_nm.x, box.upper_nm.y, box.upper_nm.z));
      },
      "Lower and upper corner of the box around all vertices, in nm.");
  type.def_readwrite("name", &Mesh::name, "As a specimen calls it.");
  type.def_readwrite("material", &Mesh::material, "What it is made of; empty: as is said.");
  add_pickling(
      type,
      [](const Mesh& m) {
        const py::object self = py::cast(&m, py::return_value_policy::reference);
        return py::make_tuple(self.attr("vertices").attr("copy")(),
                              self.attr("triangles").attr("copy")(), m.name, m.material);
      },
      [](const py::tuple& data) {
        return make_mesh(data[0], data[1], data[2].cast<std::string>(), data[3].cast<std::string>(),
                         py::none());
      });
  add_made(type, "mesh");
}

}  // namespace surf::python
