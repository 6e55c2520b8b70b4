// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/sample_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "checkpoint.h"
#include "common_parameters.h"
#include "job_identity.h"
#include "job_libraries.h"
#include "surf/afm/morphology.h"
#include "surf/afm/noise.h"
#include "surf/afm/tip_shapes.h"
#include "surf/core/error.h"
#include "surf/core/instruction_set.h"
#include "surf/core/sample_image.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/sim/materials.h"
#include "surf/io/tip_file.h"
#include "surf/mc/request/scan_request.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/vertex_normals.h"
#include "surf/reconstruction/sample_surfaces.h"
#include "surf/workflow/step_record.h"
#include "surf/workflow/version.h"

namespace surf::workflow {
namespace {

namespace fs = std::filesystem;

constexpr double degree = std::numbers::pi / 180;
constexpr int fine = 3;            // samples of the true surface per AFM sample
constexpr int per_pixel = 2;       // samples of the simulated surface per SEM pixel
constexpr double beyond_nm = 300;  // margin of the simulated surface beyond the image
constexpr std::size_t fewest_cascades = 2048;
constexpr int faces_of_a_leaning_tip = 16;

constexpr const char* files[] = {"afm.gsf",       "sem.tif",       "truth.gsf",
                                 "truth_tip.gsf", "truth_sem.exr", "truth.json"};

/// Makes libraries larger than these few primaries per pixel need: the library's chance error is
/// common to all pixels.
class LargeLibraries : public mc::LibrarySource {
 public:
  LargeLibraries(mc::LibrarySource& source, std::size_t cascades)
      : source_(&source), cascades_(cascades) {}
  std::shared_ptr<const mc::CascadeLibrary> library(const mc::CascadeSettings& settings,
                                                    std::size_t wanted, int threads,
                                                    const Watch& watch) override {
    return source_->library(settings, std::max(wanted, cascades_), threads, watch);
  }

 private:
  mc::LibrarySource* source_;
  std::size_t cascades_;
};

const SampleScene& find_scene(const std::string& name) {
  const std::string& known = find_sample_surface(name).name;
  const auto& all = sample_scenes();
  return *std::find_if(all.begin(), all.end(),
                       [&](const SampleScene& s) { return s.name == known; });
}

/// The detector that is there in place of SE's, or nothing.
std::vector<mc::Detector> detector_of(const SampleJob& job) {
  if (job.detector.empty()) return {};
  std::vector<mc::Detector> all = mc::parse_detectors(job.detector, "`sample.detector`");
  if (all.size() != 1)
    throw UsageError("`sample.detector`", fmt::format("'{}' is more than one", job.detector),
                     "Name one, as in-lens or side:axis=60deg/90deg");
  return all;
}

void check(const SampleJob& job) {
  if (job.width < 16 || job.height < 16 || job.width > 4096 || job.height > 4096)
    throw UsageError("`sample.size`", fmt::format("{} x {} pixels", job.width, job.height),
                     "Give 16 to 4096 each way");
  if (job.electrons < 1 || job.electrons > std::int64_t{1} << 31)
    throw UsageError("`sample.electrons`", fmt::format("{} is out of range", job.electrons),
                     "Give 1 to 2e9 per pixel");
  if (job.cascades < fewest_cascades)
    throw UsageError("sample", fmt::format("{} cascades are too few", job.cascades),
                     fmt::format("Give {} or more", fewest_cascades));
  const double half_angle_deg = find_scene(job.name).tip_half_angle_deg;
  if (!(std::abs(job.tip_lean_deg) < half_angle_deg))
    throw UsageError("`sample.tip_lean`",
                     fmt::format("the tip's half angle is {:g} degrees", half_angle_deg),
                     "Give less than that");
  detector_of(job);
  if (!job.film.empty()) io::find_material(job.film, "`sample.film`");
  for (const char* name : files) io::check_writable(job.folder / name);
}

/// The map from the SEM's frame to the surface's frame, whose (0, 0) is the middle of the image.
Affine sem_to_surface(const SampleJob& job, const SampleScene& scene) {
  Affine map;
  map.x0 = -0.5 * (job.width - 1) * scene.sem_pixel_nm;
  map.y0 = -0.5 * (job.height - 1) * scene.sem_pixel_nm;
  return map;
}

HeightField empty_field(int width, int height, double pitch_nm, double origin_x_nm,
                        double origin_y_nm) {
  return {{pitch_nm, pitch_nm, origin_x_nm, origin_y_nm}, Grid<double>(width, height)};
}

struct AfmFrame {
  Affine sem_to_afm;
  int width = 0, height = 0;
};

/// The scan that holds the whole SEM image and its margins.
AfmFrame afm_frame(const SampleJob& job, const SampleScene& scene) {
  AffineParts parts = scene.sem_to_afm;
  parts.shift_x_nm = parts.shift_y_nm = 0;
  AfmFrame frame{make_affine(parts)};
  Point2 low{1e300, 1e300}, high{-1e300, -1e300};
  for (const double column : {-0.5, job.width - 0.5})
    for (const double row : {-0.5, job.height - 0.5}) {
      const Point2 p = frame.sem_to_afm({column * scene.sem_pixel_nm, row * scene.sem_pixel_nm});
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  frame.sem_to_afm.x0 = scene.margin_left_nm - low.x;
  frame.sem_to_afm.y0 = scene.margin_bottom_nm - low.y;
  const auto samples = [&](double length_nm) {
    return static_cast<int>(std::ceil(length_nm / scene.afm_pitch_nm)) + 1;
  };
  frame.width = samples(high.x - low.x + scene.margin_left_nm + scene.margin_right_nm);
  frame.height = samples(high.y - low.y + scene.margin_bottom_nm + scene.margin_top_nm);
  return frame;
}

/// The tip, as wide as it is `depth_nm` above its apex. A tip that leans is a pyramid of many
/// faces.
Tip tip_of(const SampleJob& job, const SampleScene& scene, double pitch_nm, double depth_nm) {
  const double widest = (scene.tip_half_angle_deg + std::abs(job.tip_lean_deg)) * degree,
               radius = scene.tip_radius_nm, angle = widest;
  const double kink_nm = radius * (1 - std::sin(angle));  // where the sphere ends
  const double reach_nm =
      radius * std::cos(angle) + std::max(0.0, depth_nm - kink_nm) * std::tan(angle);
  const int size = 2 * static_cast<int>(std::ceil(reach_nm / pitch_nm)) + 1;
  const TipSampling sampling{pitch_nm, pitch_nm, size, size};
  if (job.tip_lean_deg == 0) return conical_tip(radius, angle, sampling);
  PyramidShape shape{{}, job.tip_azimuth_deg * degree, radius};
  for (int face = 0; face < faces_of_a_leaning_tip; ++face)
    shape.face_angles_rad.push_back(
        (scene.tip_half_angle_deg +
         job.tip_lean_deg * std::cos(2 * std::numbers::pi * face / faces_of_a_leaning_tip)) *
        degree);
  return pyramidal_tip(shape, sampling);
}

double range_of(const HeightField& field) {
  const auto [low, high] = std::minmax_element(field.z_nm.data().begin(), field.z_nm.data().end());
  return *high - *low;
}

/// The depth to which the tip must be known: the surface's range of heights over the scan, and a
/// margin for heights between samples.
double depth_of(const SampleJob& job, const SampleScene& scene, const SampleSurface& surface,
                const AfmFrame& frame) {
  HeightField coarse = empty_field(frame.width, frame.height, scene.afm_pitch_nm, 0, 0);
  sample_heights(surface, compose(sem_to_surface(job, scene), inverse(frame.sem_to_afm)), coarse,
                 job.threads);
  return 1.2 * range_of(coarse);
}

/// A value between samples, or beyond them that of the border.
double between(const PlacedImage& image, double column, double row) {
  const auto inside = [](double at, int size) { return std::clamp(at, 0.0, size - 1.0); };
  return sample_image(image, image.place_nm(inside(column, image.values.width()),
                                            inside(row, image.values.height())));
}

/// The scan of an ideal AFM. The surface extends beyond the scan as far as the tip does.
HeightField dilated(const SampleJob& job, const SampleScene& scene, const SampleSurface& surface,
                    const AfmFrame& frame, double depth_nm, const Watch& watch) {
  const Tip tip = tip_of(job, scene, scene.afm_pitch_nm / fine, depth_nm);
  const int margin = (tip.apex_x + fine - 1) / fine;
  const auto across = [&](int samples) { return (samples - 1 + 2 * margin) * fine + 1; };
  HeightField finer =
      empty_field(across(frame.width), across(frame.height), scene.afm_pitch_nm / fine,
                  -margin * scene.afm_pitch_nm, -margin * scene.afm_pitch_nm);
  sample_heights(surface, compose(sem_to_surface(job, scene), inverse(frame.sem_to_afm)), finer,
                 job.threads);
  MorphologyOptions options;
  options.threads = job.threads;
  options.watch = watch;
  const HeightField image = dilate(finer, tip, options);
  PlacedImage ideal;
  ideal.values = image.z_nm;
  HeightField scan = empty_field(frame.width, frame.height, scene.afm_pitch_nm, 0, 0);
  const double drift_nm = job.scan_drift_px * scene.sem_pixel_nm;
  for (int y = 0; y < frame.height; ++y) {
    const double across_scan = 2.0 * y / (frame.height - 1) - 1;
    // As much along x as along y of the SEM image.
    const double along = std::sqrt(0.5) * drift_nm * across_scan * across_scan;
    const Affine& m = frame.sem_to_afm;
    const double by_x = (m.xx + m.xy) * along / scene.afm_pitch_nm,
                 by_y = (m.yx + m.yy) * along / scene.afm_pitch_nm;
    for (int x = 0; x < frame.width; ++x)
      scan.z_nm(x, y) =
          drift_nm == 0 ? image.z_nm((x + margin) * fine, (y + margin) * fine)
                        : between(ideal, (x + by_x + margin) * fine, (y + by_y + margin) * fine);
  }
  return scan;
}

void add_noise_and_tilt(const SampleScene& scene, std::uint64_t seed, HeightField& scan) {
  const Grid<double> noise =
      simulate_noise(scene.afm_noise, scan.z_nm.width(), scan.z_nm.height(), seed);
  const double along_x = std::tan(scene.tilt_x_deg * degree),
               along_y = std::tan(scene.tilt_y_deg * degree);
  for (int y = 0; y < scan.z_nm.height(); ++y)
    for (int x = 0; x < scan.z_nm.width(); ++x)
      scan.z_nm(x, y) +=
          noise(x, y) + along_x * scan.x_nm(x) + along_y * scan.y_nm(y) + scene.afm_offset_nm;
}

mc::Scan scan_of(const SampleJob& job, const SampleScene& scene) {
  mc::Scan scan;
  scan.width = job.width;
  scan.height = job.height;
  scan.pixel_x_nm = scan.pixel_y_nm = scene.sem_pixel_nm;
  scan.center_x_nm = 0.5 * (job.width - 1) * scene.sem_pixel_nm;
  scan.center_y_nm = 0.5 * (job.height - 1) * scene.sem_pixel_nm;
  return scan;
}

/// The surface, moved into the specimen along its normals.
TriangleMesh below_film(TriangleMesh surface, double thickness_nm) {
  const std::vector<Vec3> normals = vertex_normals(surface);
  for (std::size_t i = 0; i < normals.size(); ++i)
    surface.vertices_nm[i] -= thickness_nm * normals[i];
  return surface;
}

mc::Scene monte_carlo_scene(const SampleJob& job, const SampleScene& scene,
                            const SampleSurface& surface) {
  const double pitch = scene.sem_pixel_nm / per_pixel;
  const int margin = static_cast<int>(std::ceil(beyond_nm / pitch));
  const auto across = [&](int pixels) { return (pixels - 1) * per_pixel + 1 + 2 * margin; };
  HeightField field =
      empty_field(across(job.width), across(job.height), pitch, -margin * pitch, -margin * pitch);
  sample_heights(surface, sem_to_surface(job, scene), field, job.threads);
  mc::Specimen specimen;
  specimen.materials = {io::find_material(scene.material, "sample")};
  specimen.height_field = mc::HeightFieldBody{surface.name, std::move(field), 0, Edge::mirror};
  if (!job.film.empty()) {
    const HeightField& top = specimen.height_field->field;
    specimen.bodies.push_back(
        {scene.material, below_film(height_field_sheet(top), job.film_nm), 0});
    specimen.materials.push_back(io::find_material(job.film, "`sample.film`"));
    specimen.height_field->material = 1;
  }
  mc::Beam beam;
  beam.energy_ev = scene.energy_ev;
  beam.spot_nm = job.spot_nm.value_or(scene.spot_nm);
  return mc::Scene(specimen, beam, scan_of(job, scene), job.physics);
}

/// Displaces rows along themselves.
void jitter_rows(double deviation_px, std::uint64_t seed, Grid<float>& image) {
  const Grid<double> displaced = simulate_noise({0, 1}, image.height(), 1, seed + 1000);
  PlacedImage straight;
  straight.values = Grid<double>(image.width(), image.height());
  std::ranges::copy(image.data(), straight.values.data().begin());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      image(x, y) = static_cast<float>(between(straight, x - deviation_px * displaced(y, 0), y));
}

/// The simulated signal of the detector. The gain drifts along a wave over the image's diagonal.
Image signal_of(const SampleJob& job, const SampleScene& scene, const Image& yields) {
  Image image = yields;
  image.channels = {{"signal", "1", Grid<float>(yields.width(), yields.height())}};
  const std::vector<mc::Detector> other = detector_of(job);
  const auto& se = yields.find(other.empty() ? "SE" : other.front().name)->values.data();
  const auto& bse = yields.find("BSE")->values.data();
  auto& signal = image.channels.front().values.data();
  for (std::size_t i = 0; i < signal.size(); ++i) {
    const double along = static_cast<double>(i % static_cast<std::size_t>(job.width)) / job.width +
                         static_cast<double>(i / static_cast<std::size_t>(job.width)) / job.height,
                 gain = 1 + job.gain_drift * std::sin(std::numbers::pi * along);
    signal[i] = static_cast<float>(
        gain * (scene.se_gain * double{se[i]} + scene.bse_gain * double{bse[i]}) + scene.offset);
  }
  if (job.line_jitter_px > 0)
    jitter_rows(job.line_jitter_px, job.seed, image.channels.front().values);
  return image;
}

nlohmann::ordered_json truth_of(const SampleJob& job, const SampleScene& scene,
                                const AfmFrame& frame) {
  const Affine& map = frame.sem_to_afm;
  const AffineParts parts = parts_of(map);
  return {{"sample", scene.name},
          {"what", scene.what},
          {"semsurf_version", version()},
          {"seed", job.seed},
          {"sem_to_afm", {map.xx, map.xy, map.x0, map.yx, map.yy, map.y0}},
          {"sem_to_afm_parts",
           {{"rotation_deg", parts.rotation_rad / degree},
            {"scale_x", parts.scale_x},
            {"scale_y", parts.scale_y},
            {"shear", parts.shear},
            {"shift_x_nm", parts.shift_x_nm},
            {"shift_y_nm", parts.shift_y_nm}}},
          {"sem",
           {{"width", job.width},
            {"height", job.height},
            {"pixel_nm", scene.sem_pixel_nm},
            {"material", scene.material},
            {"physics", mc::format_physics(job.physics)},
            {"gain_drift", job.gain_drift},
            {"line_jitter_px", job.line_jitter_px},
            {"film", job.film},
            {"film_nm", job.film.empty() ? 0 : job.film_nm},
            {"detector", job.detector.empty() ? "SE" : job.detector},
            {"energy_ev", scene.energy_ev},
            {"spot_nm", job.spot_nm.value_or(scene.spot_nm)},
            {"electrons", job.electrons},
            {"gains", {{"SE", scene.se_gain}, {"BSE", scene.bse_gain}}},
            {"offset", scene.offset}}},
          {"afm",
           {{"width", frame.width},
            {"height", frame.height},
            {"pitch_nm", scene.afm_pitch_nm},
            {"tip",
             {{"radius_nm", scene.tip_radius_nm},
              {"half_angle_deg", scene.tip_half_angle_deg},
              {"lean_deg", job.tip_lean_deg},
              {"azimuth_deg", job.tip_azimuth_deg}}},
            {"noise",
             {{"alpha", scene.afm_noise.alpha},
              {"innovation_nm2", scene.afm_noise.innovation_nm2},
              {"variance_nm2", scene.afm_noise.variance_nm2()}}},
            {"drift_px", job.scan_drift_px},
            {"tilt_x_deg", scene.tilt_x_deg},
            {"tilt_y_deg", scene.tilt_y_deg},
            {"offset_nm", scene.afm_offset_nm}}}};
}

std::map<std::string, std::string> provenance_of(const SampleJob& job) {
  return step_record("sample", record_of(job), {});
}

/// Everything that the simulated image depends on, including the program.
Identity identity_of(const SampleJob& job, const mc::SimulationOptions& options) {
  return {{"command", "sample"},
          {"sample", job.name},
          {"width", std::to_string(job.width)},
          {"height", std::to_string(job.height)},
          {"electrons", std::to_string(job.electrons)},
          {"cascades", std::to_string(job.cascades)},
          {"seed", std::to_string(job.seed)},
          {"physics", mc::format_physics(job.physics)},
          {"spot", format_exact(job.spot_nm.value_or(-1))},
          {"detector", job.detector},
          {"film", fmt::format("{} {}", job.film, format_exact(job.film_nm))},
          {"tile_pixels", std::to_string(options.tile_pixels)},
          {"instruction set", std::string(instruction_set())},
          {"ray tracer", mc::ray_tracer_version()},
          {"program", program_hash()}};
}

std::unique_ptr<Checkpoint> make_checkpoint(const SampleJob& job,
                                            const mc::SimulationOptions& options,
                                            const NoteCallback& note, const NoteCallback& warn) {
  if (!job.checkpoint.wanted) return nullptr;
  const auto say = [](const std::string&) {};
  return std::make_unique<Checkpoint>(job.checkpoint, job.folder / "sem.tif",
                                      identity_of(job, options), note ? note : say,
                                      warn ? warn : say);
}

/// Writes all files, from the result of the simulation.
void write_all(const SampleJob& job, const SampleScene& scene, const SampleSurface& surface,
               const AfmFrame& frame, const Image& yields, const CancelToken* cancel,
               std::vector<fs::path>& written) {
  HeightField truth = empty_field(job.width, job.height, scene.sem_pixel_nm, 0, 0);
  sample_heights(surface, sem_to_surface(job, scene), truth, job.threads);
  Watch watch;
  watch.cancel = cancel;
  const double depth_nm = depth_of(job, scene, surface, frame);
  HeightField scan = dilated(job, scene, surface, frame, depth_nm, watch);
  const auto number = static_cast<std::uint64_t>(&scene - sample_scenes().data());
  add_noise_and_tilt(scene, job.seed + number, scan);

  const auto path = [&](const char* name) {
    written.push_back(job.folder / name);
    return written.back();
  };
  const auto made = provenance_of(job);
  io::write_height_field(path("afm.gsf"), scan, made);
  Image sem = signal_of(job, scene, yields);
  sem.metadata["beam.energy_ev"] = format_exact(scene.energy_ev);  // a microscope records it too
  io::write_image(path("sem.tif"), sem);
  io::write_height_field(path("truth.gsf"), truth, made);
  io::write_tip(path("truth_tip.gsf"), tip_of(job, scene, scene.afm_pitch_nm, depth_nm), made);
  io::write_image(path("truth_sem.exr"), yields);
  io::write_text(path("truth.json"), truth_of(job, scene, frame).dump(2) + "\n");
}

}  // namespace

SampleSummary run(const SampleJob& job, const Reporter& reporter) {
  const CancelToken* const cancel = reporter.cancel;
  const NoteCallback& note = reporter.on_note;
  const SampleScene& scene = find_scene(job.name);
  const SampleSurface& surface = find_sample_surface(job.name);
  check(job);
  const double millions = 1e-6 * static_cast<double>(job.electrons) * job.width * job.height;
  reporter.note(fmt::format(
      "simulating {} x {} pixels of {} primaries, {}{}", job.width, job.height, job.electrons,
      millions >= 1 ? fmt::format("{:.3g} million in all, ", millions) : "",
      job.film.empty() ? fmt::format("with cascades from a library of {}", job.cascades)
                       : "each followed on its own, because of the film"));
  const AfmFrame frame = afm_frame(job, scene);
  SampleSummary summary;
  summary.sem_to_afm = frame.sem_to_afm;
  summary.afm_width = frame.width;
  summary.afm_height = frame.height;

  mc::SimulationOptions options;
  options.method = job.film.empty() ? mc::Method::replay : mc::Method::direct;
  options.budget = mc::ElectronsPerPixel{job.electrons};
  options.seed = job.seed;
  options.threads = job.threads;
  for (mc::Detector& detector : detector_of(job)) options.detectors.push_back(std::move(detector));
  JobLibraries kept(job.cache, reporter.counting("cascades"), note);
  LargeLibraries source(kept, job.cascades);
  const mc::Scene monte_carlo = monte_carlo_scene(job, scene, surface);
  const std::unique_ptr<Checkpoint> checkpoint =
      make_checkpoint(job, options, note, reporter.on_warning);
  const auto show = [&](double done, double total) {
    if (checkpoint) checkpoint->expect(total);
    reporter.progress(done, total, "primaries");
  };
  const auto keep = [&] {
    summary.complete = false;
    if (checkpoint && checkpoint->keep()) summary.checkpoint = checkpoint->path();
  };
  const mc::SimulationResult result =
      mc::simulate(monte_carlo, options,
                   {.watch = {show, cancel}, .journal = checkpoint.get(), .libraries = &source});
  if (!result.complete) {
    keep();
    return summary;
  }
  summary.seconds = result.seconds;
  Image yields = mc::make_image(result, monte_carlo.scan());
  yields.metadata = provenance_of(job);
  try {
    write_all(job, scene, surface, frame, yields, cancel, summary.written);
  } catch (const Interrupted&) {
    keep();
    summary.written.clear();
    return summary;
  } catch (const Error&) {
    keep();  // a full disk should not destroy the work as well
    if (note && !summary.checkpoint.empty())
      note(fmt::format("what is done is kept in {}; the same command goes on from there",
                       summary.checkpoint.string()));
    throw;
  }
  if (checkpoint) checkpoint->finish();
  return summary;
}

}  // namespace surf::workflow
