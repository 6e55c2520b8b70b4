// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem/model/padded_field.h"

#include "sem/model/border.h"

namespace surf {

PaddedField::PaddedField(const HeightField& field, int margin, Edge edge)
    : width_(field.z_nm.width()), height_(field.z_nm.height()), margin_(margin),
      per_two_x_(0.5 / field.pitch_x_nm), per_two_y_(0.5 / field.pitch_y_nm) {
  for (int x = -margin; x < width_ + margin; ++x) from_x_.push_back(border_sample(x, width_, edge));
  for (int y = -margin; y < height_ + margin; ++y)
    from_y_.push_back(border_sample(y, height_, edge));
  fill(field.z_nm);
}

void PaddedField::fill(const Grid<double>& z_nm) {
  z_ = Grid<double>(width_ + 2 * margin_, height_ + 2 * margin_);
  for (int y = 0; y < z_.height(); ++y)
    for (int x = 0; x < z_.width(); ++x)
      z_(x, y) = z_nm(from_x_[static_cast<std::size_t>(x)], from_y_[static_cast<std::size_t>(y)]);
}

PaddedField PaddedField::like(const Grid<double>& z_nm) const {
  PaddedField other = *this;
  other.fill(z_nm);
  return other;
}

Grid<double> PaddedField::fold(Grid<double> by_z, const Grid<double>& by_slope_x,
                               const Grid<double>& by_slope_y) const {
  for (int y = 1; y + 1 < by_z.height(); ++y)
    for (int x = 1; x + 1 < by_z.width(); ++x) {
      by_z(x + 1, y) += by_slope_x(x, y) * per_two_x_;
      by_z(x - 1, y) -= by_slope_x(x, y) * per_two_x_;
      by_z(x, y + 1) += by_slope_y(x, y) * per_two_y_;
      by_z(x, y - 1) -= by_slope_y(x, y) * per_two_y_;
    }
  Grid<double> out(width_, height_);
  for (int y = 0; y < by_z.height(); ++y)
    for (int x = 0; x < by_z.width(); ++x)
      out(from_x_[static_cast<std::size_t>(x)], from_y_[static_cast<std::size_t>(y)]) += by_z(x, y);
  return out;
}

}  // namespace surf
