// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/detection.h"

#include <algorithm>
#include <cmath>

#include "surf/core/units.h"

namespace surf::mc {

namespace {

constexpr double whole_turn_deg = 360;

// Exact where directions are: a cone of 90 degrees is the half space.
double cosine_of(double angle_deg) {
  if (angle_deg == 90) return 0;
  if (angle_deg == 180) return -1;
  return std::cos(angle_deg * degrees_to_radians);
}

double azimuth(double x, double y) {
  const double a = std::atan2(y, x) / degrees_to_radians;
  return a < 0 ? std::min(a + whole_turn_deg, std::nextafter(whole_turn_deg, 0.0)) : a;
}

}  // namespace

Spectra& Spectra::operator+=(const Spectra& b) {
  energy_ev += b.energy_ev;
  polar_deg += b.polar_deg;
  azimuth_deg += b.azimuth_deg;
  return *this;
}

Spectra make_spectra(const Detector& d, const Beam& beam) {
  // No electron leaves with more than the beam's energy but for a barrier's step between materials.
  const double top =
      std::max(std::min(d.max_energy_ev, beam.energy_ev * (1 + 1e-9)), d.min_energy_ev + 1e-6);
  Spectra s;
  s.energy_ev = {d.min_energy_ev, top, std::vector<Counts>(100)};
  s.polar_deg = {0, 180, std::vector<Counts>(90)};
  s.azimuth_deg = {0, whole_turn_deg, std::vector<Counts>(72)};
  return s;
}

Detection::Detection(const std::vector<Detector>& detectors, const Beam& beam, bool with_spectra)
    : counts_(detectors.size()) {
  for (const Detector& d : detectors) {
    detectors_.push_back(compile(d, beam));
    detectors_.back().stream = detectors_.size();
    if (with_spectra) spectra_.push_back(make_spectra(d, beam));
  }
}

Detection::Compiled Detection::compile(const Detector& d, const Beam& beam) {
  Compiled c;
  c.min_energy = d.min_energy_ev;
  c.max_energy = d.max_energy_ev;
  c.side = d.side;
  c.origin = d.origin;
  c.whole_sphere = d.min_angle_deg == 0 && d.max_angle_deg == 180;
  c.whole_turn = d.from_azimuth_deg == 0 && d.to_azimuth_deg == whole_turn_deg;
  c.axis = axis_direction(d, beam);
  // The axes x and y turned with z onto the axis, by the smallest rotation: the scan's own for the
  // beam's axis. Straight down there is no smallest one.
  const Vec3& a = c.axis;
  if (a.z > -1) {
    const double k = 1 / (1 + a.z);
    c.across = {1 - a.x * a.x * k, -a.x * a.y * k, -a.x};
    c.up = {-a.x * a.y * k, 1 - a.y * a.y * k, -a.y};
  } else {
    c.across = {1, 0, 0};
    c.up = {0, -1, 0};
  }
  c.min_cosine = cosine_of(d.max_angle_deg);
  c.max_cosine = d.min_angle_deg == 0 ? HUGE_VAL : cosine_of(d.min_angle_deg);
  c.from_turn_deg = d.from_azimuth_deg;
  c.to_turn_deg = d.to_azimuth_deg;
  c.acceptance = d.acceptance;
  return c;
}

double Detection::azimuth_deg(const Compiled& d, const Vec3& direction) {
  return azimuth(dot(direction, d.across), dot(direction, d.up));
}

bool Detection::accepts(const Compiled& d, const Escape& e) {
  if (!(e.energy_ev >= d.min_energy && e.energy_ev < d.max_energy)) return false;
  if (d.side != Side::any && (d.side == Side::up) != (e.direction.z >= 0)) return false;
  if (d.origin != Origin::any && (d.origin == Origin::se1) != (e.secondary && !e.turned))
    return false;
  if (!d.whole_sphere) {
    const double cosine = dot(e.direction, d.axis);
    if (!(cosine >= d.min_cosine && cosine < d.max_cosine)) return false;
  }
  if (!d.whole_turn && !in_sector(d, e.direction)) return false;
  return !d.acceptance || is_counted(probability(*d.acceptance, e.energy_ev, e.direction),
                                     e.energy_ev, e.direction, d.stream);
}

bool Detection::in_sector(const Compiled& d, const Vec3& direction) {
  const double turn = azimuth_deg(d, direction);
  return d.from_turn_deg < d.to_turn_deg ? turn >= d.from_turn_deg && turn < d.to_turn_deg
                                         : turn >= d.from_turn_deg || turn < d.to_turn_deg;
}

void Detection::count(std::size_t detector, const Escape& e) {
  ++counts_[detector];
  if (spectra_.empty()) return;
  Spectra& s = spectra_[detector];
  touch(s.energy_ev, e.energy_ev);
  touch(s.polar_deg, std::acos(std::clamp(e.direction.z, -1.0, 1.0)) / degrees_to_radians);
  touch(s.azimuth_deg, azimuth(e.direction.x, e.direction.y));
}

void Detection::touch(Histogram& histogram, double value) {
  const int i = histogram.bin(value);
  if (i >= 0) touched_.push_back(&histogram.bins[static_cast<std::size_t>(i)]);
}

std::vector<Spectra> Detection::take_spectra() {
  std::vector<Spectra> taken = spectra_;
  for (Spectra& s : spectra_)
    for (Histogram* h : {&s.energy_ev, &s.polar_deg, &s.azimuth_deg})
      std::fill(h->bins.begin(), h->bins.end(), Counts{});
  return taken;
}

void Detection::end_primary() {
  std::fill(counts_.begin(), counts_.end(), 0);
  if (touched_.empty()) return;
  std::sort(touched_.begin(), touched_.end());
  for (std::size_t i = 0; i < touched_.size();) {
    std::size_t j = i;
    while (j < touched_.size() && touched_[j] == touched_[i]) ++j;
    touched_[i]->add(static_cast<std::int64_t>(j - i));
    i = j;
  }
  touched_.clear();
}

}  // namespace surf::mc
