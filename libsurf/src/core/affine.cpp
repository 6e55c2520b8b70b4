// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/affine.h"

#include <cmath>

#include "surf/core/error.h"

namespace surf {

Affine inverse(const Affine& m) {
  const double d = m.determinant();
  if (!std::isfinite(d) || d == 0 || !std::isfinite(m.x0) || !std::isfinite(m.y0))
    throw InvalidInput("transform", "it maps the plane onto a line, or is not finite",
                       "Give a map that can be turned back");
  Affine r;
  r.xx = m.yy / d;
  r.xy = -m.xy / d;
  r.yx = -m.yx / d;
  r.yy = m.xx / d;
  r.x0 = -(r.xx * m.x0 + r.xy * m.y0);
  r.y0 = -(r.yx * m.x0 + r.yy * m.y0);
  return r;
}

Affine compose(const Affine& a, const Affine& b) {
  Affine r;
  r.xx = a.xx * b.xx + a.xy * b.yx;
  r.xy = a.xx * b.xy + a.xy * b.yy;
  r.x0 = a.xx * b.x0 + a.xy * b.y0 + a.x0;
  r.yx = a.yx * b.xx + a.yy * b.yx;
  r.yy = a.yx * b.xy + a.yy * b.yy;
  r.y0 = a.yx * b.x0 + a.yy * b.y0 + a.y0;
  return r;
}

AffineParts parts_of(const Affine& m) {
  AffineParts p;
  p.scale_x = std::hypot(m.xx, m.yx);
  p.rotation_rad = std::atan2(m.yx, m.xx);
  const double c = std::cos(p.rotation_rad), s = std::sin(p.rotation_rad);
  p.scale_y = -s * m.xy + c * m.yy;
  p.shear = p.scale_x > 0 ? (c * m.xy + s * m.yy) / p.scale_x : 0;
  p.shift_x_nm = m.x0;
  p.shift_y_nm = m.y0;
  return p;
}

Affine make_affine(const AffineParts& p) {
  const double c = std::cos(p.rotation_rad), s = std::sin(p.rotation_rad);
  Affine m;
  m.xx = c * p.scale_x;
  m.yx = s * p.scale_x;
  m.xy = c * p.scale_x * p.shear - s * p.scale_y;
  m.yy = s * p.scale_x * p.shear + c * p.scale_y;
  m.x0 = p.shift_x_nm;
  m.y0 = p.shift_y_nm;
  return m;
}

}  // namespace surf
