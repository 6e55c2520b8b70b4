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
#include "surf/workflow/reporter.h"
#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// A surface to learn on.
struct TrainingInput {
  std::string name;    ///< for messages and the record, as "scan.gwy"
  HeightField field;   ///< of any pitch up to twice the model's pixel
  std::string sha256;  ///< of its file; empty: of its heights
  /// The image of it, in a file or as it is. Neither: it is simulated.
  std::filesystem::path image;
  std::shared_ptr<const Image> pixels = nullptr;

  bool has_image() const { return !image.empty() || pixels; }
};

/// The samples per pixel that a job simulates with: its own, or by the range of Kanaya and Okayama.
int samples_per_pixel(const struct TrainJob& job);

/// What learning is told besides surfaces and images. Each kind of model takes what concerns it.
struct LearnOptions {
  /// Kinds as `learnable_kinds` lists them.
  std::string kind = "facet-network";
  /// Of a filter bank or a facet network; empty: the thesis's ten, of a network those within the
  /// electrons' range.
  std::vector<FacetScale> scales;
  bool multi_resolution = false;  ///< see FilterBankParameters
  std::optional<double>
      least_eigenvalue;  ///< of a filter bank: components of smaller ones are left out
  std::optional<std::vector<int>>
      hidden;  ///< of a facet network, this and the next: see FacetNetworkFitOptions
  std::optional<int> iterations;
  std::optional<double> decay, model_error;  ///< `tolerance` of FacetNetworkFitOptions
  /// Primaries that a table is made of: at each angle of slopes (31000), or in all (10240, rounded
  /// up to pages of a library of cascades).
  std::optional<std::int64_t> table_electrons;
};
/// training.kind, training.scales and so on.
void describe(ParameterVisitor& visit, LearnOptions& learn);

/// A kind of model that can be learnt, for people.
struct LearnableKind {
  std::string name;          ///< as the command line takes it
  std::string what;          ///< one line, no full stop
  bool needs_images = true;  ///< else images only judge it
};
std::vector<LearnableKind> learnable_kinds();

/// How missing images are simulated, where nothing else is said.
inline mc::SimulationOptions training_simulation() {
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{150};
  return options;
}

/// A model from surfaces to its file.
struct TrainJob {
  std::vector<TrainingInput>
      inputs;                   ///< none: `surfaces` of the program's own (training_surfaces.h)
  std::optional<int> surfaces;  ///< absent: 60, or none for kinds that need no images
  int surface_px = 64;
  Edge edge = Edge::mirror;  ///< how surfaces go on outside
  /// Surfaces are simulated with so many samples per pixel, smooth between them, 1 to 8: what lies
  /// within a pixel counts where pixels are not small against the electrons' range. 0: so many that
  /// samples are at most a fifth of it apart.
  int fine = 0;
  int held_out = 0;  ///< the last so many surfaces only judge the model

  /// The images are of a real microscope, in one channel of this name, in any unit; empty: they are
  /// as `simulate` writes them, with SE, BSE and, where they are there, SE.stderr and BSE.stderr.
  std::string signal;

  double pixel_nm = 0;  ///< of the model, > 0
  mc::Material material;
  double energy_ev = 1000, spot_nm = 0;
  mc::Physics physics;
  /// Electrons or accuracy, seed and threads; each image has a seed of its own, counted on from
  /// this.
  mc::SimulationOptions simulation = training_simulation();
  std::filesystem::path cache;  ///< as in SimulateJob
  LearnOptions learn;
  std::filesystem::path output;  ///< the model, .json
  /// Folder of the simulated images, which trainings of other kinds may share; empty: NAME.training
  /// beside NAME.json.
  std::filesystem::path images;
  // Of the record alone:
  io::HeightReadOptions reading;  ///< how the files of `inputs` were read
  std::vector<std::filesystem::path>
      material_files;  ///< where materials of one's own were looked for
};
/// The options of learning, training.surfaces and so on, scan.height_unit and so on, and of the
/// simulation what a model is for and how much is simulated.
void describe(ParameterVisitor& visit, TrainJob& job);

/// The command that trains the same model, without folders of files: of the record.
std::string training_command(const TrainJob& job);

struct TrainSummary {
  bool complete = true;  ///< false when cancelled: there is no model yet
  TrainedModel model;
  int images_found = 0;  ///< of the simulated ones, there before
  int images_made = 0;
  std::filesystem::path images;  ///< the folder that they are in; empty if none were simulated
  std::vector<std::filesystem::path> written;  ///< the model, and the record of a team
};

/// Checks everything that can be wrong before time is spent, makes the images that are not given,
/// learns the model, judges it on every surface, and writes it. A simulated image is
/// NAME.training/SURFACE.exr beside NAME.json, with its heights in channel z_nm; one that is there
/// already, of the same surface and settings and made by the same program, is used again, and one
/// that was interrupted is gone on with. So the same job, started again, goes on to the same bytes.
/// Kinds that need no images are made from the material, the energy and the physics: what surfaces
/// there are only judge them, all as held out.
///
/// Surfaces of another pitch are resampled to `pixel_nm` by bilinear interpolation, which is noted.
/// Throws UsageError, InvalidInput (also for surfaces more than twice as coarse), FileError.
///
/// With a `team` all of it call this with the same job, and simulate images, whole ones, into a
/// folder that all see; the leader learns, while the others wait, and tells in NAME.run.json who
/// did how much. Bytes are those of one process.
TrainSummary run(const TrainJob& job, const Reporter& reporter = {}, Team* team = nullptr);

}  // namespace surf::workflow
