// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/mesh_unit.h"

#include "io_test.h"
#include "surf/io/mesh_file.h"
#include "surf/io/surface_file.h"

namespace surf::io {
namespace {

using test::complaint;
using test::write;
using testing::HasSubstr;

constexpr const char* triangle = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

double width_nm(const TriangleMesh& mesh) { return bounds(mesh).size_nm().x; }

TEST(MeshUnit, IsForFilesThatDoNotSay) {
  const test::TemporaryFolder folder;
  const auto path = write(folder.path() / "a.off", triangle);
  EXPECT_EQ(width_nm(read_mesh(path)), 1);
  EXPECT_EQ(width_nm(read_mesh(path, 1000.0)), 1000);
}

TEST(MeshUnit, HasToBeWhatTheFileSays) {
  const test::TemporaryFolder folder;
  TriangleMesh mesh;
  mesh.vertices_nm = {{0, 0, 0}, {40, 0, 0}, {0, 40, 0}, {0, 0, 40}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  for (const char* name : {"a.stl", "a.obj", "a.ply", "a.off", "a.gltf", "a.glb", "a.3mf"}) {
    const auto path = folder.path() / name;
    write_mesh(path, mesh, 3);
    const double unit_nm = std::string(name).starts_with("a.gl") ? 3000 : 3;  // a metre is 1000 mm
    EXPECT_NEAR(width_nm(read_mesh(path)), 40, 1e-4) << name;
    EXPECT_NEAR(width_nm(read_mesh(path, unit_nm)), 40, 1e-4) << name;
    EXPECT_THAT(complaint<UsageError>([&] { read_mesh(path, 1000.0 * unit_nm); }),
                AllOf(HasSubstr(name), HasSubstr("says that its unit is 3.00"),
                      HasSubstr("`override_unit`")))
        << name;
    EXPECT_THAT(complaint<UsageError>([&] { read_surfaces(path, 1000.0 * unit_nm); }),
                HasSubstr(name));
    EXPECT_NEAR(width_nm(read_mesh(path, {1000 * unit_nm, true})), 40e3, 0.1) << name;
  }
}

}  // namespace
}  // namespace surf::io
