// SPDX-License-Identifier: GPL-3.0-or-later
// Many scans at once.
#include <fmt/format.h>

#include "data.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/scan_parameters.h"
#include "surf/workflow/survey_job.h"

namespace surf::python {
namespace {

namespace fs = std::filesystem;

template <class T>
py::object known(const std::optional<T>& value) {
  return value ? py::object(py::float_(*value)) : py::object(py::none());
}

py::object found_of(const workflow::SurveyedScan& s) {
  py::dict d;
  d["file"] = s.file.string();
  d["shape"] = py::make_tuple(s.height, s.width);
  d["pitch_nm"] = py::make_tuple(s.pitch_x_nm, s.pitch_y_nm);
  d["tilt_deg"] = s.tilt_deg;
  d["substrate_share"] = s.substrate_share;
  d["roughness_nm"] = s.roughness_nm;
  d["relief_nm"] = s.relief_nm;
  d["noise_nm"] = known(s.noise_nm);
  d["tip_radius_nm"] = known(s.tip_radius_nm);
  d["tip_radius_error_nm"] = known(s.tip_radius_error_nm);
  d["tip_half_angle_deg"] = known(s.tip_half_angle_deg);
  d["broadening_nm"] = known(s.broadening_nm);
  d["problem"] = with_keywords(s.problem);
  return findings(d);
}

/// Scans in memory as they are; of files the names, as they are read one at a time.
std::vector<py::object> given_scans(const py::object& given) {
  std::vector<py::object> all;
  const bool is_list = PyList_Check(given.ptr()) || PyTuple_Check(given.ptr());
  const auto add = [&](const py::handle& one) {
    if (!is_path(one)) {
      all.push_back(py::reinterpret_borrow<py::object>(one));
      return;
    }
    std::vector<fs::path> files;
    try {
      files = workflow::scans_of({path_of(one)});
    } catch (const FileError& e) {  // of a list, the others are wanted all the same
      if (!is_list) throw;
      Call::warn(e.what());
    }
    for (const fs::path& file : files) all.push_back(py::str(file.string()));
  };
  if (is_list)
    for (const py::handle one : given) add(one);
  else add(given);
  if (all.empty()) throw UsageError("scans", "there is none", "Give scans, or folders of scans");
  return all;
}

py::object survey(const Call& call) {
  const auto parameters = call.told<workflow::SurveyParameters>();
  const auto levelling = call.told<workflow::LevelParameters>();
  auto tip = call.told<workflow::TipParameters>();
  tip.threads = call.threads();
  const auto reading = call.told<io::HeightReadOptions>();
  const fs::path table = call.has("csv") ? path_of(call["csv"]) : std::string();
  if (!table.empty()) io::check_writable(table);
  std::vector<workflow::SurveyedScan> done;
  py::list found;
  const std::vector<py::object> scans = given_scans(call["scans"]);
  const auto go_on = [&](const Error& e) {  // the others are wanted all the same
    if (scans.size() == 1) throw;
    Call::warn(e.what());
  };
  for (const py::object& one : scans) {
    workflow::SurveyedScan s;
    try {
      const Heights scan = heights_of(one, reading, "scans");
      call.work([&](const workflow::Reporter& reporter) {
        workflow::Reporter listener = reporter;  // what it would say is in `problem`
        listener.on_note = listener.on_warning = nullptr;
        s = workflow::survey_scan(scan.field, parameters, levelling, tip, listener);
      });
      s.file = scan.file;
    } catch (const FileError& e) {
      go_on(e);
      continue;
    } catch (const InvalidInput& e) {
      go_on(e);
      continue;
    }
    done.push_back(s);
    found.append(found_of(s));
    if (!table.empty()) io::write_text(table, workflow::survey_csv(done));
  }
  return found;
}

}  // namespace

void add_survey(py::module_& module) {
  Function f{.name = "survey",
             .summary = "Roughness, noise, tip and its broadening of many AFM scans, as a table."};
  f.details =
      "Each scan is levelled first. A scan that cannot be read gives a warning, and the others\n"
      "are surveyed all the same.";
  f.arguments = {{"scans", "PathLike | HeightField | ArrayLike | Sequence",
                  "Scans, folders of scans, or a list of them.", true, false},
                 {"csv", "PathLike", "A table to write, anew after each scan."}};
  f.result_type = "list[Findings]";
  f.result =
      "For each scan that can be read: `file`, `shape`, `pitch_nm`, `tilt_deg` that was taken off, "
      "`substrate_share` of the samples on the plane, `roughness_nm` (Sq of those alone), "
      "`relief_nm` (from the 0.5th to the 99.5th percentile), `noise_nm`, `tip_radius_nm` (an "
      "outer "
      "bound) with `tip_radius_error_nm` (how far noise moves it), `tip_half_angle_deg`, "
      "`broadening_nm` (what the tip adds on each side at half of the relief). None where one is "
      "not known, and `problem` says why.";
  f.example = ">>> pandas.DataFrame(semsurf.survey('scans', tip_size=21))";
  workflow::TipParameters tip;
  f.takes<workflow::SurveyParameters>().takes<workflow::LevelParameters>();
  std::vector<std::string> without;
  for_each_parameter(tip, [&](const Parameter& about, Field&) {
    if (about.name != "tip.size" && about.name != "tip.seed") without.push_back(about.name);
  });
  f.takes<workflow::TipParameters>({}, without).takes<io::HeightReadOptions>();
  define(module, f, survey);
}

}  // namespace surf::python
