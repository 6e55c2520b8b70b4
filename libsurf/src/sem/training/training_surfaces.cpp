// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/training_surfaces.h"

#include <fmt/format.h>

#include <algorithm>

#include "sem/training/training_shapes.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf {
namespace {

void require(bool good, const char* subject, const std::string& value, const char* remedy) {
  if (!good) throw UsageError(subject, fmt::format("{} is out of range", value), remedy);
}

HeightField sum(HeightField a, const HeightField& b, double factor = 1) {
  for (std::size_t i = 0; i < a.z_nm.size(); ++i) a.z_nm.data()[i] += factor * b.z_nm.data()[i];
  return a;
}

/// Scale factors for a kind of surface.
struct Scale {
  double height;  ///< factor of heights
  double pixel;   ///< pixel size over 3 nm, for the scale of roughness
};

struct Kind {
  const char* name;
  HeightField (*make)(TrainingShapes& shapes, const Scale& s);
};

constexpr Kind kinds[] = {
    {"blocks", [](TrainingShapes& t, const Scale& s) { return t.blocks(14, 30 * s.height); }},
    {"island", [](TrainingShapes& t, const Scale& s) { return t.island(40 * s.height); }},
    {"blocks-rough",
     [](TrainingShapes& t, const Scale& s) {
       HeightField z = t.blocks(22, 45 * s.height);
       return sum(std::move(z), t.rough(0.5 * s.height, 20 * s.pixel + 4));
     }},
    {"pits", [](TrainingShapes& t,
                const Scale& s) { return sum(t.flat(), t.blocks(14, 40 * s.height), -1); }},
    {"hole",
     [](TrainingShapes& t, const Scale& s) { return sum(t.flat(), t.island(40 * s.height), -1); }},
    {"rough-fine",
     [](TrainingShapes& t, const Scale& s) { return t.rough(3 * s.pixel + 1, 15 * s.pixel + 4); }},
    {"rough",
     [](TrainingShapes& t, const Scale& s) { return t.rough(10 * s.pixel + 2, 30 * s.pixel + 6); }},
    {"rough-coarse", [](TrainingShapes& t,
                        const Scale& s) { return t.rough(20 * s.pixel + 4, 60 * s.pixel + 10); }},
    {"self-affine",
     [](TrainingShapes& t, const Scale& s) {
       return t.self_affine(8 * s.pixel + 3, 40 * s.pixel + 10, 0.7);
     }},
    {"line", [](TrainingShapes& t, const Scale& s) { return t.line(40 * s.height); }},
    {"bumps", [](TrainingShapes& t, const Scale&) { return t.bumps(40); }},
    {"lines", [](TrainingShapes& t, const Scale& s) { return t.lines(40 * s.height); }},
    {"blocks-self-affine",
     [](TrainingShapes& t, const Scale& s) {
       HeightField z = t.blocks(10, 20 * s.height);
       return sum(std::move(z), t.self_affine(2 * s.height, 20 * s.pixel + 5, 0.8));
     }},
    {"pyramids", [](TrainingShapes& t, const Scale& s) { return t.pyramids(25, 60 * s.height); }},
    {"low-island", [](TrainingShapes& t, const Scale& s) { return t.island(25 * s.height); }},
    {"blocks-bumps",
     [](TrainingShapes& t, const Scale& s) {
       HeightField z = t.blocks(30, 25 * s.height);
       return sum(std::move(z), t.bumps(15), 0.4);
     }},
    {"pattern", [](TrainingShapes& t, const Scale& s) { return t.pattern(45 * s.height); }},
    {"trace", [](TrainingShapes& t, const Scale& s) { return t.trace(45 * s.height); }},
    {"pits-pattern",
     [](TrainingShapes& t, const Scale& s) { return sum(t.flat(), t.trace(30 * s.height), -1); }},
    {"low-pattern", [](TrainingShapes& t, const Scale& s) { return t.pattern(25 * s.height); }},
};
static_assert(std::size(kinds) == training_surface_kinds);

}  // namespace

std::vector<NamedSurface> training_surfaces(const TrainingSurfaceOptions& o) {
  require(o.pixel_nm >= 0.1 && o.pixel_nm <= 100, "pixel size", format_exact(o.pixel_nm) + " nm",
          "Training surfaces are made for pixels of 0.1 to 100 nm");
  require(o.size_px >= 16 && o.size_px <= 4096, "size", std::to_string(o.size_px),
          "Give 16 to 4096 pixels");
  require(o.count >= 1 && o.count <= 1000, "number of surfaces", std::to_string(o.count),
          "Give 1 to 1000");
  const double across_nm = o.size_px * o.pixel_nm;
  const Scale scale{std::max(1.0, o.pixel_nm / 3) * std::min(1.0, across_nm / 96), o.pixel_nm / 3};
  std::vector<NamedSurface> surfaces;
  for (int i = 0; i < o.count; ++i) {
    const Kind& kind = kinds[i % training_surface_kinds];
    const int round = i / training_surface_kinds + 1;
    TrainingShapes shapes(o.pixel_nm, o.size_px, o.seed, i);
    surfaces.push_back({round == 1 ? kind.name : fmt::format("{}-{}", kind.name, round),
                        kind.make(shapes, scale)});
  }
  return surfaces;
}

}  // namespace surf
