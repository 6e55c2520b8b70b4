// SPDX-License-Identifier: GPL-3.0-or-later
// What lib3mf, the format's reference library, makes of our files, and we of its.
#include <lib3mf/Model/COM/NMR_DLLInterfaces.h>

#include <cmath>

#include "io_test.h"
#include "mesh/through_format.h"
#include "some_surfaces.h"

namespace surf::io {
namespace {

using namespace NMR;

void check(LIB3MFRESULT result, const char* what) { ASSERT_EQ(result, LIB3MF_OK) << what; }
#define CHECK(call) check(call, #call)

/// A model that is released at the end.
struct Model {
  PLib3MFModel* get = nullptr;
  Model() { CHECK(lib3mf_createmodel(&get)); }
  ~Model() { lib3mf_release(get); }
};

void read_strictly(const Model& model, std::string content) {
  PLib3MFModelReader* reader = nullptr;
  CHECK(lib3mf_model_queryreader(model.get, "3mf", &reader));
  CHECK(lib3mf_reader_setstrictmodeactive(reader, true));
  CHECK(lib3mf_reader_readfrombuffer(reader, reinterpret_cast<BYTE*>(content.data()),
                                     content.size()));
  DWORD warnings = 0;
  CHECK(lib3mf_reader_getwarningcount(reader, &warnings));
  EXPECT_EQ(warnings, 0u);
  lib3mf_release(reader);
}

struct Seen {
  std::string name;
  DWORD vertices = 0, triangles = 0;
  bool is_closed = false;
  MODELMESHVERTEX first{};
};

std::vector<Seen> objects(const Model& model) {
  std::vector<Seen> found;
  PLib3MFModelResourceIterator* iterator = nullptr;
  CHECK(lib3mf_model_getmeshobjects(model.get, &iterator));
  BOOL more = false;
  while (lib3mf_resourceiterator_movenext(iterator, &more) == LIB3MF_OK && more) {
    PLib3MFModelResource* object = nullptr;
    CHECK(lib3mf_resourceiterator_getcurrent(iterator, &object));
    Seen seen;
    ULONG size = 0;
    std::string name(200, '\0');
    CHECK(lib3mf_object_getnameutf8(object, name.data(), 200, &size));
    seen.name = name.substr(0, size);
    CHECK(lib3mf_meshobject_getvertexcount(object, &seen.vertices));
    CHECK(lib3mf_meshobject_gettrianglecount(object, &seen.triangles));
    CHECK(lib3mf_meshobject_getvertex(object, 0, &seen.first));
    BOOL closed = false;
    CHECK(lib3mf_meshobject_ismanifoldandoriented(object, &closed));
    seen.is_closed = closed;
    found.push_back(seen);
    lib3mf_release(object);
  }
  lib3mf_release(iterator);
  return found;
}

TEST(ThreeMfOutside, Lib3mfReadsOurs) {
  const SurfaceScene scene = test::full_scene();
  for (const Magnification& m : {Magnification{}, Magnification{1, 2}}) {
    const Model model;
    read_strictly(model, test::formatted(io::three_mf_format, "f.3mf", scene, m).at(0).content);
    DWORD unit = 0;
    CHECK(lib3mf_model_getunit(model.get, &unit));
    EXPECT_EQ(unit,
              static_cast<DWORD>(m.factor == 1 ? MODELUNIT_MICROMETER : MODELUNIT_MILLIMETER));
    const std::vector<Seen> seen = objects(model);
    ASSERT_EQ(seen.size(), 2u);
    EXPECT_EQ(seen[0].name, scene.surfaces[0].name);
    EXPECT_EQ(seen[0].vertices, scene.surfaces[0].mesh.vertices_nm.size());
    EXPECT_EQ(seen[1].triangles, scene.surfaces[1].mesh.triangles.size());
    EXPECT_TRUE(seen[0].is_closed);
    EXPECT_FALSE(seen[1].is_closed);
    const Vec3 center = bounds(scene.surfaces[1].mesh).center_nm();
    const double scale = m.factor == 1 ? 1e-3 : 1;
    EXPECT_FLOAT_EQ(
        seen[1].first.m_fPosition[0],
        static_cast<float>(scale * (scene.surfaces[1].mesh.vertices_nm[0].x - center.x)));
  }
}

TEST(ThreeMfOutside, WeReadTheirs) {
  const Model model;
  PLib3MFModelMeshObject* object = nullptr;
  CHECK(lib3mf_model_addmeshobject(model.get, &object));
  CHECK(lib3mf_model_setunit(model.get, MODELUNIT_INCH));
  CHECK(lib3mf_object_setnameutf8(object, "F"));
  const TriangleMesh f = test::letter_f_triangles();
  std::vector<MODELMESHVERTEX> vertices;
  for (const Vec3& v : f.vertices_nm) {
    vertices.push_back(
        {{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}});
  }
  std::vector<MODELMESHTRIANGLE> triangles;
  for (const Triangle& t : f.triangles) triangles.push_back({{t[0], t[1], t[2]}});
  CHECK(lib3mf_meshobject_setgeometry(object, vertices.data(), static_cast<DWORD>(vertices.size()),
                                      triangles.data(), static_cast<DWORD>(triangles.size())));
  PLib3MFModelBuildItem* item = nullptr;
  CHECK(lib3mf_model_addbuilditem(model.get, object, nullptr, &item));
  PLib3MFModelWriter* writer = nullptr;
  CHECK(lib3mf_model_querywriter(model.get, "3mf", &writer));
  ULONG64 size = 0;
  CHECK(lib3mf_writer_getstreamsize(writer, &size));
  std::string content(size, '\0');
  CHECK(lib3mf_writer_writetobuffer(writer, reinterpret_cast<BYTE*>(content.data()), size));
  ASSERT_TRUE(io::three_mf_format.is(content));
  const SurfaceScene scene = test::parsed(io::three_mf_format, "f.3mf", content, {});
  ASSERT_EQ(scene.surfaces.size(), 1u);
  EXPECT_EQ(scene.surfaces[0].name, "F");
  EXPECT_EQ(scene.surfaces[0].mesh.triangles, f.triangles);
  for (std::size_t i = 0; i < f.vertices_nm.size(); ++i) {
    const Vec3 shifted = scene.surfaces[0].mesh.vertices_nm[i] - f.vertices_nm[i] * 25.4e6;
    EXPECT_LT(length(shifted), 25.4e6 * 1e-6);  // six digits
  }
}

}  // namespace
}  // namespace surf::io
