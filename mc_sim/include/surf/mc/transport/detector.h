// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/vec3.h"
#include "surf/mc/geometry/beam.h"
#include "surf/mc/transport/acceptance.h"

namespace surf::mc {

/// Which electrons by where they come from. SE1: secondaries generated before the primary has
/// turned by more than 90 degrees from the beam, with everything that they generate in turn; SE2:
/// all others, the primary itself among them. The two add up to `any`.
enum class Origin { any, se1, se2 };

/// Which electrons by the sign of their direction's z: up counts horizontal ones.
enum class Side { any, up, down };

/// A direction from the specimen: `polar_deg` from z (0 to 180), `azimuth_deg` from x towards y.
struct Axis {
  double polar_deg = 0;
  double azimuth_deg = 0;
};

/// What counts an electron that has left for good: an energy window, a cone (or a ring, or a sector
/// of it) and an efficiency. Electrons fly straight: the cone is of directions as they leave, seen
/// from far away. Ranges that touch share no electron and leave none out.
struct Detector {
  std::string name;          ///< of the channel: letters, digits, '-', '_'
  double min_energy_ev = 0;  ///< energy in vacuum: min <= E < max
  double max_energy_ev = std::numeric_limits<double>::infinity();
  Side side = Side::any;
  Origin origin = Origin::any;
  std::optional<Axis> axis;  ///< of the cone; absent: back along the beam
  double min_angle_deg = 0;  ///< from the axis: min < angle <= max; 0 counts the axis itself
  double max_angle_deg = 180;
  double from_azimuth_deg = 0;  ///< about the axis: from <= azimuth < to, each 0 to 360;
  double to_azimuth_deg = 360;  ///< from > to goes through 0. Azimuth 0 is the image's x
  double efficiency = 1;        ///< share of those electrons that is counted, in (0, 1]
  /// Which of those electrons are counted, besides, by a table; null: all. In text it is a hash,
  /// which cannot be read back.
  std::shared_ptr<const Acceptance> acceptance = nullptr;
};

/// The two that every simulation has, first: SE (below 50 eV, any direction) and BSE (from 50 eV,
/// upward).
std::vector<Detector> default_detectors();

/// Reads one of
///   SE1, SE2                  the parts of SE
///   quadrants                 BSE-right, BSE-top, BSE-left, BSE-bottom: BSE in four sectors of 90
///                             degrees about the beam, named as they lie in the image
///   annular                   BSE-annular: BSE between 15 and 45 degrees from the beam
///   in-lens                   SE-in-lens: SE within 45 degrees of the beam
///   side                      SE-side: SE towards a side-mounted detector, the half space about an
///                             axis 60 degrees from z towards +x
/// or a name of one's own, each with changes after a colon, such as
///   loss:energy=900eV..1keV,cone=0deg..30deg   or   side:axis=60deg/90deg,efficiency=0.8
/// Keys: name, energy = FROM..TO (either end may be left out), cone = ANGLE or FROM..TO,
/// axis = beam | POLAR/AZIMUTH, sector = FROM..TO, side = up | down | any,
/// origin = any | se1 | se2, efficiency. Throws UsageError, naming `subject`.
std::vector<Detector> parse_detectors(const std::string& text, const std::string& subject);

/// A detector in the same words, every key given.
std::string format_detector(const Detector& detector);

/// Throws UsageError naming the detector: ranges that are empty or out of bounds, two detectors of
/// one name.
void validate(const std::vector<Detector>& detectors);

/// Whether turning the specimen about the beam changes what it counts: it looks from a side.
bool looks_from_a_side(const Detector& detector);

/// The unit vector of a detector's axis.
Vec3 axis_direction(const Detector& detector, const Beam& beam);

}  // namespace surf::mc
