// SPDX-License-Identifier: GPL-3.0-or-later
// Files of several bodies, with values and pictures on them.
#include <fmt/format.h>

#include <cmath>

#include <pybind11/stl.h>

#include "arrays.h"
#include "data.h"
#include "surf/core/error.h"
#include "surf/core/track.h"
#include "surf/io/mesh_file.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/io/surface_file.h"
#include "surf/io/tracks_file.h"
#include "surf/workflow/image_sampler.h"

namespace surf::python {
namespace {

VertexScalar scalar_of(const std::string& name, const py::object& given, const TriangleMesh& mesh) {
  VertexScalar scalar{scalar_name(name), "1", {}};
  const bool is_map = py::isinstance<Picture>(given) || PyTuple_Check(given.ptr());
  if (is_map) {
    const ChosenChannel map = channel_of(given, "scalars");
    const workflow::ImageSampler sampler(map.picture.image, map.channel);
    for (const Vec3& v : mesh.vertices_nm) scalar.values.push_back(sampler.at(v.x, v.y));
    scalar.unit = map.picture.image.find(map.channel)->unit;
  } else {
    using Array = py::array_t<float, py::array::c_style | py::array::forcecast>;
    const Array values = Array::ensure(given);
    if (!values) PyErr_Clear();
    if (!values || values.ndim() != 1 ||
        values.size() != static_cast<py::ssize_t>(mesh.vertices_nm.size()))
      throw InvalidInput("scalars",
                         fmt::format("'{}' is no array of {} numbers, one for each vertex", name,
                                     mesh.vertices_nm.size()),
                         "Give such an array, an image, or (image, channel)");
    scalar.values.assign(values.data(), values.data() + values.size());
  }
  for (std::size_t i = 0; i < scalar.values.size(); ++i)
    if (!std::isfinite(scalar.values[i])) {
      const Vec3& v = mesh.vertices_nm[i];
      throw InvalidInput(
          "scalars",
          fmt::format("'{}' says nothing at ({:.6g}, {:.6g}) nm, where the mesh has a vertex", name,
                      v.x, v.y),
          "Give values for all of the surface");
    }
  return scalar;
}

TrackKind kind_of(const std::string& name) {
  for (const TrackKind kind : {TrackKind::absorbed, TrackKind::se, TrackKind::bse,
                               TrackKind::transmitted, TrackKind::lost})
    if (name == name_of(kind)) return kind;
  throw InvalidInput("tracks", fmt::format("there is no kind '{}'", name),
                     "Give absorbed, se, bse, transmitted or lost");
}

/// A track as a simulation finds it.
Track track_of(const py::handle& given) {
  using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
  if (!PyDict_Check(given.ptr()))
    throw InvalidInput("tracks", "one is no track",
                       "Give the tracks that a simulation found, or a .vtp file");
  const auto d = py::reinterpret_borrow<py::dict>(given);
  for (const char* key : {"points", "energies", "kind", "secondary", "electron", "number", "parent",
                          "generation", "materials"})
    if (!d.contains(key))
      throw InvalidInput("tracks", fmt::format("one has no '{}'", key),
                         "Give the tracks that a simulation found, or a .vtp file");
  Track track;
  const Numbers points = Numbers::ensure(d["points"]);
  if (!points) PyErr_Clear();
  if (!points || points.ndim() != 2 || points.shape(1) != 3)
    throw InvalidInput("tracks", "points are no array of N x 3 numbers", "Give x, y and z in nm");
  for (py::ssize_t i = 0; i < points.shape(0); ++i)
    track.points_nm.push_back({points.at(i, 0), points.at(i, 1), points.at(i, 2)});
  track.energy_ev = d["energies"].cast<std::vector<double>>();
  track.material = d["materials"].cast<std::vector<int>>();
  track.kind = kind_of(py::str(d["kind"]));
  track.secondary = d["secondary"].cast<bool>();
  track.electron = d["electron"].cast<std::int64_t>();
  track.number = d["number"].cast<int>();
  track.parent = d["parent"].cast<int>();
  track.generation = d["generation"].cast<int>();
  validate(track, "tracks");
  return track;
}

std::vector<Track> tracks_of(const py::object& given) {
  if (is_path(given)) return io::read_tracks(path_of(given));
  std::vector<Track> tracks;
  if (!PyList_Check(given.ptr()) && !PyTuple_Check(given.ptr()))
    throw InvalidInput("tracks", "it is no list",
                       "Give the tracks that a simulation found, or a .vtp file");
  for (const py::handle one : given) tracks.push_back(track_of(one));
  return tracks;
}

/// What is written, by name: one mesh, a list, or a dictionary.
std::vector<Mesh> bodies_of(const py::object& given) {
  std::vector<Mesh> bodies;
  if (PyDict_Check(given.ptr())) {
    for (const auto& [name, mesh] : py::reinterpret_borrow<py::dict>(given)) {
      bodies.push_back(mesh_of(mesh, {}, "mesh"));
      bodies.back().name = py::str(name);
    }
  } else if (PyList_Check(given.ptr()) || PyTuple_Check(given.ptr())) {
    for (const py::handle mesh : given) bodies.push_back(mesh_of(mesh, {}, "mesh"));
  } else {
    bodies.push_back(mesh_of(given, {}, "mesh"));
  }
  if (bodies.empty()) throw UsageError("mesh", "there is none", "Give a mesh, or several");
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].name.empty())
      bodies[i].name = bodies.size() > 1 ? fmt::format("mesh {}", i + 1) : "mesh";
  return bodies;
}

py::object write_mesh(const Call& call) {
  const std::string path = path_of(call["path"]);
  const double unit_nm = call.told<io::SpecimenRequest>().mesh_unit_nm.value_or(1);
  const std::vector<Mesh> bodies = bodies_of(call["mesh"]);
  const bool carries = call.has("scalars") || call.has("drape") || call.has("tracks");
  if (!carries && bodies.size() == 1) {
    const py::gil_scoped_release unlocked;
    io::write_mesh(path, bodies.front().mesh, unit_nm);
    return py::none();
  }
  const io::SurfaceFormat& format = io::check_surface_target(path);
  const auto refuse = [&](bool holds, const char* argument, const char* what) {
    if (!holds)
      throw UsageError(argument, fmt::format("{} files hold no {}", format.extension, what),
                       "Write .ply, .vtp, .vtm or .glb; help(semsurf.write_mesh) says more");
  };
  if (call.has("scalars")) refuse(format.scalars, "scalars", "scalars");
  if (call.has("drape")) refuse(format.drape, "drape", "pictures");
  if (call.has("tracks")) refuse(format.tracks, "tracks", "tracks");
  if (unit_nm != 1) throw UsageError("`specimen.unit`", "it is for a mesh alone", "Leave it out");
  SurfaceScene scene;
  for (const Mesh& body : bodies) {
    Surface surface;
    surface.name = body.name;
    surface.mesh = body.mesh;
    if (const py::object scalars = call["scalars"]; !scalars.is_none()) {
      if (!PyDict_Check(scalars.ptr()))
        throw UsageError("scalars", "it is no dictionary", "Give {'name': values}");
      for (const auto& [name, values] : py::reinterpret_borrow<py::dict>(scalars))
        surface.scalars.push_back(
            scalar_of(py::str(name), py::reinterpret_borrow<py::object>(values), surface.mesh));
    }
    if (call.has("drape")) {
      const ChosenChannel map = channel_of(call["drape"], "drape");
      surface.drape = io::make_drape(map.picture.image, map.channel);
    }
    scene.surfaces.push_back(std::move(surface));
  }
  if (call.has("tracks")) scene.tracks = tracks_of(call["tracks"]);
  scene.metadata = bodies.front().record;
  const py::gil_scoped_release unlocked;
  io::write_surfaces(path, scene);
  return py::none();
}

py::object read_bodies(const Call& call) {
  const auto request = call.told<io::SpecimenRequest>();
  const std::string path = path_of(call["path"]);
  SurfaceScene scene;
  {
    const py::gil_scoped_release unlocked;
    scene = io::read_surfaces(path, {request.mesh_unit_nm, request.override_unit});
  }
  py::list all;
  for (Surface& surface : scene.surfaces) {
    Mesh mesh;
    mesh.file = path;
    mesh.name = surface.name;
    mesh.mesh = std::move(surface.mesh);
    mesh.record = scene.metadata;
    py::dict scalars, found;
    for (VertexScalar& scalar : surface.scalars)
      scalars[py::str(scalar.name)] = array_of(std::move(scalar.values));
    found["scalars"] = findings(scalars);
    mesh.found = findings(found);
    all.append(object_of(std::move(mesh)));
  }
  return all;
}

}  // namespace

void add_surfaces(py::module_& module) {
  Function w{.name = "write_mesh", .summary = "Write a mesh, or several, to a file."};
  w.details =
      "Several bodies, values at vertices and pictures go to .glb, .gltf, .ply, .vtp and .vtm, as\n"
      "far as the format holds them; a message says which do.";
  w.arguments = {
      {"path", "PathLike",
       "The file; its ending says the format: .stl .obj .ply .off .glb .gltf .3mf .vtp .vtm", true,
       false},
      {"mesh", "Mesh | PathLike | Sequence | dict",
       "The mesh; or several, a dictionary with their names.", true, false},
      {"scalars", "dict[str, ArrayLike | Image | tuple[Image, str]]",
       "Values by name: an array with one for each vertex, or an image or (image, channel) that "
       "lies over the mesh."},
      {"drape", "Image | PathLike | tuple[Image, str]", "A picture to lay on the mesh."},
      {"tracks", "Sequence[Findings] | PathLike",
       "Paths of electrons, the `tracks` that a simulation found, or a .vtp file of them."}};
  w.result_type = "None", w.result = "Nothing.";
  w.is_long = false;
  w.example =
      ">>> semsurf.write_mesh('grain.glb', mesh, drape=(image, 'SE'))\n"
      ">>> semsurf.write_mesh('grain.ply', mesh, scalars={'height': mesh.vertices[:, 2]})";
  std::vector<std::string> all_but_unit = all_but_units;
  all_but_unit.push_back("specimen.override_unit");
  define(module, w.takes<io::SpecimenRequest>({}, all_but_unit), write_mesh);

  Function r{.name = "read_bodies", .summary = "Read the bodies of a mesh file, each by itself."};
  r.arguments = {{"path", "PathLike", "The file.", true, false}};
  r.result_type = "list[Mesh]";
  r.result = "The bodies with their names; `found` has `scalars`, values at their vertices.";
  r.is_long = false;
  define(module, r.takes<io::SpecimenRequest>({}, all_but_units), read_bodies);
}

}  // namespace surf::python
