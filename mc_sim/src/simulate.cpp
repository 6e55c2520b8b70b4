// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/simulate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>

#include "scene_impl.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/mc/boundary.h"

namespace surf::mc {

namespace {

// Passes the loop's events on to an Observer.
struct Forward {
  Observer& to;
  void begin_track(int n, int parent, int generation, const Vec3& p, const Vec3& d, double e) {
    to.begin_track(n, parent, generation, p, d, e);
  }
  void segment(const Vec3& a, const Vec3& b, double ea, double eb, int m) {
    to.segment(a, b, ea, eb, m);
  }
  void end_track(TrackEnd end, const Vec3& p, const Vec3& d, double e) {
    to.end_track(end, p, d, e);
  }
};

// Where primaries start: above everything, on the beam's line through the pixel.
class Gun {
 public:
  explicit Gun(const Scene::Impl& scene)
      : scan_(scene.scan), direction_(mc::direction(scene.beam)), spot_nm_(scene.beam.spot_nm),
        top_nm_(scene.top_nm + 1.0) {
    // The scan's axes: x and y turned with the beam, by the smallest rotation from -z.
    const double k = 1.0 / (1.0 - direction_.z);
    const double dx = direction_.x, dy = direction_.y;
    across_ = {1.0 - dx * dx * k, -dx * dy * k, dx};
    up_ = {-dx * dy * k, 1.0 - dy * dy * k, dy};
  }

  const Vec3& direction() const { return direction_; }

  Vec3 start(int column, int row, RandomStream& random) const {
    double u = (column + 0.5 - 0.5 * scan_.width) * scan_.pixel_x_nm;
    double v = (row + 0.5 - 0.5 * scan_.height) * scan_.pixel_y_nm;
    if (spot_nm_ > 0) {
      const double r = spot_nm_ * std::sqrt(-2.0 * std::log(random.uniform()));
      double s, c;
      sin_cos_turn(random.uniform(), s, c);
      u += r * c;
      v += r * s;
    }
    const Vec3 p = Vec3{scan_.center_x_nm, scan_.center_y_nm, scan_.center_z_nm} + across_ * u +
                   up_ * v;
    return p - direction_ * ((p.z - top_nm_) / direction_.z);
  }

 private:
  Scan scan_;
  Vec3 direction_;
  double spot_nm_;
  double top_nm_;
  Vec3 across_, up_;
};

void add(PixelTally& pixel, const PrimaryTotals& p) {
  ++pixel.primaries;
  pixel.hits += p.hit ? 1 : 0;
  pixel.se += p.se;
  pixel.se_squared += static_cast<std::int64_t>(p.se) * p.se;
  pixel.bse += p.bse;
  pixel.bse_squared += static_cast<std::int64_t>(p.bse) * p.bse;
}

// One thread's way through units of work.
class Worker {
 public:
  explicit Worker(const Scene::Impl& scene) : scene_(scene), geometry_(scene), gun_(scene) {}

  template <class Watcher>
  void simulate(std::uint64_t seed, const WorkUnit& unit, Watcher& watcher, Observer* observer,
                UnitTally& out) {
    out.pixels = Grid<PixelTally>(unit.x1 - unit.x0, unit.y1 - unit.y0);
    Transport transport(geometry_, scene_.medium_pointers, scene_.physics.barrier,
                        observer == nullptr, watcher, out.balance);
    for (int y = unit.y0; y < unit.y1; ++y) {
      for (int x = unit.x0; x < unit.x1; ++x) {
        PixelTally& pixel = out.pixels(x - unit.x0, y - unit.y0);
        const std::int64_t number = static_cast<std::int64_t>(y) * scene_.scan.width + x;
        for (std::int64_t e = 0; e < unit.electrons; ++e) {
          const std::int64_t electron = unit.first_electron + e;
          RandomStream random(seed, static_cast<std::uint64_t>(number),
                              static_cast<std::uint64_t>(electron));
          if (observer) observer->primary(number, electron);
          add(pixel, transport.run(gun_.start(x, y, random), gun_.direction(),
                                   scene_.beam.energy_ev, 0, random));
        }
      }
    }
  }

 private:
  const Scene::Impl& scene_;
  SceneGeometry geometry_;
  Gun gun_;
};

void check_unit(const Scan& scan, const WorkUnit& u) {
  if (u.x0 < 0 || u.y0 < 0 || u.x1 > scan.width || u.y1 > scan.height || u.x0 >= u.x1 ||
      u.y0 >= u.y1 || u.electrons < 1 || u.first_electron < 0)
    throw UsageError("unit of work", "it is empty or reaches beyond the scan",
                     "Choose pixels within the scan and at least one electron");
}

void check_options(const SimulationOptions& options) {
  if (options.electrons < 1 || options.electrons > (std::int64_t{1} << 31))
    throw UsageError("--electrons", "the number of primaries per pixel must be 1 to 2^31",
                     "Ask for 200, say");
  if (options.tile_pixels < 1)
    throw UsageError("tile size", "a tile needs at least one pixel", "Ask for 1024, say");
}

// Units of work: runs of pixels along a row. Long counts of electrons are split, so that one pixel
// can keep all threads busy. Numbered rather than listed: there may be very many.
class Plan {
 public:
  Plan(const Scan& scan, const SimulationOptions& options) : scan_(scan), options_(options) {
    const std::int64_t pixels = std::max<std::int64_t>(1, most_primaries / options.electrons);
    run_ = static_cast<int>(std::min<std::int64_t>({options.tile_pixels, pixels, scan.width}));
    runs_ = (scan.width + run_ - 1) / run_;
    chunks_ = (options.electrons + most_primaries - 1) / most_primaries;
  }

  std::size_t units() const {
    return static_cast<std::size_t>(chunks_) * static_cast<std::size_t>(runs_) *
           static_cast<std::size_t>(scan_.height);
  }

  WorkUnit unit(std::size_t number) const {
    const auto n = static_cast<std::int64_t>(number);
    const std::int64_t first = n % chunks_ * most_primaries;
    const int x = static_cast<int>(n / chunks_ % runs_) * run_;
    const int y = static_cast<int>(n / chunks_ / runs_);
    return {x, y, std::min(x + run_, scan_.width), y + 1, first,
            std::min(most_primaries, options_.electrons - first)};
  }

 private:
  static constexpr std::int64_t most_primaries = 4096;   // a fraction of a second
  Scan scan_;
  SimulationOptions options_;
  int run_ = 1;
  std::int64_t runs_ = 1, chunks_ = 1;
};

}  // namespace

UnitTally simulate_unit(const Scene& scene, std::uint64_t seed, const WorkUnit& unit,
                        Observer* observer) {
  check_unit(scene.scan(), unit);
  UnitTally out;
  Worker worker(scene.impl());
  if (observer) {
    Forward forward{*observer};
    worker.simulate(seed, unit, forward, observer, out);
  } else {
    NoObserver nobody;
    worker.simulate(seed, unit, nobody, nullptr, out);
  }
  return out;
}

SimulationResult simulate(const Scene& scene, const SimulationOptions& options,
                          const ProgressCallback& progress, const CancelToken* cancel) {
  check_options(options);
  const auto begin = std::chrono::steady_clock::now();
  const Scan& scan = scene.scan();
  const Plan plan(scan, options);
  const int threads = resolve_threads(options.threads);
  std::vector<std::unique_ptr<Worker>> workers(static_cast<std::size_t>(threads));

  SimulationResult result;
  result.pixels = Grid<PixelTally>(scan.width, scan.height);
  const double total = static_cast<double>(options.electrons) * scan.width * scan.height;
  double done = 0;
  std::mutex merging;
  parallel_for(plan.units(), threads, [&](std::size_t i, int w) {
    if (cancel && cancel->cancelled()) return;
    auto& worker = workers[static_cast<std::size_t>(w)];
    if (!worker) worker = std::make_unique<Worker>(scene.impl());
    NoObserver nobody;
    UnitTally tally;
    const WorkUnit u = plan.unit(i);
    worker->simulate(options.seed, u, nobody, nullptr, tally);
    // Sums are whole numbers: the order of merging does not matter.
    const std::lock_guard lock(merging);
    for (int y = u.y0; y < u.y1; ++y)
      for (int x = u.x0; x < u.x1; ++x) result.pixels(x, y) += tally.pixels(x - u.x0, y - u.y0);
    result.balance += tally.balance;
    done += static_cast<double>(u.electrons) * (u.x1 - u.x0) * (u.y1 - u.y0);
    if (progress) progress(done, total);
  });
  result.complete = done == total;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

Image make_image(const SimulationResult& result, const Scan& scan) {
  Image image;
  image.pitch_x_nm = scan.pixel_x_nm;
  image.pitch_y_nm = scan.pixel_y_nm;
  image.origin_x_nm = scan.center_x_nm - 0.5 * (scan.width - 1) * scan.pixel_x_nm;
  image.origin_y_nm = scan.center_y_nm - 0.5 * (scan.height - 1) * scan.pixel_y_nm;
  auto channel = [&](const char* name, auto value) {
    Grid<float> values(scan.width, scan.height);
    for (std::size_t i = 0; i < values.size(); ++i)
      values.data()[i] = static_cast<float>(value(result.pixels.data()[i]));
    image.channels.push_back({name, "1", std::move(values)});
  };
  auto se = [](const PixelTally& p) { return estimate(p.primaries, p.se, p.se_squared); };
  auto bse = [](const PixelTally& p) { return estimate(p.primaries, p.bse, p.bse_squared); };
  channel("SE", [&](const PixelTally& p) { return se(p).mean; });
  channel("SE.stderr", [&](const PixelTally& p) { return se(p).standard_error; });
  channel("BSE", [&](const PixelTally& p) { return bse(p).mean; });
  channel("BSE.stderr", [&](const PixelTally& p) { return bse(p).standard_error; });
  channel("valid", [](const PixelTally& p) { return p.hits > 0 ? 1.0 : 0.0; });
  return image;
}

namespace {

// A caller's boundary function as a Geometry.
class CustomGeometry {
 public:
  using State = int;   // the material itself
  struct Surface {
    double distance = 0;
    Vec3 position, position_ahead, normal;
    State state_ahead = -1;
  };

  explicit CustomGeometry(const CustomSpecimen& specimen) : specimen_(specimen) {}

  int material(State s) const { return s; }
  double clearance(const Vec3& p) const { return specimen_.clearance ? specimen_.clearance(p) : 0; }
  double farthest() const { return 1e12; }

  Crossing crossing(const Vec3& start, const Vec3& direction, double length, State& state,
                    Surface& surface) const {
    const auto hit = specimen_.boundary(start, direction, length, state);
    if (!hit) return Crossing::none;
    if (!std::isfinite(hit->distance_nm) || hit->distance_nm < 0 ||
        hit->material_ahead >= static_cast<int>(specimen_.media.size()))
      throw InvalidInput("boundary function",
                         "it gave a distance that is negative or not finite, or an unknown material",
                         "Return nothing where there is no boundary ahead");
    surface.distance = hit->distance_nm;
    surface.position = surface.position_ahead = start + direction * hit->distance_nm;
    surface.normal = hit->normal;
    surface.state_ahead = hit->material_ahead;
    return Crossing::surface;
  }

 private:
  const CustomSpecimen& specimen_;
};

}  // namespace

CustomResult simulate_custom(const CustomSpecimen& specimen, const Vec3& start,
                             const Vec3& direction, double energy_ev, int start_material,
                             BarrierModel barrier, std::uint64_t seed, std::int64_t electrons,
                             Observer* observer) {
  CustomResult out;
  CustomGeometry geometry(specimen);
  const auto send = [&](auto& watcher) {
    Transport transport(geometry, specimen.media, barrier, specimen.clearance && !observer, watcher,
                        out.balance);
    for (std::int64_t e = 0; e < electrons; ++e) {
      RandomStream random(seed, 0, static_cast<std::uint64_t>(e));
      if (observer) observer->primary(0, e);
      add(out.tally, transport.run(start, direction, energy_ev, start_material, random));
    }
  };
  if (observer) {
    Forward forward{*observer};
    send(forward);
  } else {
    NoObserver nobody;
    send(nobody);
  }
  return out;
}

}  // namespace surf::mc
