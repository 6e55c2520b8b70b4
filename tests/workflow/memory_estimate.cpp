// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/memory_estimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdlib>

#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/mesh_file.h"
#include "surf/mesh/shapes.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using testing::HasSubstr;

class MemoryEstimateTest : public testing::Test {
 protected:
  ~MemoryEstimateTest() override { unsetenv("SEMSURF_MEMORY"); }
};

TEST_F(MemoryEstimateTest, CountsTrianglesByHeaderOrSize) {
  const test::TemporaryFolder folder;
  const TriangleMesh sphere = make_sphere({0, 0, 0}, 100, 5);
  for (const char* name : {"s.stl", "s.ply"}) {
    const auto path = folder.path() / name;
    io::write_mesh(path, sphere, 1);
    const auto found = triangles_in(path);
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(found->triangles, sphere.triangles.size()) << name;
    EXPECT_EQ(found->source == TriangleSource::soup, std::string(name) == "s.stl") << name;
  }
  for (const char* name : {"s.obj", "s.off"}) {
    const auto path = folder.path() / name;
    io::write_mesh(path, sphere, 1);
    const double share = double(triangles_in(path)->triangles) / double(sphere.triangles.size());
    EXPECT_GT(share, 0.6) << name;
    EXPECT_LT(share, 1.7) << name;
  }
  EXPECT_FALSE(triangles_in(folder.path() / "none.stl"));
}

TEST_F(MemoryEstimateTest, DoesNotBelieveAHeaderThatTheFileCannotHold) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "lie.ply";
  io::write_text(path,
                 "ply\nformat ascii 1.0\nelement vertex 3\nelement face 4000000000\nend_header\n");
  EXPECT_LT(triangles_in(path)->triangles, 100u);
}

TEST_F(MemoryEstimateTest, GrowsWithProcessesByWhatIsNotShared) {
  const TriangleCount count{1'000'000};
  const MemoryEstimate one = estimate_specimen(count, {1, 2}),
                       four = estimate_specimen(count, {4, 2});
  EXPECT_EQ(one.specimen, four.specimen);
  EXPECT_EQ(4 * one.ray_tracing, four.ray_tracing);
  EXPECT_EQ(one.total(), one.specimen + one.ray_tracing + one.program);
}

TEST_F(MemoryEstimateTest, RefusesWhatDoesNotFit) {
  setenv("SEMSURF_MEMORY", "1GB", 1);
  EXPECT_NO_THROW(require_memory("small.ply", {1'000'000}));
  EXPECT_THAT([] { require_memory("large.ply", {100'000'000}); },
              testing::ThrowsMessage<InvalidInput>(
                  testing::AllOf(HasSubstr("large.ply"), HasSubstr("100 million triangles"),
                                 HasSubstr("1.00 GB are there by SEMSURF_MEMORY"))));
  setenv("SEMSURF_MEMORY", "1MB", 1);
  EXPECT_THAT(
      [] { require_memory("cube.off", {7}); },
      testing::ThrowsMessage<InvalidInput>(testing::AllOf(
          HasSubstr("cube.off: this mesh and the program need about 0.19 GB"),
          HasSubstr("less than 0.01 GB is there"), HasSubstr("Make more memory available"))));
  setenv("SEMSURF_MEMORY", "off", 1);
  EXPECT_NO_THROW(require_memory("large.ply", {1'000'000'000}));
  for (const char* bad : {"", "much", "-1GB", "0", "5 apples", "1e300GB"}) {
    setenv("SEMSURF_MEMORY", bad, 1);
    EXPECT_THROW(memory_there(), UsageError) << bad;
  }
}

TEST_F(MemoryEstimateTest, KnowsWhatThereIs) {
  const MemoryThere whole = memory_there();
  EXPECT_GT(whole.bytes, std::size_t{1} << 20);
  EXPECT_LT(whole.bytes, std::size_t{1} << 50);
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  constexpr std::size_t bytes = std::size_t{1} << 32;  // below what machines have
  const rlimit less{bytes, before.rlim_max};
  if (before.rlim_max != RLIM_INFINITY && before.rlim_max < less.rlim_cur)
    GTEST_SKIP() << "there is a lower limit of address space already";
  ASSERT_EQ(setrlimit(RLIMIT_AS, &less), 0);
  const MemoryThere there = memory_there();
  setrlimit(RLIMIT_AS, &before);
  EXPECT_LE(there.bytes, bytes);
  EXPECT_NE(there.limit.find("ulimit"), std::string::npos) << there.limit;
}

}  // namespace
}  // namespace surf::workflow
