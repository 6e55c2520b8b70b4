// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/request/simulation_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <tuple>

#include "surf/core/error.h"
#include "surf/core/parameters.h"
#include "surf/core/units.h"
#include "surf/core/words.h"

namespace surf::mc {
namespace {

int pixels(std::string_view text, const std::string& subject) {
  std::optional<int> count;
  parameters_detail::Calling read(
      [&](const Parameter&, Field& field) { field.read(text, subject); }, true);
  read(count, {.name = "pixels", .limits = at_least(1)});
  return *count;
}

void read_size(std::string_view text, const std::string& subject, ScanRequest& scan) {
  const auto parts = split(text, "xX");
  if (parts.size() > 2)
    throw UsageError(subject, fmt::format("'{}' is not a size", text),
                     "Write width x height in pixels, as 256x192");
  const int width = pixels(parts[0], subject);
  scan.height = parts.size() == 1 ? width : pixels(parts[1], subject);
  scan.width = width;
}

void read_pixel_size(std::string_view text, const std::string& subject, ScanRequest& scan) {
  std::tie(scan.pixel_x_nm, scan.pixel_y_nm) = parse_two_lengths_nm(text, subject);
}

void read_region(std::string_view text, const std::string& subject, ScanRequest& scan) {
  const auto parts = split(text, ",");
  if (parts.size() != 4)
    throw UsageError(subject, fmt::format("'{}' has {} numbers", text, parts.size()),
                     "Give the outer edges X0,Y0,X1,Y1, as -96,-96,96,96");
  const ScanRequest::Region r{
      parse_length_nm(parts[0], subject), parse_length_nm(parts[1], subject),
      parse_length_nm(parts[2], subject), parse_length_nm(parts[3], subject)};
  if (!(r.x1_nm > r.x0_nm && r.y1_nm > r.y0_nm))
    throw UsageError(subject, "the region is empty",
                     "Give the outer edges X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1");
  scan.region = r;
}

/// Detectors besides SE and BSE, each as `parse_detectors` reads it.
class DetectorsField final : public Field {
 public:
  explicit DetectorsField(std::vector<Detector>& detectors) : detectors_(detectors) {}
  FieldKind kind() const override { return FieldKind::list; }
  bool given() const override { return !detectors_.empty(); }
  std::string text() const override {
    std::string all;
    for (const Detector& d : detectors_) all += (all.empty() ? "" : "; ") + format_detector(d);
    return all;
  }
  void read(std::string_view text, const std::string& subject) override {
    detectors_.clear();
    add(text, subject);
  }
  void add(std::string_view text, const std::string& subject) override {
    for (std::size_t from = 0; from < text.size();) {
      const std::size_t end = std::min(text.find(';', from), text.size());
      const std::size_t first = text.find_first_not_of(' ', from);
      if (first < end) {
        const std::string_view one =
            text.substr(first, text.find_last_not_of(' ', end - 1) + 1 - first);
        for (Detector& d : parse_detectors(std::string(one), subject))
          detectors_.push_back(std::move(d));
      }
      from = end + 1;
    }
  }

 private:
  std::vector<Detector>& detectors_;
};

}  // namespace

void describe(ParameterVisitor& visit, ScanRequest& scan) {
  const ScanRequest before = scan;
  if (visit.reads()) scan = {};
  visit.form(
      {.name = "scan.size", .help = "Pixels of the image, as 256x192", .form = "WxH"},
      [&] { return scan.width ? fmt::format("{}x{}", *scan.width, *scan.height) : std::string(); },
      [&](std::string_view text, const std::string& subject) { read_size(text, subject, scan); });
  visit.form(
      {.name = "scan.pixel_size",
       .help = "Width and height of a pixel, as 2nm or 2nmx3nm",
       .unit = Unit::nm,
       .form = "LENGTH"},
      [&] {
        if (!scan.pixel_x_nm) return std::string();
        return fmt::format("{}x{}", format_exact(*scan.pixel_x_nm), format_exact(*scan.pixel_y_nm));
      },
      [&](std::string_view text, const std::string& subject) {
        read_pixel_size(text, subject, scan);
      });
  visit.form(
      {.name = "scan.region",
       .help = "Outer pixel edges of what is imaged, as -96,-96,96,96",
       .unit = Unit::nm,
       .form = "X0,Y0,X1,Y1",
       .level = Level::advanced},
      [&] {
        if (!scan.region) return std::string();
        const auto& r = *scan.region;
        return fmt::format("{},{},{},{}", format_exact(r.x0_nm), format_exact(r.y0_nm),
                           format_exact(r.x1_nm), format_exact(r.y1_nm));
      },
      [&](std::string_view text, const std::string& subject) { read_region(text, subject, scan); });
  if (!visit.reads()) return;
  const int said = scan.width.has_value() + scan.pixel_x_nm.has_value() + scan.region.has_value();
  if (said >= 2) return;  // two say it all, three are too many: whoever resolves the scan says so
  const ScanRequest now = scan;
  scan = before;
  if (now.width) scan.width = now.width, scan.height = now.height;
  if (now.pixel_x_nm) scan.pixel_x_nm = now.pixel_x_nm, scan.pixel_y_nm = now.pixel_y_nm;
  if (now.region) scan.region = now.region;
  if (said == 0 || !scan.width || !scan.pixel_x_nm || !scan.region) return;
  if (now.pixel_x_nm) scan.width = scan.height = std::nullopt;
  else scan.pixel_x_nm = scan.pixel_y_nm = std::nullopt;
}

void describe(ParameterVisitor& visit, Execution& execution) {
  visit(execution.threads, {.name = "job.threads",
                            .help = "Number of threads, which does not change the result",
                            .limits = within(0, 4096),
                            .otherwise = "one per hardware thread",
                            .level = Level::advanced,
                            .recorded = false});
}

void describe(ParameterVisitor& visit, SimulationRequest& request) {
  describe(visit, request.beam);
  describe(visit, request.scan);
  BudgetWords words = visit.reads() ? BudgetWords{} : words_of(request.budget);
  describe(visit, words);
  if (visit.reads()) request.budget = budget_of(words, request.budget);
  visit(request.method, {"direct", "replay"},
        {.name = "simulation.method",
         .help = "Follow each electron (direct), or retrace stored cascades (replay): both have "
                 "the same statistics",
         .otherwise = "auto: whichever is less work",
         .level = Level::advanced},
        "auto");
  visit(request.mesh_tolerance_nm, {.name = "simulation.mesh_tolerance",
                                    .help = "Leave out detail of meshes and height fields, moving "
                                            "no surface by more than this; 0 simulates all of it",
                                    .unit = Unit::nm,
                                    .limits = at_least(0),
                                    .level = Level::advanced});
  DetectorsField detectors(request.detectors);
  visit.visit({.name = "simulation.detectors",
               .help = "Detector besides SE and BSE: one of these, changed after a colon "
                       "(side:axis=60deg/90deg), or one of your "
                       "own (loss:energy=900eV..,cone=30deg)",
               .form = "SE1|SE2|quadrants|annular|in-lens|side",
               .level = Level::advanced},
              detectors);
  describe(visit, request.physics);
  visit(request.seed, {.name = "simulation.seed",
                       .help = "Seed of the random numbers: the same seed gives the same bytes",
                       .level = Level::advanced});
}

void validate(const SimulationRequest& request) {
  check_parameters(request);
  validate(request.budget);
  validate(request.physics, request.beam.energy_ev);
  validate(options_of(request).detectors);
}

SimulationOptions options_of(const SimulationRequest& request, const Execution& execution) {
  SimulationOptions options;
  static_cast<Execution&>(options) = execution;
  options.budget = request.budget;
  options.method = request.method.value_or(Method::direct);
  options.seed = request.seed;
  options.detectors.insert(options.detectors.end(), request.detectors.begin(),
                           request.detectors.end());
  return options;
}

}  // namespace surf::mc
