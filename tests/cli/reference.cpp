// SPDX-License-Identifier: GPL-3.0-or-later
// docs/reference is what the program says, its examples work, and results hold nothing that it does
// not name.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "in_process.h"
#include "pages.h"
#include "surf/io/image_file.h"
#include "surf/io/sim/scene_file.h"
#include "surf/io/sim/scene_keys.h"
#include "temporary_folder.h"

namespace surf::cli {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

io::SceneFile read(const std::string& toml) {
  const test::TemporaryFolder folder;
  for (const char* file : {"scan.txt", "cube.off"})
    fs::copy_file(fs::path(SEMSURF_CLI_DATA) / file, folder.path() / file);
  const fs::path scene = folder.path() / "scene.toml";
  std::ofstream(scene) << toml;
  return io::read_scene(scene);
}

TEST(Reference, IsUpToDate) {
  for (const auto& [name, text] : reference::pages()) {
    const fs::path file = fs::path(SEMSURF_REFERENCE) / name;
    const std::string there = text_of(file);
    if (there == text) continue;
    std::istringstream old(there), made(text);
    std::string before, now;
    int line = 0;
    do ++line, std::getline(old, before), std::getline(made, now);
    while (before == now && old && made);
    ADD_FAILURE() << file << ", line " << line
                  << " is not what the program says. Run: cmake --build build --target "
                     "reference\n"
                  << "file:    " << before << "\nprogram: " << now;
  }
}

TEST(Reference, HoldsNoPagesThatTheProgramNoLongerMakes) {
  for (const auto& entry : fs::directory_iterator(SEMSURF_REFERENCE)) {
    if (reference::pages().contains(entry.path().filename())) continue;
    EXPECT_THAT(text_of(entry.path()), testing::Not(testing::HasSubstr("Made by the program")))
        << entry.path();
  }
}

TEST(Reference, ExamplesOfSceneTablesAreRead) {
  for (const io::SceneTable& table : io::scene_tables()) {
    SCOPED_TRACE(table.example);
    const bool of_materials = table.example.starts_with("[[material]]");
    EXPECT_NO_THROW(
        read(table.example + (of_materials ? "\n[substrate]\nmaterial = \"Si\"\n" : "")));
    for (const io::SceneKey& key : table.keys) {
      if (key.otherwise == "required") {
        EXPECT_THAT(table.example, testing::HasSubstr(key.name + " ="));
      }
    }
  }
}

TEST(Reference, ExamplesOfItsPageAreRead) {
  const std::string page = reference::scene_files_page();
  static const std::regex block("```toml\n([^`]*)```");
  int count = 0;
  for (std::sregex_iterator it(page.begin(), page.end(), block), end; it != end; ++it, ++count) {
    std::string toml = (*it)[1];
    SCOPED_TRACE(toml);
    if (toml.find("[substrate]") == std::string::npos) toml += "\n[substrate]\nmaterial = \"Si\"\n";
    EXPECT_NO_THROW(read(toml));
  }
  EXPECT_EQ(count, 4 + static_cast<int>(io::scene_tables().size()));
}

TEST(Reference, RequiredKeysAreRequired) {
  for (const io::SceneTable& table : io::scene_tables()) {
    if (table.heading == "elements") continue;
    for (const io::SceneKey& key : table.keys) {
      if (key.otherwise != "required") continue;
      const std::string without =
          std::regex_replace(table.example, std::regex("\n" + key.name + " = [^\n]*"), "");
      ASSERT_NE(without, table.example);
      EXPECT_ANY_THROW(read(without)) << without;
    }
  }
}

/// Whether a name is one of those of the reference, where "N" is a number and "NAME" any name.
bool is_named(const std::string& name, const std::vector<reference::NamedEntry>& entries) {
  return std::ranges::any_of(entries, [&](const reference::NamedEntry& entry) {
    std::string pattern = std::regex_replace(entry.name, std::regex("\\."), "\\.");
    pattern = std::regex_replace(pattern, std::regex("\\bNAME\\b"), ".+");
    pattern = std::regex_replace(pattern, std::regex("\\bN\\b"), "\\d+");
    return std::regex_match(name, std::regex(pattern));
  });
}

TEST(Reference, NamesChannelsAndMetadataOfImages) {
  const test::TemporaryFolder folder;
  const fs::path data = SEMSURF_CLI_DATA, image = folder.path() / "image.exr";
  const std::vector<std::vector<std::string>> ways{
      {"--detector", "quadrants", "--current", "10pA", "--dwell", "1us"},
      {"--electrons", "2", "--substrate", "Si", "--channels",
       "z_nm,normal,material,electrons,model,variance_left"},
      {"--electrons", "8", "--estimate", "guided", "--channels", "counts,radius,plain"},
      {"--accuracy", "50%", "--method", "replay", "--mesh-tolerance", "1nm", "--unit", "um",
       "--override-unit"}};
  std::vector<reference::NamedEntry> channels = reference::image_channels();
  // It would be any name: the detectors are listed here.
  std::erase_if(channels, [](const auto& entry) { return entry.name == "NAME"; });
  for (const char* detector : {"SE", "BSE", "BSE-right", "BSE-top", "BSE-left", "BSE-bottom"})
    channels.push_back({detector, ""});
  const std::vector<reference::NamedEntry> metadata = reference::image_metadata();
  for (const std::vector<std::string>& way : ways) {
    std::vector<std::string> words{
        "simulate", data / "cube.off", "--size", "4x4", "--cache", "off", "-q", "-o", image};
    words.insert(words.end(), way.begin(), way.end());
    const test::Said said = test::semsurf(words);
    ASSERT_TRUE(said.code == 0 || said.code == 4) << said.err;
    const Image read = io::read_image(image);
    for (const Channel& channel : read.channels)
      EXPECT_TRUE(is_named(channel.name, channels)) << channel.name;
    for (const auto& [key, value] : read.metadata)
      EXPECT_TRUE(is_named(key, metadata)) << key << " = " << value;
  }
}

}  // namespace
}  // namespace surf::cli
