// SPDX-License-Identifier: GPL-3.0-or-later
#include "specimen_facts.h"

#include <cstring>

#include "surf/workflow/team.h"

namespace surf::workflow {

SpecimenFacts facts_of(const mc::Specimen& specimen, NodeMemory* node, const Watch& watch) {
  SpecimenFacts facts;
  const std::string text = once_per_node(node, [&] {
    facts = {mc::extent(specimen), mc::validate(specimen, watch)};
    std::string packed(reinterpret_cast<const char*>(&facts.extent), sizeof(Box));
    packed.append(reinterpret_cast<const char*>(facts.bodies.data()),
                  facts.bodies.size() * sizeof(mc::BodyFacts));
    return packed;
  });
  std::memcpy(&facts.extent, text.data(), sizeof(Box));
  facts.bodies.resize((text.size() - sizeof(Box)) / sizeof(mc::BodyFacts));
  if (!facts.bodies.empty())
    std::memcpy(facts.bodies.data(), text.data() + sizeof(Box), text.size() - sizeof(Box));
  return facts;
}

}  // namespace surf::workflow
