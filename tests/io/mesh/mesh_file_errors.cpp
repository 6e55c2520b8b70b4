// SPDX-License-Identifier: GPL-3.0-or-later
#include "io_test.h"
#include "letter_f_mesh.h"
#include "surf/io/mesh_file.h"

namespace surf::io {
namespace {

using test::complaint;
using test::TemporaryFolder;
using test::write;
using testing::HasSubstr;

struct Case {
  const char* label;
  const char* name;
  std::string content;
  const char* place;   ///< named in the message
  const char* reason;  ///< named in the message
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.label; }

const char* const ply_start =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
    "property float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n";

std::string ply(const std::string& body) { return ply_start + body; }

std::string ply_with(const std::string& from, const std::string& to) {
  std::string text = ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  return text.replace(text.find(from), from.size(), to);
}

const char* const zero_faces =
    "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\n"
    "property float y\nproperty float z\nelement face 0\n"
    "property list uchar int vertex_indices\nend_header\n";

std::string stl_text(const std::string& from, const std::string& to) {
  std::string text =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
      "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
  return text.replace(text.find(from), from.size(), to);
}

std::string binary_stl_with_nan() {
  std::string text = test::binary_stl({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  return text.replace(84 + 12 + 12, 4, "\xff\xff\xff\xff");
}

std::string binary_stl_shorter() {
  std::string text = test::binary_stl(test::letter_f_triangles());
  text.replace(0, 5, "model");
  text.pop_back();
  return text;
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"empty", "a.stl", "", "a.stl", "empty"},
      {"unknown", "a.dat", "v 0 0 0\n", "a.dat", "neither"},
      {"garbage_stl", "a.stl", "\x01\x02\x03", "a.stl", "3 bytes"},
      {"garbage_obj", "a.obj", "\x01\x02", "line 1",
       "'?"
       "?'"},
      {"garbage_ply", "a.ply", "plx\n", "line 1", "'ply'"},
      {"garbage_off", "a.off", "hello\n", "line 1", "number of vertices"},
      {"binary_stl_short", "a.stl", binary_stl_shorter(), "a.stl", "announces"},
      {"binary_stl_nan", "a.stl", binary_stl_with_nan(), "facet 1, byte 108", "finite"},
      {"stl_no_triangles", "a.stl", "solid\nendsolid\n", "a.stl", "no triangles"},
      {"stl_no_end", "a.stl", stl_text("endsolid a\n", ""), "line 9", "endsolid"},
      {"stl_cut", "a.stl", stl_text("endloop\nendfacet\nendsolid a\n", ""), "line 7", "ends"},
      {"stl_nan", "a.stl", stl_text("1 0 0", "nan 0 0"), "line 5", "'nan'"},
      {"stl_inf", "a.stl", stl_text("1 0 0", "1 -inf 0"), "line 5", "'-inf'"},
      {"stl_huge", "a.stl", stl_text("1 0 0", "1 1e999 0"), "line 5", "'1e999'"},
      {"stl_comma", "a.stl", stl_text("1 0 0", "1,5 0 0"), "line 5", "'1,5'"},
      {"stl_two_numbers", "a.stl", stl_text("1 0 0", "1 0"), "line 5", "the z of a vertex"},
      {"stl_four_numbers", "a.stl", stl_text("1 0 0", "1 0 0 0"), "line 5", "'0' follows"},
      {"stl_four_vertices", "a.stl", stl_text("endloop", "vertex 1 1 1"), "line 7", "endloop"},
      {"obj_index_0", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "line 4", "vertex 0"},
      {"obj_empty", "a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 4\nv\n", "line 4", "x of a vertex"},
      {"obj_index_5", "a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 5\nf 1 2 2\n", "line 3", "vertex 5"},
      {"obj_index_minus", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -4 1 2\n", "line 4", "vertex -4"},
      {"obj_index_huge", "a.obj", "v 0 0 0\nf 1 1 99999999999999999999\n", "line 2", "corner"},
      {"obj_index_2^40", "a.obj", "v 0 0 0\nf 1 1 1099511627776\n", "line 2", "1099511627776"},
      {"obj_bad_corner", "a.obj", "v 0 0 0\nf 1/x 1 1\n", "line 2", "'1/x'"},
      {"obj_two_corners", "a.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n", "line 3", "2 corners"},
      {"obj_nan", "a.obj", "v 0 nan 0\n", "line 1", "'nan'"},
      {"obj_points", "a.obj", "v 0 0 0\nv 1 0 0\np 1\nl 1 2\n", "a.obj", "no triangles"},
      {"obj_faces_only", "a.obj", "f 1 2 3\n", "line 1", "has only 0"},
      {"obj_free_form", "a.obj", "v 0 0 0\ncstype bspline\n", "line 2", "free-form"},
      {"off_short", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", "line", "after 2 of 3 vertices"},
      {"off_faces", "a.off", "OFF\n2 2 0\n0 0 0\n1 0 0\n3 0 1 1\n", "line", "1 of 2 faces"},
      {"off_index", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "line 6", "vertex 3"},
      {"off_minus", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "line 6", "vertex -1"},
      {"off_more", "a.off", "OFF\n2 1 0\n0 0 0\n1 0 0\n3 0 1 1\n3 0 1 1\n", "line 6", "more"},
      {"off_count", "a.off", "OFF\n1000000000 1 0\n0 0 0\n", "line 2", "do not fit"},
      {"off_negative", "a.off", "OFF\n-3 1 0\n0 0 0\n", "line 2", "negative"},
      {"off_corners", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "line 6", "2 corners"},
      {"off_long", "a.off", "OFF\n2 2 0\n0 0 0\n1 0 0\n9 0 1 1\n3 0 1 1", "line 5", "line ends"},
      {"off_binary", "a.off", "OFF BINARY\n123", "line 1", "binary"},
      {"off_4d", "a.off", "4OFF\n1 1 0\n", "line 1", "four"},
      {"ply_no_faces", "a.ply", ply_with("element face", "element edge"), "a.ply", "'face'"},
      {"ply_zero_faces", "a.ply", zero_faces, "a.ply", "no triangles"},
      {"ply_no_end", "a.ply", "ply\nformat ascii 1.0\n", "line 3", "inside the header"},
      {"ply_version", "a.ply", ply_with("1.0", "2.0"), "line 2", "'2.0'"},
      {"ply_format", "a.ply", ply_with("ascii", "ebcdic"), "line 2", "'ebcdic'"},
      {"ply_type", "a.ply", ply_with("float y", "real y"), "line 5", "'real'"},
      {"ply_twice", "a.ply", ply_with("float y", "float x"), "line 5", "twice"},
      {"ply_no_z", "a.ply", ply_with("float z", "float w"), "line", "x, y or z"},
      {"ply_no_list", "a.ply", ply_with("vertex_indices", "corners"), "line", "vertex_index"},
      {"ply_count", "a.ply", ply_with("vertex 3", "vertex 99999999999"), "line 9", "announces"},
      {"ply_negative", "a.ply", ply_with("vertex 3", "vertex -3"), "line 3", "negative"},
      {"ply_keyword", "a.ply", ply_with("end_header", "end_of_it"), "line 9", "'end_of_it'"},
      {"ply_index", "a.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), "line 13", "vertex 3"},
      {"ply_nan", "a.ply", ply("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), "line 11", "'nan'"},
      {"ply_short", "a.ply", ply("0 0 0\n1 0 0\n0 1 0\n"), "line", "ends after 0 of 1"},
      {"ply_short_line", "a.ply", ply("0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), "line 11", "line ends"},
      {"ply_long_line", "a.ply", ply("0 0 0 1\n1 0 0\n0 1 0\n3 0 1 2\n"), "line 10", "'1' follows"},
      {"ply_more", "a.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n"), "line 14", "more"},
      {"ply_corners", "a.ply", ply("0 0 0\n1 0 0\n0 1 0\n2 0 1\n"), "line 13", "2 corners"},
      {"ply_negative_list", "a.ply", ply("0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n"), "line 13", "-3"},
  };
  return all;
}

class MeshFileErrors : public testing::TestWithParam<Case> {};

TEST_P(MeshFileErrors, SaysWhereAndWhy) {
  const Case& c = GetParam();
  const TemporaryFolder folder;
  const auto path = write(folder.path() / c.name, c.content);
  const std::string message = complaint<FileError>([&] { read_mesh(path); });
  EXPECT_THAT(message, HasSubstr(path.string()));
  EXPECT_THAT(message, HasSubstr(c.place));
  EXPECT_THAT(message, HasSubstr(c.reason));
  const auto printable = [](unsigned char b) { return b >= ' '; };
  EXPECT_TRUE(std::all_of(message.begin(), message.end(), printable)) << message;
}

std::string label(const testing::TestParamInfo<Case>& info) {
  std::string text = info.param.label;
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return text;
}

INSTANTIATE_TEST_SUITE_P(All, MeshFileErrors, testing::ValuesIn(cases()), label);

TEST(MeshFile, EveryTruncationAndEveryChangedByteIsSurvived) {
  const TriangleMesh f{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  std::string binary_ply = ply_with("ascii", "binary_big_endian");
  binary_ply.erase(binary_ply.find("end_header\n") + 11);
  for (const float c : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) {
    binary_ply += test::bytes(c, true);
  }
  binary_ply += '\3';
  for (const int i : {0, 1, 2}) binary_ply += test::bytes(i, true);
  const std::pair<const char*, std::string> files[] = {
      {"a.stl", test::text_stl(f)},
      {"a.stl", test::binary_stl(f)},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 -1//1\n"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1 1 1\n"},
      {"a.ply", ply("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")},
      {"a.ply", binary_ply},
  };
  const TemporaryFolder folder;
  int read = 0;
  const auto survive = [&](const char* name, const std::string& content) {
    try {
      validate(read_mesh(write(folder.path() / name, content)));
      ++read;
    } catch (const FileError&) {
    }
  };
  for (const auto& [name, content] : files) {
    survive(name, content);
    for (std::size_t i = 0; i < content.size(); ++i) {
      survive(name, content.substr(0, i));
      std::string changed = content;
      changed[i] = i % 2 ? '9' : '\xff';
      survive(name, changed);
    }
  }
  EXPECT_GE(read, 6);
}

TEST(MeshFile, RefusesUnitsThatAreNone) {
  const TemporaryFolder folder;
  const auto path = write(folder.path() / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1e300 0\nf 1 2 3\n");
  for (const double unit : {0.0, -1.0, HUGE_VAL, std::nan("")}) {
    complaint<UsageError>([&] { read_mesh(path, unit); });
  }
  EXPECT_THAT(complaint<FileError>([&] { read_mesh(path, 1e9); }), HasSubstr("too large"));
}

TEST(MeshFile, RefusesMissingFilesAndFolders) {
  const TemporaryFolder folder;
  const auto missing = folder.path() / "a.stl";
  EXPECT_THAT(complaint<FileError>([&] { read_mesh(missing); }), HasSubstr(missing.string()));
  EXPECT_THAT(complaint<FileError>([&] { read_mesh(folder.path()); }), HasSubstr("folder"));
}

}  // namespace
}  // namespace surf::io
