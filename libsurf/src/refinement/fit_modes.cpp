// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/refinement/fit_modes.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "surf/core/error.h"
#include "surf/mesh/vertex_normals.h"

namespace surf {
namespace {

/// The numbers of a view's state, in the order of the unknowns behind the amplitudes.
enum StateNumber { gain, offset, shift_x, shift_y, tilt_x, tilt_y, state_numbers };

void check(const RefinedView& v, std::size_t modes) {
  const std::size_t n = v.measured.size();
  bool right = n > 0 && v.simulated.size() == n && v.variance.size() == n &&
               (v.used.empty() || v.used.size() == n) && v.effects.size() == modes;
  for (const ModeEffect& e : v.effects)
    right = right && e.first.size() == e.pixels.size() && e.second.size() == e.pixels.size();
  if (!right)
    throw InvalidInput("view", "its grids and effects do not match", "Give one effect per mode");
}

/// Weights of pixels: one over the variance; 0 for those that do not count.
std::vector<double> weights_of(const RefinedView& v) {
  std::vector<double> weights(v.measured.size(), 0);
  for (std::size_t p = 0; p < weights.size(); ++p)
    if (v.used.includes(p)) weights[p] = 1 / v.variance.data()[p];
  return weights;
}

/// A column of the Jacobian: pixels and values.
struct Column {
  std::vector<std::uint32_t> pixels;
  std::vector<double> values;
};

Column column_of(const ModeEffect& e, const std::vector<double>& weights, double gain) {
  double common = 0, all = 0;
  for (std::size_t i = 0; i < e.pixels.size(); ++i) {
    const double mean = 0.5 * (e.first[i] + e.second[i]), w = weights[e.pixels[i]];
    common += w * e.first[i] * e.second[i];
    all += w * mean * mean;
  }
  const double scale = common > 0 && all > 0 ? std::sqrt(std::min(1.0, common / all)) : 0;
  Column out;
  if (scale == 0) return out;
  for (std::size_t i = 0; i < e.pixels.size(); ++i) {
    out.pixels.push_back(e.pixels[i]);
    out.values.push_back(gain * scale * 0.5 * (e.first[i] + e.second[i]));
  }
  return out;
}

Column all_pixels(const Grid<double>& values, double factor) {
  Column out;
  for (std::size_t p = 0; p < values.size(); ++p) {
    out.pixels.push_back(static_cast<std::uint32_t>(p));
    out.values.push_back(factor * values.data()[p]);
  }
  return out;
}

/// The slope of an image along x or y per nm, averaged over three rows or columns.
Grid<double> slope(const RefinedView& v, bool along_x) {
  const Grid<double>& s = v.simulated;
  const int w = s.width(), h = s.height();
  Grid<double> out(w, h);
  const double pitch = along_x ? v.placement.pitch_x_nm : v.placement.pitch_y_nm;
  const auto at = [&](int x, int y) { return s(std::clamp(x, 0, w - 1), std::clamp(y, 0, h - 1)); };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      double sum = 0;
      for (int k = -1; k <= 1; ++k) {
        const double weight = k == 0 ? 0.5 : 0.25;
        sum += weight * (along_x ? at(x + 1, y + k) - at(x - 1, y + k)
                                 : at(x + k, y + 1) - at(x + k, y - 1));
      }
      out(x, y) = sum / (2 * pitch);
    }
  return out;
}

/// Columns in all pixels, so that products are fast.
Eigen::MatrixXd dense(const std::vector<Column>& columns, std::size_t pixels) {
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(pixels),
                                            static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k)
    for (std::size_t i = 0; i < columns[k].pixels.size(); ++i)
      j(static_cast<Eigen::Index>(columns[k].pixels[i]), static_cast<Eigen::Index>(k)) =
          columns[k].values[i];
  return j;
}

Eigen::Map<const Eigen::MatrixXd> square(const std::vector<double>& values, std::size_t n) {
  return {values.data(), static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n)};
}

}  // namespace

void fit_gain(const RefinedView& view, RefinedViewState& state) {
  const std::vector<double> weights = weights_of(view);
  double sum = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t p = 0; p < weights.size(); ++p) {
    const double w = weights[p], s = view.simulated.data()[p], m = view.measured.data()[p];
    sum += w, x += w * s, y += w * m, xx += w * s * s, xy += w * s * m;
  }
  const double determinant = sum * xx - x * x;
  if (!(determinant > 0))
    throw InvalidInput("image", "the simulated image shows nothing", "Check where the image looks");
  state.gain = (sum * xy - x * y) / determinant;
  state.offset = (y - state.gain * x) / sum;
}

ModeFit fit_modes(const std::vector<RefinedView>& views,
                  const std::vector<RefinedViewState>& states,
                  const std::vector<double>& amplitudes, const std::vector<double>& prior) {
  const std::size_t modes = amplitudes.size();
  if (prior.size() != modes * modes || states.size() != views.size())
    throw InvalidInput("modes", "their prior or the states of views do not match",
                       "Give one state per view");
  const auto size = static_cast<Eigen::Index>(modes),
             all = size + static_cast<Eigen::Index>(state_numbers * views.size());
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(all, all);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(all);
  const Eigen::MatrixXd before =
      square(prior, modes).llt().solve(Eigen::MatrixXd::Identity(size, size));
  const Eigen::Map<const Eigen::VectorXd> now(amplitudes.data(), size);
  h.topLeftCorner(size, size) = before;
  b.head(size) = -before * now;
  ModeFit out;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const RefinedView& view = views[v];
    const RefinedViewState& state = states[v];
    check(view, modes);
    const std::size_t pixels = view.measured.size();
    const std::vector<double> weights = weights_of(view);
    std::vector<Column> columns;
    for (const ModeEffect& e : view.effects) columns.push_back(column_of(e, weights, state.gain));
    columns.push_back(all_pixels(view.simulated, 1));
    columns.push_back(
        all_pixels(Grid<double>(view.measured.width(), view.measured.height(), 1), 1));
    columns.push_back(all_pixels(slope(view, true), state.gain));
    columns.push_back(all_pixels(slope(view, false), state.gain));
    columns.push_back(column_of(view.tilt_x, weights, state.gain));
    columns.push_back(column_of(view.tilt_y, weights, state.gain));
    const Eigen::MatrixXd j = dense(columns, pixels);
    const Eigen::Map<const Eigen::VectorXd> w(weights.data(), static_cast<Eigen::Index>(pixels));
    Eigen::VectorXd left(static_cast<Eigen::Index>(pixels));
    for (std::size_t p = 0; p < pixels; ++p)
      left[static_cast<Eigen::Index>(p)] =
          view.measured.data()[p] - state.offset - state.gain * view.simulated.data()[p];
    const Eigen::MatrixXd weighted = w.asDiagonal() * j;
    const Eigen::MatrixXd own = j.transpose() * weighted;
    const Eigen::VectorXd pull = weighted.transpose() * left;
    const Eigen::Index at = size + static_cast<Eigen::Index>(state_numbers * v);
    h.topLeftCorner(size, size) += own.topLeftCorner(size, size);
    h.block(at, 0, state_numbers, size) = own.bottomLeftCorner(state_numbers, size);
    h.block(0, at, size, state_numbers) = own.topRightCorner(size, state_numbers);
    h.block(at, at, state_numbers, state_numbers) =
        own.bottomRightCorner(state_numbers, state_numbers);
    b.head(size) += pull.head(size);
    b.segment(at, state_numbers) = pull.tail(state_numbers);
    const auto hold = [&](StateNumber number, double value, double deviation) {
      // Without a deviation the number is held where it is.
      const double weight = deviation > 0 ? 1 / (deviation * deviation) : 1e30;
      h(at + number, at + number) += weight;
      if (deviation > 0) b[at + number] -= weight * value;
    };
    hold(shift_x, state.shift_x_nm, view.shift_error_nm);
    hold(shift_y, state.shift_y_nm, view.shift_error_nm);
    hold(tilt_x, state.tilt_x_deg, view.tilt_error_deg);
    hold(tilt_y, state.tilt_y_deg, view.tilt_error_deg);
    out.information.emplace_back();
    for (Eigen::Index k = 0; k < size; ++k) out.information.back().push_back(own(k, k));
  }
  // Unknowns of very different size: scaled to a diagonal of 1.
  const Eigen::VectorXd scale = h.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * h * scale.asDiagonal();
  const Eigen::MatrixXd inverse = scale.asDiagonal() *
                                  scaled.ldlt().solve(Eigen::MatrixXd::Identity(all, all)) *
                                  scale.asDiagonal();
  const Eigen::VectorXd change = inverse * b;
  out.amplitudes_nm = amplitudes;
  for (std::size_t k = 0; k < modes; ++k) {
    const double by = change[static_cast<Eigen::Index>(k)];
    out.amplitudes_nm[k] += by;
    out.step = std::max(out.step, std::abs(by) / std::sqrt(prior[k * modes + k]));
  }
  out.covariance.resize(modes * modes);
  Eigen::Map<Eigen::MatrixXd>(out.covariance.data(), size, size) =
      inverse.topLeftCorner(size, size);
  for (std::size_t v = 0; v < views.size(); ++v) {
    const Eigen::VectorXd by =
        change.segment(size + static_cast<Eigen::Index>(state_numbers * v), state_numbers);
    RefinedViewState s = states[v];
    s.gain += by[gain], s.offset += by[offset];
    s.shift_x_nm += by[shift_x], s.shift_y_nm += by[shift_y];
    s.tilt_x_deg += by[tilt_x], s.tilt_y_deg += by[tilt_y];
    out.views.push_back(s);
  }
  return out;
}

std::vector<double> vertex_deviations(const TriangleMesh& mesh, const std::vector<MeshMode>& modes,
                                      const std::vector<double>& covariance) {
  const std::vector<Vec3> normals = vertex_normals(mesh);
  struct Share {
    std::size_t mode;
    double size;
  };
  std::vector<std::vector<Share>> shares(mesh.vertices_nm.size());
  for (std::size_t k = 0; k < modes.size(); ++k)
    for (const MeshMode::Move& move : modes[k].moves)
      shares[move.vertex].push_back({k, dot(move.by, normals[move.vertex])});
  std::vector<double> out;
  for (const std::vector<Share>& at : shares) {
    double variance = 0;
    for (const Share& a : at)
      for (const Share& b : at)
        variance += a.size * b.size * covariance[a.mode * modes.size() + b.mode];
    out.push_back(std::sqrt(std::max(0.0, variance)));
  }
  return out;
}

}  // namespace surf
