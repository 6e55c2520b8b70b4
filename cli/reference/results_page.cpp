// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "markdown.h"
#include "pages.h"
#include "surf/core/parameters.h"
#include "surf/mc/geometry/beam.h"
#include "surf/workflow/simulate_job.h"

namespace surf::cli::reference {
namespace {

using Entries = std::vector<NamedEntry>;

const Entries& other_metadata() {
  static const Entries all{
      {"semsurf.version", "version of semsurf that wrote the file"},
      {"command", "command that made the file, of all but `simulate`"},
      {"title", "title of the scene"},
      {"partial", "`true` where the work was stopped: pixels of no electrons are not valid"},
      {"input.N", "name and SHA-256 of a file that was read"},
      {"option.NAME",
       "value of a parameter of an AFM step that changes the result, as `option.level.method`"},
      {"detector.N", "a detector in the order of the channels, as `--detector` reads it"},
      {"simulation.guided_by", "the fast model that guided an image, with its hash, or none"},
      {"simulation.dose", "electrons per pixel of the beam's current and dwell time"},
      {"specimen.substrate", "material and height of the half-space below"},
      {"specimen.height_field",
       "name, material, samples, pitch, origin and edge of the height field"},
      {"specimen.body.N", "name, material, triangles and extent of a body"},
      {"unit_override.N", "a mesh file whose own unit did not count, and the unit that did"},
      {"simplified.N", "what `simulation.mesh_tolerance` left out of a body"},
      {"material.N.name", "name of a material of the specimen"},
      {"material.N.density_g_cm3", "its density"},
      {"material.N.work_function_ev", "its work function"},
      {"material.N.barrier_ev", "its surface barrier"},
      {"material.N.valence_electrons", "valence electrons of a formula unit"},
      {"material.N.plasmon_ev", "energy of a plasmon"},
      {"material.N.loss_join_ev", "energy below which the continuous loss falls as E^(5/2)"},
      {"material.N.loss_join_fitted", "whether that energy was fitted to measured yields"},
      {"material.N.constituents",
       "its elements: atomic number and weight, share of the weight, mean ionization "
       "energy"},
      {"material.N.formula_weight_g_mol", "weight of a formula unit"},
      {"material.N.cutoff_ev", "energy inside it where tracking stopped"},
      {"material.N.estimated.NAME", "rule that a missing number was estimated by"},
      {"material.N.sources", "where its numbers come from"},
      {"balance.incident", "primaries"},
      {"balance.missed", "primaries that met nothing"},
      {"balance.generated", "secondaries set free inside"},
      {"balance.se", "electrons that left below 50 eV"},
      {"balance.bse", "electrons that left upward with 50 eV or more"},
      {"balance.transmitted", "electrons that left downward with 50 eV or more"},
      {"balance.absorbed", "electrons that stayed inside"},
      {"balance.handed_over", "electrons that replayed cascades took over"},
      {"balance.lost", "electrons that were given up; a warning says why"},
      {"library.cascades", "cascades of the library that were replayed"},
      {"pixels.NAME", "pixels done by one method: direct, replay, difference, plane, none"},
      {"model",
       "meaning of the numbers of the channel `model`; of predicted images the model's file and "
       "SHA-256"},
      {"model.kind", "kind of the model of a predicted image"},
      {"edge", "continuation of the heights of a predicted image"},
      {"warning.N", "a warning, as the program printed it"}};
  return all;
}

std::string capitalized(std::string text) {
  const bool word = text.size() > 1 && text[1] != ' ';
  if (word && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string entries(const char* head, const Entries& of) {
  std::vector<std::vector<std::string>> rows;
  for (const NamedEntry& e : of) rows.push_back({code(e.name), capitalized(e.meaning)});
  return table({head, "Meaning"}, rows);
}

const Entries& sidecar_keys() {
  static const Entries all{
      {"semsurf, libraries", "versions"},
      {"command", "the command line"},
      {"complete", "whether all was done"},
      {"inputs, outputs", "files with their paths, of inputs with SHA-256"},
      {"host, threads, ranks", "where it ran, and of several processes who did how much"},
      {"start, end, seconds", "times in UTC, and seconds of simulation"},
      {"primaries, primaries_from_checkpoint, primaries_per_second", "electrons of the beam"},
      {"rays, steps, tile_pixels, peak_memory_bytes", "work and memory"},
      {"method", "method that was taken, why, and electrons per pixel"},
      {"scene, simplification", "triangles, memory, and what was left out"},
      {"balance", "electrons and energies by where they went"},
      {"physics", "mechanisms of each material, with sources and ranges"},
      {"warnings", "as the program printed them"}};
  return all;
}

const Entries& info_keys() {
  static const Entries all{
      {"file, kind", "path; `mesh`, `image`, `SEM image`, `heights`, `model` or `scene`"},
      {"width, height", "pixels, or samples; of a scene those of its scan"},
      {"pitch_x_nm, pitch_y_nm", "distance of pixels; null where the file does not say"},
      {"origin_nm", "centre of an image's lower-left pixel"},
      {"channels",
       "of images and heights: `name`, `unit`, `lowest`, `highest`, `mean`, `not_finite`; of "
       "heights `is_height`, `lowest_nm`, `highest_nm`, `mean_nm`, `holes`"},
      {"levels, level_of_values", "sizes of a pyramid, and which of them the values are of"},
      {"format, instrument, energy_ev, tilt_deg, working_distance_nm, detector, bits, "
       "databar_rows, "
       "pixel_from",
       "of a microscope's image; null where it does not say"},
      {"triangles, vertices, components, closed, area_nm2, volume_nm3, bounds_nm, faults, bodies, "
       "scalars, tracks",
       "of a mesh; the volume is null where it is not closed"},
      {"material, energy_ev, pixel_nm, spot_nm, surfaces, residuals, held_out_residuals",
       "what a model is for (0: any), what it was trained on, and how far it is off"},
      {"title, bounds_nm, bodies, substrate, centre_nm, detectors, electrons, physics",
       "of a scene, as it will be simulated"},
      {"notes, warnings, metadata", "what reading it said, and what the file says of itself"}};
  return all;
}

}  // namespace

Entries image_channels() {
  return {
      {"NAME",
       "a detector's yield: electrons per primary, one channel for each of SE, BSE and "
       "`--detector`"},
      {"NAME.stderr",
       "standard error of that yield; of a guided image its root mean square error, bias "
       "included"},
      {"NAME.shot", "the yield with the shot noise of the dose, where there is a dose"},
      {"NAME.variance_left",
       "share of the scatter that differences and planes leave, of `--channels "
       "variance_left`"},
      {"NAME.radius",
       "of a guided image, of `--channels radius`: radius in pixels of the disc whose mean would "
       "be as noisy"},
      {"NAME.plain", "the yield without guides, of `--channels plain`"},
      {"NAME.plain.stderr", "its standard error"},
      {"NAME.sum",
       "electrons that the pixel's primaries sent to the detector, of `--channels "
       "counts`"},
      {"NAME.squares", "sum of the squares of each primary's number"},
      {"NAME.odd_sum", "the sum over primaries of odd number, counted from 0"},
      {"NAME.odd_squares", "their sum of squares"},
      {"valid", "1 where the beam met the specimen, else 0"},
      {"z_nm", "height of the point that the beam meets, of `--channels z_nm`"},
      {"normal.x", "x of the surface's normal there, of `--channels normal`"},
      {"normal.y", "y of the normal"},
      {"normal.z", "z of the normal"},
      {"material",
       "number of the material there, as in `material.N.name`, of `--channels material`"},
      {"electrons", "primaries that a pixel is the mean of, of `--channels electrons`"},
      {"model",
       "how a pixel was simulated, of `--channels model`: 0 none, 1 direct, 2 replay, 3 "
       "difference, 4 "
       "plane"}};
}

Entries image_metadata() {
  Entries all;
  const auto add = [&](const Parameter& about, Field&) {
    if (about.recorded) all.push_back({about.key(), cell(about.help)});
  };
  workflow::SimulateJob job;
  for_each_parameter(job, add);
  // Files hold the scan as it is resolved, and name each detector on its own.
  std::erase_if(all, [](const NamedEntry& e) {
    return e.name.starts_with("scan.") || e.name.starts_with("simulation.detector");
  });
  mc::Scan scan;
  for_each_parameter(scan, add);
  std::ranges::stable_sort(all, {},
                           [](const NamedEntry& e) { return e.name.substr(0, e.name.find('.')); });
  all.insert(all.end(), other_metadata().begin(), other_metadata().end());
  return all;
}

std::string results_page() {
  return page_head("Channels and metadata",
                   "What images and scans that semsurf writes hold, and what they say of how they "
                   "were made.\n"
                   "`NAME` stands for a name, `N` for a number from 1.") +
         "```sh\nsemsurf simulate samples/mesa80.toml --channels z_nm,normal -o mesa.exr\n"
         "semsurf info mesa.exr          # channels and metadata\ncat mesa.run.json              # "
         "the run\n```\n\n"
         "EXR, TIFF and VTI files hold all channels, PNG files one, as grey levels. "
         "Metadata is text: numbers are written so that they read back exactly, and units are in "
         "the key.\n\n"
         "## Channels of simulated images\n\n" +
         entries("Channel", image_channels()) + "\n## Channels of other files\n\n" +
         entries("Channel",
                 {{"z_nm",
                   "heights: of levelled, cleaned, eroded scans, of tips and of reconstructed "
                   "surfaces"},
                  {"valid", "1 where there is a value"},
                  {"certain", "1 where an eroded scan is the surface, else 0"},
                  {"deviation_nm", "standard deviation of a reconstructed height"},
                  {"lower_nm, upper_nm",
                   "95 % of draws of a reconstructed height lie between these two"},
                  {"data_support",
                   "what holds a reconstructed height: 1 the tip touched it, 2 the SEM image "
                   "says it, 3 both, 0 its neighbours"},
                  {"start_nm", "surface that a reconstruction began with"},
                  {"simulated_nm, scan_nm",
                   "the scan that the reconstructed surface makes, and the real "
                   "one"},
                  {"simulated, sem",
                   "the image that the reconstructed surface makes, and the real one"},
                  {"residual", "their difference, in standard deviations of the noise"},
                  {"used", "1 where a pixel counted"}}) +
         "\n## Metadata\n\nKeys of simulated images; those of other files are among them. What is "
         "not given is not "
         "there.\n\n" +
         entries("Key", image_metadata()) +
         "\n## The record of a run\n\n`NAME.run.json` lies beside the first output of `simulate`. "
         "It holds what may "
         "differ from run to run, "
         "as times, beside what the images hold.\n\n" +
         entries("Key", sidecar_keys()) +
         "\n## `semsurf info --json`\n\nA list of one object per file that can be read, in their "
         "order. Of the others the message says why. "
         "`semsurf --version --json` prints the version, those of libraries, and the instruction "
         "set.\n\n" +
         entries("Key", info_keys());
}

}  // namespace surf::cli::reference
