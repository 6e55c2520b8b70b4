// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/profile/fit_profile.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "afm/normal_numbers.h"
#include "profile/library_of.h"
#include "surf/core/error.h"

namespace surf {
namespace {

/// A bright rim at a wall, which is wider the shallower and rounder the wall is.
double signal(double u, const ProfileNumbers& n) {
  const double width = 3 + 0.5 * (90 - n[profile_angle]) + 0.3 * n[profile_top],
               middle = 1 + 0.2 * n[profile_top];
  const double rim = std::exp(-0.5 * std::pow((u - middle) / width, 2)),
               step = 0.5 * (1 + std::erf(u / 4)),
               shadow = std::exp(-0.5 * std::pow((u + 6 + n[profile_foot]) / 4, 2));
  return 0.8 + 0.2 * step + 1.2 * rim - 0.15 * shadow;
}

const ProfileBox box{{80, 100, 86, 4, 3}, {6, 0, 2, 2, 2}};
const ProfileNumbers truth{80, 100, 86.6, 3.2, 3.5};

ProfileLibrary library() { return test::library_of(box, -35, 35, signal); }

struct Made {
  PlacedImage image;
  double width_nm = 0;  // the mean of its rows
};

/// What other physics might make of the signal, u nm from a wall: a function of chance over 4 nm,
/// and one over 40 nm.
class OtherPhysics {
 public:
  OtherPhysics(double deviation, std::uint64_t seed) {
    NormalNumbers normal(seed, 21);
    for (double& v : near_) v = deviation * normal();
    for (double& v : far_) v = deviation * normal();
  }
  double operator()(double u) const { return between(near_, u / 4) + between(far_, u / 40); }

 private:
  static double between(const std::array<double, 24>& values, double place) {
    const double shifted = place + 12, before = std::floor(shifted), share = shifted - before;
    const auto k = static_cast<std::size_t>(before);
    return (1 - share) * values[k] + share * values[k + 1];
  }
  std::array<double, 24> near_{}, far_{};
};

/// Two lines with rough edges.
Made lines(std::uint64_t seed, double sigma, double noise, const OtherPhysics& other = {0, 1}) {
  constexpr int columns = 90, rows = 96;
  constexpr double pixel = 4;
  Made made;
  made.image.pitch_x_nm = made.image.pitch_y_nm = pixel;
  made.image.values = Grid<double>(columns, rows);
  NormalNumbers normal(seed, 9);
  double displaced[4];
  for (double& d : displaced) d = sigma * normal();
  for (int y = 0; y < rows; ++y) {
    for (double& d : displaced) d = 0.9 * d + sigma * std::sqrt(1 - 0.81) * normal();
    const double edges[4] = {51 + displaced[0], 131 + displaced[1], 221 + displaced[2],
                             301 + displaced[3]};
    made.width_nm += 0.5 * (edges[1] - edges[0] + edges[3] - edges[2]) / rows;
    for (int x = 0; x < columns; ++x) {
      const double at = x * pixel;
      const int e = at < 91 ? 0 : at < 176 ? 1 : at < 261 ? 2 : 3;
      const double u = (e % 2 == 0 ? 1 : -1) * (at - edges[e]);
      const double near = std::clamp(u, -35.0, 35.0),
                   level = 100 * (signal(near, truth) + other(near)) + 20;
      made.image.values(x, y) = level + noise * std::sqrt(level / 100) * normal();
    }
  }
  return made;
}

ProfileFitOptions usual() {
  ProfileFitOptions o;
  constexpr double unknown = std::numeric_limits<double>::infinity();
  o.prior_mean = box.middle;
  o.prior_deviation = {unknown, 0, unknown, 2, 2};
  o.model_error = 0.002;
  return o;
}

ProfileFit fit(const PlacedImage& image, const ProfileFitOptions& options) {
  static const ProfileLibrary known = library();
  return fit_profile(profile_data(image, find_edges(image, FeatureKind::line).edges), known,
                     options);
}

TEST(FitProfile, FindsShapeWidthAndRoughnessWithinItsErrors) {
  constexpr int trials = 8;
  int width_in = 0, angle_in = 0;
  double width2 = 0, sigma = 0;
  for (std::uint64_t seed = 1; seed <= trials; ++seed) {
    const Made made = lines(seed, 1.2, 12);
    const ProfileFit f = fit(made.image, usual());
    EXPECT_TRUE(f.converged);
    ASSERT_EQ(f.edges().size(), 4u);
    const Measured width = f.left[profile_width], angle = f.left[profile_angle];
    width2 += std::pow(width.value - made.width_nm, 2) / trials;
    width_in += std::abs(width.value - made.width_nm) <= 2 * width.standard_error + 0.02;
    angle_in += std::abs(angle.value - truth[profile_angle]) <= 2 * angle.standard_error + 0.02;
    sigma += f.edge_roughness.sigma_nm / trials;
    EXPECT_LT(width.standard_error, 0.8);  // where the wall is depends on its corners
    EXPECT_NEAR(f.sights.front().gain, 100, 4);
  }
  EXPECT_LT(std::sqrt(width2), 0.6);
  EXPECT_GE(width_in, 6);
  EXPECT_GE(angle_in, 6);
  EXPECT_NEAR(sigma, 1.2, 0.15);
}

TEST(FitProfile, LeftAndRightWallsMayDiffer) {
  ProfileFitOptions o = usual();
  o.walls_alike = false;
  const ProfileFit f = fit(lines(3, 0, 8).image, o);
  EXPECT_NE(f.left[profile_angle].value, f.right[profile_angle].value);
  for (const auto& wall : {f.left, f.right})
    EXPECT_NEAR(wall[profile_angle].value, truth[profile_angle],
                std::min(1.0, 3 * wall[profile_angle].standard_error));
  EXPECT_EQ(f.sights.front().profiles.size(), 2u);
}

TEST(FitProfile, ChanceInTheLibraryIsNoInformation) {
  // Noise of 0.8 % in each place of the middle profile, which all shapes and rows share.
  constexpr double noise = 0.008;
  const Made made = lines(6, 1.2, 6);
  const std::vector<ImageEdge> edges = find_edges(made.image, FeatureKind::line).edges;
  const auto shapes = profile_design(box);
  std::vector<std::vector<double>> signals;
  for (const ProfileNumbers& n : shapes) {
    signals.emplace_back();
    for (int k = 0; k <= 140; ++k) signals.back().push_back(signal(-35 + 0.5 * k, n));
  }
  ProfileFitOptions o = usual();
  o.model_error = 0.05;
  double z2 = 0;
  constexpr int trials = 6;
  for (std::uint64_t seed = 1; seed <= trials; ++seed) {
    NormalNumbers normal(seed, 4);
    FinerMiddle middle;
    for (const double v : signals.front()) {
      middle.signal.push_back(v + noise * normal());
      middle.variance.push_back(noise * noise);
    }
    const ProfileFit f =
        fit_profile(profile_data(made.image, edges), {box, -35, 0.5, shapes, signals, middle}, o);
    const Measured width = f.left[profile_width];
    z2 += std::pow((width.value - made.width_nm) / width.standard_error, 2) / trials;
  }
  EXPECT_LT(std::sqrt(z2), 1.6);
}

TEST(FitProfile, RowsThatDoNotShowTheWallAreLeftOut) {
  Made made = lines(5, 1.2, 12);
  const ProfileFit whole = fit(made.image, usual());
  const std::vector<ImageEdge> edges = find_edges(made.image, FeatureKind::line).edges;
  made.image.valid = Mask(90, 96, 1);
  for (int y = 40; y < 48; ++y)
    for (int x = 0; x < 90; ++x)  // in two rows a piece of level ground is left
      made.image.valid(x, y) = y < 42 && x == 20;
  const ProfileLibrary known = library();
  const ProfileFit part = fit_profile(profile_data(made.image, edges), known, usual());
  EXPECT_TRUE(std::isnan(part.edges()[0].errors_nm[44]));
  EXPECT_TRUE(std::isnan(part.edges()[1].errors_nm[41]));
  EXPECT_LT(part.edges()[0].errors_nm[30], 3);
  EXPECT_NEAR(part.left[profile_width].value, whole.left[profile_width].value, 0.5);
  EXPECT_NEAR(part.edge_roughness.sigma_nm, whole.edge_roughness.sigma_nm, 0.3);
}

TEST(FitProfile, AWidthBeyondTheLibraryIsSaid) {
  EXPECT_FALSE(fit(lines(4, 0, 8).image, usual()).at_border);
  ProfileBox narrow = box;
  narrow.middle[profile_width] = 60;
  const auto shapes = profile_design(narrow);
  std::vector<std::vector<double>> signals;
  for (const ProfileNumbers& n : shapes) {
    signals.emplace_back();
    for (int k = 0; k <= 140; ++k) signals.back().push_back(signal(-35 + 0.5 * k, n));
  }
  const PlacedImage image = lines(4, 0, 8).image;
  EXPECT_TRUE(fit_profile(profile_data(image, find_edges(image, FeatureKind::line).edges),
                          {narrow, -35, 0.5, shapes, signals}, usual())
                  .at_border);
}

TEST(FitProfile, AWrongModelIsToldByWhatItIsOffBy) {
  Made made = lines(4, 0, 8);
  const double right = fit(made.image, usual()).sights.front().discrepancy_share;
  ProfileFitOptions o = usual();
  o.model_error = 0.05;
  for (int y = 0; y < made.image.values.height(); ++y)
    for (int x = 0; x < made.image.values.width(); ++x) {
      const double at = 4 * x, near = std::min(std::abs(at - 65), std::abs(at - 117));
      made.image.values(x, y) += 40 * std::exp(-0.5 * near * near / 9);
    }
  EXPECT_GT(fit(made.image, o).sights.front().discrepancy_share, 5 * right + 0.01);
}

// That the simulation is right shows: then it hardly matters how far off it might have been.
TEST(FitProfile, HowFarTheSimulationIsOffIsMeasured) {
  const auto errors = [](const PlacedImage& image, double model_error) {
    ProfileFitOptions o = usual();
    o.model_error = model_error;
    const ProfileFit f = fit(image, o);
    return std::array{f.left[profile_width].standard_error, f.left[profile_angle].standard_error};
  };
  const PlacedImage same = lines(2, 1.2, 4).image,
                    other = lines(2, 1.2, 4, OtherPhysics(0.1, 3)).image;
  const auto right = errors(same, 0.01), might_be_off = errors(same, 0.08),
             off = errors(other, 0.08);
  for (std::size_t k = 0; k < right.size(); ++k) {
    EXPECT_LT(might_be_off[k], 1.3 * right[k]);
    EXPECT_GT(off[k], 1.2 * might_be_off[k]);
  }
}

TEST(FitProfile, IntervalsHoldWhereTheSimulationIsOff) {
  constexpr int trials = 12;
  double width2 = 0, angle2 = 0;
  for (std::uint64_t seed = 1; seed <= trials; ++seed) {
    // 4 % of the contrast.
    const Made made = lines(seed, 1.2, 4, OtherPhysics(0.05, 40 + seed));
    ProfileFitOptions o = usual();
    o.model_error = 0.08;
    const ProfileFit f = fit(made.image, o);
    const Measured width = f.left[profile_width], angle = f.left[profile_angle];
    width2 += std::pow((width.value - made.width_nm) / width.standard_error, 2) / trials;
    angle2 += std::pow((angle.value - truth[profile_angle]) / angle.standard_error, 2) / trials;
  }
  // Of chi-squared with 12 degrees of freedom, over 12, 0.1 % lie above 2.74.
  EXPECT_LT(width2, 2.74);
  EXPECT_LT(angle2, 2.74);
}

/// A bright flank, as wide as the beam sees it, which grows with the height and with the angle
/// between beam and wall.
double flank_signal(double u, const ProfileNumbers& n, double tilt_deg) {
  constexpr double degree = 3.14159265358979 / 180;
  const double half = 0.5 * n[profile_height] / std::tan((n[profile_angle] - tilt_deg) * degree);
  const auto step = [](double x) { return 0.5 * (1 + std::erf(x / 3)); };
  return 0.8 + 0.2 * step(u) + 1.1 * step(u + half) * step(half + 2 - u);
}

/// Images of a line 100 nm high: from above, and by a beam tilted to +x by 4 degrees, of which 3.8
/// are said. That its left wall looks wider then and its right one narrower tells how high it is.
struct TiltedScene {
  static constexpr double tilt_deg = 4, said_deg = 3.8, pixel_nm = 2;
  ProfileBox open{{80, 106, 84.5, 4, 3}, {6, 12, 1.5, 0, 0}};
  ProfileNumbers real{80, 100, 84, 4, 3};
  ProfileLibrary up = library_at(0), left = library_at(said_deg), right = library_at(-said_deg);
  ProfileFitOptions options = usual();

  TiltedScene() {
    constexpr double unknown = std::numeric_limits<double>::infinity();
    options.prior_mean = open.middle;
    options.prior_deviation = {unknown, 12, unknown, 0, 0};
  }

  ProfileLibrary library_at(double tilted_deg) const {
    const auto shapes = profile_design(open);
    std::vector<std::vector<double>> signals;
    for (const ProfileNumbers& n : shapes) {
      signals.emplace_back();
      for (int k = 0; k <= 140; ++k)
        signals.back().push_back(flank_signal(-35 + 0.5 * k, n, tilted_deg));
    }
    return {open, -35, 0.5, shapes, signals};
  }

  PlacedImage image_at(double tilted_deg, std::uint64_t seed) const {
    PlacedImage image;
    image.pitch_x_nm = image.pitch_y_nm = pixel_nm;
    image.values = Grid<double>(90, 128);
    NormalNumbers normal(seed, 9);
    for (int y = 0; y < 128; ++y)
      for (int x = 0; x < 90; ++x) {
        const double at = x * pixel_nm - 91.3, u = 0.5 * real[profile_width] - std::abs(at);
        image.values(x, y) = 100 * flank_signal(std::clamp(u, -35.0, 35.0), real,
                                                at < 0 ? tilted_deg : -tilted_deg) +
                             20 + 8 * normal();
      }
    return image;
  }

  ProfileSight above() const {
    const PlacedImage image = image_at(0, 1);
    return {profile_data(image, find_edges(image, FeatureKind::line).edges), &up, &up};
  }
  /// `brighter`: what the left wall's foot is brighter by than simulated.
  ProfileSight aside(std::uint64_t seed, double brighter = 0) const {
    PlacedImage image = image_at(tilt_deg, seed);
    const std::vector<ImageEdge> edges = find_edges(image, FeatureKind::line).edges;
    for (int y = 0; y < image.values.height(); ++y)
      for (int x = 0; x < image.values.width(); ++x) {
        const double beside = x * pixel_nm - 91.3 + 0.5 * real[profile_width] + 18;
        image.values(x, y) += brighter * std::exp(-0.5 * beside * beside / 25);
      }
    return {profile_data(image, edges), &left, &right, said_deg, 0, 0.3};
  }
};

TEST(FitProfile, ATiltedImageTellsTheHeightAndItsTiltIsFitted) {
  const TiltedScene scene;
  const ProfileSight above = scene.above(), aside = scene.aside(2);
  const ProfileFit one = fit_profile({above}, scene.options),
                   two = fit_profile({above, aside}, scene.options);
  const Measured height = two.left[profile_height], tilted = two.sights[1].tilt_deg;
  EXPECT_LT(height.standard_error, 0.7 * one.left[profile_height].standard_error);
  EXPECT_NEAR(height.value, 100, 3 * height.standard_error);
  EXPECT_NEAR(tilted.value, TiltedScene::tilt_deg, 3 * tilted.standard_error);
  EXPECT_LT(tilted.standard_error, 0.3001);
  // A flank is no quadratic function of its numbers.
  EXPECT_NEAR(two.left[profile_width].value, 80, 3 * two.left[profile_width].standard_error + 0.1);
  EXPECT_NEAR(two.left[profile_angle].value, 84, 3 * two.left[profile_angle].standard_error);
  EXPECT_EQ(two.sights[1].edges.size(), 2u);
  EXPECT_EQ(one.sights[0].tilt_deg.standard_error, 0);
}

/// The ground is darker the higher the wall beside it is.
double shaded_signal(double u, const ProfileNumbers& n) {
  return flank_signal(u, n, 0) - 0.006 * n[profile_height] * std::exp(-std::abs(u + 10) / 12);
}

// Another physics shades the ground as a lower wall would. The tilted image tells how high it is.
TEST(FitProfile, ShadingAloneTellsHeightsOnlyRoughly) {
  TiltedScene scene;
  const ProfileLibrary shaded = test::library_of(scene.open, -35, 35, shaded_signal);
  ProfileSight shading = scene.above();
  shading.left = shading.right = &shaded;
  shading.signal = 1;
  shading.shows_shading_alone = true;
  const PlacedImage tilted = scene.image_at(TiltedScene::said_deg, 2);
  const ProfileSight aside{profile_data(tilted, find_edges(tilted, FeatureKind::line).edges),
                           &scene.left, &scene.right, TiltedScene::said_deg};
  ProfileNumbers lower = scene.real;
  lower[profile_height] = 90;
  NormalNumbers normal(4, 9);
  for (ProfileSample& s : shading.data.samples) {
    const double u = 0.5 * scene.real[profile_width] - std::abs(s.x_nm - 91.3);
    s.value += 100 * (shaded_signal(u, lower) - flank_signal(u, lower, 0)) + normal();
  }
  const auto height = [&](double doubt_nm) {
    scene.options.shading_doubt_nm = doubt_nm;
    const ProfileFit f = fit_profile({scene.above(), shading, aside}, scene.options);
    EXPECT_TRUE(f.converged);
    return f.left[profile_height];
  };
  const Measured believed = height(0), doubted = height(20);
  EXPECT_LT(believed.value, 100 - 3 * believed.standard_error);
  EXPECT_NEAR(doubted.value, 100, 2 * doubted.standard_error);
  EXPECT_LT(doubted.standard_error, 5);
}

TEST(FitProfile, ImagesOfOneFeatureShareItsWidth) {
  TiltedScene scene;
  scene.options.model_error = 0.5;
  ProfileSight aside = scene.aside(2);
  NormalNumbers normal(3, 1);
  for (ProfileSample& sample : aside.data.samples) {
    sample.x_nm += 0.03 * (sample.x_nm - 91.3);
    sample.value += 200 * normal();
  }
  const auto found = [&](bool one) {
    scene.options.one_feature = one;
    const ProfileFit f = fit_profile({scene.above(), aside}, scene.options);
    std::vector<double> widths;
    for (const SightFit& sight : f.sights)
      widths.push_back(sight.edges[1].place_nm.value - sight.edges[0].place_nm.value);
    return std::pair(f.left[profile_width].standard_error, widths[1] - widths[0]);
  };
  const auto [error_apart, apart_nm] = found(false);
  const auto [error, shared_nm] = found(true);
  EXPECT_LT(std::abs(shared_nm), 0.5 * std::abs(apart_nm));
  EXPECT_LT(error, 0.9 * error_apart);
}

// A scan tells the height better than images do, which pull at it by what physics they leave out.
TEST(FitProfile, AHeldHeightStaysAndItsErrorEntersTheOthers) {
  TiltedScene scene;
  scene.options.hold_height = true;
  const auto found = [&](double height_nm, double error_nm) {
    scene.options.prior_mean[profile_height] = height_nm;
    scene.options.prior_deviation[profile_height] = error_nm;
    return fit_profile({scene.above(), scene.aside(2)}, scene.options).left;
  };
  const auto surely = found(98, 1e-3), higher = found(98.5, 1e-3), roughly = found(98, 1.5);
  EXPECT_EQ(roughly[profile_height].value, 98);
  EXPECT_NEAR(roughly[profile_height].standard_error, 1.5, 1e-9);
  const double angle_per_nm = (higher[profile_angle].value - surely[profile_angle].value) / 0.5;
  EXPECT_NEAR(roughly[profile_angle].value, surely[profile_angle].value, 1e-3);
  EXPECT_NEAR(roughly[profile_angle].standard_error,
              std::hypot(surely[profile_angle].standard_error, 1.5 * angle_per_nm),
              0.1 * roughly[profile_angle].standard_error);
  EXPECT_GT(1.5 * std::abs(angle_per_nm), surely[profile_angle].standard_error);
}

// What the simulation is off by at flanks would be taken for another height, and not show.
TEST(FitProfile, WhereHeightsAreFoundTheWholeErrorOfTheSimulationCounts) {
  TiltedScene scene;
  scene.options.model_error = 0.02;
  const auto error = [&] {
    return fit_profile({scene.above(), scene.aside(2)}, scene.options)
        .left[profile_width]
        .standard_error;
  };
  const double found = error();
  scene.options.prior_mean[profile_height] = 100;
  scene.options.prior_deviation[profile_height] = 4.9;  // known
  EXPECT_GT(found, 1.4 * error());
}

// Two images that look alike are no two measurements of what the simulation is off by.
TEST(FitProfile, TheSimulationIsOffByTheSameInImagesThatLookAlike) {
  TiltedScene scene;
  scene.options.model_error = 0.05;
  ProfileSight first = scene.aside(2), second = scene.aside(3);
  first.tilt_error_deg = second.tilt_error_deg = 0;
  ProfileSight own = second;
  own.signal = 1;
  const auto error = [&](const std::vector<ProfileSight>& sights) {
    return fit_profile(sights, scene.options).left[profile_angle].standard_error;
  };
  const double one = error({first}), shared = error({first, second}), apart = error({first, own});
  EXPECT_LT(apart, 0.75 * one);
  EXPECT_GT(shared, 1.1 * apart);
}

// The wall that faces the beam and the one that does not are simulated each with its own error.
TEST(FitProfile, TheSimulationMayBeOffAtOneSideOfATiltedImage) {
  TiltedScene scene;
  scene.options.model_error = 0.08;
  const ProfileFit f = fit_profile({scene.above(), scene.aside(2, 25)}, scene.options);
  for (const MeanProfile& side : f.sights[1].profiles)
    for (std::size_t i = 0; i < side.u_nm.size(); ++i)
      if (std::abs(side.u_nm[i] + 18) < 8)
        EXPECT_NEAR(side.measured[i], side.fitted[i], 5) << side.material_right << side.u_nm[i];
  EXPECT_NEAR(f.left[profile_height].value, 100, 3 * f.left[profile_height].standard_error);
}

TEST(FitProfile, ANumberWithoutEffectDoesNotSpoilTheOthers) {
  const auto shapes = profile_design(box);
  std::vector<std::vector<double>> signals;
  for (ProfileNumbers n : shapes) {
    n[profile_angle] = truth[profile_angle];
    signals.emplace_back();
    for (int k = 0; k <= 140; ++k) signals.back().push_back(signal(-35 + 0.5 * k, n));
  }
  const Made made = lines(7, 1.2, 12);
  const ProfileFit f =
      fit_profile(profile_data(made.image, find_edges(made.image, FeatureKind::line).edges),
                  {box, -35, 0.5, shapes, signals}, usual());
  EXPECT_TRUE(std::isfinite(f.left[profile_angle].value));
  EXPECT_NEAR(f.left[profile_width].value, made.width_nm, 1);
}

TEST(FitProfile, RefusesAnEdgeWithoutPixels) {
  ProfileData data = profile_data(lines(1, 0, 8).image, {{0, true, 51, 0, 91}});
  data.samples.resize(10);
  const ProfileLibrary known = library();
  EXPECT_THROW(fit_profile(data, known, usual()), InvalidInput);
}

}  // namespace
}  // namespace surf
