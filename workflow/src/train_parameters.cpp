// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "surf/core/command_words.h"
#include "surf/core/error.h"
#include "surf/core/some_parameters.h"
#include "surf/core/units.h"
#include "surf/core/words.h"
#include "surf/io/cache.h"
#include "surf/io/scan_parameters.h"
#include "surf/mc/request/simulation_request.h"
#include "surf/sem/fit_facet_network.h"
#include "surf/sem/fit_filter_bank.h"
#include "surf/workflow/slope_table.h"
#include "surf/workflow/train_job.h"

namespace surf::workflow {
namespace {

constexpr double most_electrons = 2147483648.0;
constexpr std::size_t most_hidden_layers = 3;
constexpr double most_pixel_nm = 1e6;

std::string write_scales(const std::vector<FacetScale>& scales) {
  std::string text;
  for (const FacetScale& scale : scales)
    text += fmt::format("{}{}", text.empty() ? "" : ",", scale.size);
  return text;
}

std::vector<FacetScale> read_scales(std::string_view text, const std::string& subject) {
  const std::vector<FacetScale> all = thesis_scales();
  std::vector<FacetScale> scales;
  for (const int size : parse_whole_numbers(
           text, {.name = "scale", .help = "", .limits = within(5, 255)}, subject)) {
    const auto known = std::ranges::find(all, size, &FacetScale::size);
    if (known == all.end())
      throw UsageError(subject, fmt::format("there is no neighbourhood of {} samples", size),
                       "Choose among " + write_scales(all));
    scales.push_back(*known);
  }
  return scales;
}

/// Reads "24,12" for two hidden layers, "0" for none.
std::vector<int> read_hidden(std::string_view text, const std::string& subject) {
  if (text == "0") return {};
  return parse_whole_numbers(text, {.name = "units", .help = "", .limits = within(1, 256)},
                             subject);
}

/// The hidden layers of a network, which can also be set from a list of values.
class HiddenField final : public Field {
 public:
  explicit HiddenField(std::optional<std::vector<int>>& layers) : layers_(layers) {}
  FieldKind kind() const override { return FieldKind::text; }
  bool given() const override { return layers_.has_value(); }
  std::string text() const override {
    return !layers_ ? "" : layers_->empty() ? "0" : fmt::format("{}", fmt::join(*layers_, ","));
  }
  void read(std::string_view text, const std::string& subject) override {
    layers_ = read_hidden(text, subject);
    check(subject);
  }
  void clear() override { layers_.reset(); }
  void check(const std::string& subject) const override {
    if (!layers_) return;
    for (const int units : *layers_)
      if (units < 1 || units > 256)
        throw UsageError(subject, fmt::format("{} is out of range", units),
                         "Give 1 to 256 units for each layer");
    if (layers_->size() > most_hidden_layers)
      throw UsageError(subject, fmt::format("{} hidden layers are too many", layers_->size()),
                       "Give 1 to 3, or 0 for none");
  }

 private:
  std::optional<std::vector<int>>& layers_;
};

/// A kind of model that can be trained. Unknown kinds are refused later, when the learner is looked
/// up.
class KindField final : public Field {
 public:
  explicit KindField(std::string& kind) : kind_(kind) {}
  FieldKind kind() const override { return FieldKind::choice; }
  std::vector<std::string> choices() const override {
    std::vector<std::string> names;
    for (const LearnableKind& one : learnable_kinds()) names.push_back(one.name);
    return names;
  }
  bool given() const override { return !kind_.empty(); }
  std::string text() const override { return kind_; }
  void read(std::string_view text, const std::string&) override { kind_ = text; }

 private:
  std::string& kind_;
};

/// Describes a number whose value 0 stands for an automatic choice.
void show_or_none(ParameterVisitor& visit, int& number, const Parameter& about) {
  std::optional<int> given = number != 0 ? std::optional(number) : std::nullopt;
  visit(given, about);
  number = given.value_or(0);
}

double read_square_nm(std::string_view text, const std::string& subject) {
  const auto [x, y] = parse_two_lengths_nm(text, subject);
  if (!(x > 0) || x != y)
    throw UsageError(subject, "a model's pixels are square and above zero", "Write 3nm");
  if (x > most_pixel_nm)
    throw UsageError(subject, fmt::format("{} is out of range", format_length(x)),
                     fmt::format("Give at most {}", format_length(most_pixel_nm)));
  return x;
}

/// Describes the scope of a model and the simulation of its images, in the form of a simulation
/// request.
void describe_simulation(ParameterVisitor& visit, TrainJob& job) {
  mc::SimulationRequest request;
  request.beam.energy_ev = job.energy_ev;
  request.beam.spot_nm = job.spot_nm;
  request.detectors = job.detectors;
  request.physics = job.physics;
  request.budget = job.simulation.budget;
  request.seed = job.simulation.seed;
  const std::string usual = std::to_string(mc::electrons_of(training_simulation().budget));
  describe_some(visit, request,
                {{"beam.energy"},
                 {"beam.spot"},
                 {"simulation.electrons", "Primaries per pixel of simulated images", usual},
                 {"simulation.accuracy",
                  "Standard error of every detector over the pixel's mean, in place of a number of "
                  "electrons"},
                 {"simulation.detectors",
                  "Detector that the model learns besides SE and BSE: one of these, changed after "
                  "a colon (side:axis=60deg/90deg), or one of your own"},
                 {"simulation.physics"},
                 {"simulation.cutoff"},
                 {"simulation.seed",
                  "Seed of surfaces and simulations: the same seed gives the same model"}});
  if (!visit.reads()) return;
  job.energy_ev = request.beam.energy_ev;
  job.spot_nm = request.beam.spot_nm;
  job.detectors = request.detectors;
  job.physics = request.physics;
  job.simulation.budget = request.budget;
  job.simulation.seed = request.seed;
  if (mc::accuracy_of(request.budget) > 0) job.simulation.method = mc::Method::replay;
}

std::string file_name(const std::filesystem::path& path) { return path.filename().string(); }

}  // namespace

void describe(ParameterVisitor& visit, LearnOptions& learn) {
  const FacetNetworkFitOptions network;
  KindField kind(learn.kind);
  visit.visit({.name = "training.kind", .help = "Kind of model", .form = "KIND"}, kind);
  visit.form(
      {.name = "training.scales",
       .help = "Samples across the neighbourhoods of a filter bank or network, as 5,7,11",
       .otherwise = "all ten; of a network those that the electrons' range covers",
       .form = "N,N..."},
      [&] { return write_scales(learn.scales); },
      [&](std::string_view text, const std::string& subject) {
        learn.scales = read_scales(text, subject);
      });
  HiddenField hidden(learn.hidden);
  visit.visit({.name = "training.hidden",
               .help = "Units of a network's hidden layers, as 24,12; 0 is no layer",
               .otherwise = fmt::format("{}", fmt::join(network.hidden, ",")),
               .form = "N,N..."},
              hidden);
  visit(learn.iterations, {.name = "training.iterations",
                           .help = "Largest number of iterations of a network's training",
                           .limits = within(1, 100'000),
                           .otherwise = std::to_string(network.iterations)});
  visit(learn.decay, {.name = "training.decay",
                      .help = "Weight decay of a network's training",
                      .limits = at_least(0),
                      .otherwise = fmt::format("{:g}", network.decay)});
  visit(learn.model_error, {.name = "training.model_error",
                            .help = "Error that a network is expected to have besides noise",
                            .unit = Unit::share,
                            .limits = at_least(0),
                            .otherwise = format_value(network.tolerance, Unit::share)});
  visit(learn.least_eigenvalue,
        {.name = "training.least_eigenvalue",
         .help = "Least eigenvalue of the components that a filter bank keeps",
         .unit = Unit::share,
         .limits = at_least(0),
         .otherwise = fmt::format("{:g}", FilterBankFitOptions{}.eigenvalue_cutoff),
         .form = "NUMBER"});
  visit(learn.multi_resolution, {.name = "training.multi_resolution",
                                 .help = "Wide neighbourhoods of a filter bank on fewer samples"});
  visit(learn.table_electrons,
        {.name = "training.table_electrons",
         .help = "Primaries that a table is simulated with, at each angle of slopes or in all",
         .limits = within(2, most_electrons),
         .otherwise = fmt::format("{} at each, 10240 in all", SlopeTableOptions{}.electrons)});
}

void describe(ParameterVisitor& visit, TrainJob& job) {
  visit(job.surfaces, {.name = "training.surfaces",
                       .help = "Number of semsurf's own surfaces; there are 20 kinds",
                       .limits = within(1, 1000),
                       .otherwise = "60; 0 if no images are needed"});
  visit(job.surface_px, {.name = "training.surface_size",
                         .help = "Pixels across each of semsurf's own surfaces",
                         .limits = within(16, 4096)});
  visit(job.held_out, {.name = "training.hold_out",
                       .help = "Number of the last surfaces that only judge the model",
                       .limits = within(0, 1000)});
  visit(job.estimate, {"plain", "guided"},
        {.name = "training.estimate",
         .help = "Estimate of the training images: guided needs fewer electrons; images of "
                 "surfaces that are held out are always plain"});
  show_or_none(
      visit, job.fine,
      {.name = "training.fine",
       .help = "Samples per pixel to simulate with, interpolated smoothly",
       .limits = within(1, 8),
       .otherwise = "so many that they are at most a fifth of the electrons' range apart"});
  visit(job.edge, {"mirror", "flat", "periodic"},
        {.name = "training.edge", .help = "Continuation of surfaces outside their samples"});
  describe(visit, job.reading);
  visit.form(
      {.name = "training.pixel_size",
       .help = "Size of the images' pixels, which are square",
       .unit = Unit::nm,
       .limits = above(0, most_pixel_nm),
       .otherwise = "that of the first of HEIGHTS",
       .form = "LENGTH"},
      [&] { return job.pixel_nm != 0 ? format_exact(job.pixel_nm) : std::string(); },
      [&](std::string_view text, const std::string& subject) {
        job.pixel_nm = read_square_nm(text, subject);
      },
      FieldKind::number);
  describe(visit, job.learn);
  describe_simulation(visit, job);
  visit.form(
      {.name = "job.cache",
       .help =
           "Folder that libraries of cascades are kept in, 115 MB or so for every image, or off",
       .otherwise = "off",
       .form = "FOLDER|off",
       .recorded = false},
      [&] { return job.cache.string(); },
      [&](std::string_view text, const std::string&) {
        job.cache = io::cache_folder(std::string(text));
      });
  visit.form(
      {.name = "output",
       .help = "The model to write, .json",
       .form = "FILE",
       .recorded = false,
       .file = FileRole::written},
      [&] { return job.output.string(); },
      [&](std::string_view text, const std::string&) { job.output = text; });
  describe(visit, static_cast<mc::Execution&>(job.simulation));
}

std::string training_command(const TrainJob& job) {
  std::vector<std::string> words{"semsurf", "train"};
  const auto add = [&words](const char* option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  for (const TrainingInput& input : job.inputs) words.push_back(file_name(input.name));
  for (const TrainingInput& input : job.inputs) {
    if (!input.has_image()) continue;
    const std::string image = input.image.empty() ? input.name : file_name(input.image);
    if (job.signal.empty()) add("--images", image);
    else add("--signal", image + ":" + job.signal);
  }
  for (const std::filesystem::path& file : job.material_files) add("--materials", file_name(file));
  add("--material", job.material.name);
  const std::vector<std::string> changed =
      command_words(job, TrainJob{}, {{"simulation.detectors", "--detector"}});
  words.insert(words.end(), changed.begin(), changed.end());
  return quoted_command(words);
}

}  // namespace surf::workflow
