// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sem_frame.h"

namespace surf::workflow {
namespace {

constexpr double nm_per_um = 1000;
constexpr double blank = std::numeric_limits<double>::quiet_NaN();
constexpr int squares = 8;  // number along the image's shorter side

/// Subtracts the mean and divides by the standard deviation, so that two images can be compared as
/// greys.
void standardise(Grid<double>& values) {
  double sum = 0, squared = 0, count = 0;
  for (const double v : values.data())
    if (std::isfinite(v)) sum += v, squared += v * v, ++count;
  if (count < 2) return;
  const double mean = sum / count,
               deviation = std::sqrt(std::max(squared / count - mean * mean, 0.0));
  for (double& v : values.data()) v = (v - mean) / (deviation > 0 ? deviation : 1);
}

PlacedImage under_sem(const PlacedImage& sem, const PlacedImage& simulated, const Affine& map) {
  HeightField field;
  field.z_nm = simulated.values;
  field.valid = simulated.valid;
  field.placement() = simulated.placement();
  const SurfaceUnderSem under = surface_under_sem(field, sem, map);
  PlacedImage image = sem;
  image.values = under.surface.z_nm;
  image.valid = under.known;
  return image;
}

}  // namespace

io::PlotImage picture_um(const PlacedImage& image) {
  io::PlotImage picture;
  picture.values = image.values;
  for (int y = 0; y < image.values.height(); ++y)
    for (int x = 0; x < image.values.width(); ++x)
      if (!image.is_valid(x, y)) picture.values(x, y) = blank;
  picture.pitch_x = image.pitch_x_nm / nm_per_um, picture.pitch_y = image.pitch_y_nm / nm_per_um;
  picture.origin_x = image.origin_x_nm / nm_per_um,
  picture.origin_y = image.origin_y_nm / nm_per_um;
  return picture;
}

io::PlotPanel image_panel(const std::string& title, io::PlotImage image) {
  io::PlotPanel panel;
  panel.title = title;
  panel.x.label = "x (µm)";
  panel.y.label = "y (µm)";
  panel.image = std::move(image);
  panel.legend = false;
  return panel;
}

io::PlotSeries outline_um(const PlacedImage& sem, const Affine& map) {
  const double right = sem.values.width() - 0.5, top = sem.values.height() - 0.5;
  io::PlotSeries line;
  for (const auto& [column, row] :
       {std::pair{-0.5, -0.5}, {right, -0.5}, {right, top}, {-0.5, top}, {-0.5, -0.5}}) {
    const Point2 p = map(sem.place_nm(column, row));
    line.x.push_back(p.x / nm_per_um);
    line.y.push_back(p.y / nm_per_um);
  }
  line.color = 1;
  return line;
}

io::Plot registration_picture(const PlacedImage& sem, const PlacedImage& simulated,
                              const Affine& map) {
  const PlacedImage under = under_sem(sem, simulated, map);
  io::PlotImage real = picture_um(sem), model = picture_um(under);
  standardise(real.values);
  standardise(model.values);
  io::PlotImage both = real;
  const int side = std::max(2, std::min(sem.values.width(), sem.values.height()) / squares);
  for (int y = 0; y < both.values.height(); ++y)
    for (int x = 0; x < both.values.width(); ++x)
      if ((x / side + y / side) % 2 && std::isfinite(model.values(x, y)))
        both.values(x, y) = model.values(x, y);
  for (io::PlotImage* image : {&real, &model, &both}) {
    image->range = io::PlotAxis::Range{-2.5, 3.5};
    image->label = "deviations from the mean";
  }
  io::PlotPanel whole =
      image_panel("simulated from the AFM scan; the SEM image's outline", picture_um(simulated));
  whole.image->label = "electrons per primary";
  whole.series.push_back(outline_um(sem, map));
  io::Plot plot;
  plot.panels = {image_panel("SEM image", std::move(real)),
                 image_panel("simulated, as registered", std::move(model)),
                 image_panel("squares of both in turn", std::move(both)), std::move(whole)};
  plot.columns = 2;
  plot.width_px = 1600;
  return plot;
}

}  // namespace surf::workflow
