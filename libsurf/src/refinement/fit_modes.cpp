// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/refinement/fit_modes.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "surf/core/error.h"
#include "surf/mesh/vertex_normals.h"

namespace surf {
namespace {

/// The numbers of a view's state, in the order of the unknowns behind the amplitudes.
enum StateNumber { gain, offset, shift_x, shift_y, tilt_x, tilt_y, bend, blur, state_numbers };

void check(const RefinedView& v, std::size_t modes) {
  const std::size_t n = v.measured.size();
  bool right = n > 0 && v.simulated.size() == n && v.variance.size() == n &&
               (v.first_half.empty() || (v.first_half.size() == n && v.second_half.size() == n)) &&
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

Column column_of(const std::vector<std::uint32_t>& pixels, std::vector<double> values,
                 double factor) {
  for (double& v : values) v *= factor;
  return {pixels, std::move(values)};
}

Column all_pixels(const Grid<double>& values, double factor) {
  Column out;
  for (std::size_t p = 0; p < values.size(); ++p) {
    out.pixels.push_back(static_cast<std::uint32_t>(p));
    out.values.push_back(factor * values.data()[p]);
  }
  return out;
}

/// One of the two simulations of a view.
const Grid<double>& first_of(const RefinedView& v) {
  return v.first_half.empty() ? v.simulated : v.first_half;
}
const Grid<double>& second_of(const RefinedView& v) {
  return v.first_half.empty() ? v.simulated : v.second_half;
}

/// The slope of an image along x or y per nm, averaged over three rows or columns.
Grid<double> slope(const RefinedView& v, const Grid<double>& s, bool along_x) {
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

/// What a bent relation between yields adds to the simulated ones, per unit of `bend`: squares of
/// the distance from their mean, over their standard deviation.
Grid<double> bend_shape(const RefinedView& v, const Grid<double>& simulated) {
  const auto n = static_cast<double>(v.simulated.size());
  double sum = 0, squares = 0;
  for (const double s : v.simulated.data()) sum += s;
  for (const double s : v.simulated.data()) squares += (s - sum / n) * (s - sum / n);
  const double deviation = std::sqrt(squares / n);
  Grid<double> out(v.simulated.width(), v.simulated.height(), 0);
  if (deviation > 0)
    for (std::size_t p = 0; p < out.size(); ++p) {
      const double off = simulated.data()[p] - sum / n;
      out.data()[p] = off * off / deviation;
    }
  return out;
}

/// What a wider spot adds to the simulated yields, per nm^2 of its variance: half the Laplacian
/// (the first term of a Gaussian filter), averaged over three rows or columns.
Grid<double> blur_shape(const RefinedView& v, const Grid<double>& s) {
  const int w = s.width(), h = s.height();
  const auto at = [&](int x, int y) { return s(std::clamp(x, 0, w - 1), std::clamp(y, 0, h - 1)); };
  const double px = v.placement.pitch_x_nm, py = v.placement.pitch_y_nm;
  Grid<double> out(w, h, 0);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      for (int k = -1; k <= 1; ++k) {
        const double weight = k == 0 ? 0.5 : 0.25;
        const double along = at(x + 1, y + k) - 2 * at(x, y + k) + at(x - 1, y + k),
                     up = at(x + k, y + 1) - 2 * at(x + k, y) + at(x + k, y - 1);
        out(x, y) += 0.5 * weight * (along / (px * px) + up / (py * py));
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

/// Bumps over wide parts of an image: triangular along x and y, so that they add up to 1.
class WideBumps {
 public:
  explicit WideBumps(const RefinedView& v)
      : view_(v), across_(count(v.measured.width() * v.placement.pitch_x_nm)),
        along_(count(v.measured.height() * v.placement.pitch_y_nm)) {}

  std::size_t size() const { return static_cast<std::size_t>(across_ * along_); }

  /// Calls visit(bump, share) for the bumps at a pixel.
  template <class Visit>
  void at(std::size_t pixel, const Visit& visit) const {
    if (size() == 0) return;
    const auto w = static_cast<std::size_t>(view_.measured.width());
    const Share x = share(static_cast<double>(pixel % w), view_.measured.width(), across_),
                y = share(static_cast<double>(pixel / w), view_.measured.height(), along_);
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i)
        if (const double size = (i ? x.next : 1 - x.next) * (j ? y.next : 1 - y.next); size > 0)
          visit(static_cast<std::size_t>((y.first + j) * across_ + x.first + i), size);
  }

  std::vector<Column> columns() const {
    std::vector<Column> out(size());
    for (std::uint32_t p = 0; p < view_.measured.size(); ++p)
      at(p, [&](std::size_t bump, double share) {
        out[bump].pixels.push_back(p), out[bump].values.push_back(share);
      });
    return out;
  }

 private:
  struct Share {
    int first;
    double next;
  };
  int count(double size_nm) const {
    return view_.wide_error > 0 ? 1 + static_cast<int>(std::ceil(size_nm / view_.wide_nm)) : 0;
  }
  static Share share(double pixel, int pixels, int bumps) {
    if (bumps < 2) return {0, 0};
    const double at = (pixel + 0.5) / pixels * (bumps - 1);
    const int first = std::min(static_cast<int>(at), bumps - 2);
    return {first, at - first};
  }

  const RefinedView& view_;
  int across_, along_;
};

/// What a simulation leaves of the image, in measured units.
Grid<double> left_by(const Grid<double>& simulated, const RefinedView& view,
                     const RefinedViewState& state) {
  Grid<double> left = simulation_error(view, state, simulated);
  for (std::size_t p = 0; p < left.size(); ++p)
    left.data()[p] =
        view.measured.data()[p] - state.offset - state.gain * simulated.data()[p] - left.data()[p];
  return left;
}

Eigen::Map<const Eigen::MatrixXd> square(const std::vector<double>& values, std::size_t n) {
  return {values.data(), static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n)};
}

Eigen::Index numbers_of(const std::vector<RefinedView>& views) {
  Eigen::Index sum = 0;
  for (const RefinedView& v : views)
    sum += state_numbers + static_cast<Eigen::Index>(WideBumps(v).size());
  return sum;
}

/// What an image tells of the amplitudes, and behind them of the numbers of its state: products of
/// effects. In `told` no chance is multiplied by itself, which would look like information: each
/// product is of two simulations. `seen` are products of their means, with the chance in them.
struct ViewEquations {
  Eigen::MatrixXd told, seen;
  Eigen::VectorXd pull;
};

/// Adds a view's products to those of all unknowns; its own numbers begin at `at`.
void add_view(const Eigen::MatrixXd& own, Eigen::Index modes, Eigen::Index at,
              Eigen::MatrixXd& all) {
  const Eigen::Index others = own.rows() - modes;
  all.topLeftCorner(modes, modes) += own.topLeftCorner(modes, modes);
  all.block(at, 0, others, modes) = own.bottomLeftCorner(others, modes);
  all.block(0, at, modes, others) = own.topRightCorner(modes, others);
  all.block(at, at, others, others) = own.bottomRightCorner(others, others);
}

ViewEquations equations_of(const RefinedView& view, const RefinedViewState& state) {
  const std::size_t pixels = view.measured.size();
  const std::vector<double> weights = weights_of(view);
  const Grid<double>&one = first_of(view), &other = second_of(view);
  std::vector<Column> first, second;
  const auto add_effect = [&](const ModeEffect& e) {
    first.push_back(column_of(e.pixels, e.first, state.gain));
    second.push_back(column_of(e.pixels, e.second, state.gain));
  };
  const auto add = [&](Column column) {
    first.push_back(column), second.push_back(std::move(column));
  };
  for (const ModeEffect& e : view.effects) add_effect(e);
  const auto add_of = [&](const auto& shape, double factor) {
    first.push_back(all_pixels(shape(one), factor));
    second.push_back(all_pixels(shape(other), factor));
  };
  add_of([](const Grid<double>& s) { return s; }, 1);
  add(all_pixels(Grid<double>(view.measured.width(), view.measured.height(), 1), 1));
  for (const bool along_x : {true, false})
    add_of([&](const Grid<double>& s) { return slope(view, s, along_x); }, state.gain);
  add_effect(view.tilt_x), add_effect(view.tilt_y);
  add_of([&](const Grid<double>& s) { return bend_shape(view, s); }, state.gain);
  add_of([&](const Grid<double>& s) { return blur_shape(view, s); }, state.gain);
  for (Column& wide : WideBumps(view).columns()) add(std::move(wide));
  const Eigen::MatrixXd a = dense(first, pixels), b = dense(second, pixels);
  const Eigen::Map<const Eigen::VectorXd> w(weights.data(), static_cast<Eigen::Index>(pixels));
  // What one simulation leaves of the image is multiplied by columns of the other.
  const Grid<double> left_by_one = left_by(one, view, state),
                     left_by_other = left_by(other, view, state);
  const auto column = [&](const Grid<double>& left) {
    return Eigen::Map<const Eigen::VectorXd>(left.data().data(), static_cast<Eigen::Index>(pixels));
  };
  const Eigen::MatrixXd product = a.transpose() * w.asDiagonal() * b, mean = 0.5 * (a + b);
  return {0.5 * (product + product.transpose()), mean.transpose() * w.asDiagonal() * mean,
          0.5 * (a.transpose() * (w.asDiagonal() * column(left_by_other)) +
                 b.transpose() * (w.asDiagonal() * column(left_by_one)))};
}

/// What is known of the numbers of a view's state, which begin at `at`. Gain and offset are free.
void set_prior(const RefinedView& view, const RefinedViewState& s, Eigen::Index at,
               Eigen::MatrixXd& root, Eigen::VectorXd& center) {
  const auto set = [&](Eigen::Index number, double off, double deviation) {
    root(at + number, at + number) = deviation;
    center[at + number] = deviation > 0 ? -off / deviation : 0;
  };
  double most = 0;
  for (const double v : view.simulated.data()) most = std::max(most, std::abs(v));
  constexpr double free = 10;
  set(gain, 0, free * std::abs(s.gain));
  set(offset, 0, free * std::abs(s.gain) * most);
  set(shift_x, s.shift_x_nm - view.shift_x_nm, view.shift_error_nm);
  set(shift_y, s.shift_y_nm - view.shift_y_nm, view.shift_error_nm);
  set(tilt_x, s.tilt_x_deg, view.tilt_error_deg);
  set(tilt_y, s.tilt_y_deg, view.tilt_error_deg);
  set(bend, s.bend, view.bend_error);
  set(blur, s.blur_nm2, view.blur_error_nm2);
  const auto bumps = static_cast<Eigen::Index>(WideBumps(view).size());
  for (Eigen::Index k = 0; k < bumps; ++k)
    set(state_numbers + k, s.wide.empty() ? 0 : s.wide[static_cast<std::size_t>(k)],
        view.wide_error);
}

RefinedViewState moved_by(RefinedViewState s, const Eigen::VectorXd& by) {
  s.gain += by[gain], s.offset += by[offset];
  s.shift_x_nm += by[shift_x], s.shift_y_nm += by[shift_y];
  s.tilt_x_deg += by[tilt_x], s.tilt_y_deg += by[tilt_y];
  s.bend += by[bend], s.blur_nm2 += by[blur];
  s.wide.resize(static_cast<std::size_t>(by.size() - state_numbers), 0);
  for (std::size_t k = 0; k < s.wide.size(); ++k)
    s.wide[k] += by[state_numbers + static_cast<Eigen::Index>(k)];
  return s;
}

}  // namespace

Grid<double> simulation_error(const RefinedView& view, const RefinedViewState& state,
                              const Grid<double>& simulated) {
  Grid<double> out(view.measured.width(), view.measured.height(), 0);
  const auto add = [&](const Grid<double>& shape, double factor) {
    for (std::size_t p = 0; p < out.size(); ++p) out.data()[p] += factor * shape.data()[p];
  };
  if (state.bend != 0) add(bend_shape(view, simulated), state.gain * state.bend);
  if (state.blur_nm2 != 0) add(blur_shape(view, simulated), state.gain * state.blur_nm2);
  if (state.wide.empty()) return out;
  const WideBumps bumps(view);
  for (std::size_t p = 0; p < out.size(); ++p)
    bumps.at(p, [&](std::size_t bump, double share) { out.data()[p] += share * state.wide[bump]; });
  return out;
}

void fit_gain(const RefinedView& view, RefinedViewState& state) {
  const std::vector<double> weights = weights_of(view);
  const Grid<double>&one = first_of(view), &other = second_of(view);
  const Grid<double> error_of_one = simulation_error(view, state, one),
                     error_of_other = simulation_error(view, state, other);
  double sum = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t p = 0; p < weights.size(); ++p) {
    const double w = weights[p], m = view.measured.data()[p], first = one.data()[p],
                 second = other.data()[p], m_first = m - error_of_one.data()[p],
                 m_second = m - error_of_other.data()[p];
    sum += w, x += 0.5 * w * (first + second), y += 0.5 * w * (m_first + m_second);
    xy += 0.5 * w * (first * m_second + second * m_first);
    xx += w * first * second;
  }
  const double determinant = sum * xx - x * x;
  if (!(determinant > 0))
    throw InvalidInput("image", "the simulated image shows nothing", "Check where the image looks");
  state.gain = (sum * xy - x * y) / determinant;
  state.offset = (y - state.gain * x) / sum;
}

ModeFit fit_modes(const std::vector<RefinedView>& views,
                  const std::vector<RefinedViewState>& states,
                  const std::vector<double>& amplitudes, const std::vector<double>& prior,
                  double damping) {
  const std::size_t modes = amplitudes.size();
  if (prior.size() != modes * modes || states.size() != views.size())
    throw InvalidInput("modes", "their prior or the states of views do not match",
                       "Give one state per view");
  const auto size = static_cast<Eigen::Index>(modes), all = size + numbers_of(views);
  // All unknowns are those of the prior, a standard normal one, times this matrix.
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(all, all);
  Eigen::VectorXd center = Eigen::VectorXd::Zero(all);  // of the prior, in standard deviations
  root.topLeftCorner(size, size) = square(prior, modes).llt().matrixL();
  center.head(size) = root.topLeftCorner(size, size)
                          .triangularView<Eigen::Lower>()
                          .solve(-Eigen::Map<const Eigen::VectorXd>(amplitudes.data(), size));
  Eigen::MatrixXd told = Eigen::MatrixXd::Zero(all, all), seen = told;
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(all);
  ModeFit out;
  Eigen::Index at = size;
  for (std::size_t v = 0; v < views.size(); ++v) {
    check(views[v], modes);
    const ViewEquations own = equations_of(views[v], states[v]);
    const Eigen::Index others = own.told.rows() - size;
    add_view(own.told, size, at, told);
    add_view(own.seen, size, at, seen);
    pull.head(size) += own.pull.head(size);
    pull.segment(at, others) = own.pull.tail(others);
    set_prior(views[v], states[v], at, root, center);
    at += others;
    out.information.emplace_back();
    for (Eigen::Index k = 0; k < size; ++k)
      out.information.back().push_back(std::max(0.0, own.told(k, k)));
  }
  // Directions of their own. What chance is among the effects of each makes it tell less, as more
  // noise of the image would.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(root.transpose() * told * root);
  const Eigen::MatrixXd spread = root * parts.eigenvectors();
  const Eigen::VectorXd held = parts.eigenvectors().transpose() * center;
  const Eigen::VectorXd with_chance = (spread.transpose() * seen * spread).diagonal();
  Eigen::VectorXd to_be_told = spread.transpose() * pull, variances(all);
  for (Eigen::Index k = 0; k < all; ++k) {
    const double real = std::max(0.0, parts.eigenvalues()[k]),
                 share = real > 0 ? std::min(1.0, real / with_chance[k]) : 0;
    variances[k] = 1 / (1 + share * real);
    to_be_told[k] *= share;
  }
  Eigen::VectorXd along(all);  // the step, in these directions
  for (Eigen::Index k = 0; k < all; ++k) {
    const double curvature = 1 / variances[k] + damping, gradient = to_be_told[k] + held[k];
    along[k] = gradient / curvature;
    out.promised += along[k] * along[k] / variances[k] - 2 * along[k] * gradient;
  }
  const Eigen::VectorXd change = spread * along;
  const Eigen::MatrixXd covariance =
      spread.topRows(size) * variances.asDiagonal() * spread.topRows(size).transpose();
  out.amplitudes_nm = amplitudes;
  for (std::size_t k = 0; k < modes; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const double by = change[i];
    out.amplitudes_nm[k] += by;
    out.step = std::max(out.step, std::abs(by) / std::sqrt(prior[k * modes + k]));
    out.move = std::max(out.move, std::abs(by) / std::sqrt(covariance(i, i)));
  }
  out.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  at = size;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const auto others = state_numbers + static_cast<Eigen::Index>(WideBumps(views[v]).size());
    out.views.push_back(moved_by(states[v], change.segment(at, others)));
    at += others;
  }
  return out;
}

double misfit(const std::vector<RefinedView>& views, const std::vector<RefinedViewState>& states,
              const std::vector<double>& amplitudes, const std::vector<double>& prior) {
  const auto size = static_cast<Eigen::Index>(amplitudes.size());
  const Eigen::Map<const Eigen::VectorXd> now(amplitudes.data(), size);
  double sum = now.dot(square(prior, amplitudes.size()).llt().solve(now));
  const auto off_by = [&](double value, double deviation) {
    if (deviation > 0) sum += value * value / (deviation * deviation);
  };
  for (std::size_t v = 0; v < views.size(); ++v) {
    const RefinedView& view = views[v];
    const RefinedViewState& s = states[v];
    const std::vector<double> weights = weights_of(view);
    const Grid<double> first = left_by(first_of(view), view, s),
                       second = left_by(second_of(view), view, s);
    for (std::size_t p = 0; p < weights.size(); ++p)
      sum += weights[p] * first.data()[p] * second.data()[p];
    off_by(s.shift_x_nm - view.shift_x_nm, view.shift_error_nm);
    off_by(s.shift_y_nm - view.shift_y_nm, view.shift_error_nm);
    off_by(s.tilt_x_deg, view.tilt_error_deg);
    off_by(s.tilt_y_deg, view.tilt_error_deg);
    off_by(s.bend, view.bend_error);
    off_by(s.blur_nm2, view.blur_error_nm2);
    for (const double w : s.wide) off_by(w, view.wide_error);
  }
  return sum;
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
