// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "files/zip_file.h"
#include "io_test.h"
#include "mesh/through_format.h"
#include "some_surfaces.h"
#include "surf/io/mesh_file.h"

namespace surf::io {
namespace {

using test::scene_of;
using test::TemporaryFolder;

constexpr double float_step = 1.0 / (1 << 23);
constexpr const char* core = "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"";
constexpr const char* tetrahedron =
    "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex "
    "x=\"0\" y=\"1\" "
    "z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1e0\"/></vertices><triangles><triangle v1=\"0\" v2=\"2\" "
    "v3=\"1\"/>"
    "<triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/><triangle "
    "v1=\"2\" v2=\"0\" "
    "v3=\"3\"/></triangles></mesh>";

std::string format(const SurfaceScene& scene, const Magnification& magnification = {}) {
  validate(scene);
  return test::formatted(io::three_mf_format, "f.3mf", scene, magnification).at(0).content;
}

SurfaceScene parse(const std::string& content, std::optional<double> unit_nm = {}) {
  SurfaceScene scene = test::parsed(io::three_mf_format, "f.3mf", content, {unit_nm, true});
  validate(scene);
  return scene;
}

std::string model_of(const std::string& content) {
  return ZipReader("f.3mf", content).read("3D/3dmodel.model").value();
}

/// A package of one model, and further parts.
std::string package(const std::string& model,
                    const std::map<std::string, std::string>& others = {}) {
  ZipWriter zip("f.3mf");
  zip.begin("_rels/.rels");
  zip.append(
      "<Relationships><Relationship Target=\"/3D/3dmodel.model\" Id=\"r\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>");
  zip.begin("3D/3dmodel.model");
  zip.append(model);
  for (const auto& [name, content] : others) {
    zip.begin(name);
    zip.append(content);
  }
  return zip.finish();
}

std::string model(const std::string& resources, const std::string& items,
                  const std::string& more = "") {
  return fmt::format("<model {} {}><resources>{}</resources><build>{}</build></model>", core, more,
                     resources, items);
}

std::string object(int id, const std::string& content) {
  return fmt::format("<object id=\"{}\" name=\"o{}\">{}</object>", id, id, content);
}

TEST(ThreeMfFile, AllComesBack) {
  SurfaceScene scene = test::full_scene();
  for (const Magnification& m :
       {Magnification{}, Magnification{1, 1}, Magnification{999, 3}, Magnification{1e9, 0.5}}) {
    SCOPED_TRACE(m.factor);
    const SurfaceScene back = parse(format(scene, m));
    ASSERT_EQ(back.surfaces.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(back.surfaces[i].name, scene.surfaces[i].name);
      EXPECT_EQ(back.surfaces[i].mesh.triangles, scene.surfaces[i].mesh.triangles);
      EXPECT_LE(test::relative_shift(scene.surfaces[i], back.surfaces[i]), float_step);
    }
    EXPECT_EQ(back.metadata, scene.metadata);
  }
}

TEST(ThreeMfFile, TheBodyIsAsLargeAsPrinted) {
  const SurfaceScene scene = scene_of({"F", test::letter_f_triangles(), {}, {}});
  const auto size_mm = [&](const Magnification& m) {
    return bounds(parse(format(scene, m), 1.0).surfaces.at(0).mesh).size_nm().x;
  };
  EXPECT_THAT(model_of(format(scene)), testing::HasSubstr("unit=\"millimeter\""));
  EXPECT_NEAR(size_mm({}), 3, 1e-6);  // 3 nm, as 3 mm
  EXPECT_THAT(model_of(format(scene, {1, 1})), testing::HasSubstr("unit=\"micron\""));
  EXPECT_NEAR(size_mm({1, 1}), 3e-3, 1e-9);  // of a micron
}

TEST(ThreeMfFile, AnyExtentAndAnyPlace) {
  for (const double extent : {1e-3, 1.0, 1e9}) {
    for (const double offset : {0.0, 1e7}) {
      for (const double factor : {1.0, 1e6}) {
        SCOPED_TRACE(testing::Message() << extent << " nm at " << offset << ", " << factor);
        Surface f{"F", test::letter_f_triangles(), {}, {}};
        for (Vec3& v : f.mesh.vertices_nm) v = v * extent + Vec3{offset, -offset, offset};
        const Surface back = parse(format(scene_of(f), {factor, 1})).surfaces.at(0);
        EXPECT_LE(test::relative_shift(f, back), float_step + 1e-15 * offset / extent * 8);
      }
    }
  }
}

TEST(ThreeMfFile, BodiesAreModelsAndSheetsAreSurfaces) {
  const std::string text = model_of(format(test::full_scene()));
  EXPECT_THAT(
      text, testing::HasSubstr("<object id=\"1\" type=\"model\" name=\"F &lt;1&gt; &amp; &quot;"));
  EXPECT_THAT(text, testing::HasSubstr("<object id=\"2\" type=\"surface\" name=\"waves\""));
}

TEST(ThreeMfFile, MeshReaderSeesTheSameNanometres) {
  const TemporaryFolder folder;
  const Surface f{"F", test::letter_f_triangles(), {}, {}};
  const auto path = test::write(folder.path() / "x.dat", format(scene_of(f), {55, 4}));
  const std::vector<NamedMesh> meshes = read_meshes(path);
  ASSERT_EQ(meshes.size(), 1u);
  EXPECT_EQ(meshes[0].name, "F");
  EXPECT_LE(test::relative_shift(f, {"", meshes[0].mesh, {}, {}}), float_step);
}

TEST(ThreeMfFile, LargeAndSameBytes) {
  const SurfaceScene scene = scene_of(test::wavy_sheet("w", 264, {}));
  const std::string content = format(scene);
  EXPECT_EQ(content, format(scene));
  EXPECT_LE(test::relative_shift(scene.surfaces[0], parse(content).surfaces.at(0)), float_step);
}

TEST(ThreeMfFile, UnitsOfOthersCount) {
  for (const auto& [unit, nm] :
       std::map<std::string, double>{{"", 1e6}, {"micron", 1e3}, {"inch", 25.4e6}}) {
    const std::string more = unit.empty() ? "" : "unit=\"" + unit + "\"";
    const SurfaceScene scene =
        parse(package(model(object(1, tetrahedron), "<item objectid=\"1\"/>", more)));
    EXPECT_EQ(bounds(scene.surfaces.at(0).mesh).upper_nm, (Vec3{nm, nm, nm})) << unit;
    EXPECT_EQ(scene.surfaces[0].name, "o1");
  }
}

TEST(ThreeMfFile, ComponentsAreMovedFromTheInsideOut) {
  const std::string parts =
      object(1, tetrahedron) +
      object(2,
             "<components><component objectid=\"1\"/><component objectid=\"1\" "
             "transform=\"0 1 0 -1 0 0 0 0 1 10 0 0\"/></components>");
  const SurfaceScene scene = parse(
      package(model(parts, "<item objectid=\"2\" transform=\"2 0 0 0 2 0 0 0 -2 0 0 5\"/>")), 1.0);
  ASSERT_EQ(scene.surfaces.size(), 2u);
  EXPECT_EQ(scene.surfaces[1].name, "o1 2");
  EXPECT_EQ(scene.surfaces[0].mesh.vertices_nm[3], (Vec3{0, 0, 3}));
  // x becomes y and moves by 10, then all doubles.
  EXPECT_EQ(scene.surfaces[1].mesh.vertices_nm[1], (Vec3{20, 2, 5}));
  EXPECT_EQ(scene.surfaces[1].mesh.triangles[0], (Triangle{0, 1, 2}))
      << "mirrored: turned the right way round";
}

TEST(ThreeMfFile, ObjectsMayLieInOtherParts) {
  const std::string item = "<item objectid=\"1\" p:path=\"/3D/other.model\"/>";
  const SurfaceScene scene =
      parse(package(model("", item), {{"3D/other.model", model(object(1, tetrahedron), "")}}), 1.0);
  ASSERT_EQ(scene.surfaces.size(), 1u);
}

TEST(ThreeMfFile, NamesOfFilesNeedNotBeUtf8) {
  SurfaceScene scene = scene_of({"caf\xE9\x01", test::letter_f_triangles(), {}, {}});
  scene.metadata = {{"a", "\xFF"}, {"semsurf.version", "\xFF"}};
  const SurfaceScene back = parse(format(scene));
  EXPECT_EQ(back.surfaces.at(0).name, "caf\uFFFD\uFFFD");
  EXPECT_EQ(back.metadata.at("a"), "\uFFFD");
}

TEST(ThreeMfFile, RefusesWhatItCannotHold) {
  const auto refuse = [](const Surface& surface) {
    return test::complaint<InvalidInput>([&] { format(scene_of(surface)); });
  };
  Surface f{"F", test::letter_f_triangles(), {}, {}};
  f.mesh.triangles.push_back({1, 1, 2});
  EXPECT_THAT(refuse(f), testing::HasSubstr("one vertex twice"));
  f = {"F", test::letter_f_triangles(), {}, {}};
  f.mesh.vertices_nm[0].x = 1e300;
  EXPECT_THAT(refuse(f), testing::HasSubstr("too large"));
}

TEST(ThreeMfFile, DamageIsNamed) {
  const auto complaint = [](const std::string& content) {
    return test::complaint<FileError>(
        [&] { test::parsed(io::three_mf_format, "f.3mf", content, {}); });
  };
  const std::string good = format(scene_of({"F", test::letter_f_triangles(), {}, {}}));
  EXPECT_THAT(complaint(good.substr(0, good.size() / 2)), testing::HasSubstr("cut off"));
  std::string flipped = good;
  flipped[flipped.find("3D/3dmodel.model") + 100] ^= 1;
  EXPECT_THAT(complaint(flipped), testing::HasSubstr("3D/3dmodel.model"));
  const auto broken = [&](const std::string& resources, const std::string& items) {
    return complaint(package(model(resources, items)));
  };
  EXPECT_THAT(complaint(package("<model>")), testing::HasSubstr("XML"));
  EXPECT_THAT(broken(object(1, tetrahedron), "<item objectid=\"2\"/>"),
              testing::HasSubstr("no object '2'"));
  EXPECT_THAT(broken(object(1, "<components><component objectid=\"1\"/></components>"), ""),
              testing::HasSubstr("no object '1'"));
  EXPECT_THAT(
      broken(object(1, "<mesh><vertices><vertex x=\"nan\" y=\"0\" z=\"0\"/></vertices></mesh>"),
             ""),
      testing::HasSubstr("not a number"));
  EXPECT_THAT(
      broken(
          object(1, "<mesh><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh>"),
          ""),
      testing::HasSubstr("not one of the 0 vertices"));
  std::string nested = object(1, tetrahedron);
  for (int i = 2; i < 60; ++i) {
    nested += object(
        i, fmt::format("<components><component objectid=\"{0}\"/><component objectid=\"{0}\"/>"
                       "</components>",
                       i - 1));
  }
  EXPECT_THAT(broken(nested, "<item objectid=\"59\"/>"), testing::HasSubstr("too many"));
}

TEST(ThreeMfFile, ExtensionsThatAreNeededAreRefused) {
  const auto needing = [](const char* space) {
    return package(model(object(1, tetrahedron), "<item objectid=\"1\"/>",
                         fmt::format("requiredextensions=\"b\" xmlns:b=\"{}\"", space)));
  };
  EXPECT_EQ(parse(needing("http://schemas.microsoft.com/3dmanufacturing/material/2015/02"))
                .surfaces.size(),
            1u);
  EXPECT_THAT(test::complaint<Unsupported>([&] {
                parse(needing("http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02"));
              }),
              testing::HasSubstr("beamlattice"));
}

TEST(ThreeMfFile, OnlyPackagesWithAModelAreTaken) {
  EXPECT_TRUE(three_mf_format.is(format(scene_of({"F", test::letter_f_triangles(), {}, {}}))));
  ZipWriter zip("x");
  zip.begin("word/document.xml");
  zip.append("<a/>");
  EXPECT_FALSE(three_mf_format.is(zip.finish()));
  EXPECT_FALSE(three_mf_format.is("PK\3\4"));
  EXPECT_FALSE(three_mf_format.is("solid"));
}

}  // namespace
}  // namespace surf::io
