// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/planar_controls.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>

#include "geometry/scene_impl.h"
#include "replay/replay.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "transport/random_streams.h"

namespace surf::mc {

namespace {

constexpr double step_deg = 1;         // between controls, where azimuths do not count
constexpr double coarse_step_deg = 5;  // where they do
constexpr double steepest_deg = 86;
constexpr double exact_steps = 1e9;  // normals that agree to this are one

thread_local double spent_here = 0;  // seconds

// Everything below a plane through the origin.
class HalfSpace {
 public:
  using State = int;  // 0: vacuum, 1: matter
  struct Surface {
    double distance = 0;
    Vec3 position, position_ahead, normal;
    State state_ahead = 0;
  };

  HalfSpace(const Vec3& normal, int material) : normal_(normal), material_(material) {}

  int material(State s) const { return s == 0 ? -1 : material_; }
  double clearance(const Vec3& p) const { return std::fabs(dot(p, normal_)); }
  double farthest() const { return 1e12; }
  bool flies_free(const Vec3& p, const Vec3& d) const {
    return dot(p, normal_) >= 0 && dot(d, normal_) > 0;
  }

  Crossing crossing(const Vec3& start, const Vec3& direction, double most, State& state,
                    Surface& surface, const KnownFaces& = {}) const {
    const double height = dot(start, normal_), rate = dot(direction, normal_);
    if (state == 0 ? rate >= 0 : rate <= 0) return Crossing::none;
    const double distance = std::max(0.0, -height / rate);
    if (distance > most) return Crossing::none;
    Vec3 p = start + direction * distance;
    p -= normal_ * dot(p, normal_);
    surface = {distance, p, p, normal_, 1 - state};
    return Crossing::surface;
  }

 private:
  Vec3 normal_;
  int material_;
};

bool axial(const Scene::Impl& scene, const std::vector<Detector>& detectors) {
  const Vec3 beam = direction(scene.beam);
  for (const Detector& d : detectors) {
    const bool whole = d.min_angle_deg == 0 && d.max_angle_deg == 180;
    if (!whole && length(axis_direction(d, scene.beam) + beam) > 1e-12) return false;
    if (d.from_azimuth_deg != 0 || d.to_azimuth_deg != 360) return false;
    if (d.side != Side::any && scene.beam.tilt_deg != 0) return false;
  }
  return true;
}

}  // namespace

struct PlanarControls::Slot {
  std::once_flag made;
  std::atomic<bool> ready = false;
  std::shared_ptr<const PlanarControl> control;
};

PlanarControls::PlanarControls(const Scene::Impl& scene, const SimulationOptions& options,
                               const Libraries& libraries, const CancelToken* cancel)
    : scene_(scene), options_(options), libraries_(libraries), cancel_(cancel),
      axial_(axial(scene, options.detectors)), against_(-direction(scene.beam)) {
  // The smallest rotation of x and y with -z onto the beam.
  const double k = 1.0 / (1.0 + against_.z);
  across_ = {1 - k * against_.x * against_.x, -k * against_.x * against_.y, -against_.x};
  up_ = {-k * against_.x * against_.y, 1 - k * against_.y * against_.y, -against_.y};
  for (const auto& l : libraries)
    if (l) cascades_ = cascades_ == 0 ? l->cascades() : std::min(cascades_, l->cascades());
}

PlanarControls::~PlanarControls() = default;

double PlanarControls::azimuth(std::uint64_t seed, std::size_t cascade) {
  return azimuth_of({seed, random_streams::azimuths, cascade, cascade, 0});
}

PlanarControls::Made PlanarControls::made() const {
  const std::lock_guard lock(mutex_);
  return made_;
}

double PlanarControls::seconds_of_this_thread() { return spent_here; }

PlanarControls::Place PlanarControls::place(int material, const Vec3& normal, bool exact) const {
  const double cosine = std::clamp(dot(normal, against_), -1.0, 1.0);
  const double polar = std::acos(cosine) / degrees_to_radians;
  const double turn = std::atan2(dot(normal, up_), dot(normal, across_)) / (2 * std::numbers::pi);
  const double azimuth = turn < 0 ? turn + 1 : turn;
  const auto at = [&](double polar_deg, double azimuth_turns) {
    double s, c;
    sin_cos_turn(azimuth_turns, s, c);
    const double sine = std::sin(polar_deg * degrees_to_radians);
    return across_ * (sine * c) + up_ * (sine * s) +
           against_ * std::cos(polar_deg * degrees_to_radians);
  };

  Place out;
  auto& [key, plane, turned] = out;
  if (exact) {
    plane = axial_ ? normalized(across_ * std::sqrt(std::max(0.0, 1 - cosine * cosine)) +
                                against_ * cosine)
                   : normal;
    key = {material, std::llround(plane.x * exact_steps), std::llround(plane.y * exact_steps),
           std::llround(plane.z * exact_steps)};
    if (axial_) turned = azimuth;
  } else {
    const double step = axial_ ? step_deg : coarse_step_deg;
    const auto i = std::llround(std::min(polar, steepest_deg) / step);
    // As many sectors as keep neighbours about a step apart.
    const auto sectors =
        axial_ || i == 0
            ? std::int64_t{1}
            : std::llround(360 / step * std::sin(double(i) * step * degrees_to_radians));
    const auto j = axial_ ? 0 : std::llround(azimuth * double(sectors)) % sectors;
    plane = at(double(i) * step, axial_ ? 0 : double(j) / double(sectors));
    key = {-1 - material, i, j, 0};
    if (axial_) turned = azimuth;
  }
  return out;
}

PlanarControls::Match PlanarControls::match(int material, const Vec3& normal, bool exact) {
  const Place where = place(material, normal, exact);
  Match out;
  out.azimuth = where.azimuth;
  std::shared_ptr<Slot> slot;
  {
    const std::lock_guard lock(mutex_);
    auto& known = slots_[where.key];
    if (!known) known = std::make_shared<Slot>();
    slot = known;
  }
  if (slot->ready) {
    out.control = slot->control;
    return out;
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  std::call_once(slot->made, [&] {
    // A number that depends on the plane alone, not on who asks first.
    const auto [a, b, c, d] = where.key;
    std::uint64_t number = random_streams::planes;
    for (const std::int64_t v : {std::int64_t{a}, b, c, d})
      number ^= (static_cast<std::uint64_t>(v) * 0x9e3779b97f4a7c15u + (number << 6)) >> 20;
    slot->control = make(material, where.plane, number);
    slot->ready = true;
    const std::lock_guard lock(mutex_);
    ++made_.planes;
    made_.seconds += seconds();
  });
  spent_here += seconds();
  out.control = slot->control;
  return out;
}

std::shared_ptr<const PlanarControl> PlanarControls::make(int material, const Vec3& normal,
                                                          std::uint64_t number) const {
  const std::size_t detectors = options_.detectors.size();
  auto control = std::make_shared<PlanarControl>();
  control->normal = normal;
  control->number = number;
  control->counts.assign(detectors, std::vector<std::uint8_t>(cascades_));
  control->sums.resize(detectors);

  HalfSpace geometry(normal, material);
  Detection detection(options_.detectors, scene_.beam, false);
  Balance balance;
  NoObserver nobody;
  Transport<HalfSpace, NoObserver> direct(geometry, scene_.medium_pointers, scene_.physics.barrier,
                                          true, nobody, detection, balance);
  std::vector<const CascadeLibrary*> libraries;
  for (const auto& l : libraries_) libraries.push_back(l.get());
  const bool turns = std::any_of(options_.detectors.begin(), options_.detectors.end(),
                                 [](const Detector& d) { return d.origin != Origin::any; });
  Replay<HalfSpace> replay(geometry, scene_.medium_pointers, libraries, scene_.physics.barrier,
                           turns, direct, detection, balance);
  replay.surroundings({{}, normal, HUGE_VAL, true, 1, 0});
  replay.use_common_random_numbers(true);
  const Vec3 beam = -against_;
  HalfSpace::Surface entry;
  int state = 0;
  if (geometry.crossing(against_, beam, HUGE_VAL, state, entry) != Crossing::surface)
    return control;
  for (std::size_t i = 0; i < cascades_; ++i) {
    if (cancel_ && cancel_->cancelled()) throw Interrupted();
    if (i + 1 < cascades_) replay.fetch(material, i + 1);
    replay.run_from(entry, beam, scene_.beam.energy_ev, 0,
                    {options_.seed, number, i, i, azimuth(options_.seed, i)});
    for (std::size_t d = 0; d < detectors; ++d) {
      const int n = std::min(detection.counts()[d], 255);
      control->counts[d][i] = static_cast<std::uint8_t>(n);
      control->sums[d].add(n);
    }
    detection.end_primary();
  }
  return control;
}

}  // namespace surf::mc
