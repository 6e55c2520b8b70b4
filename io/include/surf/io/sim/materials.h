// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/mc/physics/material.h"

namespace surf::io {

/// The materials that come with semsurf (data/materials.toml), in the order of the file.
const std::vector<mc::Material>& builtin_materials();

/// The name of a material, built into semsurf or read from the user's files.
struct MaterialChoice {
  std::string name;                ///< empty: no material is chosen
  std::vector<std::string> files;  ///< paths for MaterialLibrary::read
};
/// The parameters specimen.material and specimen.materials.
void describe(ParameterVisitor& visit, MaterialChoice& choice);
/// Finds the chosen material. Throws UsageError naming specimen.material, and what reading the
/// files throws. `notes`: see MaterialLibrary::add.
mc::Material find_material(const MaterialChoice& choice, std::vector<std::string>& notes);

/// The built-in material of that name; see MaterialLibrary::find.
const mc::Material& find_material(const std::string& name, const std::string& subject);

/// Materials by name: the built-in ones and the user's own. A user's material replaces a built-in
/// one of the same name.
///
/// A file of materials is TOML with [[material]] tables and nothing else. A scene file may hold
/// such tables too. All keys (numbers are in eV or g/cm^3):
///
///     [[material]]
///     name = "nitride"
///     formula = "Si3N4"              # or Ca(OH)2, Al0.3Ga0.7As; or, instead, weight fractions:
///     # elements = [{ symbol = "Si", weight_fraction = 0.6 }, { Z = 7, weight_fraction = 0.4 }]
///     density_g_cm3 = 3.17
///     band_gap_ev = 5.3              # 0, a metal, if it is missing
///     # If missing, these are estimated by the rules of mc::complete:
///     # work_function_ev, barrier_ev, valence_electrons, plasmon_ev, loss_join_ev
///     # loss_join_fitted = false; sources = "text"; an element's A and J_ev
class MaterialLibrary {
 public:
  /// Holds the built-in materials.
  MaterialLibrary();

  /// All materials: the built-in ones first, then the added ones in the order in which they were
  /// added.
  const std::vector<mc::Material>& all() const { return materials_; }

  /// Returns the material of that name (case matters: "Co" is not "CO"). Throws UsageError, naming
  /// `subject` and listing the known names, nearest first.
  const mc::Material& find(const std::string& name, const std::string& subject) const;

  /// Adds a material. A material of the same name is replaced in its place, which is said in
  /// `notes`. `origin` is the file that the material comes from.
  void add(mc::Material material, const std::string& origin, std::vector<std::string>& notes);

  /// Adds the materials of a file. Throws FileError, UsageError or InvalidInput with line and key.
  void read(const std::filesystem::path& path, std::vector<std::string>& notes);

 private:
  std::vector<mc::Material> materials_;
  std::vector<std::string> origins_;  // empty for built-in ones; in step with materials_
};

}  // namespace surf::io
