// SPDX-License-Identifier: GPL-3.0-or-later
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataWriter.h>

#include <functional>

#include "io_test.h"
#include "mesh/letter_f_mesh.h"
#include "surf/io/mesh_file.h"

namespace surf::io {
namespace {

using test::complaint;
using test::corners;
using test::TemporaryFolder;
using test::write;
using testing::HasSubstr;

std::string array(const char* type, const char* name, const std::string& values,
                  const std::string& attributes = {}) {
  return fmt::format("<DataArray type=\"{}\" Name=\"{}\" format=\"ascii\" {}>{}</DataArray>\n",
                     type, name, attributes, values);
}

/// A VTP file as text: its points, then cells and fields as given.
std::string vtp(std::size_t points, const std::string& counts, const std::string& coordinates,
                const std::string& rest, const char* type = "Float64") {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<PolyData>\n<Piece NumberOfPoints=\"{}\" {}>\n"
      "<Points>{}</Points>\n{}</Piece>\n</PolyData>\n</VTKFile>\n",
      points, counts, array(type, "Points", coordinates, "NumberOfComponents=\"3\""), rest);
}

std::string cells(const char* kind, const std::string& corners, const std::string& offsets) {
  return fmt::format("<{}>\n{}{}</{}>\n", kind, array("Int64", "connectivity", corners),
                     array("Int64", "offsets", offsets), kind);
}

std::string coordinates_of_f() {
  std::string text;
  for (const Vec3& v : test::letter_f_triangles().vertices_nm) {
    text += fmt::format("{} {} {} ", v.x, v.y, v.z);
  }
  return text;
}

std::string vtp_of_f(const char* type) {
  const test::QuadMesh f = test::letter_f_quads();
  std::string list, offsets;
  for (std::size_t i = 0; i < f.quads.size(); ++i) {
    for (const std::uint32_t c : f.quads[i]) list += fmt::format("{} ", c);
    offsets += fmt::format("{} ", 4 * (i + 1));
  }
  return vtp(f.vertices.size(), fmt::format("NumberOfPolys=\"{}\"", f.quads.size()),
             coordinates_of_f(), cells("Polys", list, offsets), type);
}

const char* const square = "0 0 0  1 0 0  0 1 0  1 1 0  0 2 0";

std::vector<NamedMesh> read(const std::string& content) {
  const TemporaryFolder folder;
  return read_meshes(write(folder.path() / "part.vtp", content));
}

TEST(VtpFile, ReadsTheLetter) {
  for (const char* type : {"Float32", "Float64"}) {
    const auto meshes = read(vtp_of_f(type));
    ASSERT_EQ(meshes.size(), 1u);
    EXPECT_EQ(corners(meshes[0].mesh), corners(test::letter_f_triangles()));
    EXPECT_EQ(meshes[0].name, "part");
  }
}

TEST(VtpFile, ReadsStripsAndSkipsPointsAndLines) {
  const auto meshes = read(vtp(
      5, "NumberOfVerts=\"2\" NumberOfLines=\"1\" NumberOfPolys=\"1\" NumberOfStrips=\"1\"", square,
      cells("Verts", "0 1", "1 2") + cells("Lines", "0 1 2", "3") + cells("Polys", "0 2 1", "3") +
          cells("Strips", "0 1 2 3 4 4", "6")));
  const TriangleMesh expected{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}},
                              {{0, 2, 1}, {0, 1, 2}, {1, 3, 2}, {2, 3, 4}}};
  ASSERT_EQ(meshes.size(), 1u);
  EXPECT_EQ(corners(meshes[0].mesh), corners(expected));
}

/// Texts as VTK writes them: the characters' numbers, each text ended by 0.
std::string texts(const std::vector<std::string>& values) {
  std::string list;
  for (const std::string& value : values) {
    for (const char c : value) list += fmt::format("{} ", static_cast<int>(c));
    list += "0 ";
  }
  return array("String", "material", list, fmt::format("NumberOfTuples=\"{}\"", values.size()));
}

TEST(VtpFile, MaterialsMakeBodies) {
  const std::string polygons =
      cells("Verts", "0", "1") + cells("Polys", "0 1 2 1 3 2 2 3 4", "3 6 9");
  const char* const counts = "NumberOfVerts=\"1\" NumberOfPolys=\"3\"";
  const auto by_cell =
      read(vtp(5, counts, square,
               polygons + "<CellData>" + texts({"none", "Au", "Si", "Au"}) + "</CellData>"));
  ASSERT_EQ(by_cell.size(), 2u);
  EXPECT_EQ(by_cell[0].material, "Au");
  EXPECT_EQ(by_cell[0].mesh.triangles.size(), 2u);
  EXPECT_EQ(by_cell[1].material, "Si");
  EXPECT_EQ(by_cell[1].mesh.vertices_nm.front(), (Vec3{1, 0, 0}));

  const auto by_point =
      read(vtp(5, counts, square,
               polygons + "<PointData>" + texts({"Au", "Au", "C", "C", "C"}) + "</PointData>"));
  ASSERT_EQ(by_point.size(), 2u);
  EXPECT_EQ(by_point[0].material, "Au");
  EXPECT_EQ(by_point[1].material, "C");
}

/// Where VTK's writer is told how, and nothing else.
std::string written_by_vtk(const std::function<void(vtkXMLPolyDataWriter*)>& choose) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vec3& v : test::letter_f_triangles().vertices_nm)
    points->InsertNextPoint(v.x, v.y, v.z);
  vtkNew<vtkCellArray> polygons;
  for (const Triangle& t : test::letter_f_triangles().triangles) {
    polygons->InsertNextCell({vtkIdType{t[0]}, vtkIdType{t[1]}, vtkIdType{t[2]}});
  }
  vtkNew<vtkStringArray> materials;
  materials->SetName("material");
  materials->SetNumberOfValues(polygons->GetNumberOfCells());
  for (vtkIdType i = 0; i < materials->GetNumberOfValues(); ++i) materials->SetValue(i, "SiO2");
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(polygons);
  data->GetCellData()->AddArray(materials);
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(data);
  writer->WriteToOutputStringOn();
  choose(writer);
  writer->Write();
  return writer->GetOutputString();
}

TEST(VtpFile, ReadsAllThatVtkWrites) {
  for (const int order : {vtkXMLWriter::LittleEndian, vtkXMLWriter::BigEndian}) {
    for (const int header : {vtkXMLWriter::UInt32, vtkXMLWriter::UInt64}) {
      for (const int compressor : {vtkXMLWriter::NONE, vtkXMLWriter::ZLIB}) {
        for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended}) {
          for (const bool encoded : {false, true}) {
            SCOPED_TRACE(fmt::format("{} {} {} {} {}", order, header, compressor, mode, encoded));
            const auto meshes = read(written_by_vtk([&](vtkXMLPolyDataWriter* writer) {
              writer->SetByteOrder(order);
              writer->SetHeaderType(header);
              writer->SetCompressorType(compressor);
              writer->SetDataMode(mode);
              writer->SetEncodeAppendedData(encoded);
              writer->SetBlockSize(256);  // several blocks, the last one smaller
            }));
            ASSERT_EQ(meshes.size(), 1u);
            EXPECT_EQ(corners(meshes[0].mesh), corners(test::letter_f_triangles()));
            EXPECT_EQ(meshes[0].material, "SiO2");
          }
        }
      }
    }
  }
}

TEST(VtpFile, OtherCompressorsAreNotSupported) {
  const std::string content = written_by_vtk([](vtkXMLPolyDataWriter* writer) {
    writer->SetDataModeToBinary();
    writer->SetCompressorType(vtkXMLWriter::LZ4);
  });
  EXPECT_THAT(complaint<Unsupported>([&] { read(content); }), HasSubstr("LZ4"));
}

std::string refusal(const std::string& content) {
  const TemporaryFolder folder;
  return complaint<FileError>([&] { read_mesh(write(folder.path() / "a.vtp", content)); });
}

TEST(VtpFile, RefusesDamage) {
  const auto polygons = [](const std::string& corners, const std::string& offsets) {
    return vtp(5, "NumberOfPolys=\"1\"", square, cells("Polys", corners, offsets));
  };
  EXPECT_THAT(refusal(polygons("0 1 5", "3")), HasSubstr("point 5 of 5"));
  EXPECT_THAT(refusal(polygons("0 1 -1", "3")), HasSubstr("point -1 of 5"));
  EXPECT_THAT(refusal(polygons("0 1 nan", "3")), HasSubstr("point nan of 5"));
  EXPECT_THAT(refusal(polygons("0 1 2", "4")), HasSubstr("cell 0 ends at corner 4"));
  EXPECT_THAT(refusal(polygons("0 1 2", "-3")), HasSubstr("corner -3"));
  EXPECT_THAT(refusal(polygons("0 1 2", "")), HasSubstr("1 cells are announced"));
  EXPECT_THAT(refusal(vtp(5, "NumberOfPolys=\"1\"", square, "")), HasSubstr("Polys are missing"));
  EXPECT_THAT(refusal(vtp(6, "NumberOfPolys=\"1\"", square, "")), HasSubstr("6 points"));
  EXPECT_THAT(refusal(vtp(5, "NumberOfPolys=\"1e99\"", square, "")), HasSubstr("1e99"));
  EXPECT_THAT(refusal(polygons("0 1", "2")), HasSubstr("no triangles"));
  EXPECT_THAT(
      refusal(vtp(3, "NumberOfPolys=\"1\"", "0 0 0 nan 0 0 0 1 0", cells("Polys", "0 1 2", "3"))),
      HasSubstr("point 1 is not finite"));
  const std::string good = vtp_of_f("Float64");
  EXPECT_THAT(refusal(good.substr(0, good.size() / 2)), HasSubstr("cut off"));
  EXPECT_THAT(refusal(good + "<AppendedData encoding=\"raw\">"), HasSubstr("cut off"));
  EXPECT_THAT(refusal("not XML"), HasSubstr("XML is broken"));
  EXPECT_THAT(refusal("<VTKFile type=\"ImageData\"/>"), HasSubstr("type PolyData"));
}

}  // namespace
}  // namespace surf::io
