// SPDX-License-Identifier: GPL-3.0-or-later
#include "checkpoint.h"

#include <gmock/gmock.h>

#include "simulation_setup.h"
#include "small_job.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/mc/results/serialize.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;
namespace fs = std::filesystem;

mc::UnitTally tally_of(std::int64_t primaries) {
  mc::UnitTally tally;
  tally.pixels = Grid<mc::PixelTally>(1, 1, {primaries, primaries});
  tally.counts = {Grid<mc::Counts>(1, 1, {primaries, 2 * primaries})};
  tally.balance.incident = primaries;
  return tally;
}

class CheckpointTest : public testing::Test {
 protected:
  std::unique_ptr<Checkpoint> open(const Identity& identity) {
    said.clear();
    const auto say = [this](const std::string& text) { said += text + "\n"; };
    return std::make_unique<Checkpoint>(options, folder.path() / "image.exr", identity, say, say);
  }
  // Records units [first, end), in one block each.
  void record(Checkpoint& checkpoint, std::size_t first, std::size_t end) {
    checkpoint.expect(1000);
    for (std::size_t unit = first; unit < end; ++unit) {
      checkpoint.record(unit, tally_of(static_cast<std::int64_t>(unit) + 1));
      checkpoint.keep();
    }
  }
  std::vector<std::size_t> recalled(Checkpoint& checkpoint, std::size_t units) {
    std::vector<std::size_t> found;
    for (std::size_t unit = 0; unit < units; ++unit) {
      mc::UnitTally tally;
      if (!checkpoint.recall(unit, tally)) continue;
      EXPECT_EQ(mc::serialize(tally), mc::serialize(tally_of(static_cast<std::int64_t>(unit) + 1)));
      found.push_back(unit);
    }
    return found;
  }

  TemporaryFolder folder;
  CheckpointOptions options;
  Identity job{{"electrons", "100"}, {"geometry", "aa"}};
  std::string said;
};

TEST_F(CheckpointTest, GivesBackWhatItWasTold) {
  auto first = open(job);
  record(*first, 4, 8);
  record(*first, 0, 2);
  const fs::path path = first->path();
  first.reset();
  EXPECT_TRUE(fs::exists(path));
  EXPECT_EQ(path,
            checkpoint_path(folder.path() / "another.exr", job).parent_path() / path.filename());

  auto second = open(job);
  EXPECT_THAT(said, HasSubstr("resuming: 2 % is done"));  // 1 + 2 + 5 + 6 + 7 + 8 of 1000
  EXPECT_THAT(recalled(*second, 10), testing::ElementsAre(0, 1, 4, 5, 6, 7));
  record(*second, 2, 4);
  second.reset();
  auto third = open(job);
  EXPECT_THAT(recalled(*third, 10), testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  third->finish();
  EXPECT_FALSE(fs::exists(path));
}

TEST_F(CheckpointTest, IsNotBegunByShortJobs) {
  auto checkpoint = open(job);
  checkpoint->record(0, tally_of(1));
  EXPECT_FALSE(fs::exists(checkpoint->path()));
  EXPECT_TRUE(checkpoint->keep());
  EXPECT_TRUE(fs::exists(checkpoint->path()));
}

TEST_F(CheckpointTest, LosesOnlyWhatIsDamaged) {
  auto first = open(job);
  const fs::path path = first->path();
  record(*first, 0, 4);
  first.reset();
  std::string bytes = bytes_of(path);
  const std::size_t block =
      bytes.rfind("semsurfB") - bytes.rfind("semsurfB", bytes.rfind("semsurfB") - 1);
  bytes[bytes.size() - block - 1] ^= 1;  // the last byte of the last block but one
  io::write_text(path, bytes);
  auto second = open(job);
  EXPECT_THAT(said, HasSubstr("damaged"));
  EXPECT_THAT(recalled(*second, 4), testing::ElementsAre(0, 1, 3));
  second.reset();

  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    io::write_text(path, bytes.substr(0, size));
    auto cut = open(job);
    recalled(*cut, 4);
    record(*cut, 4, 5);
    cut.reset();
    auto again = open(job);
    EXPECT_THAT(recalled(*again, 5), testing::Contains(4)) << size;
    EXPECT_THAT(said, testing::Not(HasSubstr("anew"))) << size;
  }
}

TEST_F(CheckpointTest, OfAnotherJobIsNeitherUsedNorTouched) {
  auto first = open(job);
  record(*first, 0, 2);
  const fs::path path = first->path();
  first.reset();
  const std::string bytes = bytes_of(path);

  Identity other = job;
  other["electrons"] = "200";
  EXPECT_TRUE(recalled(*open(other), 2).empty());
  EXPECT_THAT(said, HasSubstr("different: electrons 100 there and 200 here"));

  options.file = path;
  EXPECT_THROW(open(other), FileError);
  EXPECT_EQ(bytes_of(path), bytes);
  options.restart = true;
  EXPECT_TRUE(recalled(*open(other), 2).empty());
  EXPECT_EQ(bytes_of(path), "");

  io::write_text(path, "precious");
  EXPECT_THROW(open(job), FileError);
  EXPECT_EQ(bytes_of(path), "precious");
}

TEST_F(CheckpointTest, IsHeldByOneAtATime) {
  auto first = open(job);
  record(*first, 0, 1);
  EXPECT_THROW(open(job), FileError);
  first.reset();
  EXPECT_NO_THROW(open(job));
}

TEST_F(CheckpointTest, ThatCannotBeWrittenIsAWarning) {
  options.file = folder.path() / "missing" / "file.checkpoint";
  auto checkpoint = open(job);
  record(*checkpoint, 0, 3);
  EXPECT_THAT(said, HasSubstr("The job goes on"));
  EXPECT_EQ(said.find("The job goes on"), said.rfind("The job goes on"));
  EXPECT_FALSE(checkpoint->keep());
}

TEST(JobIdentity, ChangesWithWhatChangesTheResult) {
  const SimulateJob job = small_job();
  const Identity identity = identity_of(resolve(job), {{"seed", "1"}});
  const auto differs = [&](auto change) {
    SimulateJob other = job;
    change(other);
    return fingerprint(identity_of(resolve(other), {{"seed", "1"}})) != fingerprint(identity);
  };
  EXPECT_TRUE(
      differs([](SimulateJob& j) { j.scene.specimen.bodies[0].mesh.vertices_nm[3].x += 1e-9; }));
  EXPECT_TRUE(
      differs([](SimulateJob& j) { j.scene.specimen.bodies[0].mesh.triangles.pop_back(); }));
  EXPECT_TRUE(differs([](SimulateJob& j) { j.spectra = true; }));
  EXPECT_TRUE(differs([](SimulateJob& j) { j.execution.tile_pixels = 5; }));
  EXPECT_FALSE(differs([](SimulateJob& j) { j.execution.threads = 5; }));
  EXPECT_FALSE(differs([](SimulateJob& j) { j.outputs = {"elsewhere.tif"}; }));
  EXPECT_NE(fingerprint(identity), fingerprint(identity_of(resolve(job), {{"seed", "2"}})));
}

TEST(JobIdentity, SaysWhatDiffers) {
  EXPECT_EQ(difference({{"a", "1"}}, {{"a", "1"}}), "");
  EXPECT_EQ(difference({{"a", "1"}}, {{"a", "2"}, {"b", "3"}}), "a 1 there and 2 here, and 1 more");
  EXPECT_EQ(difference({{"dose", "1"}}, {}), "dose 1 there and not given here");
  EXPECT_EQ(difference({{"geometry", "1"}}, {{"geometry", "2"}}), "the specimen");
}

}  // namespace
}  // namespace surf::workflow
