// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "surf/core/edge.h"
#include "surf/core/height_field.h"
#include "surf/core/image.h"
#include "surf/core/parameters.h"
#include "surf/core/progress.h"
#include "surf/io/height_field_file.h"
#include "surf/mc/physics/material.h"
#include "surf/mc/physics/physics.h"
#include "surf/mc/simulate.h"
#include "surf/sem/trained_model.h"
#include "surf/workflow/estimate_options.h"
#include "surf/workflow/reporter.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// A surface to train on.
struct TrainingInput {
  std::string name;    ///< for messages and the record, such as "scan.gwy"
  HeightField field;   ///< any pitch up to twice the model's pixel size
  std::string sha256;  ///< hash of its file; empty: of its heights
  /// Its image, in a file or in memory. If both are empty, the image is simulated.
  std::filesystem::path image;
  std::shared_ptr<const Image> pixels = nullptr;

  bool has_image() const { return !image.empty() || pixels; }
};

/// The samples per pixel that surfaces of such pixels are simulated with, by the range of Kanaya
/// and Okayama.
int samples_per_pixel(const mc::Material& material, double energy_ev, double pixel_nm);
/// The same of a job, or its `fine`.
int samples_per_pixel(const struct TrainJob& job);

/// Options of learning, besides surfaces and images. Each kind of model uses those that concern it.
struct LearnOptions {
  /// A kind from `learnable_kinds`.
  std::string kind = "facet-network";
  /// For a filter bank or a facet network; empty: the thesis's ten scales, for a network those
  /// within the electrons' range.
  std::vector<FacetScale> scales;
  bool multi_resolution = false;  ///< see FilterBankParameters
  /// For a filter bank: components with smaller eigenvalues are left out.
  std::optional<double> least_eigenvalue;
  /// For a facet network, like the next two: see FacetNetworkFitOptions.
  std::optional<std::vector<int>> hidden;
  std::optional<int> iterations;
  /// `model_error` is the `tolerance` of FacetNetworkFitOptions.
  std::optional<double> decay, model_error;
  /// Primaries of a table: at each angle of slopes (default 31000), or in total (default 10240,
  /// rounded up to pages of a library of cascades).
  std::optional<std::int64_t> table_electrons;
};
/// The parameters training.kind, training.scales and so on.
void describe(ParameterVisitor& visit, LearnOptions& learn);

/// A kind of model that can be trained.
struct LearnableKind {
  std::string name;          ///< as in the option
  std::string what;          ///< one line, no full stop
  bool needs_images = true;  ///< false: images only judge it
};
std::vector<LearnableKind> learnable_kinds();

/// Default options of the simulation of missing images.
inline mc::SimulationOptions training_simulation() {
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{150};
  return options;
}

/// Generated surfaces that teach, where no number is given and no surface is.
inline constexpr int usual_training_surfaces = 60;

/// Trains a model on surfaces and writes it to a file.
struct TrainJob {
  std::vector<TrainingInput> inputs;  ///< None: `surfaces` generated ones (training_surfaces.h)
  /// Number of generated surfaces; absent: 60, or none for kinds that need no images.
  std::optional<int> surfaces;
  int surface_px = 64;
  Edge edge = Edge::mirror;  ///< how surfaces continue outside
  /// Samples per pixel in the simulated surfaces, smooth between them, 1 to 8: details within a
  /// pixel matter if pixels are not small compared with the electrons' range. 0: chosen so that
  /// samples are at most a fifth of the range apart.
  int fine = 0;
  int held_out = 0;  ///< the last surfaces, this many, only judge the model
  /// How the images that teach are estimated: guided by shape they need fewer electrons. Images of
  /// surfaces that are held out stay plain.
  Estimate estimate = Estimate::plain;

  /// If not empty: the images are from a real microscope, in one channel of this name, in any unit.
  /// Empty: they are as written by `simulate`, with SE, BSE and optionally SE.stderr and
  /// BSE.stderr.
  std::string signal;

  double pixel_nm = 0;  ///< pixel size of the model, > 0
  mc::Material material;
  double energy_ev = 1000, spot_nm = 0;
  std::vector<mc::Detector> detectors;  ///< besides SE and BSE, that the model learns as well
  mc::Physics physics;
  /// Electrons or accuracy, seed and threads. Each image has its own seed, counted on from this
  /// one.
  mc::SimulationOptions simulation = training_simulation();
  std::filesystem::path cache;  ///< as in SimulateJob
  LearnOptions learn;
  std::filesystem::path output;  ///< the model file, .json
  /// Folder of the simulated images, which trainings of other kinds may share. Empty: NAME.training
  /// beside NAME.json.
  std::filesystem::path images;
  // For the record alone:
  io::HeightReadOptions reading;                      ///< how the files of `inputs` were read
  std::vector<std::filesystem::path> material_files;  ///< files of the user's own materials
};
/// The options of learning; training.surfaces and so on; scan.height_unit and so on; and the
/// parameters of the simulation that say what the model is for and how much is simulated.
void describe(ParameterVisitor& visit, TrainJob& job);

/// The note of a model's record that holds its detectors besides SE and BSE, each in the words of
/// `mc::format_detector`, separated by semicolons.
inline constexpr const char* detectors_note = "detectors";

/// The command that trains the same model, with file names without folders, for the record.
std::string training_command(const TrainJob& job);

struct TrainSummary {
  bool complete = true;  ///< false if cancelled: there is no model yet
  TrainedModel model;
  int images_found = 0;  ///< simulated images from earlier jobs
  int images_made = 0;
  std::filesystem::path images;  ///< folder of the simulated images; empty if there are none
  std::vector<std::filesystem::path> written;  ///< the model, and the record of the team
};

/// Checks everything that can be wrong before time is spent, makes the missing images, trains the
/// model, judges it on every surface, and writes it. A simulated image is NAME.training/SURFACE.exr
/// beside NAME.json, with its heights in channel z_nm. An existing image of the same surface and
/// settings, made by the same program, is used again; an interrupted one is continued. So the same
/// job, started again, continues to the same bytes. Kinds that need no images are made from the
/// material, the energy and the physics. Surfaces then only judge the model, all as held out.
///
/// Surfaces of another pitch are resampled to `pixel_nm` by bilinear interpolation, with a note.
/// Throws UsageError, InvalidInput (also for surfaces more than twice as coarse), FileError.
///
/// With a `team` all members call this with the same job, and each simulates whole images into a
/// folder that all members see. The leader trains while the others wait, and records in
/// NAME.run.json how much each member did. The bytes are the same as with one process.
TrainSummary run(const TrainJob& job, const Reporter& reporter = {}, Team* team = nullptr);

}  // namespace surf::workflow
