// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/reconstruction/sample_surfaces.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reconstruction/sample_shapes.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/core/random.h"

namespace surf {
namespace {

constexpr double pi = std::numbers::pi;

// Stream number that nothing else uses with the same seed.
constexpr std::uint64_t stream = 0x5a3e;

/// The area with features: the view and the surroundings that a rotated scan may show.
constexpr double half_width_nm = 5000, half_depth_nm = 4000;

class Draw {
 public:
  explicit Draw(std::uint64_t surface) : random_(1, surface, stream) {}
  double operator()(double from, double to) { return from + (to - from) * random_.uniform(); }

 private:
  RandomStream random_;
};

using Shape = std::function<double(Point2)>;

/// Shapes of the same height that may touch and cross; the surface does not rise higher where they
/// do.
SampleSurface merged(std::string name, std::string what, std::vector<Shape> shapes,
                     double height_nm) {
  return {std::move(name), std::move(what),
          [shapes = std::move(shapes), height_nm](double x, double y) {
            double ground = 1;
            for (const Shape& shape : shapes) ground *= 1 - shape({x, y});
            return height_nm * (1 - ground);
          }};
}

struct Raised {
  Shape shape;
  double height_nm;  ///< below 0: a pit
};

SampleSurface stacked(std::string name, std::string what, std::vector<Raised> shapes) {
  return {std::move(name), std::move(what), [shapes = std::move(shapes)](double x, double y) {
            double z = 0;
            for (const Raised& raised : shapes) z += raised.height_nm * raised.shape({x, y});
            return z;
          }};
}

SampleSurface thick_lines() {
  constexpr double width = 300, blur = 16;
  const auto line = [](double x, double y, double heading, std::vector<StrokePiece> pieces) {
    return Shape(Stroke({x, y}, heading, width, blur, pieces));
  };
  return merged(
      "nist0523-thick",
      "silicon lines 100 nm high, 300 nm wide and 3.5 to 5.5 um long, with bends and ends",
      {line(-1750, -560, 7, {{2300}, {500, 60}, {1900}}),
       line(-3100, 380, -4, {{1750}, {420, 50}, {900}, {500, -55}, {1500}}),
       line(1950, -1500, 97, {{1150}, {450, -35}, {2300}}),
       line(-560, 2100, -78, {{1780}, {420, 65}, {1700}}),
       line(-3600, -1500, 3, {{2400}, {450, -35}, {1700}}),
       line(-4200, 1600, 10, {{2000}, {450, 40}, {2000}}),
       line(900, 2700, -20, {{2000}, {450, 45}, {1800}}),
       line(-3500, 2900, -12, {{2400}, {400, 25}, {2000}}),
       line(-2600, -2900, 12, {{2200}, {450, -30}, {2400}}),
       line(3700, -2800, 110, {{2000}, {450, -50}, {1400}})},
      100);
}

SampleSurface thin_lines() {
  constexpr double blur = 15;
  std::vector<Shape> lines;
  const auto line = [&](double x, double y, double heading, double line_width,
                        std::vector<StrokePiece> pieces) {
    lines.emplace_back(Stroke({x, y}, heading, line_width, blur, pieces));
  };
  line(-2050, -520, 11, 58, {{1500}, {300, 35}, {900}});
  line(-2500, 230, -8, 55, {{3100}, {350, 40}, {1400}});
  line(-1500, 640, -63, 55, {{1350}});
  line(-350, -700, 68, 60, {{1500}, {300, -45}, {600}});
  line(350, -380, -14, 50, {{1800}});
  line(900, 720, -52, 55, {{1250}, {260, 50}, {700}});
  line(1350, -650, 85, 52, {{950}});
  line(-850, -150, 2, 58, {{700}, {250, -70}, {350}});
  line(1500, 520, 18, 55, {{1600}});
  Draw draw(1);
  for (int i = 0; i < 60; ++i) {
    const Point2 start{draw(-half_width_nm, half_width_nm), draw(-half_depth_nm, half_depth_nm)};
    const double heading = draw(-180, 180), length = draw(700, 1700), turn = draw(-50, 50),
                 more = draw(400, 1200);
    // The view has lines of its own.
    const bool near = std::abs(start.x) < 3300 && std::abs(start.y) < 1900;
    if (!near) line(start.x, start.y, heading, draw(50, 60), {{length}, {300, turn}, {more}});
  }
  return merged("nist0523-thin",
                "silicon lines 100 nm high and 50 to 60 nm wide, which cross, bend and end",
                std::move(lines), 100);
}

/// Calls `place(centre)` for random places that are at least `apart_nm` from each other.
template <class Place>
void strew(Draw& draw, double apart_nm, const Place& place) {
  std::vector<Point2> taken;
  for (int attempt = 0; attempt < 6000; ++attempt) {
    const Point2 p{draw(-half_width_nm, half_width_nm), draw(-half_depth_nm, half_depth_nm)};
    const bool free = std::none_of(taken.begin(), taken.end(), [&](Point2 q) {
      return std::hypot(p.x - q.x, p.y - q.y) < apart_nm;
    });
    if (!free) continue;
    taken.push_back(p);
    place(p);
  }
}

SampleSurface pads_and_pits() {
  constexpr double blur = 16;
  Draw draw(2);
  std::vector<Raised> pads;
  strew(draw, 430, [&](Point2 p) {
    const double kind = draw(0, 1), height = draw(60, 100),
                 across = std::exp(draw(std::log(110), std::log(420)));
    const double other = draw(0.5, 1) * across, turn = draw(0, 180);
    const double z = kind < 0.7 ? height : -0.7 * height;
    if (draw(0, 1) < 0.45) pads.push_back({Stroke(p, 0, across, blur, {}), z});
    else pads.push_back({Pad(p, across, other, turn, blur), z});
    // Some pads carry a smaller one.
    if (z > 0 && across > 300)
      pads.push_back({Stroke({p.x + 20, p.y - 25}, 0, 0.35 * across, blur, {}), 40});
  });
  return stacked("pads",
                 "round and square pads and pits, 110 to 420 nm across and 40 to 100 nm high",
                 std::move(pads));
}

SampleSurface islands() {
  constexpr double blur = 15;
  Draw draw(3);
  std::vector<Shape> outlines;
  strew(draw, 560, [&](Point2 p) {
    std::vector<double> amplitudes, phases;
    for (int k = 2; k <= 6; ++k) {
      amplitudes.push_back(draw(0.1, 0.5) / k);
      phases.push_back(draw(0, 2 * pi));
    }
    outlines.emplace_back(Island(p, draw(130, 330), amplitudes, phases, blur));
  });
  return merged("islands", "islands of irregular outline, 90 nm high, some grown together",
                std::move(outlines), 90);
}

/// A sum of waves in all directions, whose amplitude is a power of their length. It is self-affine
/// between the shortest and the longest wave (Voss, in Fundamental Algorithms for Computer
/// Graphics, 1985), and defined everywhere.
class Waves {
 public:
  Waves(Draw& draw, int count, double shortest_nm, double longest_nm, double hurst, double rms_nm) {
    double power = 0;
    for (int i = 0; i < count; ++i) {
      // Lengths are evenly distributed over their logarithm, one wave in each step.
      const double share = (i + draw(0, 1)) / count;
      const double length = longest_nm * std::pow(shortest_nm / longest_nm, share);
      const double turn = draw(0, 2 * pi), amplitude = std::pow(length, hurst);
      waves_.push_back({2 * pi / length * std::cos(turn), 2 * pi / length * std::sin(turn),
                        draw(0, 2 * pi), amplitude});
      power += 0.5 * amplitude * amplitude;
    }
    for (Wave& wave : waves_) wave.amplitude *= rms_nm / std::sqrt(power);
  }

  double operator()(double x, double y) const {
    double z = 0;
    for (const Wave& wave : waves_)
      z += wave.amplitude * std::cos(wave.kx * x + wave.ky * y + wave.phase);
    return z;
  }

 private:
  struct Wave {
    double kx, ky, phase, amplitude;
  };
  std::vector<Wave> waves_;
};

SampleSurface terrain() {
  Draw draw(4);
  const Waves ridges(draw, 40, 500, 1800, 0.8, 1), rough(draw, 260, 90, 900, 0.65, 21);
  return {"terrain", "rough terrain with valleys, 200 nm in all and up to 55 degrees steep",
          [ridges, rough](double x, double y) {
            const double r = ridges(x, y);
            return 35 * std::sqrt(r * r + 0.02) + rough(x, y);  // valleys where r changes its sign
          }};
}

}  // namespace

const std::vector<SampleSurface>& sample_surfaces() {
  static const std::vector<SampleSurface> all{thick_lines(), thin_lines(), pads_and_pits(),
                                              islands(), terrain()};
  return all;
}

const SampleSurface& find_sample_surface(const std::string& name) {
  const auto& all = sample_surfaces();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const SampleSurface& s) { return s.name == name; });
  if (found != all.end()) return *found;
  std::vector<std::string> names;
  for (const SampleSurface& s : all) names.push_back(s.name);
  throw UsageError(name, "there is no such sample",
                   fmt::format("Choose one of {}", fmt::join(names, ", ")));
}

void sample_heights(const SampleSurface& surface, const Affine& to_surface, HeightField& field,
                    int threads) {
  validate(field);
  parallel_for(static_cast<std::size_t>(field.z_nm.height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < field.z_nm.width(); ++x) {
      const Point2 p = to_surface({field.x_nm(x), field.y_nm(y)});
      field.z_nm(x, y) = surface.z_nm(p.x, p.y);
    }
  });
}

}  // namespace surf
