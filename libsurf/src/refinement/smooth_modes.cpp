// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "surf/refinement/mesh_modes.h"

namespace surf {
namespace {

constexpr int degree = 2;

/// Legendre's polynomials up to the second degree, scaled to a largest magnitude of 1 on [-1, 1].
std::array<double, degree + 1> polynomials(double t) { return {1, t, 0.5 * (3 * t * t - 1)}; }

/// Likewise for displacements along z by the place along z: the ground stays, so that the amplitude
/// is what the top moves by.
std::array<double, degree + 1> above_ground(double t) { return {1, 0.5 * (1 + t), 1 - t * t}; }

/// The place within the box, each coordinate from -1 to 1.
Vec3 place_in(const Box& box, const Vec3& p) {
  const Vec3 middle = box.center_nm(), size = box.size_nm();
  const auto one = [](double v, double m, double s) {
    return s > 0 ? std::clamp(2 * (v - m) / s, -1.0, 1.0) : 0.0;
  };
  return {one(p.x, middle.x, size.x), one(p.y, middle.y, size.y), one(p.z, middle.z, size.z)};
}

/// Which vertices are at the rim of an open mesh.
std::vector<bool> at_rim(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++sides[std::minmax({t[k], t[(k + 1) % 3]})];
  std::vector<bool> out(mesh.vertices_nm.size(), false);
  for (const auto& [edge, count] : sides)
    if (count == 1) out[edge.first] = out[edge.second] = true;
  return out;
}

/// Whether a polynomial of degrees a, b, c along x, y, z changes a size along a direction, or leans
/// or tapers walls along it.
bool is_of_walls(const Vec3& direction, int a, int b, int c) {
  const int along = direction.x > 0 ? a : direction.y > 0 ? b : c, all = a + b + c;
  const bool taper = direction.z == 0 && all == 2 && along == 1 && c == 1;
  return taper || (all == 1 && (along == 1 || c == 1));
}

}  // namespace

std::vector<MeshMode> smooth_modes(const TriangleMesh& mesh, const Box& box, SmoothKind kind) {
  std::vector<MeshMode> modes;
  const std::vector<bool> rim = at_rim(mesh);
  constexpr std::array<Vec3, 3> directions{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  for (const Vec3& direction : directions)
    for (int a = 0; a <= degree; ++a)
      for (int b = 0; a + b <= degree; ++b)
        for (int c = 0; a + b + c <= degree; ++c) {
          if (a + b + c == 0) continue;  // images do not tell where the whole is
          if (kind == SmoothKind::walls && !is_of_walls(direction, a, b, c)) continue;
          MeshMode mode;
          mode.vertical = direction.z > 0;
          for (std::size_t v = 0; v < mesh.vertices_nm.size(); ++v) {
            const Vec3 t = place_in(box, mesh.vertices_nm[v]);
            const double size =
                polynomials(t.x)[static_cast<std::size_t>(a)] *
                polynomials(t.y)[static_cast<std::size_t>(b)] *
                (mode.vertical ? above_ground(t.z) : polynomials(t.z))[static_cast<std::size_t>(c)];
            if (size != 0 && !rim[v])
              mode.moves.push_back({static_cast<std::uint32_t>(v), direction * size});
          }
          modes.push_back(std::move(mode));
        }
  return modes;
}

}  // namespace surf
