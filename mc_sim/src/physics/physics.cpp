// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/physics.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/parameters.h"
#include "surf/mc/physics/medium.h"
#include "surf/mc/physics/physics_words.h"

namespace surf::mc {

namespace {

using Choice = std::pair<std::string_view, int>;

// What is usual with a tier, where it changes.
void choose_tier(Physics& p, InelasticTier tier) {
  if (p.inelastic == tier) return;
  p.inelastic = tier;
  const bool dielectric = tier == InelasticTier::dielectric;
  p.elastic = dielectric ? ElasticModel::mott_phonon : ElasticModel::mott;
  p.atoms = dielectric ? MottAtoms::solid : MottAtoms::free;
}

// A key of `simulation.physics`, its words (the default first), and how it is stored.
struct Key {
  std::string_view name;
  std::vector<Choice> words;
  int (*get)(const Physics&);
  void (*set)(Physics&, int);
};

const std::array<Key, 8>& keys() {
  static const std::array<Key, 8> all{{
      {"inelastic",
       {{"monsel", int(InelasticTier::monsel)}, {"dielectric", int(InelasticTier::dielectric)}},
       [](const Physics& p) { return int(p.inelastic); },
       [](Physics& p, int v) { choose_tier(p, InelasticTier(v)); }},
      {"inelastic-model",
       {{"full-penn", int(InelasticModel::full_penn)},
        {"single-pole", int(InelasticModel::single_pole)}},
       [](const Physics& p) { return int(p.inelastic_model); },
       [](Physics& p, int v) { p.inelastic_model = InelasticModel(v); }},
      {"auger",
       {{"off", 0}, {"on", 1}},
       [](const Physics& p) { return int(p.auger); },
       [](Physics& p, int v) { p.auger = v != 0; }},
      {"elastic",
       {{"mott", int(ElasticModel::mott)},
        {"mott-phonon", int(ElasticModel::mott_phonon)},
        {"browning", int(ElasticModel::browning)}},
       [](const Physics& p) { return int(p.elastic); },
       [](Physics& p, int v) { p.elastic = ElasticModel(v); }},
      {"atoms",
       {{"free", int(MottAtoms::free)}, {"solid", int(MottAtoms::solid)}},
       [](const Physics& p) { return int(p.atoms); },
       [](Physics& p, int v) { p.atoms = MottAtoms(v); }},
      {"loss",
       {{"joy-luo", int(LossModel::joy_luo)}, {"none", int(LossModel::none)}},
       [](const Physics& p) { return int(p.loss); },
       [](Physics& p, int v) { p.loss = LossModel(v); }},
      {"secondaries",
       {{"on", 1}, {"off", 0}},
       [](const Physics& p) { return int(p.secondaries); },
       [](Physics& p, int v) { p.secondaries = v != 0; }},
      {"barrier",
       {{"quantum", int(BarrierModel::quantum)},
        {"classical", int(BarrierModel::classical)},
        {"off", int(BarrierModel::off)}},
       [](const Physics& p) { return int(p.barrier); },
       [](Physics& p, int v) { p.barrier = BarrierModel(v); }},
  }};
  return all;
}

// Whether a key says anything with these settings.
bool matters(const Key& key, const Physics& physics) {
  if (key.name == "inelastic-model" || key.name == "auger") return is_dielectric(physics);
  return key.name != "loss" || !is_dielectric(physics);
}

std::string choices(const Key& key) {
  std::string out;
  for (const auto& [word, value] : key.words) out += (out.empty() ? "" : ", ") + std::string(word);
  return out;
}

std::string key_names() {
  std::string out;
  for (std::size_t i = 0; i < keys().size(); ++i)
    out += fmt::format("{}{}=",
                       i == 0                   ? ""
                       : i + 1 == keys().size() ? " or "
                                                : ", ",
                       keys()[i].name);
  return out;
}

void apply_item(const std::string& item, Physics& physics, const std::string& subject) {
  const auto equals = item.find('=');
  const std::string name = item.substr(0, equals);
  for (const Key& key : keys()) {
    if (key.name != name) continue;
    const std::string word = equals == std::string::npos ? "" : item.substr(equals + 1);
    for (const auto& [known, value] : key.words)
      if (known == word) return key.set(physics, value);
    throw UsageError(subject, fmt::format("'{}' is no choice for {}", word, name),
                     fmt::format("Choose one of: {}", choices(key)));
  }
  throw UsageError(subject, fmt::format("there is no '{}'", name),
                   fmt::format("Use {}, separated by commas", key_names()));
}

}  // namespace

void validate(const Physics& physics, double beam_energy_ev) {
  if (is_dielectric(physics) && physics.barrier == BarrierModel::off)
    throw UsageError(
        "`simulation.physics`",
        "barrier=off does not go with inelastic=dielectric, which counts energies from the band",
        "Choose barrier=quantum or barrier=classical");
  const double cutoff = physics.cutoff_ev;
  if (cutoff == 0 || (cutoff >= min_cutoff_ev && cutoff < beam_energy_ev)) return;
  throw UsageError(
      "`simulation.cutoff`",
      fmt::format("{:g} eV is outside {:g} eV to the beam's energy of {:g} eV (excluded)", cutoff,
                  min_cutoff_ev, beam_energy_ev),
      "Choose an energy in that range, such as 5eV, or 0 for the default");
}

double effective_barrier_ev(const Physics& physics, const Material& material) {
  if (is_dielectric(physics)) return material.dielectric->barrier_ev();
  return physics.barrier == BarrierModel::off ? 0.0 : material.barrier_ev;
}

double effective_cutoff_ev(const Physics& physics, double effective_barrier_ev) {
  if (physics.cutoff_ev > 0) return physics.cutoff_ev;
  if (physics.secondaries && physics.barrier != BarrierModel::off) return effective_barrier_ev;
  return is_dielectric(physics) ? effective_barrier_ev + se_bse_split_ev : se_bse_split_ev;
}

double effective_cutoff_ev(const Physics& physics, const Material& material) {
  return effective_cutoff_ev(physics, effective_barrier_ev(physics, material));
}

void describe(ParameterVisitor& visit, Physics& physics) {
  visit.form(
      {.name = "simulation.physics",
       .help = "Changes to the physics: inelastic=monsel|dielectric, "
               "inelastic-model=full-penn|single-pole, auger=off|on, "
               "elastic=mott|mott-phonon|browning, atoms=free|solid, loss=joy-luo|none, "
               "secondaries=on|off, "
               "barrier=quantum|classical|off",
       .otherwise = "the first of each",
       .form = "KEY=VALUE,...",
       .level = Level::advanced},
      [&] { return format_physics(physics); },
      [&](std::string_view text, const std::string& subject) {
        parse_physics(std::string(text), physics, subject);
      });
  visit(physics.cutoff_ev, {.name = "simulation.cutoff",
                            .help = "Energy inside the material where tracking stops, at least "
                                    "0.5eV and below that of the beam; 0 "
                                    "is the surface barrier, or 50eV without secondaries",
                            .unit = Unit::ev,
                            .level = Level::advanced});
}

void parse_physics(const std::string& text, Physics& physics, const std::string& subject) {
  // The tier first: other keys change what comes with it.
  for (const bool tier : {true, false}) {
    std::stringstream stream(text);
    for (std::string item; std::getline(stream, item, ',');)
      if (!item.empty() && item.starts_with("inelastic=") == tier)
        apply_item(item, physics, subject);
  }
}

std::string format_physics(const Physics& physics) {
  std::string out;
  for (const Key& key : keys())
    for (const auto& [word, value] : key.words)
      if (value == key.get(physics) && matters(key, physics))
        out += fmt::format("{}{}={}", out.empty() ? "" : ",", key.name, word);
  return out;
}

std::vector<PhysicsWords> physics_words() {
  std::vector<PhysicsWords> all;
  for (const Key& key : keys()) {
    PhysicsWords& words = all.emplace_back(PhysicsWords{std::string(key.name), {}});
    for (const auto& [word, value] : key.words) words.values.emplace_back(word);
  }
  return all;
}

std::vector<std::string> describe(const Physics& physics, const Material& material) {
  std::vector<std::string> lines = make_medium(material, physics).describe();
  if (physics.loss == LossModel::none && !is_dielectric(physics))
    lines.emplace_back("continuous loss: none");
  if (!physics.secondaries) lines.emplace_back("secondaries: none");
  switch (physics.barrier) {
    case BarrierModel::quantum:
      lines.push_back(
          fmt::format("surface barrier of {:g} eV: refraction, total reflection, "
                      "quantum-mechanical transmission of an abrupt step",
                      effective_barrier_ev(physics, material)));
      break;
    case BarrierModel::classical:
      lines.push_back(fmt::format("surface barrier of {:g} eV: refraction and total reflection",
                                  effective_barrier_ev(physics, material)));
      break;
    case BarrierModel::off:
      lines.emplace_back("surface barrier: none; energies count from the vacuum level");
      break;
  }
  lines.push_back(
      fmt::format("tracking stops at {:g} eV inside; {:g} eV in vacuum divides SE from "
                  "BSE",
                  effective_cutoff_ev(physics, material), se_bse_split_ev));
  return lines;
}

}  // namespace surf::mc
