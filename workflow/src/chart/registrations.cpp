// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>

#include "chain_methods.h"
#include "surf/core/random.h"
#include "surf/registration/landmarks.h"
#include "surf/registration/register_images.h"

namespace surf::workflow {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double degree = std::numbers::pi / 180;
constexpr double part = 0.85;                  // share of the image's sides in a draw
constexpr double captured = 0.9;               // share of the draws
constexpr std::uint64_t draw_stream = 0x9e57;  // separate from all other uses of the seed

enum class Way { correlation, mutual_information, search, landmarks, landmarks_only };

// Two independent standard normal numbers (Box and Muller).
Point2 normal_pair(RandomStream& random) {
  const double r = std::sqrt(-2 * std::log(random.uniform())),
               angle = 2 * std::numbers::pi * random.uniform();
  return {r * std::cos(angle), r * std::sin(angle)};
}

PlacedImage part_of(const PlacedImage& image, int x0, int y0, int width, int height) {
  PlacedImage out = image;
  out.values = Grid<double>(width, height);
  if (!image.valid.empty()) out.valid = Mask(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      out.values(x, y) = image.values(x0 + x, y0 + y);
      if (!image.valid.empty()) out.valid(x, y) = image.valid(x0 + x, y0 + y);
    }
  const Point2 first = image.place_nm(x0, y0);
  out.origin_x_nm = first.x;
  out.origin_y_nm = first.y;
  return out;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

// Returns the map if it is verified.
std::optional<Affine> registered(Way way, const ChainSetting& setting, const RegistrationDraw& draw,
                                 const Watch& watch) {
  RegistrationOptions options;
  options.threads = setting.job.threads;
  options.watch = watch;
  if (way == Way::mutual_information) options.objective = RegistrationObjective::mutual_information;
  if (way == Way::landmarks || way == Way::landmarks_only) {
    std::vector<LandmarkPair> pairs;
    for (const auto& [sem, afm] : draw.pairs) pairs.push_back({sem, afm});
    options.start = fit_landmarks(pairs).sem_to_afm;
    if (way == Way::landmarks_only) return options.start;
  } else if (way != Way::search) {
    options.start = draw.start;
  }
  const Registration r = register_images(draw.sem, setting.simulated, options);
  if (r.verdict != RegistrationVerdict::verified) return std::nullopt;
  return r.sem_to_afm;
}

void measure(Way way, const ChainSetting& setting, const Watch& watch, RegistrationPoint& point) {
  std::vector<double> errors, times;
  point.draws = setting.job.draws;
  for (int i = 0; i < point.draws; ++i) {
    const RegistrationDraw draw =
        draw_registration(setting.sample, point.offset_px, point.offset_deg, setting.job.seed, i);
    const auto begin = Clock::now();
    const auto map = registered(way, setting, draw,
                                watch.part(double(i) / point.draws, double(i + 1) / point.draws));
    times.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
    if (!map) continue;
    const double off =
        registration_error_px(setting.sample.sem.sem_to_afm, *map, draw.sem, setting.simulated);
    errors.push_back(off);
    ++point.verified;
    ++(off <= right_px ? point.right : point.wrong);
  }
  point.median_px = median(errors);
  point.largest_px = errors.empty() ? 0 : *std::max_element(errors.begin(), errors.end());
  point.median_s = median(times);
}

}  // namespace

double registration_error_px(const Affine& truth, const Affine& found, const PlacedImage& sem,
                             const PlacedImage& simulated) {
  const Point2 last =
      simulated.place_nm(simulated.values.width() - 1, simulated.values.height() - 1);
  double sum = 0;
  int count = 0;
  for (int y = 0; y < sem.values.height(); y += 3)
    for (int x = 0; x < sem.values.width(); x += 3) {
      const Point2 p = sem.place_nm(x, y), a = truth(p), b = found(p);
      if (a.x < simulated.origin_x_nm || a.y < simulated.origin_y_nm || a.x > last.x ||
          a.y > last.y)
        continue;
      const double dx = a.x - b.x, dy = a.y - b.y;
      sum += dx * dx + dy * dy;
      ++count;
    }
  return std::sqrt(sum / count) / sem.pitch_x_nm;
}

RegistrationDraw draw_registration(const SampleTruth& sample, double offset_px, double offset_deg,
                                   std::uint64_t seed, int number) {
  RandomStream random(seed, draw_stream, static_cast<std::uint64_t>(number));
  const PlacedImage& whole = sample.sem.image;
  const auto size = [](int all) { return static_cast<int>(std::lround(part * all)); };
  const int width = size(whole.values.width()), height = size(whole.values.height());
  const auto first = [&](int all, int some) {
    return static_cast<int>(random.uniform() * (all - some + 1));
  };
  const int x0 = first(whole.values.width(), width), y0 = first(whole.values.height(), height);
  RegistrationDraw draw;
  draw.sem = part_of(whole, x0, y0, width, height);
  const Affine& truth = sample.sem.sem_to_afm;
  const Point2 middle = draw.sem.place_nm(0.5 * (width - 1), 0.5 * (height - 1));
  const double pixel = draw.sem.pitch_x_nm, toward = 2 * std::numbers::pi * random.uniform();
  const double turn = (random.uniform() < 0.5 ? -1 : 1) * offset_deg * degree;
  Affine off = make_affine({turn, 1, 1, 0, 0, 0});
  const Point2 turned = off(middle);
  off.x0 = middle.x - turned.x + offset_px * pixel * std::cos(toward);
  off.y0 = middle.y - turned.y + offset_px * pixel * std::sin(toward);
  draw.start = compose(truth, off);
  // Near the corners, as people choose them.
  for (const double u : {0.1, 0.8})
    for (const double v : {0.1, 0.8}) {
      const double du = 0.1 * random.uniform(), dv = 0.1 * random.uniform();
      const Point2 place = draw.sem.place_nm((u + du) * (width - 1), (v + dv) * (height - 1)),
                   error = normal_pair(random);
      const double each = offset_px * pixel / std::numbers::sqrt2;
      draw.pairs.push_back({{place.x + each * error.x, place.y + each * error.y}, truth(place)});
    }
  return draw;
}

std::vector<ChainMethod<RegistrationPoint>> list_registrations(const ChainChartJob& job) {
  const std::vector<double> shifts =
      job.quick ? std::vector<double>{4, 16} : std::vector<double>{2, 4, 8, 16, 32, 64};
  const std::vector<double> turns =
      job.quick ? std::vector<double>{} : std::vector<double>{2, 5, 10, 20};
  std::vector<ChainMethod<RegistrationPoint>> out;
  const auto add = [&](const std::string& family, Way way, double px, double deg) {
    if (!wants(job, family)) return;
    RegistrationPoint point;
    point.family = family;
    point.any_start = way == Way::search;
    point.id = point.any_start ? family
               : deg > 0       ? fmt::format("{}-{:g}deg", family, deg)
                               : fmt::format("{}-{:g}px", family, px);
    point.offset_px = px;
    point.offset_deg = deg;
    out.push_back({std::move(point), [way](const ChainSetting& s, const Watch& watch,
                                           RegistrationPoint& p) { measure(way, s, watch, p); }});
  };
  for (const auto& [family, way] : {std::pair{"correlation", Way::correlation},
                                    std::pair{"mutual-information", Way::mutual_information}}) {
    for (const double px : shifts) add(family, way, px, 0);
    for (const double deg : turns) add(family, way, 0, deg);
  }
  for (const auto& [family, way] :
       {std::pair{"landmarks", Way::landmarks}, std::pair{"landmarks-only", Way::landmarks_only}}) {
    if (way == Way::landmarks_only)  // these small offsets are within `right_px` or near it
      for (const double px : {0.1, 0.3, 1.0}) add(family, way, px, 0);
    for (const double px : shifts) add(family, way, px, 0);
  }
  add("search", Way::search, 0, 0);
  return out;
}

CaptureRange capture_range(const std::vector<RegistrationPoint>& points,
                           const std::string& family) {
  CaptureRange range;
  range.family = family;
  std::vector<const RegistrationPoint*> own;
  std::vector<double> times;
  for (const RegistrationPoint& p : points)
    if (p.family == family) {
      own.push_back(&p);
      times.push_back(p.median_s);
      range.any_start = range.any_start || p.any_start;
    }
  range.median_s = median(times);
  const auto largest = [&](double RegistrationPoint::*offset, std::optional<double>& found,
                           bool& open) {
    std::sort(own.begin(), own.end(),
              [&](const auto* a, const auto* b) { return a->*offset < b->*offset; });
    bool tried = false;
    open = true;
    for (const RegistrationPoint* p : own) {
      if (p->any_start || !(p->*offset > 0)) continue;
      tried = true;
      if (p->share() < captured - 1e-9) {
        open = false;
        break;
      }
      found = p->*offset;
    }
    open = open && tried;
  };
  largest(&RegistrationPoint::offset_px, range.px, range.px_open);
  largest(&RegistrationPoint::offset_deg, range.deg, range.deg_open);
  return range;
}

}  // namespace surf::workflow
