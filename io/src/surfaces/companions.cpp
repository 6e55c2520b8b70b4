// SPDX-License-Identifier: GPL-3.0-or-later
// Files that belong to others: read or written together with them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <regex>
#include <string>
#include <string_view>
#include <system_error>

#include "files/lower_extension.h"
#include "files/percent_encoded.h"
#include "sem/sem_settings.h"
#include "surf/core/error.h"
#include "surf/io/mesh_file.h"
#include "surf/io/overlaps.h"

namespace surf::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_bytes = std::size_t{1}
                                   << 20;  // in which a file names others, or bears its mark

std::string beginning(const fs::path& path, std::size_t bytes = most_bytes) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return {};
  std::ifstream in(path, std::ios::binary);
  std::string text(bytes, '\0');
  in.read(text.data(), static_cast<std::streamsize>(bytes));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

/// The rest of all lines that begin with `start`.
std::vector<std::string> values_of(std::string_view text, std::string_view start) {
  std::vector<std::string> values;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    if (line.starts_with(start)) values.emplace_back(line.substr(start.size()));
  }
  return values;
}

void add_obj_files(const fs::path& path, std::vector<fs::path>& files) {
  const fs::path folder = path.parent_path();
  for (const std::string& library : values_of(beginning(path), "mtllib ")) {
    files.push_back(folder / library);
    for (const std::string& picture : values_of(beginning(files.back()), "map_Kd "))
      files.push_back(folder / picture);
  }
}

/// Whether `text` has the name as a word of its own.
bool has_word(std::string_view text, std::string_view name) {
  constexpr std::string_view before = "\"'= \t/\n>", after = "\"' \t\r\n<,";
  for (std::size_t at = text.find(name); at != text.npos; at = text.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    const bool begins = at == 0 || before.find(text[at - 1]) != before.npos;
    if (begins && (end == text.size() || after.find(text[end]) != after.npos)) return true;
  }
  return false;
}

/// Whether a text names the file, as it is or as glTF does.
bool names(std::string_view text, const fs::path& file) {
  const std::string name = file.filename().string();
  return has_word(text, name) || has_word(text, percent_encoded(name));
}

/// Records and spectra, materials, VTK's files and PNG pictures bear a mark; the numbers of glTF
/// and pictures of tracks none.
bool is_marked(const fs::path& path) {
  constexpr std::array<std::string_view, 7> marks{
      "\"semsurf\":",
      "semsurf.version",
      "semsurf:",
      "written by semsurf",
      "surface:unit_nm",
      "image:pitch_x_nm",
      "detector,quantity,unit,from,to,yield,standard_error"};
  const std::string text = beginning(path);
  return std::ranges::any_of(marks,
                             [&](std::string_view mark) { return text.find(mark) != text.npos; });
}

/// The names of files in `folder` that are `stem` and what `rest` matches.
void add_numbered(const fs::path& folder, const std::string& stem, const std::regex& rest,
                  std::vector<fs::path>& files) {
  std::error_code ignored;
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(folder.empty() ? fs::path(".") : folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(stem) && std::regex_match(name.substr(stem.size()), rest))
      found.push_back(folder / name);
  }
  std::ranges::sort(found);
  files.insert(files.end(), found.begin(), found.end());
}

/// Whether a file of semsurf with the same stem as `main` names it: their pictures have the same
/// names.
bool belongs_to_sibling(const fs::path& main, const fs::path& file) {
  for (const char* extension : {".gltf", ".mtl", ".vtm"}) {
    const fs::path sibling = main.parent_path() / (main.stem().string() + extension);
    if (is_marked(sibling) && names(beginning(sibling, std::size_t{64} << 20), file)) return true;
  }
  return false;
}

}  // namespace

std::vector<fs::path> files_read_with(const fs::path& path) {
  std::vector<fs::path> files{path};
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return files;
  const std::string extension = lower_extension(path);
  try {
    if (is_mesh_file(path)) files = mesh_input_files(path);
    if (extension == ".obj") add_obj_files(path, files);
    if (extension == ".gltf" || extension == ".vtm") {
      std::vector<fs::path> pictures;
      add_numbered(path.parent_path(), path.stem().string(), std::regex("_drape[0-9]+\\.png"),
                   pictures);
      const std::string text = beginning(path);
      for (fs::path& picture : pictures)
        if (names(text, picture)) files.push_back(std::move(picture));
    }
    for (fs::path& settings : sem_settings_beside(path)) files.push_back(std::move(settings));
  } catch (const Error&) {
    files.assign({path});  // reading will say what is wrong
  }
  return files;
}

std::vector<fs::path> files_written_with(const fs::path& path) {
  std::vector<fs::path> files{path};
  const std::string extension = lower_extension(path), stem = path.stem().string();
  const fs::path folder = path.parent_path();
  const auto add = [&](const char* end) { files.push_back(folder / (stem + end)); };
  const auto add_pictures = [&] {
    add_numbered(folder, stem, std::regex("_drape[0-9]+\\.png"), files);
  };
  if (extension == ".gltf") {
    add(".bin");
    add_pictures();
  } else if (extension == ".obj") {
    add(".mtl");
    add_pictures();
  } else if (extension == ".vtm") {
    add("_surface1.vtp");
    add("_tracks.vtp");
    add_numbered(folder, stem, std::regex("_surface([2-9]|[1-9][0-9]+)\\.vtp|_surface[0-9]+\\.vti"),
                 files);
  }
  return files;
}

void refuse_strangers(const fs::path& main, const std::vector<fs::path>& beside) {
  std::string text;
  for (const fs::path& file : beside) {
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored) || is_marked(file))
      continue;  // writing refuses what is no file
    if (text.empty()) text = beginning(main, std::size_t{64} << 20);
    if (names(text, file) || belongs_to_sibling(main, file)) continue;
    throw UsageError(
        main.string(),
        fmt::format(
            "{} would be written with it, and a file of that name is there that semsurf did not "
            "write",
            file.string()),
        "Choose another name, or move that file away");
  }
}

}  // namespace surf::io
