// SPDX-License-Identifier: GPL-3.0-or-later
// How well images are registered from no landmarks: random affine maps (any turn, scales 0.8
// to 1.25 along each axis, shear up to 5 %, overlap from 50 %) of random surfaces.
//   bench_registration MODEL.json RESULTS.csv FROM TO
// MODEL.json: a fast model, samples/si-1keV-10nm.json. RESULTS.csv: what it appends to, one line a
// pair of images; pairs that are there already are not done again, so that 0 300 can be measured in
// parts. FROM, TO: numbers of maps, TO not among them. Each number is a surface whose pose can be
// known, of five kinds in turn and of 456 x 172 and 300 x 300 SEM pixels in turn; each ninth number
// also one of every pattern that repeats or slides, and images that show different places. At the
// end it sums up all that RESULTS.csv holds. How the images are made: registration_scenes.h. error:
// root mean square over the overlap of where SEM pixels are put less where they belong, SEM pixels.
// corner: the largest such distance at the SEM image's four corners, most of which lie outside of
// the overlap. z: error over its own standard error; a mean square of 1 says that the standard
// error is right, less that it is too large. seconds: of all threads.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "chain_methods.h"
#include "registration_scenes.h"
#include "surf/io/model/model_file.h"
#include "surf/registration/register_images.h"

namespace {

using namespace surf;

double distance_px(const RegistrationScene& scene, const Affine& found, Point2 sem_place) {
  const Point2 a = scene.truth(sem_place), b = found(sem_place);
  return std::hypot(a.x - b.x, a.y - b.y) / scene.sem.pitch_x_nm;
}

double error_px(const RegistrationScene& scene, const Affine& found) {
  return workflow::registration_error_px(scene.truth, found, scene.sem, scene.simulated);
}

double corner_px(const RegistrationScene& scene, const Affine& found) {
  double largest = 0;
  for (const int x : {0, scene.sem.values.width() - 1})
    for (const int y : {0, scene.sem.values.height() - 1})
      largest = std::max(largest, distance_px(scene, found, scene.sem.place_nm(x, y)));
  return largest;
}

/// Clopper and Pearson's upper limit at 95 %, one-sided: where k or fewer of n have a chance of 5
/// %.
double upper_limit(int k, int n) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double p = 0.5 * (low + high);
    double sum = 0, term = std::pow(1 - p, n);
    for (int j = 0; j <= k; ++j) {
      sum += term;
      term *= double(n - j) / (j + 1) * p / (1 - p);
    }
    (sum > 0.05 ? low : high) = p;
  }
  return high;
}

constexpr Pattern knowable[] = {Pattern::blocks, Pattern::bumps, Pattern::pits, Pattern::rough,
                                Pattern::lines_with_ends};
constexpr const char* verdicts[] = {"verified", "ambiguous", "unconverged", "unrelated"};

constexpr double aim_px = 0.3;

/// One pair of images, as a line of the file has it.
struct Row {
  int number = 0, pattern = 0, verdict = 0, rivals = 0;
  double overlap = 0, error_px = 0, corner_px = 0, stderr_px = 0, blur_px = 0, score = 0,
         seconds = 0;

  bool verified() const { return verdict == static_cast<int>(RegistrationVerdict::verified); }
};

std::vector<Row> read_rows(const std::string& path) {
  std::vector<Row> rows;
  for_each_row(path, [&](std::istream& in) {
    Row r;
    if (in >> r.number >> r.pattern >> r.verdict >> r.rivals >> r.overlap >> r.error_px >>
        r.corner_px >> r.stderr_px >> r.blur_px >> r.score >> r.seconds)
      rows.push_back(r);
  });
  return rows;
}

Row measure(const std::shared_ptr<const ImageModel>& model, int number, Pattern pattern) {
  const RegistrationScene scene = numbered_scene(model, number, pattern);
  const std::clock_t start = std::clock();
  const Registration r = register_images(scene.sem, scene.simulated);
  const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
  const double error = error_px(scene, r.sem_to_afm);
  fmt::print("  {} {} {} error {:.3f}: {}\n", number, surf::name_of(pattern),
             verdicts[static_cast<int>(r.verdict)], error, r.reason);
  return {number,
          static_cast<int>(pattern),
          static_cast<int>(r.verdict),
          static_cast<int>(r.rivals.size()),
          scene.overlap,
          error,
          corner_px(scene, r.sem_to_afm),
          r.stderr_px,
          r.blur_px,
          r.score,
          seconds};
}

double quantile(std::vector<double> v, double share) {
  if (v.empty()) return 0;
  std::sort(v.begin(), v.end());
  return v[static_cast<std::size_t>(share * double(v.size() - 1))];
}

/// A line of the tables in docs/development/registration_figures.md: of all pairs how many have
/// which verdict, of the verified ones how far they are off.
void print(const char* what, const std::vector<Row>& rows) {
  if (rows.empty()) return;
  int counts[4] = {}, with_rivals = 0, near = 0, within_one = 0, within_two = 0;
  std::vector<double> errors, corners, stderrs, seconds;
  double z2 = 0;
  for (const Row& r : rows) {
    ++counts[r.verdict];
    with_rivals += r.rivals > 0;
    seconds.push_back(r.seconds);
    if (!r.verified()) continue;
    errors.push_back(r.error_px);
    corners.push_back(r.corner_px);
    stderrs.push_back(r.stderr_px);
    const double z = r.error_px / r.stderr_px;
    z2 += z * z;
    near += r.error_px <= aim_px;
    within_one += z <= 1;
    within_two += z <= 2;
  }
  fmt::print("| {} | {} |", what, rows.size());
  for (const int count : counts) fmt::print(" {} |", count);
  fmt::print(" {} | {} |", with_rivals, near);
  const double n = double(errors.size());
  if (errors.empty()) fmt::print(" | | | |");
  else
    fmt::print(" {:.3f}, {:.3f}, {:.3f} | {:.3f}, {:.3f} | {:.3f} | {:.0f} %, {:.0f} %, {:.2f} |",
               quantile(errors, 0.5), quantile(errors, 0.95), quantile(errors, 1),
               quantile(corners, 0.5), quantile(corners, 0.95), quantile(stderrs, 0.5),
               100 * within_one / n, 100 * within_two / n, z2 / n);
  fmt::print(" {:.1f}, {:.1f} |\n", quantile(seconds, 0.5), quantile(seconds, 1));
}

template <class IsFalse>
void print_false(const char* what, const std::vector<Row>& rows, const IsFalse& is_false) {
  const int wrong = static_cast<int>(std::count_if(
      rows.begin(), rows.end(), [&](const Row& r) { return r.verified() && is_false(r); }));
  const int n = static_cast<int>(rows.size());
  fmt::print("{}: {} of {}, 95 % upper limit {:.2f} %\n", what, wrong, n,
             100 * upper_limit(wrong, n));
}

void sum_up(const std::vector<Row>& rows) {
  const auto of = [&](auto&& wanted) {
    std::vector<Row> some;
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(some), wanted);
    return some;
  };
  const auto is = [](const Row& r, Pattern p) { return r.pattern == static_cast<int>(p); };
  const auto is_open = [&](const Row& r) {
    return std::any_of(std::begin(without_place), std::end(without_place),
                       [&](Pattern p) { return is(r, p); });
  };
  fmt::print(
      "| scene | pairs | verified | ambiguous | unconverged | unrelated | with rivals | verified "
      "within {} px | "
      "error: median, 95 %, largest | corner: median, 95 % | standard error: median | error within "
      "1, 2 standard "
      "errors; mean z^2 | seconds: median, largest |\n",
      aim_px);
  for (const auto& patterns :
       {std::vector<Pattern>(std::begin(knowable), std::end(knowable)),
        std::vector<Pattern>(std::begin(without_place), std::end(without_place))})
    for (const Pattern p : patterns)
      print(surf::name_of(p), of([&](const Row& r) { return is(r, p); }));
  const std::vector<Row> with = of([&](const Row&r) { return !is_open(r); }), without = of(is_open);
  print("with a pose", with);
  print("without a pose", without);
  print_false("verified and off by more than 0.3 px", with,
              [](const Row& r) { return r.error_px > aim_px; });
  print_false("verified and off by more than 0.3 px and 2 standard errors", with,
              [](const Row& r) { return r.error_px > std::max(aim_px, 2 * r.stderr_px); });
  print_false("verified and off by more than 1 px", with,
              [](const Row& r) { return r.error_px > 1; });
  print_false("without a pose and verified", without, [](const Row&) { return true; });
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5)
    return fmt::print(stderr, "bench_registration MODEL.json RESULTS.csv FROM TO\n"), 2;
  const auto model = make_model(io::read_model(argv[1]));
  const std::string path = argv[2];
  std::vector<Row> rows = read_rows(path);
  const auto add = [&](int number, Pattern pattern) {
    if (std::any_of(rows.begin(), rows.end(), [&](const Row& r) {
          return r.number == number && r.pattern == static_cast<int>(pattern);
        }))
      return;
    const Row r = measure(model, number, pattern);
    rows.push_back(r);
    std::ofstream file(path, std::ios::app);
    if (rows.size() == 1)
      file << "number,pattern,verdict,rivals,overlap,error_px,corner_px,stderr_px,blur_px,score,"
              "seconds\n";
    file << fmt::format("{},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{},{:.5f},{:.3f}\n", r.number,
                        r.pattern, r.verdict, r.rivals, r.overlap, r.error_px, r.corner_px,
                        r.stderr_px, r.blur_px, r.score, r.seconds);
    std::fflush(stdout);
  };
  for (int number = std::atoi(argv[3]); number < std::atoi(argv[4]); ++number) {
    add(number, knowable[number % std::size(knowable)]);
    if (number % 9 == 0)
      for (const Pattern pattern : without_place) add(number, pattern);
  }
  sum_up(rows);
}
