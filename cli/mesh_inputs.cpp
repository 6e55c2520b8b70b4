// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_inputs.h"

#include <fmt/format.h>

#include <algorithm>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/surface_file.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/sheet_solid.h"
#include "surf/mesh/thin_height_field.h"
#include "surf/mesh/vertex_curvature.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr double base_share = 0.05;  // of the longer side, under the lowest place

void print_repair(const RepairSummary& summary) {
  const char* label = "repair";
  for (const std::string& line : describe(summary)) {
    print("{:<10} {}\n", label, line);
    label = "";
  }
}

void advise(const RepairSummary& summary) {
  double longest_nm = 0;
  for (const OpenHole& hole : summary.open_holes) {
    if (hole.too_large) longest_nm = std::max(longest_nm, hole.perimeter_nm);
  }
  if (longest_nm == 0) return;
  print_note(fmt::format("to fill the holes that are left open, add --max-hole {:.4g}nm",
                         1.001 * longest_nm));  // rounding to four digits never goes below it
}

void print_simplified(const SimplifySummary& s) {
  std::string how;
  if (s.end == SimplifyEnd::not_proven)
    how = "not proven: nothing simpler could be shown to keep the tolerance";
  else if (s.triangles_after == s.triangles_before) how = "nothing could be removed";
  else if (!s.deviation.proven()) how = "how far apart is not proven: coordinates are too large";
  else
    how = fmt::format("at most {} apart (original to result {}, back {}), proven",
                      format_length(s.deviation.largest_nm()),
                      format_length(s.deviation.from_first_nm),
                      format_length(s.deviation.from_second_nm));
  print("{:<10} {} triangles to {}, {}\n", "simplify", s.triangles_before, s.triangles_after, how);
}

std::string unique_name(const SurfaceScene& scene, const std::string& name) {
  std::string unique = name;
  const auto is_taken = [&](const Surface& surface) { return surface.name == unique; };
  for (int number = 2; std::ranges::any_of(scene.surfaces, is_taken); ++number)
    unique = fmt::format("{} {}", name, number);
  return unique;
}

/// One input on its way to surfaces.
class Treatment {
 public:
  Treatment(const workflow::FileChannel& input, const MeshWork& work, const Watch& watch,
            SurfaceScene& scene)
      : input_(input), work_(work), watch_(watch), scene_(scene) {}

  void scan() {
    if (work_.repair || work_.smooth.iterations > 0)
      throw UsageError(work_.repair ? "--repair" : "--smooth",
                       fmt::format("{} is a scan, not a mesh", input_.file.string()),
                       "Treat scans with 'semsurf clean' and 'semsurf level'");
    const io::HeightFieldFile file = io::read_height_field(
        input_.file, {input_.channel, work_.z_unit_nm, work_.pitch.x_nm, work_.pitch.y_nm});
    if (!work_.quiet)
      for (const std::string& note : file.notes)
        print_note(fmt::format("{}: {}", input_.file.string(), note));
    Surface surface;
    surface.name = input_.file.stem().string();
    surface.mesh = work_.reduces() ? thinned(file.field) : height_field_sheet(file.field);
    if (work_.scale != 1) transform(surface.mesh, work_.scale, {});
    add(std::move(surface));
  }

  void mesh() {
    if (!input_.channel.empty())
      throw UsageError(input_.file.string(),
                       fmt::format("a mesh has no channel '{}'", input_.channel),
                       "Name the file alone");
    const bool changes = work_.repair || work_.smooth.iterations > 0 || work_.reduces();
    if (changes || !work_.keep_bodies) return whole_mesh();
    SurfaceScene read = io::read_surfaces(input_.file, work_.unit);
    for (Surface& surface : read.surfaces) {
      std::erase_if(surface.scalars, [](const VertexScalar& s) {
        return s.name == "height" || s.name == "curvature";
      });
      if (surface.scalars.empty()) surface.mesh = merge_equal_vertices(surface.mesh);
      if (work_.scale != 1) enlarge(surface);
      add(std::move(surface));
    }
    add_tracks(std::move(read.tracks));
  }

 private:
  TriangleMesh thinned(const HeightField& field) {
    auto [mesh, s] = thin_height_field(
        field, {work_.reduce.tolerance_nm / work_.scale, work_.reduce.triangles, watch_});
    if (!work_.quiet)
      print("{:<10} {} triangles to {}, nowhere more than {} above or below (proven)\n", "simplify",
            s.triangles_before, s.triangles_after, format_length(s.deviation_nm * work_.scale));
    if (work_.reduce.tolerance_nm > 0 && !s.reached)
      print_warning(fmt::format(
          "--triangles: with {} of them the surface is {} off, more than --mesh-tolerance",
          s.triangles_after, format_length(s.deviation_nm * work_.scale)));
    return std::move(mesh);
  }

  void whole_mesh() {
    Surface surface;
    surface.name = input_.file.stem().string();
    surface.mesh = joined();
    TriangleMesh& mesh = surface.mesh;
    if (work_.scale != 1) transform(mesh, work_.scale, {});
    if (work_.repair) {
      RepairOptions repair = *work_.repair;
      repair.watch = watch_;
      auto [mended, summary] = repair_mesh(mesh, repair);
      mesh = std::move(mended);
      if (!work_.quiet) {
        print_repair(summary);
        advise(summary);
      }
    }
    watch_.check();
    if (work_.smooth.iterations > 0) mesh = smooth_mesh(mesh, work_.smooth);
    watch_.check();
    if (work_.reduces()) {
      SimplifyOptions reduce = work_.reduce;
      reduce.watch = watch_;
      auto [simple, summary] = simplify_mesh(mesh, reduce);
      mesh = std::move(simple);
      if (!work_.quiet) print_simplified(summary);
      if (!summary.reached)
        print_warning(fmt::format(
            "--triangles: {} are left; fewer would {}", summary.triangles_after,
            work_.reduce.tolerance_nm > 0 ? "exceed --mesh-tolerance" : "turn faces over"));
    }
    add(std::move(surface));
  }

  /// All bodies of the file, without what lies on them.
  TriangleMesh joined() {
    SurfaceScene read = io::read_surfaces(input_.file, work_.unit);
    const auto carries = [](const Surface& s) {
      return s.drape || std::ranges::any_of(s.scalars, [](const VertexScalar& scalar) {
               return scalar.name != "height" && scalar.name != "curvature";
             });
    };
    if (work_.keep_bodies && !work_.quiet && std::ranges::any_of(read.surfaces, carries))
      print_note(fmt::format(
          "{}: its scalars and pictures are left out, as its vertices change; --scalar and --drape "
          "lay them on what is made",
          input_.file.string()));
    std::vector<io::NamedMesh> bodies;
    for (Surface& body : read.surfaces) bodies.push_back({body.name, {}, std::move(body.mesh)});
    add_tracks(std::move(read.tracks));
    return io::join(bodies);
  }

  void add_tracks(std::vector<Track> tracks) {
    for (Track& track : tracks) {
      for (Vec3& point : track.points_nm) point *= work_.scale;
      scene_.tracks.push_back(std::move(track));
    }
  }

  void enlarge(Surface& surface) const {
    transform(surface.mesh, work_.scale, {});
    if (!surface.drape) return;
    for (double* nm : {&surface.drape->pitch_x_nm, &surface.drape->pitch_y_nm,
                       &surface.drape->origin_x_nm, &surface.drape->origin_y_nm})
      *nm *= work_.scale;
  }

  void add(Surface surface) {
    if (work_.solid_nm) {
      const Box box = bounds(surface.mesh);
      const Vec3 size = box.size_nm();
      const double depth =
          *work_.solid_nm > 0 ? *work_.solid_nm : base_share * std::max(size.x, size.y);
      if (work_.curvature)
        surface.scalars.push_back({"curvature", "1/nm", mean_curvature(surface.mesh, 0, watch_)});
      surface.mesh = sheet_solid(surface.mesh, box.lower_nm.z - depth, watch_);
      for (VertexScalar& scalar : surface.scalars)  // of the walls' feet nothing is known
        scalar.values.resize(surface.mesh.vertices_nm.size(), 0);
      if (!work_.quiet)
        print("{:<10} walls, and a base {} under the lowest place\n", "solid",
              format_length(depth));
    }
    surface.name = unique_name(scene_, surface.name);
    scene_.surfaces.push_back(std::move(surface));
  }

  const workflow::FileChannel& input_;
  const MeshWork& work_;
  const Watch& watch_;
  SurfaceScene& scene_;
};

}  // namespace

void add_mesh_input(const workflow::FileChannel& input, const MeshWork& work, const Watch& watch,
                    SurfaceScene& scene) {
  watch.check();
  Treatment treatment(input, work, watch, scene);
  if (io::is_height_field_file(input.file) || io::is_image_file(input.file)) treatment.scan();
  else treatment.mesh();
}

}  // namespace surf::cli
