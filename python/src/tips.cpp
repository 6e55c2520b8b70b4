// SPDX-License-Identifier: GPL-3.0-or-later
// Tips: found from scans, by a known surface, or by their shape.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arrays.h"
#include "scan_findings.h"
#include "surf/afm/height_range.h"
#include "surf/afm/tip_measure.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/scan_parameters.h"
#include "surf/workflow/step_record.h"
#include "surf/workflow/tip_job.h"

namespace surf::python {
namespace {

namespace fs = std::filesystem;

double depth_of(const Tip& tip) {
  double lowest = 0;
  for (const double z : tip.z_nm.data())
    if (std::isfinite(z)) lowest = std::min(lowest, z);
  return -lowest;
}

/// Radius and angle, where the samples tell them.
void add_measures(const Tip& tip, double depth_nm, py::dict& found) {
  try {
    TipMeasures m = measure_tip(tip);
    if (const double whole_nm = depth_of(tip); !std::isfinite(m.radius_nm) && whole_nm > 0)
      m = measure_tip(tip, {.fit_depth_nm = whole_nm});
    found["radius_nm"] = m.radius_nm;
    found["radius_residual_nm"] = m.radius_residual_nm;
    if (m.half_angle_rad) found["half_angle_deg"] = *m.half_angle_rad / degrees_to_radians;
  } catch (const InvalidInput&) {  // a flat end, or too few samples
    found["radius_nm"] = py::none();
  }
  found["volume_nm3"] = tip_volume_nm3(tip, depth_nm);
}

py::object made_of(Tip tip, double depth_nm, Metadata record, py::dict found) {
  TipShape made;
  add_measures(tip, depth_nm, found);
  made.tip = std::move(tip);
  made.record = std::move(record);
  made.found = findings(found);
  return object_of(std::move(made));
}

py::object by_shape(const Call& call) {
  if (call.has("scan")) throw UsageError("`tip.shape`", "it takes no scan", "Leave out the scan");
  auto parameters = call.told<workflow::TipShapeParameters>();
  const auto reading = call.told<io::HeightReadOptions>();
  if (reading.pitch_x_nm)
    parameters.pitch_x_nm = *reading.pitch_x_nm, parameters.pitch_y_nm = *reading.pitch_y_nm;
  Tip tip = workflow::tip_by_shape(parameters);
  const double depth_nm = depth_of(tip);
  return made_of(std::move(tip), depth_nm,
                 workflow::step_record("tip", workflow::records_of(parameters, reading)),
                 py::dict());
}

struct Scans {
  std::vector<HeightField> fields;
  std::vector<fs::path> files;

  void add(const Heights& heights) {
    fields.push_back(heights.field);
    if (!heights.file.empty()) files.push_back(heights.file);
  }
  double relief_nm() const { return std::max(height_range(fields).span_nm(), 1e-9); }
};

/// One scan, or a list of scans by the same tip.
Scans scans_of(const Call& call) {
  const auto reading = call.told<io::HeightReadOptions>();
  Scans scans;
  const py::object given = call["scan"];
  if (PyList_Check(given.ptr()) || PyTuple_Check(given.ptr()))
    for (const py::handle one : given) scans.add(heights_of(one, reading, "scan"));
  else scans.add(heights_of(given, reading, "scan"));
  if (scans.fields.empty()) throw UsageError("scan", "there is none", "Give a scan, or shape=");
  return scans;
}

py::object by_characterizer(const Call& call) {
  auto parameters = call.told<workflow::CharacterizerParameters>();
  parameters.threads = call.threads();
  Scans scans = scans_of(call);
  if (scans.fields.size() > 1)
    throw UsageError("scan", "a characterizer takes one scan", "Leave out the others");
  const Heights known = heights_of(call["characterizer"], {}, "characterizer");
  CharacterizedTip found_tip;
  call.work([&](const workflow::Reporter& reporter) {
    found_tip = workflow::tip_by_characterizer(scans.fields[0], known.field, parameters, reporter);
  });
  if (!known.file.empty()) scans.files.push_back(known.file);
  Record record = workflow::records_of(parameters, call.told<io::HeightReadOptions>());
  record["tip.answer"] = "characterizer";
  py::dict found;
  found["offset"] = py::make_tuple(found_tip.offset_x, found_tip.offset_y);
  found["offset_z_nm"] = found_tip.offset_z_nm;
  found["residual_nm"] = found_tip.residual_nm;
  return made_of(std::move(found_tip.tip), scans.relief_nm(),
                 workflow::step_record("tip", record, scans.files), found);
}

py::dict found_of(const TipSweep& sweep) {
  std::vector<double> thresholds, volumes, residuals, expected;
  for (const SweptTip& one : sweep.curve) {
    thresholds.push_back(one.threshold_nm), volumes.push_back(one.volume_nm3);
    residuals.push_back(one.residual_nm), expected.push_back(one.expected_nm);
  }
  py::dict d;
  d["thresholds_nm"] = array_of(std::move(thresholds));
  d["volumes_nm3"] = array_of(std::move(volumes));
  d["residuals_nm"] = array_of(std::move(residuals));
  d["expected_nm"] = array_of(std::move(expected));
  d["chosen"] = sweep.chosen;
  return d;
}

py::object from_scans(const Call& call) {
  auto parameters = call.told<workflow::TipParameters>();
  parameters.threads = call.threads();
  const Scans scans = scans_of(call);
  workflow::TipResult result;
  call.work([&](const workflow::Reporter& reporter) {
    result = workflow::find_tip(scans.fields, parameters, reporter);
  });
  py::dict found;
  if (result.used.noise) {
    found["sigma_nm"] = result.sigma_nm;
    found["alpha"] = result.used.noise->alpha;
    found["noise_found"] = result.noise_found;
  }
  if (result.used.threshold_nm) found["threshold_nm"] = *result.used.threshold_nm;
  if (result.sweep) found["sweep"] = findings(found_of(*result.sweep));
  if (result.best) {
    found["stderr"] = array_of(result.best->standard_error_nm);
    found["misfit"] = result.best->chosen.misfit;
    found["freedom"] = result.best->chosen.freedom;
  }
  const Metadata record = workflow::step_record(
      "tip", workflow::records_of(result.used, call.told<io::HeightReadOptions>()), scans.files);
  return made_of(std::move(result.tip), scans.relief_nm(), record, found);
}

py::object tip(const Call& call) {
  if (call.is_given("tip.shape")) return by_shape(call);
  if (!call.has("scan"))
    throw UsageError("scan", "no scan is given", "Give one, or `tip.shape=cone:10nm,15deg`");
  return call.has("characterizer") ? by_characterizer(call) : from_scans(call);
}

}  // namespace

void add_tips(py::module_& module) {
  Function f{.name = "tip", .summary = "Find the tip that made a scan, or make one by its shape."};
  f.details =
      "Without `threshold`, thresholds are swept, and the tip is chosen that leaves of the scan\n"
      "what its noise explains. Level the scan first.";
  Argument scan = scan_argument;
  scan.type = "PathLike | HeightField | ArrayLike | Sequence";
  scan.help += " Or a list of scans by the same tip. None with `shape`.";
  scan.required = false;
  f.arguments = {scan,
                 {"characterizer", "PathLike | HeightField | ArrayLike",
                  "The known surface that the scan shows, as heights."}};
  f.takes<workflow::TipParameters>()
      .takes<workflow::TipShapeParameters>()
      .takes<workflow::CharacterizerParameters>()
      .takes<io::HeightReadOptions>();
  f.result_type = "Tip";
  f.result =
      "The tip. `found` has its radius, the threshold and the curve of the sweep; with "
      "answer='best' also the standard errors `stderr`.";
  f.example =
      ">>> tip = semsurf.tip(semsurf.level('scan.gwy'), tip_size=25)\n"
      ">>> cone = semsurf.tip(shape='cone:10nm,15deg', height_pitch='2nm')";
  define(module, f, tip);
}

}  // namespace surf::python
