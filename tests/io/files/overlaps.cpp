// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/overlaps.h"

#include "io_test.h"
#include "mesh/some_surfaces.h"
#include "surf/io/mesh_file.h"
#include "surf/io/surface_file.h"

namespace surf::io {
namespace {

namespace fs = std::filesystem;
using test::complaint;
using test::write;
using testing::ElementsAre;
using testing::HasSubstr;

SurfaceScene some_scene() {
  SurfaceScene scene;
  scene.surfaces.push_back(test::wavy_sheet("sheet", 3, {0, 0, 0}));
  return scene;
}

class Overlaps : public testing::Test {
 protected:
  /// What is said of an output over an input.
  std::string refused(const fs::path& input, const fs::path& output) {
    return complaint<UsageError>([&] {
      refuse_overlaps({{"--tip", input, {}}}, {{"--output", output, {}}});
    });
  }

  test::TemporaryFolder folder_;
  fs::path here_ = folder_.path();
  fs::path tip_ = write(here_ / "tip.gsf", "a tip");
};

TEST_F(Overlaps, AreSeenThroughEverySpelling) {
  fs::create_directory(here_ / "sub");
  fs::create_directory_symlink(here_, here_ / "sub" / "back");
  fs::create_symlink(tip_, here_ / "link.gsf");
  fs::create_symlink("link.gsf", here_ / "link_to_link.gsf");
  fs::create_hard_link(tip_, here_ / "hard.gsf");
  for (const fs::path& output :
       {here_ / "tip.gsf", here_ / "." / "sub" / ".." / "tip.gsf", here_ / "sub/back/tip.gsf",
        here_ / "link.gsf", here_ / "link_to_link.gsf", here_ / "hard.gsf", fs::relative(tip_)}) {
    EXPECT_THAT(refused(tip_, output), HasSubstr("an input")) << output;
    EXPECT_THAT(refused(output, tip_), HasSubstr("an input")) << output;
  }
  EXPECT_THAT(refused(tip_, here_ / "gone/../tip.gsf"), HasSubstr("an input"))
      << "writing would make the folder";
  EXPECT_THAT(refused(tip_, here_ / "link.gsf"),
              AllOf(HasSubstr("--output"), HasSubstr("link.gsf"), HasSubstr("--tip"),
                    HasSubstr("Choose another name")));
}

TEST_F(Overlaps, AreSeenAmongOutputsThatDoNotExist) {
  fs::create_directory(here_ / "sub");
  fs::create_directory_symlink(here_, here_ / "sub" / "back");
  const auto both = [&](const fs::path& a, const fs::path& b) {
    return complaint<UsageError>([&] {
      refuse_overlaps({}, {{"--output", a, {}}, {"--surface", b, {}}});
    });
  };
  EXPECT_THAT(both(here_ / "m.tif", here_ / "m.tif"), HasSubstr("--surface"));
  EXPECT_THAT(both(here_ / "m.tif", here_ / "./sub/../m.tif"), HasSubstr("of --output"));
  EXPECT_THAT(both(here_ / "sub/back/m.tif", here_ / "m.tif"), HasSubstr("the same file"));
  EXPECT_THAT(both("m.tif", fs::absolute("m.tif")), HasSubstr("the same file"));
  EXPECT_THAT(both("new/m.tif", "new/./m.tif"), HasSubstr("the same file"));
  EXPECT_THAT(complaint<UsageError>([&] {
                refuse_overlaps({}, {{"--output", "a", {}}, {"--output", "a", {}}});
              }),
              HasSubstr("given twice"));
}

TEST_F(Overlaps, OfAnOutputFolderHoldNoInput) {
  fs::create_directory(here_ / "points");
  const fs::path inside = write(here_ / "points" / "a.json", "{}");
  EXPECT_THAT(refused(inside, here_ / "points"), HasSubstr("lies in"));
  EXPECT_NO_THROW(refuse_overlaps({{"--tip", tip_, {}}}, {{"--output", here_ / "points", {}}}));
}

TEST_F(Overlaps, LetDifferentFilesBe) {
  write(here_ / "before.gsf", "of the run before");
  fs::create_symlink(here_ / "nothing", here_ / "dangling.gsf");
  EXPECT_NO_THROW(refuse_overlaps({{"--tip", tip_, {}}, {"INPUT", tip_, {}}},
                                  {{"--output", here_ / "before.gsf", {}},
                                   {"--plot", here_ / "dangling.gsf", {}},
                                   {"--csv", here_ / "nothing", {}}}));
  // What reads it says that it is missing.
  EXPECT_NO_THROW(
      refuse_overlaps({{"INPUT", here_ / "no.gsf", {}}}, {{"--output", here_ / "no.gsf", {}}}));
}

TEST_F(Overlaps, SayWhichFileBelongsToWhich) {
  EXPECT_THAT(complaint<UsageError>([&] {
                refuse_overlaps({{"INPUT", tip_, here_ / "scene.toml"}}, {{"--output", tip_, {}}});
              }),
              AllOf(HasSubstr("which belongs to"), HasSubstr("scene.toml"), HasSubstr("(INPUT)")));
}

class Companions : public Overlaps {};

TEST_F(Companions, OfMeshesAreReadWithThem) {
  const fs::path gltf = here_ / "a.gltf", obj = here_ / "a.obj";
  write_surfaces(gltf, some_scene());
  EXPECT_THAT(files_read_with(gltf), testing::Contains(here_ / "a.bin"));
  write(obj, "mtllib paint.mtl\nv 0 0 0\n");
  write(here_ / "paint.mtl", "newmtl a\nmap_Kd wood.png\n");
  EXPECT_THAT(files_read_with(obj), ElementsAre(obj, here_ / "paint.mtl", here_ / "wood.png"));
  write(here_ / "broken.gltf", "{");
  EXPECT_THAT(files_read_with(here_ / "broken.gltf"), ElementsAre(here_ / "broken.gltf"));
  EXPECT_THAT(files_read_with(here_ / "missing.gltf"), ElementsAre(here_ / "missing.gltf"));
}

TEST_F(Companions, OfSemImagesAreTheirSettings) {
  const fs::path image = write(here_ / "a.tif", "no matter");
  EXPECT_THAT(files_read_with(image), ElementsAre(image));
  write(here_ / "a.txt", "heights of mine");
  EXPECT_THAT(files_read_with(image), ElementsAre(image));
  write(here_ / "a.txt", "$CM_FORMAT JEOL-SEM\n");
  EXPECT_THAT(files_read_with(image), ElementsAre(image, here_ / "a.txt"));
}

TEST_F(Companions, OfOthersAreNotReplaced) {
  const SurfaceScene scene = some_scene();
  const fs::path gltf = here_ / "mm.gltf", bin = here_ / "mm.bin";
  write(bin, "of somebody else");
  EXPECT_THAT(complaint<UsageError>([&] { check_surface_target(gltf); }),
              AllOf(HasSubstr("mm.bin"), HasSubstr("did not write"), HasSubstr("another name")));
  EXPECT_THAT(complaint<UsageError>([&] { write_surfaces(gltf, scene); }), HasSubstr("mm.bin"));
  EXPECT_FALSE(fs::exists(gltf));
  EXPECT_EQ(test::content_of(bin), "of somebody else");
  fs::remove(bin);
  EXPECT_THAT(write_surfaces(gltf, scene), testing::Contains(bin));
  EXPECT_NO_THROW(check_surface_target(gltf)) << "the file names it";
  EXPECT_NO_THROW(write_surfaces(gltf, scene));
  fs::remove(gltf);
  EXPECT_THAT(complaint<UsageError>([&] { check_surface_target(gltf); }), HasSubstr("mm.bin"));
}

// glTF and OBJ of one name have one name for their pictures.
TEST_F(Companions, OfASiblingOfSemsurfAreReplaced) {
  write(here_ / "a_drape1.png", "a picture");
  write(here_ / "a.gltf",
        R"({"asset": {"generator": "somebody"}, "images": [{"uri": "a_drape1.png"}]})");
  EXPECT_THAT(
      complaint<UsageError>([&] { refuse_strangers(here_ / "a.obj", {here_ / "a_drape1.png"}); }),
      HasSubstr("a_drape1.png"));
  write(here_ / "a.gltf",
        R"({"asset": {"extras": {"semsurf.version": "1"}}, "images": [{"uri": "a_drape1.png"}]})");
  EXPECT_NO_THROW(refuse_strangers(here_ / "a.obj", {here_ / "a_drape1.png"}));
}

TEST_F(Companions, WithAMarkOfSemsurfAreReplaced) {
  write(here_ / "a.run.json", "{\"semsurf\": \"1.0\"}");
  write(here_ / "b.run.json", "{\"name\": \"b\"}");
  EXPECT_NO_THROW(refuse_strangers(here_ / "a.exr", {here_ / "a.run.json", here_ / "missing.csv"}));
  EXPECT_THAT(
      complaint<UsageError>([&] { refuse_strangers(here_ / "b.exr", {here_ / "b.run.json"}); }),
      HasSubstr("b.run.json"));
  write(here_ / "b.tracks.png", "a picture");
  write(here_ / "b.run.json", "{\"semsurf\": \"1.0\", \"outputs\": [\"/x/b.tracks.png\"]}");
  EXPECT_NO_THROW(refuse_strangers(here_ / "b.run.json", {here_ / "b.tracks.png"}));
  write(here_ / "b.run.json", "{\"semsurf\": \"1.0\", \"outputs\": [\"/x/bb.tracks.png\"]}");
  EXPECT_THAT(complaint<UsageError>(
                  [&] { refuse_strangers(here_ / "b.run.json", {here_ / "b.tracks.png"}); }),
              HasSubstr("b.tracks.png"));
}

}  // namespace
}  // namespace surf::io
