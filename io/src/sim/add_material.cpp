// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/add_material.h"

#include <algorithm>

namespace surf::io {

int add_material(SceneFile& scene, const std::string& name, const std::string& subject) {
  const mc::Material& material = scene.materials.find(name, subject);
  auto& all = scene.specimen.materials;
  const auto found = std::ranges::find(all, material.name, &mc::Material::name);
  if (found != all.end()) return static_cast<int>(found - all.begin());
  all.push_back(material);
  return static_cast<int>(all.size()) - 1;
}

}  // namespace surf::io
