// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtkSemsurfSimulate.h"

#include <fmt/format.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "attempt.h"
#include "convert/digest.h"
#include "convert/specimen.h"
#include "convert/table.h"
#include "convert/tracks.h"
#include "labels.h"
#include "pipeline.h"
#include "simulation.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mc/choose_method.h"
#include "surf/mc/material_doubts.h"
#include "surf/mc/result_summary.h"
#include "surf/workflow/simulate_job.h"
#include "surf/workflow/version.h"

vtkStandardNewMacro(vtkSemsurfSimulate);

using namespace surf;

struct vtkSemsurfSimulate::State {
  std::string settings;             // that the plan is of
  std::uint64_t input = 0;          // its digest
  bool planned = false;
  pv::SimulationPlan plan;
  std::unique_ptr<pv::LiveSimulation> live;   // of this plan
};

namespace {

using Pipeline = vtkStreamingDemandDrivenPipeline;

constexpr double first_wait_s = 0.7, next_wait_s = 0.2;   // of live updates, for something to show

pv::Frame frame_of(const mc::Scan& s) {
  return {s.width, s.height, s.pixel_x_nm, s.pixel_y_nm, s.center_x_nm - 0.5 * (s.width - 1) * s.pixel_x_nm,
          s.center_y_nm - 0.5 * (s.height - 1) * s.pixel_y_nm};
}

std::vector<mc::Detector> detectors_of(const std::string& text) {
  std::vector<mc::Detector> detectors = mc::default_detectors();
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find(';', from), text.size());
    const std::size_t first = text.find_first_not_of(' ', from);
    if (first < end) {
      const std::size_t last = text.find_last_not_of(' ', end - 1);
      for (mc::Detector& d : mc::parse_detectors(text.substr(first, last + 1 - first), "Detectors")) detectors.push_back(d);
    }
    from = end + 1;
  }
  return detectors;
}

/// A row for each detector, then where all electrons went.
void fill_table(vtkTable* table, const mc::SimulationResult& result) {
  const mc::ResultSummary summary = mc::summarize(result);
  std::vector<std::string> names, settings;
  std::vector<double> yields, errors;
  for (std::size_t d = 0; d < result.detectors.size(); ++d) {
    names.push_back(result.detectors[d].name);
    settings.push_back(mc::format_detector(result.detectors[d]));
    yields.push_back(summary.yields.at(d).mean);
    errors.push_back(summary.yields.at(d).standard_error);
  }
  const std::vector<double> electrons(names.size(), summary.mean_electrons);
  pv::add_column(table, "detector", names);
  pv::add_column(table, "yield", std::move(yields));
  pv::add_column(table, "standard_error", std::move(errors));
  pv::add_column(table, "electrons_per_pixel", electrons);
  pv::add_column(table, "settings", settings);
}

std::map<std::string, std::string> made_by(const pv::SimulationPlan& plan, const mc::SimulationResult& result) {
  std::map<std::string, std::string> made{{"semsurf.version", workflow::version()}, {"command", "simulate"}};
  made["beam.energy_ev"] = format_exact(plan.beam.energy_ev);
  made["beam.spot_nm"] = format_exact(plan.beam.spot_nm);
  made["beam.tilt_deg"] = format_exact(plan.beam.tilt_deg);
  made["beam.azimuth_deg"] = format_exact(plan.beam.azimuth_deg);
  made["physics"] = mc::format_physics(plan.physics);
  made["seed"] = fmt::format("{}", plan.options.seed);
  if (result.accuracy > 0) made["accuracy"] = format_exact(result.accuracy);
  else made["electrons"] = fmt::format("{}", plan.options.electrons);
  made["method"] = result.library_cascades > 0 ? "replay" : "direct";
  int number = 0;
  for (const mc::Material& m : plan.specimen.materials) made[fmt::format("material.{}.name", ++number)] = m.name;
  return made;
}

}  // namespace

vtkSemsurfSimulate::vtkSemsurfSimulate() : Kept(std::make_unique<State>()) { this->SetNumberOfOutputPorts(3); }
vtkSemsurfSimulate::~vtkSemsurfSimulate() = default;

int vtkSemsurfSimulate::FillInputPortInformation(int, vtkInformation* info) {
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  for (const char* type : {"vtkPolyData", "vtkImageData", "vtkCompositeDataSet"})
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), type);
  return 1;
}

int vtkSemsurfSimulate::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : port == 1 ? "vtkPolyData" : "vtkTable");
  return 1;
}

void vtkSemsurfSimulate::Check() const {
  const auto need = [](bool good, const char* property, const std::string& reason, const char* remedy) {
    if (!good) throw UsageError(property, reason, remedy);
  };
  need(this->Energy >= mc::min_beam_energy_ev && this->Energy <= mc::max_beam_energy_ev, "Energy",
       fmt::format("{} eV are not in 100 to 30000", this->Energy), "Give 1000 for 1 keV");
  constexpr double most_nm = 1e9;   // rays that begin farther away than this miss by rounding
  need(this->Spot >= 0 && this->Spot <= most_nm, "Spot", fmt::format("{} nm are not in 0 to {}", this->Spot, most_nm),
       "Give 0 for a point");
  for (const auto& [name, value] : {std::pair{"Substrate Top", this->SubstrateTop}, {"Focus", this->Focus},
                                    {"Working Distance", this->WorkingDistance}})
    need(std::abs(value) <= most_nm, name, fmt::format("{} nm are not in -{} to {}", value, most_nm, most_nm), "Give 0");
  for (const double edge : this->Region)
    need(std::abs(edge) <= most_nm, "Region", fmt::format("{} nm are not in -{} to {}", edge, most_nm, most_nm),
         "Give 0 0 0 0 for all of the specimen");
  need(std::isfinite(this->PixelSize), "Pixel Size", "it is no number", "Give 0 to go by Pixels");
  need(this->PixelSize >= 0, "Pixel Size", fmt::format("{} nm are below 0", this->PixelSize), "Give 0 to go by Pixels");
  need(this->PixelSize > 0 || (this->Pixels >= 1 && this->Pixels <= 16384), "Pixels",
       fmt::format("{} is not in 1 to 16384", this->Pixels), "Give 256 where in doubt");
  need(this->Budget == ByAccuracy || this->Electrons >= 1, "Electrons", fmt::format("{} are too few", this->Electrons),
       "Give 1 or more per pixel");
  need(this->Budget == ByElectrons || (this->Accuracy >= 1e-4 && this->Accuracy <= 1), "Accuracy",
       fmt::format("{} is not in 0.0001 to 1", this->Accuracy), "Give 0.05 for 5 %");
  need(this->Trajectories >= 0 && this->Trajectories <= 100000, "Trajectories",
       fmt::format("{} is not in 0 to 100000", this->Trajectories), "Give 50 where in doubt");
  need(this->Seed >= 0, "Seed", fmt::format("{} is below 0", this->Seed), "Give 1");
  need(this->Edge >= 0 && this->Edge <= 2, "Edge", fmt::format("there is no edge {}", this->Edge), "Choose 0 to 2");
  need(this->Method >= Auto && this->Method <= Replay, "Method", fmt::format("there is no method {}", this->Method),
       "Choose 0 to 2");
}

std::string vtkSemsurfSimulate::Settings() const {
  return fmt::format("{}|{}|{}|{}|{}|{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", this->Materials,
                     this->MaterialFile, this->Substrate, this->Physics, this->Detectors, this->SubstrateTop, this->Edge,
                     this->Energy, this->Spot, this->Tilt, this->Azimuth, this->Convergence, this->Focus,
                     this->WorkingDistance, this->Pixels, this->PixelSize, this->Region[0], this->Region[1],
                     this->Region[2], this->Region[3], this->Budget, this->Electrons, this->Accuracy, this->AccuracyFloor,
                     this->Method, this->Seed, this->Trajectories);
}

void vtkSemsurfSimulate::Plan(vtkDataObject* input) {
  State& k = *this->Kept;
  std::string settings = this->Settings();
  auto* const image = vtkImageData::SafeDownCast(input);
  vtkDataArray* const heights = image ? pv::chosen_array(this, 0, image) : nullptr;
  if (heights && heights->GetName()) settings += heights->GetName();
  const std::uint64_t digest = pv::digest(input);
  if (k.planned && k.settings == settings && k.input == digest) return;
  k.live.reset();
  k.planned = false;
  this->Check();
  pv::SimulationPlan plan;
  plan.specimen = pv::to_specimen(input, heights, {this->Materials, this->MaterialFile, this->Substrate, this->SubstrateTop,
                                                   static_cast<surf::Edge>(this->Edge)});
  plan.beam = {this->Energy, this->Tilt, this->Azimuth, this->Spot, this->Convergence, this->Focus, this->WorkingDistance};
  mc::parse_physics(this->Physics, plan.physics);
  const Box extent = mc::extent(plan.specimen);
  mc::ScanRequest request;
  const double* const r = this->Region;
  if (r[0] != 0 || r[1] != 0 || r[2] != 0 || r[3] != 0) request.region = {r[0], r[1], r[2], r[3]};
  if (this->PixelSize > 0) request.pixel_x_nm = request.pixel_y_nm = this->PixelSize;
  plan.scan = workflow::resolve_scan(request, extent, plan.beam);
  constexpr int usual = 256;   // across the longer side, where nothing is said
  if (this->PixelSize <= 0 && this->Pixels != usual) {
    const double fewer = static_cast<double>(this->Pixels) / usual;
    const auto pixels = [&](int of_usual) { return std::max(1, static_cast<int>(std::lround(fewer * of_usual))); };
    request.width = pixels(plan.scan.width);
    request.height = pixels(plan.scan.height);
    plan.scan = workflow::resolve_scan(request, extent, plan.beam);
  }
  if (this->Budget == ByAccuracy) {
    plan.options.budget = mc::Accuracy{this->Accuracy, this->AccuracyFloor};
  } else {
    plan.options.budget = mc::ElectronsPerPixel{this->Electrons};
  }
  plan.options.seed = static_cast<std::uint64_t>(this->Seed);
  plan.options.detectors = detectors_of(this->Detectors);
  mc::validate(plan.options.detectors);
  if (this->Method != Auto) plan.method = this->Method == Direct ? mc::Method::direct : mc::Method::replay;
  plan.trajectories = this->Trajectories;
  for (const mc::Material& material : plan.specimen.materials)
    for (const std::string& doubt : mc::doubts(material)) pv::warn(this, doubt);
  k.plan = std::move(plan);
  k.settings = std::move(settings);
  k.input = digest;
  k.planned = true;
}

/// How large the image becomes depends on the specimen, so that has to be made before anything is said of it.
int vtkSemsurfSimulate::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) {
  return pv::attempt_information(this, outputs, [&] {
    pv::with_labels([&] {
      int port = 0;
      vtkAlgorithm* const producer = this->GetInputAlgorithm(0, 0, port);
      vtkInformation* const about = producer->GetOutputInformation(port);
      if (about->Has(Pipeline::WHOLE_EXTENT())) producer->UpdateWholeExtent();
      else producer->UpdatePiece(0, 1, 0);
      vtkDataObject* const data = producer->GetOutputDataObject(port);
      if (!data) throw InvalidInput("Input", "there is none", "Give a surface");
      this->Plan(data);
      pv::announce(outputs->GetInformationObject(0), frame_of(this->Kept->plan.scan));
    });
  });
}

int vtkSemsurfSimulate::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*) {
  pv::request_whole(inputs, 1);
  return 1;
}

int vtkSemsurfSimulate::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    pv::with_labels([&] {
      this->Plan(vtkDataObject::GetData(inputs[0]->GetInformationObject(0)));
      State& k = *this->Kept;
      vtkInformation* const output = outputs->GetInformationObject(0);
      auto* ranks = vtkMultiProcessController::GetGlobalController();
      const bool spread = ranks && ranks->GetNumberOfProcesses() > 1 && output->Has(Pipeline::UPDATE_NUMBER_OF_PIECES()) &&
                          output->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) == ranks->GetNumberOfProcesses();
      if (!spread) ranks = nullptr;
      Image image;
      std::vector<Track> tracks;
      vtkNew<vtkTable> table;
      std::map<std::string, std::string> texts;
      if (this->Live && !ranks) {
        const bool first = !k.live;
        if (first) k.live = std::make_unique<pv::LiveSimulation>(k.plan);
        try {
          pv::work(this, [&](const Watch& watch) { k.live->wait(first ? first_wait_s : next_wait_s, *watch.cancel); });
        } catch (...) {
          k.live.reset();
          throw;
        }
        pv::LiveSimulation::View view = k.live->look();
        image = std::move(view.image);
        tracks = std::move(view.tracks);
        texts = made_by(k.plan, view.result);
        texts["state"] = view.state;
        fill_table(table, view.result);
      } else {
        k.live.reset();
        pv::Simulated done = pv::simulate(this, k.plan, ranks);
        image = mc::make_image(done.result, k.plan.scan);
        tracks = std::move(done.tracks);
        texts = made_by(k.plan, done.result);
        texts["state"] = "done";
        const mc::ResultSummary summary = mc::summarize(done.result);
        if (summary.seen == 0) pv::warn(this, "no pixel sees the specimen: check Region, and the unit of the input: nm");
        if (summary.missed > 0)
          pv::warn(this, fmt::format("Accuracy: {} pixels miss it, the worst by a factor of {:.2g}", summary.missed, summary.worst));
        fill_table(table, done.result);
      }
      image.metadata = std::move(texts);
      pv::give(output, pv::to_vtk(std::move(image)));
      pv::give(outputs->GetInformationObject(1), pv::to_vtk(tracks));
      pv::give(outputs->GetInformationObject(2), table);
    });
  });
}

/// Asked by ParaView's timer of live sources, which then marks what follows as modified, but not this.
bool vtkSemsurfSimulate::GetNeedsUpdate() {
  const bool news = this->Live && this->Kept->live && this->Kept->live->has_news();
  if (news) this->Modified();
  return news;
}
