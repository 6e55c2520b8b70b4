// SPDX-License-Identifier: GPL-3.0-or-later
#include "drawn_scene.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "afm/normal_numbers.h"
#include "reconstruction/discrepancy.h"
#include "surf/afm/tip_shapes.h"

namespace surf::bench {
namespace {

using namespace reconstruction;

constexpr double pitch_nm = 10;
constexpr int ground_px = 44;  // ground around the SEM image: the scan's corners and the tip
constexpr int scan_px = 20;    // the scan around the SEM image
constexpr int reconstruction_margin_px = 12;  // samples that a fit has around the SEM image
constexpr double tip_radius_nm = 20, tip_half_angle_rad = 0.35;
constexpr double se_gain = 900, other_gain = 300, given_offset = 120;

/// Uniform and normal numbers of one seed.
struct Dice {
  NormalNumbers normal;
  RandomStream random;
  explicit Dice(std::uint64_t seed) : normal(seed, 11), random(seed, 12, 0) {}
  double within(double low, double high) { return low + (high - low) * random.uniform(); }
};

struct Relief {
  std::vector<std::array<double, 4>> waves;  // amplitude, wave vector, phase
  explicit Relief(Dice& dice) {
    for (int k = 0; k < 8; ++k) {
      const double turn = dice.within(0, std::numbers::pi),
                   number = 2 * std::numbers::pi / dice.within(150, 500);
      waves.push_back({0.6 * dice.normal(), number * std::cos(turn), number * std::sin(turn),
                       dice.within(0, 2 * std::numbers::pi)});
    }
  }
  double operator()(Point2 p) const {
    double z = 0;
    for (const auto& w : waves) z += w[0] * std::cos(w[1] * p.x + w[2] * p.y + w[3]);
    return z;
  }
};

Block draw_block(Dice& dice, Point2 middle, double least_half_nm, double most_half_nm) {
  Block b;
  b.middle = middle;
  b.half_u_nm = dice.within(least_half_nm, most_half_nm);
  b.half_v_nm = dice.within(least_half_nm, most_half_nm);
  b.turn_rad = dice.within(-0.5, 0.5);
  b.height_nm = dice.within(15, 60);
  b.wall_nm = dice.within(8, 25);
  return b;
}

std::vector<Block> draw_blocks(Dice& dice, const SceneOptions& options, DrawnScene& scene) {
  if (!options.features) {
    scene.plateau = draw_block(dice, {dice.within(-15, 15), dice.within(-15, 15)}, 35, 50);
    return {scene.plateau};
  }
  scene.plateau = draw_block(dice, {dice.within(-210, -130), dice.within(-120, 120)}, 50, 90);
  scene.line = draw_block(dice, {dice.within(100, 170), 0}, 30, 80);
  scene.line.half_v_nm = 1e4;
  scene.line.turn_rad = dice.within(-0.2, 0.2);
  std::vector<Block> blocks{scene.plateau, scene.line};
  for (int k = 0; k < 60 && blocks.size() < 8; ++k) {
    const Block b = draw_block(dice, {dice.within(-650, 650), dice.within(-570, 570)}, 20, 60);
    const double reach = std::hypot(b.half_u_nm, b.half_v_nm) + 40;
    const Point2 from_line = scene.line.within(b.middle);
    if (std::abs(from_line.x) < scene.line.half_u_nm + reach) continue;
    const double apart =
        std::hypot(b.middle.x - scene.plateau.middle.x, b.middle.y - scene.plateau.middle.y);
    if (apart < reach + std::hypot(scene.plateau.half_u_nm, scene.plateau.half_v_nm)) continue;
    blocks.push_back(b);
  }
  return blocks;
}

SurfaceFrame frame_around(int width, int height, int margin) {
  const int w = width + 2 * margin, h = height + 2 * margin;
  return {w, h, pitch_nm, -0.5 * (w - 1) * pitch_nm, -0.5 * (h - 1) * pitch_nm};
}

void make_scan(DrawnScene& scene, const SceneOptions& options, const SurfaceFrame& ground,
               const Grid<double>& z, std::uint64_t seed) {
  const int w = options.width + 2 * scan_px, h = options.height + 2 * scan_px;
  AfmData& afm = scene.afm;
  afm.image = frame_around(w, h, 0).field(Grid<double>(w, h));
  const int side = 2 * options.tip_half_px + 1;
  afm.tip = conical_tip(tip_radius_nm, tip_half_angle_rad, {pitch_nm, pitch_nm, side, side});
  afm.noise = {0.825, 0.201};
  const AfmTerm term(afm, afm.image, ground, scene.true_map, 1);
  if (term.used_pixels() != static_cast<std::int64_t>(w) * h)
    throw std::logic_error("the ground does not cover the scan");
  afm.image.z_nm = term.evaluate(z, scene.true_map, scene.true_tip).simulated;
  const Grid<double> noise = simulate_noise(afm.noise, w, h, seed);
  for (std::size_t i = 0; i < noise.size(); ++i) afm.image.z_nm.data()[i] += noise.data()[i];
}

void make_sem(DrawnScene& scene, const SceneOptions& options, const SurfaceFrame& ground,
              const Grid<double>& z, std::uint64_t seed, Dice& dice) {
  SemData& sem = scene.sem;
  const std::size_t channels = sem.model->channels().size();
  sem.gains.assign(channels, other_gain);
  sem.gains[0] = se_gain;
  sem.offset = given_offset;
  sem.noise = {6, -6 * given_offset, 100};
  ModelOptions one_thread;
  one_thread.threads = 1;
  const ModelImages made = sem.model->predict(ground.field(z), one_thread);
  const SurfaceFrame frame = frame_around(options.width, options.height, 0);
  sem.image.placement() = frame.field({}).placement();
  Grid<double> clean(options.width, options.height, scene.true_offset);
  for (std::size_t c = 0; c < channels; ++c) {
    const Grid<double> seen = cut_out(made[c], ground_px, ground_px, options.width, options.height);
    for (std::size_t i = 0; i < clean.size(); ++i)
      clean.data()[i] += scene.true_gain_factor * sem.gains[c] * seen.data()[i];
  }
  sem.image.values = clean;
  if (options.discrepancy_share > 0) {
    const Discrepancy drawn(usual_discrepancy(sem.image, options.discrepancy_share));
    const Grid<double> off =
        drawn.factor(Grid<double>(options.width, options.height, 1.0))->draw(seed, 21);
    for (std::size_t i = 0; i < off.size(); ++i) sem.image.values.data()[i] += off.data()[i];
  }
  for (std::size_t i = 0; i < clean.size(); ++i)
    sem.image.values.data()[i] += std::sqrt(sem.noise.variance(clean.data()[i])) * dice.normal();
  sem.discrepancy = usual_discrepancy(sem.image, options.discrepancy_share);
}

class LastState : public ReconstructionJournal {
 public:
  std::optional<ReconstructionState> found() override { return first; }
  void keep(const ReconstructionState& state) override { last = state; }
  std::optional<ReconstructionState> first;
  ReconstructionState last;
};

/// As if the first of the two scales had ended there.
ReconstructionState state_of_truth(const DrawnScene& scene) {
  const HeightField& truth = scene.truth;
  const SurfaceFrame frame =
      frame_around(truth.z_nm.width(), truth.z_nm.height(), reconstruction_margin_px);
  const int left = ground_px - reconstruction_margin_px;
  ReconstructionState s;
  s.surface = frame.field(cut_out(scene.ground.z_nm, left, left, frame.width, frame.height));
  s.sem_to_afm = scene.true_map;
  s.gains = scene.sem.gains;
  s.offset = scene.true_offset;
  s.scales = {ScaleReport()};
  for (double& g : s.gains) g *= scene.true_gain_factor;
  s.scales.front().curvature_prior_per_nm = 1e-3;
  s.tip_change.assign(scene.true_tip.begin(), scene.true_tip.end());
  return s;
}

}  // namespace

Point2 Block::within(Point2 p) const {
  const double c = std::cos(turn_rad), s = std::sin(turn_rad), x = p.x - middle.x,
               y = p.y - middle.y;
  return {c * x + s * y, -s * x + c * y};
}

double Block::height_at(Point2 p) const {
  const Point2 q = within(p);
  const auto between = [&](double at, double half) {
    const double scale = std::numbers::sqrt2 * wall_nm;
    return 0.5 * (std::erf((at + half) / scale) - std::erf((at - half) / scale));
  };
  return height_nm * between(q.x, half_u_nm) * between(q.y, half_v_nm);
}

DrawnScene draw_scene(const std::shared_ptr<const ImageModel>& model, std::uint64_t seed,
                      const SceneOptions& options) {
  DrawnScene scene;
  Dice dice(seed);
  const Relief relief(dice);
  const std::vector<Block> blocks = draw_blocks(dice, options, scene);
  const SurfaceFrame ground = frame_around(options.width, options.height, ground_px);
  Grid<double> z(ground.width, ground.height);
  for (int y = 0; y < ground.height; ++y)
    for (int x = 0; x < ground.width; ++x) {
      const Point2 p{ground.origin_x_nm + x * pitch_nm, ground.origin_y_nm + y * pitch_nm};
      z(x, y) = relief(p);
      for (const Block& b : blocks) z(x, y) += b.height_at(p);
    }
  scene.ground = ground.field(z);
  scene.truth = frame_around(options.width, options.height, 0)
                    .field(cut_out(z, ground_px, ground_px, options.width, options.height));

  AffineParts map;
  map.rotation_rad = dice.within(-0.2, 0.2);
  scene.sem.sem_to_afm = make_affine(map);
  map.rotation_rad += 0.004 * dice.normal();
  map.scale_x += 0.006 * dice.normal();
  map.scale_y += 0.006 * dice.normal();
  map.shear += 0.006 * dice.normal();
  map.shift_x_nm += 4 * dice.normal();
  map.shift_y_nm += 4 * dice.normal();
  scene.true_map = make_affine(map);
  for (double& t : scene.true_tip) t = dice.normal() / 3;
  scene.true_gain_factor = std::exp(0.05 * dice.normal());
  scene.true_offset = given_offset + 20 * dice.normal();

  scene.sem.model = model;
  make_scan(scene, options, ground, z, seed);
  make_sem(scene, options, ground, z, seed, dice);
  return scene;
}

Fitted fit_scene(const DrawnScene& scene, Start start, bool uncertainty, int margin_px) {
  ReconstructionOptions options;
  options.refine_tip = true;
  options.uncertainty = uncertainty;
  options.threads = 1;
  LastState journal;
  if (start == Start::truth) journal.first = state_of_truth(scene);
  Reconstruction result = reconstruct(&scene.afm, &scene.sem, options, &journal);
  const ReconstructionState& last = journal.last;
  const int had = (last.surface.z_nm.width() - scene.truth.z_nm.width()) / 2;
  const int margin = margin_px < 0 ? had : margin_px;
  Objective o{.prior = CurvaturePrior(pitch_nm, last.scales.back().curvature_prior_per_nm),
              .frame = frame_of(&scene.afm, &scene.sem, margin)};
  o.fit_map = o.fit_mixture = true;
  o.afm.emplace(scene.afm, eroded(scene.afm, 1), o.frame, scene.sem.sem_to_afm, 1);
  o.sem.emplace(scene.sem, o.frame, margin, margin, 1);
  o.fit_tip = true;
  Unknowns at{cut_out(last.surface.z_nm, had - margin, had - margin, o.frame.width, o.frame.height),
              last.sem_to_afm,
              {last.gains, last.offset}};
  std::copy_n(last.tip_change.begin(), tip_numbers, at.tip.begin());
  AfmData now = scene.afm;
  now.tip = o.afm->tip(at.tip);
  o.afm->set_outside(eroded(now, 1));
  return {std::move(result), std::move(o), std::move(at), margin};
}

}  // namespace surf::bench
