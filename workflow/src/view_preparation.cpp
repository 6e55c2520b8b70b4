// SPDX-License-Identifier: GPL-3.0-or-later
#include "view_preparation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "chain_steps.h"
#include "first_calibration.h"
#include "seen_from.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/registration/find_shift.h"
#include "surf/workflow/signal_detectors.h"

namespace surf::workflow {
namespace {

constexpr double least_correlation = 0.3;  // of a view with what the surface looks like from there
constexpr double as_good = 0.02;           // correlations that differ by less are alike

std::string count_of(std::size_t views) {
  return views == 1 ? "1 further SEM image" : fmt::format("{} further SEM images", views);
}

/// The image that the surface would give, over all that a tilted beam sees of it.
/// `quarters`: from a detector that stands elsewhere, see `seen_from`.
PlacedImage predicted(const HeightField& surface, const PlacedImage& view, const ViewPose& pose,
                      const ImageModel& model, const std::vector<double>& gains, int threads,
                      int quarters = 0) {
  const BeamAxes axes = beam_axes(pose.tilt_deg, pose.azimuth_deg);
  // The plane's part that the surface's corners lie in.
  Point2 low{1e300, 1e300}, high{-1e300, -1e300};
  const auto [lowest, highest] = std::ranges::minmax_element(surface.z_nm.data());
  for (const double x : {surface.x_nm(0), surface.x_nm(surface.z_nm.width() - 1)})
    for (const double y : {surface.y_nm(0), surface.y_nm(surface.z_nm.height() - 1)})
      for (const double z : {*lowest, *highest}) {
        const Vec3 p{x, y, z};
        low = {std::min(low.x, dot(p, axes.across)), std::min(low.y, dot(p, axes.up))};
        high = {std::max(high.x, dot(p, axes.across)), std::max(high.y, dot(p, axes.up))};
      }
  PlacedImage whole;
  whole.pitch() = view.pitch();
  whole.origin_x_nm = low.x, whole.origin_y_nm = low.y;
  whole.values = Grid<double>(static_cast<int>((high.x - low.x) / view.pitch_x_nm) + 2,
                              static_cast<int>((high.y - low.y) / view.pitch_y_nm) + 2);
  const HeightField along =
      heights_along_beam(surface, whole, {pose.tilt_deg, pose.azimuth_deg, {}}, 0, threads);
  HeightField filled = along;
  filled.valid = {};
  ModelOptions options;
  options.threads = threads;
  const ModelImages images = seen_from(model, filled, quarters, options);
  for (std::size_t c = 0; c < images.size(); ++c)
    for (std::size_t i = 0; i < whole.values.size(); ++i)
      whole.values.data()[i] += gains[c] * images[c].data()[i];
  whole.valid = along.valid;
  return whole;
}

std::string doubt_of(const PreparedView& view) {
  if (view.correlation < least_correlation)
    return fmt::format(
        "it has nothing in common with what the surface looks like from there (correlation "
        "{:.2f}): is it of the same place, and are tilt and azimuth right?",
        view.correlation);
  if (clearly_larger(view.other_side, view.correlation))
    return fmt::format(
        "it looks as a beam sees the surface that is tilted to the other side (correlation {:.2f}, "
        "and {:.2f} as told): is `beam.azimuth` off by 180 degrees?",
        view.other_side, view.correlation);
  return {};
}

/// Of shifts that agree as well, the one nearest to where the images' frames say: gratings look
/// alike a pitch away.
ImageShift nearest_of_best(const std::vector<ImageShift>& shifts, Point2 expected) {
  ImageShift best = shifts.front();
  const auto away = [&](const ImageShift& s) {
    return std::hypot(s.x_nm - expected.x, s.y_nm - expected.y);
  };
  for (const ImageShift& s : shifts)
    if (s.correlation > shifts.front().correlation - as_good && away(s) < away(best)) best = s;
  return best;
}

}  // namespace

std::string first_signal(const ReconstructJob& job) {
  return first_signal(job.view_settings, job.views.size(), job.model.signal);
}

bool all_known(const KnownViews& s) {
  return !s.gains.empty() && !s.noises.empty() && !s.places_nm.empty();
}

void check_views(const ReconstructJob& job) {
  const KnownViews& v = job.known_views;
  const std::size_t views = job.views.size();
  if (views > 0 && !job.sem)
    throw UsageError("`reconstruction.sem`", "further SEM images need a first one", "Give one");
  angles_of(job.view_settings, views, 0);
  const std::vector<std::string> signals = signals_of(job.view_settings, views, first_signal(job));
  // Names of a model's own channels are known where there is one.
  if (job.model.file.empty() && v.models.empty())
    for (const std::string& signal : signals)
      if (!signal.empty()) detectors_of(signal, "`reconstruction.view_signal`");
  if (!job.film.empty() && views > 0)
    throw UsageError("`reconstruction.film`", "a film is known to the first image's model alone",
                     "Leave it out, or leave out further images");
  for_each_view(v.models, views, std::filesystem::path(), "`reconstruction.view_model`");
  const auto known = [&](std::size_t count, const char* subject) {
    if (count != 0 && count != views)
      throw UsageError(subject,
                       fmt::format("{} are given, and there {} {}", count,
                                   views == 1 ? "is" : "are", count_of(views)),
                       "Give one for each SEM image after the first");
  };
  known(v.gains.size(), "`reconstruction.view_gains`");
  known(v.noises.size(), "`reconstruction.view_noise`");
  known(v.places_nm.size(), "`reconstruction.view_place`");
  if (views > most_views)
    throw UsageError("`reconstruction.sem`", fmt::format("{} SEM images are given", views + 1),
                     fmt::format("Give {} at most", most_views + 1));
  for (const SemInput& view : job.views) validate(view.image, "SEM image");
}

std::vector<SemView> prepare_views(const ReconstructJob& job, ReconstructSummary& s,
                                   const SemData& sem, const HeightField* surface,
                                   const Reporter& told) {
  std::vector<SemView> out;
  const std::size_t views = job.views.size();
  if (views == 0) return out;
  begin(told, "views");
  const KnownViews& settings = job.known_views;
  const std::vector<ViewAngles> angles = angles_of(job.view_settings, views, 0);
  const auto models =
      for_each_view(settings.models, views, std::filesystem::path(), "`reconstruction.view_model`");
  const std::vector<std::string> signals = signals_of(job.view_settings, views, first_signal(job));
  const int threads = job.options.threads;
  for (std::size_t k = 0; k < views; ++k) {
    PreparedView found;
    found.tilt_deg = angles[k].tilt_deg, found.azimuth_deg = angles[k].azimuth_deg;
    PlacedImage image = job.views[k].image;
    found.saturated = leave_out_saturated(image);
    ModelRequest request = job.model;
    if (request.folder.empty()) request.folder = job.folder;
    if (const double energy = angles[k].energy_ev;
        energy > 0 && energy != s.model->trained.scope.energy_ev) {
      request.energy_ev = energy;
      request.file.clear();
    }
    if (!models[k].empty()) request.file = models[k];
    request.signal = found.signal = signals[k];
    found.model = model_of(request, image, told);
    const ImageModel& model = *found.model.model;
    SemView view;
    view.pose = {angles[k].tilt_deg, angles[k].azimuth_deg, {}};
    view.tilt_error_deg = job.view_settings.tilt_error_deg;
    const bool same_signal =
        signals[k] == first_signal(job) && model.channels() == sem.model->channels();
    const bool same_frame = found.tilt_deg == 0 && image.placement() == sem.image.placement() &&
                            image.values.width() == sem.image.values.width() &&
                            image.values.height() == sem.image.values.height();
    const std::vector<double> gains =
        same_signal ? sem.gains : std::vector<double>(model.channels().size(), 1.0);

    // Where it looks: by the surface, or, where none is known yet, by the first image. Images of
    // different signals look different: without a surface they are taken as of one scan.
    std::vector<ImageShift> shifts;
    if (surface)
      shifts = find_shifts(predicted(*surface, image, view.pose, model, gains, threads), image);
    else if (same_signal) shifts = find_shifts(sem.image, image);
    const bool compared = surface || same_signal;
    if (shifts.empty()) shifts = {{0, 0, 0}};
    ImageShift shift = nearest_of_best(shifts, {});
    if (!settings.places_nm.empty())
      shift.x_nm = settings.places_nm[k].x, shift.y_nm = settings.places_nm[k].y;
    found.shift_x_nm = shift.x_nm, found.shift_y_nm = shift.y_nm;
    found.correlation = shift.correlation;
    if (surface && found.tilt_deg > 0) {
      const ViewPose mirrored{found.tilt_deg, found.azimuth_deg + 180, {}};
      const std::vector<ImageShift> others =
          find_shifts(predicted(*surface, image, mirrored, model, gains, threads), image);
      if (!others.empty()) found.other_side = others.front().correlation;
    }
    if (settings.places_nm.empty() && compared) found.doubt = doubt_of(found);
    if (surface && found.model.sided) {
      // All at one place: of a scan, or where the image suits best.
      const Affine map = same_frame ? Affine{} : Affine{1, 0, shift.x_nm, 0, 1, shift.y_nm};
      std::string doubt = facing_doubt(model.channels().front(), [&](int quarters) {
        return correlation_at(
            image, predicted(*surface, image, view.pose, model, gains, threads, quarters), map);
      });
      if (!doubt.empty()) found.doubt = std::move(doubt);
    }
    view.pose.to_plane = {1, 0, shift.x_nm, 0, 1, shift.y_nm};
    view.same_scan = !same_signal && same_frame && shift.x_nm == 0 && shift.y_nm == 0 &&
                     found.model.trained.scope.energy_ev == s.model->trained.scope.energy_ev;
    if (view.same_scan)
      told.note(
          fmt::format("view {}: taken as of the first image's scan, by another detector", k + 2));

    std::optional<GivenCalibration> given;
    if (!settings.gains.empty()) {
      const std::vector<double>& known = settings.gains[k];
      if (known.size() != model.channels().size() + 1)
        throw UsageError("`reconstruction.view_gains`",
                         fmt::format("view {} has {} numbers, and its model {} channels", k + 2,
                                     known.size(), model.channels().size()),
                         "Give a gain for each channel, then the offset");
      given = GivenCalibration{{known.begin(), known.end() - 1}, known.back()};
    } else if (!surface && !same_signal) {
      throw UsageError("`reconstruction.view_gains`",
                       fmt::format("view {} shows another signal than the first image, and there "
                                   "is no scan to find its gain with",
                                   k + 2),
                       "Give a gain and an offset for it");
    } else if (!surface) {
      told.warn(fmt::format(
          "view {}: taken to have the first image's gain and offset, because there is no scan to "
          "find its own with; say `reconstruction.view_gains` if you know them",
          k + 2));
      given = GivenCalibration{gains, sem.offset};
    }
    const std::optional<SemNoise> noise =
        settings.noises.empty() ? job.sem_noise : std::optional(settings.noises[k]);
    HeightField along;
    if (surface) {
      along = heights_along_beam(*surface, image, view.pose, 0, threads);
      if (image.valid.empty()) image.valid = Mask(image.values.width(), image.values.height(), 1);
    }
    FirstCalibration first =
        calibrate_first(image, surface ? &along : nullptr, model, {}, given, noise, threads);
    if (surface) {
      // What the scan does not know of the surface is not noise.
      HeightField whole = along;
      whole.valid = {};
      PlacedImage seen = image;
      for (std::size_t i = 0; i < seen.valid.size(); ++i)
        seen.valid.data()[i] = seen.valid.data()[i] && along.valid.data()[i];
      calibrate_again(seen, whole, model, given.has_value(), noise.has_value(), threads, first);
    }
    view.sem = {image,
                found.model.model,
                first.gains,
                first.offset,
                first.noise,
                {},
                usual_discrepancy(image, job.model_error)};
    found.gains = first.gains, found.offset = first.offset;
    found.noise = first.noise, found.noise_from = first.noise_from;
    for (const std::string& warning : first.warnings) told.warn(warning);
    told.note(fmt::format(
        "view {}: {:g} deg to {:g} deg; displaced by {:.1f}, {:.1f} nm, correlation {:.2f}", k + 2,
        found.tilt_deg, found.azimuth_deg, found.shift_x_nm, found.shift_y_nm, found.correlation));
    s.views.push_back(std::move(found));
    out.push_back(std::move(view));
  }
  if (!job.afm && !s.model->sided &&
      std::ranges::none_of(s.views, [](const PreparedView& v) { return v.model.sided; }))
    told.warn(
        "heights from SEM images alone begin flat, and hardly leave that: give a scan, or images "
        "of quadrants, which tell slopes (`reconstruction.view_signal`), or measure lines, "
        "trenches "
        "and edges by 'semsurf profile'");
  return out;
}

}  // namespace surf::workflow
