// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare_truth.h"
#include "registration_picture.h"
#include "sem_frame.h"

namespace surf::workflow {
namespace {

using io::PlotColors;
using io::PlotPanel;
using io::PlotSeries;
using io::PlotStyle;

constexpr double nm_per_um = 1000;
constexpr double blank = std::numeric_limits<double>::quiet_NaN();
// Range of whitened residuals shown, in standard deviations either way.
constexpr double deviations_shown = 4;
constexpr double row_height_px = 330;

PlacedImage on_samples(const HeightField& field, Grid<double> values, const Mask& valid = {}) {
  return {field.placement(), std::move(values), valid};
}

PlotPanel picture(const std::string& title, const PlacedImage& image, PlotColors colors,
                  const std::string& label) {
  PlotPanel panel = image_panel(title, picture_um(image));
  panel.image->colors = colors;
  panel.image->label = label;
  panel.image->lit_per_unit = 1 / nm_per_um;
  return panel;
}

PlotPanel residual_panel(const std::string& title, const PlacedImage& image) {
  PlotPanel panel = picture(title, image, PlotColors::difference, "deviations");
  panel.image->range = io::PlotAxis::Range{-deviations_shown, deviations_shown};
  return panel;
}

/// The data along a line across the surface.
struct Section {
  std::vector<double> place_um, scan, start, surface, truth;
  std::vector<double> middle, half;  // of the 95 % interval
};

struct Line {
  bool along_x = true;
  int index = 0;  // number of the row or column
};

/// The row or column whose heights vary most, away from the border.
Line most_relief(const HeightField& surface, bool along_x) {
  const int lines = along_x ? surface.z_nm.height() : surface.z_nm.width();
  const int length = along_x ? surface.z_nm.width() : surface.z_nm.height();
  const int margin = lines / 10;
  Line best{along_x, lines / 2};
  double most = -1;
  for (int line = margin; line < lines - margin; ++line) {
    double sum = 0, squared = 0, count = 0;
    for (int i = 0; i < length; ++i) {
      const int x = along_x ? i : line, y = along_x ? line : i;
      if (!surface.is_valid(x, y)) continue;
      sum += surface.z_nm(x, y), squared += surface.z_nm(x, y) * surface.z_nm(x, y), ++count;
    }
    const double variance = count > 0 ? squared / count - sum / count * (sum / count) : 0;
    if (variance > most) most = variance, best.index = line;
  }
  return best;
}

Section section_of(const Line& line, const Reconstruction& r, const HeightField* scan,
                   const HeightField* truth, double offset) {
  Section s;
  const int length = line.along_x ? r.surface.z_nm.width() : r.surface.z_nm.height();
  for (int i = 0; i < length; ++i) {
    const int x = line.along_x ? i : line.index, y = line.along_x ? line.index : i;
    if (!r.surface.is_valid(x, y)) continue;
    s.place_um.push_back((line.along_x ? r.surface.x_nm(x) : r.surface.y_nm(y)) / nm_per_um);
    s.surface.push_back(r.surface.z_nm(x, y));
    if (!r.lower_nm.empty()) {
      s.middle.push_back(0.5 * (r.lower_nm(x, y) + r.upper_nm(x, y)));
      s.half.push_back(0.5 * (r.upper_nm(x, y) - r.lower_nm(x, y)));
    }
    if (r.start.z_nm.size() == r.surface.z_nm.size()) s.start.push_back(r.start.z_nm(x, y));
    if (scan) s.scan.push_back(scan->is_valid(x, y) ? scan->z_nm(x, y) : blank);
    if (truth) s.truth.push_back(truth->is_valid(x, y) ? truth->z_nm(x, y) + offset : blank);
  }
  return s;
}

/// A series of values; those that are not finite are left out.
PlotSeries series(const std::string& name, const Section& s, const std::vector<double>& values,
                  int color, bool dashed) {
  PlotSeries line;
  line.name = name;
  line.color = color;
  line.dashed = dashed;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isfinite(values[i])) line.x.push_back(s.place_um[i]), line.y.push_back(values[i]);
  return line;
}

PlotPanel section_panel(const std::string& title, const std::string& axis, const Section& s) {
  PlotPanel panel;
  panel.title = title;
  panel.x.label = axis;
  panel.y.label = "height (nm)";
  const auto add = [&](PlotSeries line) {
    if (!line.y.empty()) panel.series.push_back(std::move(line));
  };
  if (!s.half.empty()) {
    PlotSeries band = series("95 % interval", s, s.middle, 0, false);
    band.style = PlotStyle::band;
    band.y_error = s.half;
    add(std::move(band));
  }
  add(series("AFM scan", s, s.scan, 7, false));
  add(series("eroded scan", s, s.start, 4, true));
  add(series("reconstruction", s, s.surface, 0, false));
  add(series("truth", s, s.truth, 6, true));
  return panel;
}

Grid<double> as_numbers(const Grid<unsigned char>& mask) {
  Grid<double> values(mask.width(), mask.height());
  std::ranges::copy(mask.data(), values.data().begin());
  return values;
}

std::string title_of(const ReconstructJob& job, const ReconstructSummary& s) {
  std::string text = job.afm ? job.afm->file.filename().string() : "";
  if (job.sem) text += (text.empty() ? "" : " and ") + job.sem->file.filename().string();
  text += s.verdict == ReconstructionVerdict::sound ? ": converged, residuals like noise"
                                                    : ": flagged, see the reasons in report.json";
  if (s.truth)
    text += fmt::format("; {:.2f} nm rms from the truth ({:.2f} nm before)", s.truth->rms_nm,
                        s.truth->start_rms_nm);
  return text;
}

}  // namespace

io::Plot reconstruction_panel(const ReconstructJob& job, const ReconstructSummary& s,
                              const AfmData* afm, const SemData* sem,
                              const std::vector<SemView>& views) {
  const Reconstruction& r = s.result;
  std::vector<PlotPanel> first, second, third;
  if (afm) {
    const HeightField& scan = afm->image;
    PlotPanel input = picture("AFM scan, levelled", on_samples(scan, scan.z_nm, scan.valid),
                              PlotColors::relief, "nm");
    PlotPanel simulated = picture("AFM scan, simulated",
                                  on_samples(scan, r.simulated_afm.z_nm, r.simulated_afm.valid),
                                  PlotColors::relief, "nm");
    PlotPanel residual =
        residual_panel("AFM residual, whitened", on_samples(scan, r.afm_residual, r.afm_used));
    if (sem)
      for (PlotPanel* panel : {&input, &simulated, &residual})
        panel->series.push_back(outline_um(sem->image, r.sem_to_afm));
    first.push_back(std::move(input));
    second.push_back(std::move(simulated));
    third.push_back(std::move(residual));
  }
  if (sem) {
    const PlacedImage& image = sem->image;
    first.push_back(picture("SEM image", image, PlotColors::grey, "grey level"));
    PlotPanel simulated = picture("SEM image, simulated", on_samples(r.surface, r.simulated_sem),
                                  PlotColors::grey, "grey level");
    second.push_back(std::move(simulated));
    third.push_back(residual_panel("SEM residual, whitened",
                                   on_samples(r.surface, r.sem_residual, image.valid)));
  }
  constexpr std::size_t most_shown = 3;
  for (std::size_t k = 0; k < std::min(views.size(), most_shown); ++k) {
    const PlacedImage& image = views[k].sem.image;
    const ViewResult& view = r.views[k];
    const std::string name = fmt::format("view {}", k + 2);
    first.push_back(picture(fmt::format("{}, tilted by {:.2f}° to {:.0f}°", name,
                                        view.pose.tilt_deg, view.pose.azimuth_deg),
                            image, PlotColors::grey, "grey level"));
    second.push_back(picture(name + ", simulated", {image.placement(), view.simulated, {}},
                             PlotColors::grey, "grey level"));
    Mask used(view.used.width(), view.used.height());
    std::ranges::copy(view.used.data(), used.data().begin());
    third.push_back(
        residual_panel(name + ", residual", {image.placement(), view.residual, std::move(used)}));
  }
  first.push_back(picture("surface", on_samples(r.surface, r.surface.z_nm, r.surface.valid),
                          PlotColors::relief, "nm"));
  if (!r.deviation_nm.empty())
    second.push_back(picture("standard deviation",
                             on_samples(r.surface, r.deviation_nm, r.surface.valid),
                             PlotColors::heights, "nm"));
  else
    second.push_back(picture("eroded scan", on_samples(r.start, r.start.z_nm, r.start.valid),
                             PlotColors::relief, "nm"));
  std::optional<HeightField> truth, scan;
  if (job.truth) truth = truth_on(r.surface, *job.truth);
  if (truth && s.truth) {
    Grid<double> error = r.surface.z_nm;
    for (std::size_t i = 0; i < error.size(); ++i)
      error.data()[i] = truth->valid.data()[i]
                            ? error.data()[i] - truth->z_nm.data()[i] - s.truth->offset_nm
                            : blank;
    third.push_back(picture("surface less truth", on_samples(r.surface, std::move(error)),
                            PlotColors::difference, "nm"));
  } else if (!r.data_support.empty()) {
    PlotPanel held =
        picture("held by 1 AFM, 2 SEM, 3 both", on_samples(r.surface, as_numbers(r.data_support)),
                PlotColors::heights, "");
    held.image->range = io::PlotAxis::Range{0, 3};
    third.push_back(std::move(held));
  } else {
    Grid<double> change = r.surface.z_nm;
    for (std::size_t i = 0; i < change.size(); ++i) change.data()[i] -= r.start.z_nm.data()[i];
    third.push_back(picture("surface less eroded scan", on_samples(r.surface, std::move(change)),
                            PlotColors::difference, "nm"));
  }
  io::Plot plot;
  plot.title = title_of(job, s);
  plot.columns = static_cast<int>(std::max({first.size(), second.size(), std::size_t{2}}));
  for (auto* row : {&first, &second, &third})
    for (PlotPanel& panel : *row) plot.panels.push_back(std::move(panel));
  if (afm) {
    const PlacedImage place = on_samples(r.surface, r.surface.z_nm);
    SurfaceUnderSem under = surface_under_sem(afm->image, place, sem ? r.sem_to_afm : Affine{});
    under.surface.valid = under.known;
    scan = std::move(under.surface);
  }
  for (const bool along_x : {true, false}) {
    const Line line = most_relief(r.surface, along_x);
    const Section section = section_of(line, r, scan ? &*scan : nullptr, truth ? &*truth : nullptr,
                                       s.truth ? s.truth->offset_nm : 0);
    const double at =
        (along_x ? r.surface.y_nm(line.index) : r.surface.x_nm(line.index)) / nm_per_um;
    PlotPanel panel =
        section_panel(fmt::format("section at {} = {:.3g} µm", along_x ? "y" : "x", at),
                      along_x ? "x (µm)" : "y (µm)", section);
    panel.legend = along_x;
    panel.columns = along_x ? std::max(plot.columns - 1, 1) : 1;
    plot.panels.push_back(std::move(panel));
  }
  plot.width_px = 640 * plot.columns;
  plot.height_px = static_cast<int>(row_height_px * (third.empty() ? 3 : 4) + 60);
  return plot;
}

}  // namespace surf::workflow
