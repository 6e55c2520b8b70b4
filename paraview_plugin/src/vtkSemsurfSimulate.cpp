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
#include "property_values.h"
#include "simulation.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/cache.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/mc/results/result_summary.h"
#include "surf/workflow/simulate_job.h"

vtkStandardNewMacro(vtkSemsurfSimulate);

using namespace surf;

struct vtkSemsurfSimulate::State {
  pv::PropertyValues values;
  std::string settings;     // that the plan is of
  std::uint64_t input = 0;  // its digest
  bool planned = false;
  workflow::SimulateJob job;
  mc::Scan scan;
  std::unique_ptr<pv::LiveSimulation> live;  // of this plan
};

namespace {

using Pipeline = vtkStreamingDemandDrivenPipeline;

constexpr double first_wait_s = 0.7, next_wait_s = 0.2;  // of live updates, for something to show

pv::Frame frame_of(const mc::Scan& s) {
  return {{s.pixel_x_nm, s.pixel_y_nm, s.center_x_nm - 0.5 * (s.width - 1) * s.pixel_x_nm,
           s.center_y_nm - 0.5 * (s.height - 1) * s.pixel_y_nm},
          s.width,
          s.height};
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

/// Lengths from here on are not told apart from none by rays.
constexpr double most_nm = 1e9;

/// What the properties ask for, but for the pixels and the specimen.
workflow::SimulateJob job_of(pv::PropertyValues values, int budget) {
  const bool by_accuracy = budget == vtkSemsurfSimulate::ByAccuracy;
  for (const char* other : {"simulation.accuracy", "simulation.accuracy_floor"})
    if (!by_accuracy) values.forget(other);
  if (by_accuracy) values.forget("simulation.electrons");
  workflow::SimulateJob job;
  job.cache = io::cache_folder();
  job.checkpoint.wanted = false;
  values.apply(static_cast<mc::SimulationRequest&>(job.scene));
  values.apply(job.extras);
  values.apply(job.estimate);
  return job;
}

pv::SpecimenWish wish_of(const pv::PropertyValues& values) {
  io::SpecimenRequest said;
  values.apply(said);
  const double top_nm = said.substrate_z_nm.value_or(0);
  if (!(std::abs(top_nm) <= most_nm))
    throw UsageError("`specimen.substrate_z`",
                     fmt::format("{} nm are not in -{} to {}", top_nm, most_nm, most_nm), "Give 0");
  return {said.material.value_or("Si"),
          said.material_files.empty() ? std::string() : said.material_files.front(),
          said.substrate.value_or(""), top_nm, said.edge.value_or(Edge::mirror)};
}

}  // namespace

vtkSemsurfSimulate::vtkSemsurfSimulate() : Kept(std::make_unique<State>()) {
  this->SetNumberOfOutputPorts(3);
}
vtkSemsurfSimulate::~vtkSemsurfSimulate() = default;

int vtkSemsurfSimulate::FillInputPortInformation(int, vtkInformation* info) {
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  for (const char* type : {"vtkPolyData", "vtkImageData", "vtkCompositeDataSet"})
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), type);
  return 1;
}

int vtkSemsurfSimulate::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0   ? "vtkImageData"
                                             : port == 1 ? "vtkPolyData"
                                                         : "vtkTable");
  return 1;
}

void vtkSemsurfSimulate::SetParameter(const char* name, double value) {
  if (this->Kept->values.set(name, value)) this->Modified();
}
void vtkSemsurfSimulate::SetParameter(const char* name, const char* text) {
  if (this->Kept->values.set(name, text)) this->Modified();
}
void vtkSemsurfSimulate::SetParameter(const char* name, double a, double b, double c, double d) {
  if (this->Kept->values.set(name, std::vector{a, b, c, d})) this->Modified();
}

void vtkSemsurfSimulate::Plan(vtkDataObject* input) {
  State& k = *this->Kept;
  std::string settings = fmt::format("{}{}|{}", k.values.all(), this->Pixels, this->Budget);
  auto* const image = vtkImageData::SafeDownCast(input);
  vtkDataArray* const heights = image ? pv::chosen_array(this, 0, image) : nullptr;
  if (heights && heights->GetName()) settings += heights->GetName();
  const std::uint64_t digest = pv::digest(input);
  if (k.planned && k.settings == settings && k.input == digest) return;
  k.live.reset();
  k.planned = false;
  workflow::SimulateJob job = job_of(k.values, this->Budget);
  const bool by_pixels = !job.scene.scan.pixel_x_nm;
  if (by_pixels && (this->Pixels < 1 || this->Pixels > 16384))
    throw UsageError("Pixels", fmt::format("{} is not in 1 to 16384", this->Pixels),
                     "Give 256 where in doubt");
  job.scene.specimen = pv::to_specimen(input, heights, wish_of(k.values));
  mc::validate(job.scene);
  const Box extent = mc::extent(job.scene.specimen);
  k.scan = workflow::resolve_scan(job.scene.scan, extent, job.scene.beam);
  constexpr int usual = 256;  // across the longer side, where nothing is said
  if (by_pixels && this->Pixels != usual) {
    const double fewer = static_cast<double>(this->Pixels) / usual;
    const auto pixels = [&](int of_usual) {
      return std::max(1, static_cast<int>(std::lround(fewer * of_usual)));
    };
    job.scene.scan.width = pixels(k.scan.width);
    job.scene.scan.height = pixels(k.scan.height);
    k.scan = workflow::resolve_scan(job.scene.scan, extent, job.scene.beam);
  }
  k.job = std::move(job);
  k.settings = std::move(settings);
  k.input = digest;
  k.planned = true;
}

/// How large the image becomes depends on the specimen, so that has to be made before anything is
/// said of it.
int vtkSemsurfSimulate::RequestInformation(vtkInformation*, vtkInformationVector**,
                                           vtkInformationVector* outputs) {
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
      pv::announce(outputs->GetInformationObject(0), frame_of(this->Kept->scan));
    });
  });
}

int vtkSemsurfSimulate::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs,
                                            vtkInformationVector*) {
  pv::request_whole(inputs, 1);
  return 1;
}

int vtkSemsurfSimulate::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                    vtkInformationVector* outputs) {
  return pv::attempt(this, [&] {
    pv::with_labels([&] {
      this->Plan(vtkDataObject::GetData(inputs[0]->GetInformationObject(0)));
      State& k = *this->Kept;
      vtkInformation* const output = outputs->GetInformationObject(0);
      auto* ranks = vtkMultiProcessController::GetGlobalController();
      const bool spread =
          ranks && ranks->GetNumberOfProcesses() > 1 &&
          output->Has(Pipeline::UPDATE_NUMBER_OF_PIECES()) &&
          output->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) == ranks->GetNumberOfProcesses();
      if (!spread) ranks = nullptr;
      if (ranks && k.job.estimate.kind != workflow::Estimate::plain &&
          mc::accuracy_of(k.job.scene.budget) > 0)
        throw UsageError("`simulation.accuracy`",
                         "guided images reach it in rounds, which ParaView's ranks do not share",
                         "Give a number of electrons");
      Image image;
      std::vector<Track> tracks;
      vtkNew<vtkTable> table;
      std::map<std::string, std::string> texts;
      if (this->Live && !ranks) {
        const bool first = !k.live;
        if (first) k.live = std::make_unique<pv::LiveSimulation>(k.job, k.scan);
        try {
          pv::work(this, [&](const Watch& watch) {
            k.live->wait(first ? first_wait_s : next_wait_s, *watch.cancel);
          });
        } catch (...) {
          k.live.reset();
          throw;
        }
        pv::LiveSimulation::View view = k.live->look();
        image = std::move(view.image);
        tracks = std::move(view.tracks);
        for (const std::string& warning : view.warnings) pv::warn(this, warning);
        texts = std::move(view.record);
        texts["state"] = view.state;
        fill_table(table, view.result);
      } else {
        k.live.reset();
        workflow::SimulateSummary done = pv::simulate(this, k.job, ranks);
        image = workflow::image_of(done);
        tracks = std::move(done.tracks);
        texts = std::move(done.record);
        texts["state"] = "done";
        fill_table(table, done.result);
      }
      image.metadata = std::move(texts);
      pv::give(output, pv::to_vtk(std::move(image)));
      pv::give(outputs->GetInformationObject(1), pv::to_vtk(tracks));
      pv::give(outputs->GetInformationObject(2), table);
    });
  });
}

/// Asked by ParaView's timer of live sources, which then marks what follows as modified, but not
/// this.
bool vtkSemsurfSimulate::GetNeedsUpdate() {
  const bool news = this->Live && this->Kept->live && this->Kept->live->has_news();
  if (news) this->Modified();
  return news;
}
