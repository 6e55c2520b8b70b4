// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/specimen_reader.h"

#include <nlohmann/json.hpp>

#include "surf/workflow/memory_estimate.h"
#include "surf/workflow/team.h"

namespace surf::workflow {

io::BodyReader specimen_reader(NodeMemory* node, int each) {
  return [node, each](const std::filesystem::path& path, const io::MeshUnit& unit,
                      const io::MaterialNames& names, const io::MaterialLibrary& library) {
    std::vector<io::MeshBody> bodies;
    const std::string text = once_per_node(node, [&] {
      if (const auto found = triangles_in(path))
        require_memory(path.string(), *found,
                       {.processes = node ? node->processes() : each,
                        .threads = 0,
                        .shared = node != nullptr});
      bodies = io::read_mesh_bodies(path, unit, names, library);
      auto all = nlohmann::json::array();
      for (const io::MeshBody& b : bodies)
        all.push_back({b.name, b.file_material, b.material, b.is_default, b.unit_assumed});
      return all.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    });
    if (!node || node->is_first()) return bodies;
    for (const auto& b : nlohmann::json::parse(text))
      bodies.push_back({b[0], b[1], b[2], b[3].get<bool>(), {}, b[4].get<bool>()});
    return bodies;
  };
}

}  // namespace surf::workflow
