// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/libraries.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "library_page.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/sim/materials.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

using mc::CascadeLibrary;
using mc::CascadePage;
using mc::CascadeSettings;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
namespace fs = std::filesystem;

constexpr std::size_t page_size = CascadeLibrary::page_cascades;

/// Few secondaries, so that pages are made quickly.
CascadeSettings quick() {
  CascadeSettings settings;
  settings.material = io::find_material("Si", "test");
  settings.start_energy_ev = 100 + settings.material.barrier_ev;
  return settings;
}

std::shared_ptr<const CascadeLibrary> get(CachedLibraries& libraries, const CascadeSettings& s,
                                          std::size_t cascades, int threads = 1) {
  return libraries.library(s, cascades, threads, {});
}

std::vector<std::uint64_t> words(const CascadeLibrary& library) {
  std::vector<std::uint64_t> all;
  for (std::size_t i = 0; i < library.cascades(); ++i) {
    const auto cascade = library.cascade(i);
    all.insert(all.end(), cascade.begin(), cascade.end());
  }
  return all;
}

std::vector<std::uint64_t> fresh(const CascadeSettings& settings, std::size_t cascades) {
  CascadeLibrary library(settings);
  library.grow(cascades, 1);
  return words(library);
}

class LibrariesTest : public testing::Test {
 protected:
  /// What another run of the program gets, and what it says.
  std::vector<std::uint64_t> run(std::size_t cascades = 1) {
    CachedLibraries libraries(folder.path());
    const auto library = get(libraries, quick(), cascades);
    pages = libraries.pages();
    notes = libraries.take_notes();
    return words(*library);
  }
  void expect_pages(std::size_t loaded, std::size_t made) const {
    EXPECT_EQ(pages.loaded, loaded);
    EXPECT_EQ(pages.made, made);
  }
  /// Puts other bytes under the key of a page, with the right checksum.
  void put(std::size_t page, const std::vector<std::byte>& bytes) {
    io::Cache(folder.path()).store(mc::cascade_page_key(quick(), page), bytes);
  }

  TemporaryFolder folder;
  CachedLibraries::Pages pages;
  std::vector<std::string> notes;
};

TEST_F(LibrariesTest, FromTheCacheAreWordForWordAsMadeAfresh) {
  const auto expected = fresh(quick(), 2 * page_size);
  EXPECT_EQ(run(2 * page_size), expected);
  expect_pages(0, 2);
  EXPECT_EQ(run(2 * page_size), expected);
  expect_pages(2, 0);
  EXPECT_THAT(notes, IsEmpty());
}

TEST_F(LibrariesTest, GrowToTheSameInStepsAndOnAnyNumberOfThreads) {
  const auto expected = fresh(quick(), 3 * page_size);
  CachedLibraries libraries(folder.path());
  EXPECT_EQ(get(libraries, quick(), 1, 3)->cascades(), page_size);
  const auto all = get(libraries, quick(), 2 * page_size + 1, 2);
  EXPECT_EQ(all->cascades(), 3 * page_size);
  EXPECT_EQ(words(*all), expected);
  // Who asked for more before does not matter.
  EXPECT_EQ(get(libraries, quick(), page_size)->cascades(), page_size);
  EXPECT_EQ(libraries.pages().made, 3u);
  EXPECT_EQ(run(3 * page_size), expected);
  expect_pages(3, 0);
}

TEST_F(LibrariesTest, WithoutACacheAreTheSame) {
  CachedLibraries libraries({});
  EXPECT_EQ(words(*get(libraries, quick(), 1)), fresh(quick(), 1));
  EXPECT_THAT(libraries.take_notes(), IsEmpty());
}

TEST_F(LibrariesTest, ThatCannotBeStoredAreTheSameWithANote) {
  io::write_text(folder.path() / "file", "in the way");
  CachedLibraries libraries(folder.path() / "file");
  EXPECT_EQ(words(*get(libraries, quick(), 2 * page_size)), fresh(quick(), 2 * page_size));
  EXPECT_THAT(libraries.take_notes(), ElementsAre(HasSubstr("Nothing is kept")));
  get(libraries, quick(), 3 * page_size);
  EXPECT_THAT(libraries.take_notes(), IsEmpty()) << "once is enough";
}

TEST_F(LibrariesTest, DamagedOnTheDiskAreMadeAgain) {
  const auto expected = run(2 * page_size);
  const fs::path file = io::Cache(folder.path()).list().at(0).path;
  const std::string sound = io::read_file(file);
  std::string flipped = sound;
  flipped[sound.size() / 2] ^= 1;
  for (const std::string& bytes : {flipped, sound.substr(0, sound.size() / 2), std::string("x")}) {
    io::write_text(file, bytes);
    EXPECT_EQ(run(2 * page_size), expected);
    expect_pages(1, 1);
    EXPECT_THAT(notes, ElementsAre(HasSubstr("was damaged")));
    EXPECT_EQ(io::read_file(file), sound);
  }
}

// The checksum is right, the content is not.
TEST_F(LibrariesTest, ForeignContentIsNeverTaken) {
  const auto expected = fresh(quick(), 1);
  CascadeLibrary library(quick());
  const auto page = page_to_bytes(library.make_page(0, 1));
  const auto expect_refused = [&](const std::vector<std::byte>& bytes, const char* reason) {
    put(0, bytes);
    EXPECT_EQ(run(), expected) << reason;
    expect_pages(0, 1);
    EXPECT_THAT(notes, ElementsAre(HasSubstr(reason)));
    EXPECT_EQ(run(), expected);
    expect_pages(1, 0);
  };
  expect_refused({}, "cut off");
  expect_refused({page.begin(), page.end() - 1}, "cut off");
  std::vector<std::byte> longer = page;
  longer.push_back({});
  expect_refused(longer, "cut off");
  std::vector<std::byte> huge = page;
  for (std::size_t i = 0; i < 16; ++i) huge[i] = std::byte{0xff};
  expect_refused(huge, "cut off");
  expect_refused(page_to_bytes(library.make_page(1, 1)), "another version");
  CascadePage other = *page_from_bytes(page);  // a later cascade says it has more words
  other.words[other.starts[page_size - 1] + 1] ^= std::uint64_t{1} << 33;
  expect_refused(page_to_bytes(other), "not cascades");
}

TEST_F(LibrariesTest, OfAnotherVersionAreMadeAgain) {
  // As if a model had changed without the format's version: the same key, other numbers.
  CascadeSettings other = quick();
  other.material.loss_join_ev += 1;
  put(0, page_to_bytes(CascadeLibrary(other).make_page(0, 1)));
  EXPECT_EQ(run(), fresh(quick(), 1));
  expect_pages(0, 1);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("another version of semsurf")));
}

TEST_F(LibrariesTest, CanBeMadeByProcessesAtOnce) {
  const auto expected = fresh(quick(), 2 * page_size);
  std::vector<pid_t> children;
  for (int i = 0; i < 3; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      CachedLibraries libraries(folder.path());
      const auto library = get(libraries, quick(), 2 * page_size);
      _exit(words(*library) == expected && libraries.take_notes().empty() ? 0 : 1);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  EXPECT_EQ(run(2 * page_size), expected);
  expect_pages(2, 0);
}

TEST_F(LibrariesTest, TellHowFarTheyAreAndCanBeCancelled) {
  CachedLibraries libraries(folder.path());
  double last = 0;
  CancelToken cancel;
  const auto watch = [&](double done, double total) {
    EXPECT_EQ(total, 3.0 * page_size - 5);
    EXPECT_GE(done, last);
    EXPECT_LE(done, total);
    last = done;
    if (done > page_size) cancel.cancel();
  };
  EXPECT_THROW(libraries.library(quick(), 3 * page_size - 5, 1, {watch, &cancel}), Interrupted);
  EXPECT_EQ(libraries.pages().made, 1u) << "whole pages are kept";
  const auto library =
      libraries.library(quick(), 3 * page_size - 5, 1, {[&](double done, double) { last = done; }});
  EXPECT_EQ(last, 3.0 * page_size - 5);
  EXPECT_EQ(words(*library), fresh(quick(), 3 * page_size));
}

TEST_F(LibrariesTest, RefuseWhatNoLibraryCanBe) {
  CachedLibraries libraries(folder.path());
  CascadeSettings settings = quick();
  settings.physics.loss = mc::LossModel::none;
  EXPECT_THROW(get(libraries, settings, 1), UsageError);
  settings = quick();
  settings.start_energy_ev = 1;
  EXPECT_THROW(get(libraries, settings, 1), UsageError);
}

TEST(LibraryKey, ChangesWithAllThatTheCascadesDependOn) {
  const CascadeSettings settings = quick();
  const std::string key = mc::cascade_page_key(settings, 0);
  const auto changed = [&](const std::function<void(CascadeSettings&)>& change) {
    CascadeSettings other = settings;
    change(other);
    return mc::cascade_page_key(other, 0) != key;
  };
  EXPECT_NE(mc::cascade_page_key(settings, 1), key);
  EXPECT_TRUE(changed([](auto& s) { s.seed = 2; }));
  EXPECT_TRUE(changed([](auto& s) { s.start_energy_ev += 1e-9; }));
  EXPECT_TRUE(changed([](auto& s) { s.physics.elastic = mc::ElasticModel::browning; }));
  EXPECT_TRUE(changed([](auto& s) { s.physics.secondaries = false; }));
  EXPECT_TRUE(changed([](auto& s) { s.physics.barrier = mc::BarrierModel::classical; }));
  EXPECT_TRUE(changed([](auto& s) { s.physics.cutoff_ev = 60; }));
  EXPECT_TRUE(changed([](auto& s) { s.material.density_g_cm3 += 1e-9; }));
  EXPECT_TRUE(changed([](auto& s) { s.material.formula_weight_g_mol += 1e-9; }));
  EXPECT_TRUE(changed([](auto& s) { s.material.work_function_ev += 1e-9; }));
  EXPECT_TRUE(changed([](auto& s) { s.material.barrier_ev += 1e-9; }));
  EXPECT_TRUE(changed([](auto& s) { s.material.valence_electrons += 1; }));
  EXPECT_TRUE(changed([](auto& s) { s.material.plasmon_ev = 0; }));
  EXPECT_TRUE(changed([](auto& s) { s.material.loss_join_ev += 1e-9; }));
  EXPECT_TRUE(changed([](auto& s) { s.material.constituents[0].atomic_number = 13; }));
  EXPECT_TRUE(changed([](auto& s) { s.material.constituents[0].atomic_weight += 1e-9; }));
  EXPECT_TRUE(changed([](auto& s) { s.material.constituents[0].weight_fraction -= 1e-9; }));
  EXPECT_TRUE(changed([](auto& s) { s.material.constituents[0].mean_ionization_ev += 1e-9; }));
  EXPECT_TRUE(
      changed([](auto& s) { s.material.constituents.push_back(s.material.constituents[0]); }));
  // What is only said about a material, and the cutoff that holds anyway, change nothing.
  EXPECT_FALSE(changed([](auto& s) { s.material.sources = "hearsay"; }));
  EXPECT_FALSE(changed([](auto& s) { s.material.estimates = {{"plasmon_ev", "a rule"}}; }));
  EXPECT_FALSE(changed(
      [](auto& s) { s.physics.cutoff_ev = mc::effective_cutoff_ev(s.physics, s.material); }));
}

}  // namespace
}  // namespace surf::workflow
