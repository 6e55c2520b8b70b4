// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "surf/core/error.h"

namespace surf {
namespace {

bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

void validate_scalars(const Surface& surface, const char* subject) {
  std::set<std::string_view> names;
  for (const VertexScalar& scalar : surface.scalars) {
    const std::string what =
        fmt::format("the scalar '{}' of surface '{}'", scalar.name, surface.name);
    if (!is_scalar_name(scalar.name)) {
      throw InvalidInput(subject, what + " has a name that files cannot hold",
                         "Use lower-case letters, digits and '_', a letter first");
    }
    if (!names.insert(scalar.name).second) {
      throw InvalidInput(subject, what + " is there twice", "Names must be unique");
    }
    const std::size_t vertices = surface.mesh.vertices_nm.size();
    if (scalar.values.size() != vertices) {
      throw InvalidInput(
          subject,
          fmt::format("{} has {} values for {} vertices", what, scalar.values.size(), vertices),
          "Give one for each vertex");
    }
    const auto bad = std::find_if(scalar.values.begin(), scalar.values.end(),
                                  [](float value) { return !std::isfinite(value); });
    if (bad == scalar.values.end()) continue;
    throw InvalidInput(
        subject, fmt::format("{} is {} at vertex {}", what, *bad, bad - scalar.values.begin()),
        "Every value must be finite");
  }
}

void validate_drape(const Surface& surface, const char* subject) {
  const Drape& drape = *surface.drape;
  const auto refuse = [&](const std::string& reason) {
    throw InvalidInput(subject, fmt::format("the picture draped on '{}' {}", surface.name, reason),
                       "Give an image with its pixel size");
  };
  const auto positive = [](double pitch) { return std::isfinite(pitch) && pitch > 0; };
  if (drape.grey.empty()) refuse("has no pixels");
  if (!positive(drape.pitch_x_nm) || !positive(drape.pitch_y_nm)) {
    refuse(fmt::format("has pixels of {} nm by {} nm", drape.pitch_x_nm, drape.pitch_y_nm));
  }
  if (!std::isfinite(drape.origin_x_nm) || !std::isfinite(drape.origin_y_nm)) {
    refuse(fmt::format("begins at ({}, {}) nm", drape.origin_x_nm, drape.origin_y_nm));
  }
}

}  // namespace

bool is_scalar_name(std::string_view name) {
  return !name.empty() && is_lower(name.front()) &&
         std::ranges::all_of(name, [](char c) { return is_lower(c) || is_digit(c) || c == '_'; });
}

std::string scalar_name(std::string_view name) {
  if (is_scalar_name(name)) return std::string(name);
  std::string plain;
  for (const char c : name) {
    if (is_upper(c)) plain += static_cast<char>(c - 'A' + 'a');
    else if (is_lower(c) || is_digit(c)) plain += c;
    else if (!plain.empty() && plain.back() != '_') plain += '_';
  }
  while (!plain.empty() && plain.back() == '_') plain.pop_back();
  if (plain.empty()) return "scalar";
  return is_digit(plain.front()) ? "scalar_" + plain : plain;
}

void validate(const SurfaceScene& scene, const char* subject) {
  if (scene.surfaces.empty()) {
    throw InvalidInput(subject, "there is no surface", "Give at least one");
  }
  std::set<std::string_view> names;
  for (const Surface& surface : scene.surfaces) {
    if (surface.name.empty()) throw InvalidInput(subject, "a surface has no name", "Name each");
    if (!names.insert(surface.name).second) {
      throw InvalidInput(subject, fmt::format("two surfaces have the name '{}'", surface.name),
                         "Names must be unique");
    }
    validate(surface.mesh, subject);
    validate_scalars(surface, subject);
    if (surface.drape) validate_drape(surface, subject);
  }
  for (const Track& track : scene.tracks) validate(track, subject);
}

}  // namespace surf
