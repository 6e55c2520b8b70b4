// SPDX-License-Identifier: GPL-3.0-or-later
#include "job_identity.h"

#include <fmt/format.h>

#include <set>
#include <span>
#include <vector>

#include "surf/core/error.h"
#include "surf/core/instruction_set.h"
#include "surf/io/files.h"
#include "surf/mc/geometry/scene.h"
#include "surf/workflow/version.h"

namespace surf::workflow {
namespace {

constexpr const char* geometry_key = "geometry";
constexpr const char* program_key = "program";
constexpr std::size_t longest_value = 40;  // characters of a value in a message

template <class T>
std::string hash_of(const std::vector<T>& values) {
  return io::sha256_of(std::as_bytes(std::span(values)));
}

std::string hash_of(const std::string& text) {
  return io::sha256_of(std::as_bytes(std::span(text)));
}

std::string geometry(const mc::Specimen& specimen) {
  std::string hashes;
  for (const mc::Body& body : specimen.bodies)
    hashes += fmt::format("{} {} {}\n", body.material, hash_of(body.mesh.vertices_nm),
                          hash_of(body.mesh.triangles));
  if (const auto& h = specimen.height_field)
    hashes +=
        fmt::format("field {} {}", hash_of(h->field.z_nm.data()), hash_of(h->field.valid.data()));
  return hash_of(hashes);
}

const std::string& program() {
  static const std::string hash = [] {
    try {
      return io::sha256_of_file("/proc/self/exe");
    } catch (const FileError&) {
      return std::string("unknown");
    }
  }();
  return hash;
}

}  // namespace

const std::string& program_hash() { return program(); }

namespace {

std::string shown(const Identity& identity, const std::string& key) {
  const auto found = identity.find(key);
  if (found == identity.end()) return "not given";
  if (found->second.size() <= longest_value) return found->second;
  return found->second.substr(0, longest_value - 3) + "...";
}

}  // namespace

Identity identity_of(const ResolvedJob& job, const std::map<std::string, std::string>& settings) {
  Identity identity = settings;
  identity[geometry_key] = geometry(job.scene.specimen);
  identity["spectra"] = job.spectra ? "yes" : "no";
  identity["tile_pixels"] = std::to_string(job.options.tile_pixels);
  identity["planar_control"] = job.options.planar_control ? "yes" : "no";
  identity["instruction set"] = std::string(instruction_set());
  identity["ray tracer"] = mc::ray_tracer_version();
  identity[program_key] = program();
  return identity;
}

std::string fingerprint(const Identity& identity) {
  std::string text;
  for (const auto& [key, value] : identity)
    text += fmt::format("{} {} {} {}\n", key.size(), key, value.size(), value);
  return hash_of(text);
}

std::string difference(const Identity& there, const Identity& here) {
  std::set<std::string> keys;
  for (const Identity* side : {&there, &here})
    for (const auto& [key, value] : *side) {
      const auto a = there.find(key), b = here.find(key);
      if (a == there.end() || b == here.end() || a->second != b->second) keys.insert(key);
    }
  if (keys.empty()) return "";
  // Hashes mean little to people: they are named only if nothing else differs.
  std::set<std::string> telling = keys;
  telling.erase(geometry_key);
  telling.erase(program_key);
  if (telling.empty()) return keys.contains(geometry_key) ? "the specimen" : "the build of semsurf";
  const std::string& key = *telling.begin();
  std::string text =
      fmt::format("{} {} there and {} here", key, shown(there, key), shown(here, key));
  if (telling.size() > 1) text += fmt::format(", and {} more", telling.size() - 1);
  return text;
}

}  // namespace surf::workflow
