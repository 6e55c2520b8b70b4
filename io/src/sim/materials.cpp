// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/sim/materials.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/material_tables.h"
#include "sim/materials_data.h"
#include "sim/suggest.h"
#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

constexpr std::size_t max_file_bytes = std::size_t{16} << 20;

std::vector<mc::Material> read_builtin_materials() {
  const TomlTable root = TomlTable::parse(materials_toml, "materials.toml");
  root.allow({"material"});
  return read_material_tables(root, {}, [](const std::string& name) {
    return std::string(mc::find_energy_loss_file(name));
  });
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

const mc::Material& find_in(const std::vector<mc::Material>& materials, const std::string& name,
                            const std::string& subject) {
  std::vector<std::string> names;
  for (const mc::Material& material : materials) {
    if (material.name == name) return material;
    names.push_back(material.name);
  }
  for (const std::string& other : names)
    if (std::ranges::equal(name, other, {}, lower, lower))
      throw UsageError(subject, fmt::format("there is no material '{}'", name),
                       fmt::format("Did you mean {}?", other));
  throw UsageError(subject, fmt::format("there is no material '{}'", name),
                   fmt::format("Choose one of: {}. Or describe it in a file and add "
                               "`specimen.materials=FILE.toml`",
                               join(nearest_first(name, std::move(names)))));
}

}  // namespace

const std::vector<mc::Material>& builtin_materials() {
  static const std::vector<mc::Material> materials = read_builtin_materials();
  return materials;
}

void describe(ParameterVisitor& visit, MaterialChoice& choice) {
  visit(choice.name,
        {.name = "specimen.material", .help = "Material of the specimen", .form = "MATERIAL"});
  visit(choice.files, {.name = "specimen.materials",
                       .help = "File of your own materials (TOML)",
                       .form = "FILE",
                       .level = Level::advanced,
                       .file = FileRole::read});
}

mc::Material find_material(const MaterialChoice& choice, std::vector<std::string>& notes) {
  MaterialLibrary materials;
  for (const std::string& file : choice.files) materials.read(file, notes);
  return materials.find(choice.name, "`specimen.material`");
}

const mc::Material& find_material(const std::string& name, const std::string& subject) {
  return find_in(builtin_materials(), name, subject);
}

MaterialLibrary::MaterialLibrary() : materials_(builtin_materials()), origins_(materials_.size()) {}

const mc::Material& MaterialLibrary::find(const std::string& name,
                                          const std::string& subject) const {
  return find_in(materials_, name, subject);
}

void MaterialLibrary::add(mc::Material material, const std::string& origin,
                          std::vector<std::string>& notes) {
  const auto found = std::find_if(materials_.begin(), materials_.end(),
                                  [&](const mc::Material& m) { return m.name == material.name; });
  if (found == materials_.end()) {
    materials_.push_back(std::move(material));
    origins_.push_back(origin);
    return;
  }
  std::string& replaced = origins_[static_cast<std::size_t>(found - materials_.begin())];
  notes.push_back(fmt::format("{} is as {} says, in place of {}", material.name, origin,
                              replaced.empty() ? "the built-in one" : "that of " + replaced));
  *found = std::move(material);
  replaced = origin;
}

void MaterialLibrary::read(const std::filesystem::path& path, std::vector<std::string>& notes) {
  const TomlTable root = TomlTable::parse(read_file(path, max_file_bytes), path.string());
  root.allow({"material"});
  if (!root.has("material")) {
    throw FileError(path.string(), "it holds no material", "Add [[material]] tables");
  }
  for (mc::Material& material :
       read_material_tables(root, builtin_materials(), reader_beside(path))) {
    add(std::move(material), path.string(), notes);
  }
}

}  // namespace surf::io
