// SPDX-License-Identifier: GPL-3.0-or-later
// Targets that read meshes.
#include "memory_files.h"
#include "surf/io/surface_file.h"
#include "surf/io/tracks_file.h"
#include "target_lists.h"

namespace surf::test {
namespace {

/// Files that inputs may name. glTF: 32 floats; VTM: one triangle.
void put_companions() {
  static const bool done = [] {
    put_memory_file("buffer.bin", std::string(128, '\x3e'));
    put_memory_file("input/part.vtp", R"(<VTKFile type="PolyData" version="1.0"><PolyData>
<Piece NumberOfPoints="3" NumberOfPolys="1"><Points>
<DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0</DataArray></Points>
<Polys><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">3</DataArray></Polys></Piece></PolyData></VTKFile>)");
    return true;
  }();
  static_cast<void>(done);
}

Accepted read_mesh_as(const char* path, const std::string& content) {
  put_companions();
  put_memory_file(path, content);
  Accepted accepted;
  accepted.surfaces = io::read_surfaces(path);
  return accepted;
}

template <const char* Path>
Accepted mesh(const std::string& content) {
  return read_mesh_as(Path, content);
}

constexpr char stl[] = "input.stl", obj[] = "input.obj", ply[] = "input.ply", off[] = "input.off",
               gltf[] = "input.gltf", glb[] = "input.glb", three_mf[] = "input.3mf",
               vtp[] = "input.vtp", vtm[] = "input.vtm";

Accepted tracks(const std::string& content) {
  put_memory_file("tracks.vtp", content);
  io::read_tracks("tracks.vtp");
  return {};
}

}  // namespace

std::vector<FuzzTarget> mesh_targets() {
  return {{"stl", mesh<stl>, mutate_stl},          {"obj", mesh<obj>, mutate_text},
          {"ply", mesh<ply>, mutate_ply},          {"off", mesh<off>, mutate_counted_text},
          {"gltf", mesh<gltf>, mutate_json},       {"glb", mesh<glb>, mutate_glb},
          {"3mf", mesh<three_mf>, mutate_zip},     {"vtp", mesh<vtp>, mutate_counted_text},
          {"vtm", mesh<vtm>, mutate_counted_text}, {"tracks", tracks, mutate_counted_text}};
}

}  // namespace surf::test
