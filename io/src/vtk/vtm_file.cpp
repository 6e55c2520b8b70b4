// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's multi-block files: XML that names a file for each block.
#include <fmt/format.h>

#include <utility>

#include "files/lower_extension.h"
#include "files/side_file.h"
#include "files/text_scanner.h"
#include "files/xml_text.h"
#include "raster/image_formats.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "vtk_xml.h"
#include "vtp_format.h"

namespace surf::io {
namespace {

using Element = VtkXml::Element;

constexpr const char* vtm_type = "vtkMultiBlockDataSet";
constexpr const char* tracks_block = "electron tracks";
constexpr const char* tracks_file = "_tracks.vtp";  // behind the stem
constexpr std::string_view drape_of =
    "drape of ";  // a block's name: this and that of the surface's block

struct Block {
  std::string name;
  std::filesystem::path file;
};

/// All data sets with a file, in order, whatever blocks they are in.
void collect(const Element& element, const std::filesystem::path& main,
             std::vector<Block>& blocks) {
  for (const char* kind : {"Block", "Piece"}) {
    for (const Element& inner : element.children(kind)) collect(inner, main, blocks);
  }
  for (const Element& data : element.children("DataSet")) {
    const std::filesystem::path file = data.attribute("file");
    if (file.empty()) continue;  // an empty block
    const auto place = side_file(main, file);
    if (!place)
      data.fail(fmt::format("its file '{}' is not in or below the folder", shown(file.string())));
    blocks.push_back({data.attribute("name"), *place});
  }
}

std::vector<Block> blocks_of(const std::filesystem::path& path, std::string_view content) {
  const VtkXml xml(path.string(), content, vtm_type);
  std::vector<Block> blocks;
  collect(xml.data(), path, blocks);
  return blocks;
}

void add_drape(const Block& block, const std::vector<std::pair<std::string, std::size_t>>& places,
               ParsedFile& parsed) {
  if (!block.name.starts_with(drape_of)) return;  // an image of its own
  for (const auto& [name, place] : places) {
    if (name != std::string_view(block.name).substr(drape_of.size())) continue;
    parsed.bodies[place].surface.drape = read_drape(block.file);
    return;
  }
}

}  // namespace

bool is_vtm(std::string_view content) {
  const std::string_view start = content.substr(0, 4096);
  return start.find("<VTKFile") != start.npos && start.find(vtm_type) != start.npos;
}

std::vector<std::filesystem::path> vtm_part_files(const std::filesystem::path& path,
                                                  std::string_view content) {
  std::vector<std::filesystem::path> files;
  for (Block& block : blocks_of(path, content)) files.push_back(std::move(block.file));
  return files;
}

ParsedFile parse_vtm(const std::filesystem::path& path, std::string_view content, Want want) {
  ParsedFile parsed;
  std::vector<std::pair<std::string, std::size_t>> places;  // of surfaces by their block's name
  const std::vector<Block> blocks = blocks_of(path, content);
  for (const Block& block : blocks) {
    const std::string extension = lower_extension(block.file);
    if (extension == ".vti") continue;  // once the surfaces are there
    if (extension != ".vtp") {
      throw Unsupported(path.string(),
                        fmt::format("its block {} is no surface or picture (.vtp, .vti)",
                                    block.file.filename().string()),
                        "Extract the surface of it in ParaView and save that");
    }
    const std::string file = block.file.string();
    const std::string part = read_file(block.file);
    if (block.name == tracks_block && file.ends_with(tracks_file)) {
      if (want == Want::everything) parsed.tracks = parse_tracks(file, part);
      continue;
    }
    ParsedFile surfaces = parse_vtp(file, part, want);
    if (surfaces.bodies.empty()) continue;
    if (places.empty()) parsed.note = surfaces.note;
    if (surfaces.note.unit_nm != parsed.note.unit_nm) {
      throw FileError(path.string(), "its blocks have different units",
                      "Read the blocks one by one");
    }
    places.emplace_back(block.name, parsed.bodies.size());
    for (ParsedBody& body : surfaces.bodies) {
      if (body.surface.name.empty()) body.surface.name = block.name;
      parsed.bodies.push_back(std::move(body));
    }
  }
  for (const Block& block : blocks) {
    if (want == Want::everything && lower_extension(block.file) == ".vti")
      add_drape(block, places, parsed);
  }
  return parsed;
}

std::vector<OutputFile> format_vtm(const std::filesystem::path& path, const SceneView& scene) {
  const std::string file = path.string(), stem = path.stem().string();
  std::vector<OutputFile> files;
  std::string blocks;
  const auto add = [&](const std::string& name, const std::string& part, std::string content) {
    blocks += fmt::format("    <DataSet index=\"{}\" name=\"{}\" file=\"{}\"/>\n", files.size(),
                          xml_escaped(name), xml_escaped(part));
    files.push_back({path.parent_path() / part, std::move(content)});
  };
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const SurfaceView& surface = scene.surfaces[s];
    SceneView one{{surface}, {}, scene.note};
    one.note.names.clear();
    add(std::string(surface.name), fmt::format("{}_surface{}.vtp", stem, s + 1),
        format_vtp(file, one));
    if (!surface.drape) continue;
    add(std::string(drape_of) + std::string(surface.name),
        fmt::format("{}_surface{}.vti", stem, s + 1), vti_content(file, to_image(*surface.drape)));
  }
  if (!scene.tracks.empty()) {
    add(tracks_block, stem + tracks_file, format_tracks(file, scene.tracks, scene.note.metadata));
  }
  files.push_back(
      {path, fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"{0}\" version=\"1.0\" "
                         "byte_order=\"LittleEndian\">\n  <{0}>\n{1}  </{0}>\n</VTKFile>\n",
                         vtm_type, blocks)});
  return files;
}

constexpr std::array vtm_forms{SurfaceFormat{
    .extension = ".vtm", .several = true, .scalars = true, .drape = true, .tracks = true}};

constinit const MeshFormat vtm_format{
    .forms = vtm_forms,
    .is = is_vtm,
    .parse = [](const MeshSource& s) { return parse_vtm(s.path, s.content, s.want); },
    .named_files = vtm_part_files,
    .format = format_vtm,
    .needs_vtk = true};

}  // namespace surf::io
