// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/library_list.h"

#include <gmock/gmock.h>

#include "surf/io/files.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/cascades/cascade_library.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

mc::CascadeSettings settings_of(const char* material, double beam_ev) {
  mc::CascadeSettings settings;
  settings.material = io::find_material(material, "test");
  settings.start_energy_ev = beam_ev + settings.material.barrier_ev;
  return settings;
}

class LibraryListTest : public testing::Test {
 protected:
  void store(const mc::CascadeSettings& settings, std::size_t page) {
    cache.store(mc::cascade_page_key(settings, page), std::vector<std::byte>(1000));
  }
  LibraryList list(io::Cache::Check check = io::Cache::Check::header) const {
    return list_libraries(cache, check);
  }

  test::TemporaryFolder folder;
  io::Cache cache{folder.path()};
};

TEST_F(LibraryListTest, PutsPagesTogether) {
  EXPECT_THAT(list().libraries, IsEmpty());
  for (const std::size_t page : {2, 0, 1}) store(settings_of("Si", 1000), page);
  store(settings_of("Si", 500), 0);
  store(settings_of("Au", 1000), 0);
  cache.store("what = something else\n", {});
  const auto found = list().libraries;
  ASSERT_THAT(found, SizeIs(3));
  EXPECT_EQ(found[0].name.material, "Au");
  EXPECT_NEAR(found[1].name.beam_energy_ev, 500, 1e-9);
  const StoredLibrary& si = found[2];
  EXPECT_EQ(si.name.material, "Si");
  EXPECT_NEAR(si.name.beam_energy_ev, 1000, 1e-9);
  EXPECT_EQ(si.name.number, 0u);
  EXPECT_TRUE(si.name.is_current);
  EXPECT_TRUE(si.name.is_usual_cutoff);
  EXPECT_EQ(si.cascades, 3 * mc::CascadeLibrary::page_cascades);
  ASSERT_THAT(si.pages, SizeIs(3));
  EXPECT_EQ(si.bytes, si.pages[0].bytes + si.pages[1].bytes + si.pages[2].bytes);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(mc::read_cascade_page_key(si.pages[i].key)->number, i);
}

TEST_F(LibraryListTest, TellsLibrariesApart) {
  mc::CascadeSettings settings = settings_of("Si", 1000);
  store(settings, 0);
  settings.seed = 2;
  store(settings, 0);
  settings.material.density_g_cm3 = 3;
  store(settings, 0);
  settings.physics.barrier = mc::BarrierModel::off;
  settings.physics.cutoff_ev = 70;
  settings.start_energy_ev = 1000;
  store(settings, 0);
  const auto found = list().libraries;
  ASSERT_THAT(found, SizeIs(4));
  std::size_t without_barrier = 0;
  for (const StoredLibrary& l : found) {
    EXPECT_NEAR(l.name.beam_energy_ev, 1000, 1e-9);
    if (l.name.physics.barrier != mc::BarrierModel::off) continue;
    ++without_barrier;
    EXPECT_FALSE(l.name.is_usual_cutoff);
    EXPECT_EQ(l.name.physics.cutoff_ev, 70);
  }
  EXPECT_EQ(without_barrier, 1u);
}

TEST_F(LibraryListTest, SetsWhatIsDamagedAside) {
  store(settings_of("Si", 1000), 0);
  store(settings_of("Si", 1000), 1);
  const auto path = list().libraries.at(0).pages.at(1).path;
  std::string bytes = io::read_file(path);
  bytes.back() ^= 1;
  io::write_text(path, bytes);
  EXPECT_THAT(list().damaged, IsEmpty()) << "the beginning is sound";
  const LibraryList checked = list(io::Cache::Check::everything);
  ASSERT_THAT(checked.damaged, SizeIs(1));
  EXPECT_EQ(checked.damaged[0].path, path);
  EXPECT_EQ(checked.libraries.at(0).cascades, mc::CascadeLibrary::page_cascades);
}

TEST_F(LibraryListTest, KnowsOtherVersions) {
  std::string key = mc::cascade_page_key(settings_of("Si", 1000), 0);
  const std::size_t at = key.find("format = ");
  key.replace(at, key.find('\n', at) - at, "format = 0");
  cache.store(key, {});
  cache.store("what = cascades of electrons\nformat = 99\nsomething = new\n", {});
  const auto found = list().libraries;
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_FALSE(found[0].name.is_current);
}

}  // namespace
}  // namespace surf::workflow
