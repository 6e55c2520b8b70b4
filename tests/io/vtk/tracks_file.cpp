// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/tracks_file.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include <cmath>

#include "io_test.h"
#include "some_tracks.h"

namespace surf::io {
namespace {

using test::complaint;
using test::TemporaryFolder;
using testing::HasSubstr;

class WrittenTracks : public testing::Test {
 protected:
  vtkPolyData* write_and_read(const std::vector<Track>& tracks,
                              const std::map<std::string, std::string>& metadata = {}) {
    const auto path = folder_.path() / "t.vtp";
    write_tracks(path, tracks, metadata);
    EXPECT_EQ(test::files_in(folder_.path()), 1);
    EXPECT_EQ(test::content_of(path).find("AppendedData"), std::string::npos)
        << "Debian's ParaView cannot read it";
    reader_->SetFileName(path.c_str());
    reader_->Update();
    return reader_->GetOutput();
  }

  std::vector<double> cell_values(const char* name) {
    vtkDataArray* const array = reader_->GetOutput()->GetCellData()->GetArray(name);
    if (!array) return {};
    std::vector<double> values;
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i) {
      values.push_back(array->GetComponent(i, 0));
    }
    return values;
  }

  TemporaryFolder folder_;
  vtkNew<vtkXMLPolyDataReader> reader_;
};

TEST_F(WrittenTracks, AreLinesWithTheirPoints) {
  const auto tracks = test::two_tracks();
  vtkPolyData* const data = write_and_read(tracks);
  ASSERT_EQ(data->GetNumberOfCells(), 2);
  ASSERT_EQ(data->GetNumberOfPoints(), 7);
  EXPECT_EQ(data->GetCell(0)->GetNumberOfPoints(), 5);
  vtkIdType point = 0;
  for (const Track& track : tracks) {
    for (const Vec3& p : track.points_nm) {
      double q[3];
      data->GetPoint(point++, q);
      EXPECT_EQ((Vec3{q[0], q[1], q[2]}), p);
    }
  }
}

TEST_F(WrittenTracks, CarryEnergyAndMaterialAtTheirPoints) {
  vtkPointData* const points = write_and_read(test::two_tracks())->GetPointData();
  vtkDataArray* const energy = points->GetArray("energy_ev");
  vtkDataArray* const material = points->GetArray("material");
  ASSERT_TRUE(energy && material);
  const std::vector<double> energies{1000, 1010, 900.5, 880, 870, 12, 0};
  const std::vector<double> materials{-1, -1, 0, 1, -1, 1, 1};
  for (vtkIdType i = 0; i < 7; ++i) {
    EXPECT_EQ(energy->GetComponent(i, 0), energies[static_cast<std::size_t>(i)]);
    EXPECT_EQ(material->GetComponent(i, 0), materials[static_cast<std::size_t>(i)]);
  }
}

TEST_F(WrittenTracks, SayWhatTheyAre) {
  write_and_read(test::two_tracks());
  const double electron = std::ldexp(1.0, 40) + 7;
  EXPECT_EQ(cell_values("kind"), (std::vector<double>{2, 0}));
  EXPECT_EQ(cell_values("secondary"), (std::vector<double>{0, 1}));
  EXPECT_EQ(cell_values("generation"), (std::vector<double>{0, 1}));
  EXPECT_EQ(cell_values("electron"), (std::vector<double>{electron, electron}));
  EXPECT_EQ(cell_values("number"), (std::vector<double>{0, 1}));
  EXPECT_EQ(cell_values("parent"), (std::vector<double>{-1, 0}));
}

TEST_F(WrittenTracks, CarryMetadata) {
  const std::map<std::string, std::string> metadata{
      {"material", "Si & <Au>"}, {"note", "two\nlines, \xC2\xB5m"}, {"empty", ""}};
  vtkFieldData* const fields = write_and_read(test::two_tracks(), metadata)->GetFieldData();
  for (const auto& [key, value] : metadata) {
    auto* const array = vtkStringArray::SafeDownCast(fields->GetAbstractArray(key.c_str()));
    ASSERT_TRUE(array && array->GetNumberOfValues() == 1) << key;
    EXPECT_EQ(array->GetValue(0), value);
  }
}

TEST_F(WrittenTracks, NoneAreAnEmptyDataSet) {
  EXPECT_EQ(write_and_read({})->GetNumberOfCells(), 0);
}

TEST(TracksFile, TheSameTracksGiveTheSameBytes) {
  const TemporaryFolder folder;
  for (const char* name : {"a.vtp", "b.vtp"}) {
    write_tracks(folder.path() / name, test::random_walks(20), {{"seed", "5"}});
  }
  EXPECT_EQ(test::content_of(folder.path() / "a.vtp"), test::content_of(folder.path() / "b.vtp"));
}

TEST(TracksFile, RefusesInvalidTracksAndNames) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "t.vtp";
  const auto refusal = [&](const auto& spoil) {
    std::vector<Track> tracks = test::two_tracks();
    spoil(tracks[1]);
    return complaint<InvalidInput>([&] { write_tracks(path, tracks); });
  };
  EXPECT_THAT(refusal([](Track& t) { t.points_nm.pop_back(); }), HasSubstr("1 points"));
  EXPECT_THAT(refusal([](Track& t) { t.energy_ev.pop_back(); }), HasSubstr("1 energies"));
  EXPECT_THAT(refusal([](Track& t) { t.material.push_back(0); }), HasSubstr("2 materials"));
  EXPECT_THAT(refusal([](Track& t) { t.points_nm[1].z = NAN; }), HasSubstr("point 1"));
  EXPECT_THAT(refusal([](Track& t) { t.energy_ev[0] = -1; }), HasSubstr("-1 eV"));
  EXPECT_THAT(complaint<UsageError>([&] { write_tracks(folder.path() / "t.vtk", {}); }),
              HasSubstr(".vtp"));
  EXPECT_THAT(complaint<UsageError>([&] { check_tracks_target(folder.path() / "t.png"); }),
              HasSubstr(".vtp"));
  EXPECT_EQ(test::files_in(folder.path()), 0);
  check_tracks_target(folder.path() / "new" / "t.VTP");
}

}  // namespace
}  // namespace surf::io
