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

/// A material by its name, of those that come with semsurf or of files of one's own.
struct MaterialChoice {
  std::string name;                ///< empty: none is said
  std::vector<std::string> files;  ///< as MaterialLibrary::read takes them
};
/// specimen.material and specimen.materials.
void describe(ParameterVisitor& visit, MaterialChoice& choice);
/// Throws UsageError naming specimen.material, and as the files do. `notes`: see
/// MaterialLibrary::add.
mc::Material find_material(const MaterialChoice& choice, std::vector<std::string>& notes);

/// The built-in material of that name; see MaterialLibrary::find.
const mc::Material& find_material(const std::string& name, const std::string& subject);

/// Materials by name: those that come with semsurf and the user's own, which go before them.
///
/// A file of materials is TOML with [[material]] tables and nothing else; a scene file may hold
/// such tables too. All keys (numbers are eV or g/cm^3):
///
///     [[material]]
///     name = "nitride"
///     formula = "Si3N4"              # or Ca(OH)2, Al0.3Ga0.7As; or by weight, in place of it:
///     # elements = [{ symbol = "Si", weight_fraction = 0.6 }, { Z = 7, weight_fraction = 0.4 }]
///     density_g_cm3 = 3.17
///     band_gap_ev = 5.3              # 0, a metal, where it is missing
///     # What is missing of these is estimated by the rules of mc::complete:
///     # work_function_ev, barrier_ev, valence_electrons, plasmon_ev, loss_join_ev
///     # loss_join_fitted = false; sources = "text"; an element's A and J_ev
class MaterialLibrary {
 public:
  /// What comes with semsurf.
  MaterialLibrary();

  /// Built-in ones first, then new ones in the order in which they were added.
  const std::vector<mc::Material>& all() const { return materials_; }

  /// The material of that name (case matters: "Co" is not "CO"). Throws UsageError, naming
  /// `subject` and listing the names, nearest first.
  const mc::Material& find(const std::string& name, const std::string& subject) const;

  /// Adds a material, or puts it in the place of the one of the same name and says so in `notes`.
  /// `origin` is the file it comes from.
  void add(mc::Material material, const std::string& origin, std::vector<std::string>& notes);

  /// Adds those of a file. Throws FileError, UsageError or InvalidInput with line and key.
  void read(const std::filesystem::path& path, std::vector<std::string>& notes);

 private:
  std::vector<mc::Material> materials_;
  std::vector<std::string> origins_;  // empty for built-in ones; in step with materials_
};

}  // namespace surf::io
