// SPDX-License-Identifier: GPL-3.0-or-later
// Levelling, cleaning, morphology and certainty of AFM scans.
#include <fmt/format.h>

#include "arrays.h"
#include "data.h"
#include "scan_findings.h"
#include "surf/core/error.h"
#include "surf/io/scan_parameters.h"
#include "surf/workflow/certainty_job.h"
#include "surf/workflow/clean_job.h"
#include "surf/workflow/level_job.h"
#include "surf/workflow/morphology_job.h"
#include "surf/workflow/step_record.h"

namespace surf::python {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(std::initializer_list<const Made*> made) {
  std::vector<fs::path> files;
  for (const Made* const one : made)
    if (!one->file.empty()) files.push_back(one->file);
  return files;
}

namespace {

py::dict numbers_of(const Plane& plane) {
  py::dict d;
  d["tilt_deg"] = plane.tilt_deg();
  d["uphill_deg"] = plane.uphill_deg();
  d["slope_x"] = plane.slope_x;
  d["slope_y"] = plane.slope_y;
  d["height_nm"] = plane.height_nm;
  return d;
}

py::object what_levelling_found(const workflow::LevelResult& levelled, const Mask& use) {
  py::dict found;
  found["tilt_deg"] = levelled.tilt_deg;
  found["roughness"] = findings(found_of(measure_roughness(levelled.field, use)));
  if (!levelled.substrate.empty()) found["substrate"] = array_of(levelled.substrate);
  if (levelled.plane) found["plane"] = findings(numbers_of(*levelled.plane));
  if (levelled.rows) found["row_offsets_nm"] = array_of(levelled.rows->offsets_nm);
  if (levelled.hough) {
    found["inlier_share"] = levelled.hough->inlier_share;
    found["inlier_rms_nm"] = levelled.hough->inlier_rms_nm;
    found["runner_up_share"] = levelled.hough->runner_up_share;
    found["substrate_roughness"] =
        findings(found_of(measure_roughness(levelled.field, levelled.substrate)));
  }
  return findings(found);
}

void refuse_degree_alone(const Call& call, const workflow::LevelParameters& p) {
  if (call.is_given("level.degree") && p.method != workflow::LevelMethod::polynomial)
    throw UsageError("`level.degree`", "only a polynomial has one",
                     "Add `level.method=polynomial`");
}

py::object level(const Call& call) {
  const auto parameters = call.told<workflow::LevelParameters>();
  refuse_degree_alone(call, parameters);
  const Heights scan = heights_of(call, "scan");
  std::vector<fs::path> inputs = files_of({&scan});
  const Mask use = masks_of(call, scan.field, inputs);
  workflow::LevelResult levelled;
  call.work([&](const workflow::Reporter& reporter) {
    levelled = workflow::level(scan.field, parameters, use, reporter);
  });
  Record record = workflow::records_of(parameters, scan.reading);
  for (const char* name : {"use", "exclude"})
    if (call.has(name) && is_path(call[name]))
      record[fmt::format("scan.{}", name)] = path_of(call[name]);
  Heights made;
  made.record = workflow::step_record("level", record, inputs);
  made.found = what_levelling_found(levelled, use);
  made.field = std::move(levelled.field);
  return object_of(std::move(made));
}

py::object numbers_of(const CleanSummary& summary) {
  py::dict d;
  d["changed"] = summary.changed;
  d["filled"] = summary.filled;
  d["holes"] = summary.holes;
  return findings(d);
}

py::object clean(const Call& call) {
  auto parameters = call.told<workflow::CleanParameters>();
  if (!parameters.median && !parameters.spikes && !parameters.closing)
    throw UsageError("clean", "nothing is to be done",
                     "Add `clean.spikes=3:0.5nm`, `clean.median=3` or `clean.closing=5`");
  if (parameters.disc && !parameters.median && !parameters.spikes)
    throw UsageError("`clean.disc`", "a closing is by a square",
                     "Leave it out, or add `clean.median=3`");
  parameters.threads = call.threads();
  const Heights scan = heights_of(call, "scan");
  workflow::CleanResult cleaned;
  call.work([&](const workflow::Reporter& reporter) {
    cleaned = workflow::clean(scan.field, parameters, reporter);
  });
  py::dict found;
  if (cleaned.spikes) found["spikes"] = numbers_of(*cleaned.spikes);
  if (cleaned.median) found["median"] = numbers_of(*cleaned.median);
  if (cleaned.closing) found["closing"] = numbers_of(*cleaned.closing);
  Heights made;
  made.record = workflow::step_record("clean", workflow::records_of(cleaned.used, scan.reading),
                                      files_of({&scan}));
  made.found = findings(found);
  made.field = std::move(cleaned.field);
  return object_of(std::move(made));
}

using workflow::MorphologyOperation;

Body morphology(MorphologyOperation operation) {
  return [operation](const Call& call) {
    auto parameters = call.told<workflow::MorphologyParameters>();
    parameters.threads = call.threads();
    const Heights scan = heights_of(call, "scan");
    const TipShape tip = tip_of(call["tip"], "tip");
    Heights made;
    call.work([&](const workflow::Reporter& reporter) {
      const Tip fitting = workflow::tip_for(tip.tip, scan.field, name_of(tip), reporter);
      made.field = workflow::morphology(operation, scan.field, fitting, parameters, reporter);
    });
    made.record = workflow::step_record(workflow::name(operation),
                                        workflow::records_of(parameters, scan.reading),
                                        files_of({&scan, &tip}));
    return object_of(std::move(made));
  };
}

/// Certain, radius and surface, as the command writes them.
Image image_of(const CertaintyMap& map) {
  const int w = map.level.width(), h = map.level.height();
  Image image;
  image.placement() = map.surface.placement();
  Grid<float> certain(w, h), radius(w, h), surface(w, h);
  for (std::size_t i = 0; i < certain.size(); ++i) {
    const bool is_certain = map.level.data()[i] != CertaintyMap::uncertain;
    certain.data()[i] = is_certain ? 1.0f : 0.0f;
    radius.data()[i] = is_certain ? static_cast<float>(map.level.data()[i]) : -1.0f;
    surface.data()[i] = static_cast<float>(map.surface.z_nm.data()[i]);
  }
  image.channels = {{"certain", "1", std::move(certain)},
                    {"radius_px", "1", std::move(radius)},
                    {"surface", "nm", std::move(surface)}};
  return image;
}

py::object certainty(const Call& call) {
  auto parameters = call.told<workflow::CertaintyParameters>();
  parameters.threads = call.threads();
  const Heights scan = heights_of(call, "scan");
  const TipShape tip = tip_of(call["tip"], "tip");
  workflow::CertaintyResult result;
  call.work([&](const workflow::Reporter& reporter) {
    const Tip fitting = workflow::tip_for(tip.tip, scan.field, name_of(tip), reporter);
    result = workflow::certainty(scan.field, fitting, parameters, reporter);
  });
  const CertaintyMap& map = result.map;
  const auto share = [](std::size_t part, std::size_t whole) {
    return whole ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  };
  Picture made;
  made.image = image_of(map);
  made.record = made.image.metadata = workflow::step_record(
      "certainty", workflow::records_of(result.used, scan.reading), files_of({&scan, &tip}));
  Heights eroded;
  eroded.field = map.surface;
  eroded.record = made.record;
  py::dict found;
  found["tolerance_nm"] = map.tolerance_nm;
  found["neighbourhood"] = map.neighbourhood;
  found["single_share"] = share(map.single, map.image_pixels);
  found["ambiguous_share"] = share(map.ambiguous, map.image_pixels);
  found["unexplained_share"] = share(map.unexplained, map.image_pixels);
  found["certain_share"] = share(map.certain, map.surface_samples);
  found["trustworthy"] = result.trustworthy;
  found["eroded"] = object_of(std::move(eroded));
  made.found = findings(found);
  return object_of(std::move(made));
}

Function of_scan(const char* name, const char* summary) {
  Function f{.name = name, .summary = summary, .arguments = {scan_argument}};
  f.result_type = "HeightField";
  return f;
}

Function with_tip(const char* name, const char* summary, const char* what) {
  Function f = of_scan(name, summary);
  f.arguments.front().help = fmt::format("{}: a file, or heights; arrays are in nm.", what);
  f.arguments.push_back(tip_argument);
  f.takes<io::HeightReadOptions>();
  f.result = "The heights, with their record.";
  return f;
}

}  // namespace

py::dict found_of(const Roughness& r) {
  py::dict d;
  d["sa_nm"] = r.sa_nm;
  d["sq_nm"] = r.sq_nm;
  d["sz_nm"] = r.sz_nm;
  d["ssk"] = r.ssk;
  d["sku"] = r.sku;
  d["sq_levelled_nm"] = r.sq_levelled_nm;
  d["samples"] = r.samples;
  return d;
}

std::string name_of(const TipShape& tip) { return tip.file.empty() ? "tip" : tip.file.string(); }

void add_scans(py::module_& module) {
  Function f = of_scan("level", "Level an AFM scan: take its background off.");
  f.arguments.push_back(use_argument), f.arguments.push_back(exclude_argument);
  f.result =
      "The levelled heights. `found` has the plane, the tilt, the substrate's mask and the "
      "roughness.";
  f.example =
      ">>> flat = semsurf.level('scan.gwy', rows='median')\n"
      ">>> flat.found.tilt_deg, flat.found.roughness.sq_nm";
  define(module, f.takes<workflow::LevelParameters>().takes<io::HeightReadOptions>(), level);

  f = of_scan("clean", "Take spikes, noise and pits out of an AFM scan.");
  f.details =
      "What is asked for happens in this order: spikes, median, closing. Widths are odd numbers\n"
      "of samples.";
  f.result = "The cleaned heights. `found` says how many were changed.";
  f.example = ">>> clean = semsurf.clean(scan, spikes='3:0.5nm')";
  define(module, f.takes<workflow::CleanParameters>().takes<io::HeightReadOptions>(), clean);

  const auto add = [&](MorphologyOperation operation, const char* summary, const char* what) {
    const bool distance =
        operation == MorphologyOperation::erode || operation == MorphologyOperation::dilate;
    const std::vector<std::string> without =
        distance ? std::vector<std::string>{} : std::vector<std::string>{"morphology.distance"};
    define(module,
           with_tip(workflow::name(operation), summary, what)
               .takes<workflow::MorphologyParameters>({}, without),
           morphology(operation));
  };
  add(MorphologyOperation::erode,
      "Take a tip out of a scan: the highest surface that agrees with it.", "The scan");
  add(MorphologyOperation::dilate, "The scan that a tip makes of a surface.", "The surface");
  add(MorphologyOperation::open,
      "Take off a scan what a tip cannot have touched: erosion, then dilation.", "The scan");
  add(MorphologyOperation::close,
      "Fill what a tip does not reach of a surface: dilation, then erosion.", "The surface");

  f = with_tip("certainty", "Where an eroded scan is the surface.", "The scan");
  f.result_type = "Image";
  f.result =
      "Channels 'certain' (1 where the tip touched the surface and nothing else could have made "
      "the scan what it is), 'radius_px' and 'surface'. `found` has the shares, and `eroded`.";
  define(module, f.takes<workflow::CertaintyParameters>(), certainty);
}

}  // namespace surf::python
