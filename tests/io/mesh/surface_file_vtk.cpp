// SPDX-License-Identifier: GPL-3.0-or-later
// What VTK's own readers find in VTP and VTM files.
#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPolyDataReader.h>

#include "io_test.h"
#include "surf/io/mesh_file.h"
#include "surface_scenes.h"

namespace surf::io {
namespace {

using test::complaint;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

TEST(SurfaceFileVtk, VtpHasArraysUnitsAndFieldData) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "f.vtp";
  const SurfaceScene scene = test::two_letters();
  write_surfaces(path, scene);
  EXPECT_THAT(test::content_of(path), Not(HasSubstr("appended"))) << "ParaView could not read it";
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkPolyData* const data = reader->GetOutput();
  const auto points = static_cast<vtkIdType>(2 * scene.surfaces[0].mesh.vertices_nm.size());
  EXPECT_EQ(data->GetNumberOfPoints(), points);
  EXPECT_EQ(data->GetPointData()->GetScalars()->GetName(), std::string("height"));
  vtkDataArray* const curvature = data->GetPointData()->GetArray("curvature_2");
  ASSERT_TRUE(curvature);
  EXPECT_EQ(curvature->GetInformation()->Get(vtkDataArray::UNITS_LABEL()), std::string("1/nm"));
  EXPECT_EQ(curvature->GetTuple1(points / 2), double{scene.surfaces[1].scalars[2].values[0]});
  ASSERT_TRUE(data->GetPointData()->GetNormals());
  double normal[3];
  data->GetPointData()->GetNormals()->GetTuple(0, normal);
  EXPECT_NEAR(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2], 1, 1e-6);
  ASSERT_TRUE(data->GetPointData()->GetTCoords());
  vtkDataArray* const surface = data->GetCellData()->GetArray("surface");
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->GetTuple1(0), 0);
  EXPECT_EQ(surface->GetTuple1(data->GetNumberOfCells() - 1), 1);
  const auto text = [&](const char* name) {
    const auto* array = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray(name));
    return array ? std::string(const_cast<vtkStringArray*>(array)->GetValue(0))
                 : std::string("none");
  };
  EXPECT_EQ(text("surface:unit_nm"), "1");
  EXPECT_EQ(text("semsurf:title"), scene.metadata.at("title"));
}

TEST(SurfaceFileVtk, VtmHasNamedBlocksOfEveryKind) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "f.vtm";
  const SurfaceScene scene = test::two_letters();
  write_surfaces(path, scene);
  EXPECT_EQ(test::files_in(folder.path()), 5);
  EXPECT_EQ(mesh_input_files(path).size(), 5u);
  vtkNew<vtkXMLMultiBlockDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  auto* const blocks = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutput());
  ASSERT_TRUE(blocks);
  ASSERT_EQ(blocks->GetNumberOfBlocks(), 4u);
  EXPECT_EQ(blocks->GetMetaData(1u)->Get(vtkCompositeDataSet::NAME()), scene.surfaces[1].name);
  EXPECT_TRUE(vtkPolyData::SafeDownCast(blocks->GetBlock(0)));
  auto* const picture = vtkImageData::SafeDownCast(blocks->GetBlock(2));
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->GetPointData()->GetScalars()->GetTuple1(4),
            1.0 * scene.surfaces[1].drape->grey(1, 1));
  EXPECT_EQ(picture->GetSpacing()[0], 1.25);
  auto* const tracks = vtkPolyData::SafeDownCast(blocks->GetBlock(3));
  ASSERT_TRUE(tracks);
  EXPECT_EQ(tracks->GetNumberOfLines(), 2);
}

TEST(SurfaceFileVtk, VtmNamesFilesInItsFolderOnly) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "f.vtm";
  SurfaceScene scene = test::two_letters();
  write_surfaces(path, scene);
  const std::string text = test::content_of(path);
  const std::string part = "f_surface1.vtp";
  for (const char* other : {"../x.vtp", "/x.vtp", "a/../../x.vtp"}) {
    std::string changed = text;
    changed.replace(changed.find(part), part.size(), other);
    test::write(path, changed);
    EXPECT_THAT(complaint<FileError>([&] { read_surfaces(path); }), HasSubstr("below the folder"));
  }
  std::string changed = text;
  changed.replace(changed.find(part), part.size(), "f.vtu");
  test::write(path, changed);
  EXPECT_THAT(complaint<Unsupported>([&] { read_meshes(path); }), HasSubstr("f.vtu"));
  test::write(path, text);
  std::filesystem::remove(folder.path() / part);
  EXPECT_THAT(complaint<FileError>([&] { read_meshes(path); }), HasSubstr(part));
}

TEST(SurfaceFileVtk, BlocksMayLieInBlocksAndBeOfOthers) {
  const TemporaryFolder folder;
  write_mesh(folder.path() / "a.vtp", test::letter_f_triangles());
  test::write(folder.path() / "f.vtm",
              "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet><Block "
              "index=\"0\" "
              "name=\"outer\"><DataSet index=\"0\" name=\"inner\" file=\"./a.vtp\"/><DataSet "
              "index=\"1\"/></Block>"
              "</vtkMultiBlockDataSet></VTKFile>\n");
  const SurfaceScene scene = read_surfaces(folder.path() / "f.vtm");
  ASSERT_EQ(scene.surfaces.size(), 1u);
  EXPECT_EQ(scene.surfaces[0].name, "a") << "the file's own name comes before that of the block";
  EXPECT_EQ(test::corners(scene.surfaces[0].mesh), test::corners(test::letter_f_triangles()));
}

}  // namespace
}  // namespace surf::io
