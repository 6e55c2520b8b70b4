// SPDX-License-Identifier: GPL-3.0-or-later
// What `semsurf reconstruct` makes of pairs whose place cannot be known (gratings, dots, single
// lines) and of images of different places, nothing told:
//   bench_open_pairs MODEL.json RESULTS.csv FROM TO
// The pairs are those of bench_registration: of every ninth number one of each pattern.
// RESULTS.csv: what it appends to, one line a pair; pairs that are there already are not done
// again. The model makes the SEM images, so that there is nothing for Monte Carlo to correct, and
// it does not. A pair is accepted where the verdict is "sound". Its interval is tight where fewer
// than nine in ten heights lie within two standard deviations of what the SEM image shows, less the
// median difference, because a scan does not know where 0 is.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "registration_scenes.h"
#include "surf/io/model/model_file.h"
#include "surf/workflow/reconstruct_job.h"

namespace {

using namespace surf;

constexpr double fair = 0.9;

struct Row {
  int number = 0, pattern = 0, verdict = 0, registration = 0;
  double rms_nm = 0, stated_nm = 0, within_1 = 0, within_2 = 0, rival = 0, seconds = 0;

  bool refused() const {
    return verdict == static_cast<int>(workflow::ReconstructionVerdict::not_registered);
  }
  bool accepted() const {
    return verdict == static_cast<int>(workflow::ReconstructionVerdict::sound);
  }
  bool tight() const { return !refused() && within_2 < fair; }
};

std::vector<Row> read_rows(const std::string& path) {
  std::vector<Row> rows;
  for_each_row(path, [&](std::istream& in) {
    Row r;
    if (in >> r.number >> r.pattern >> r.verdict >> r.registration >> r.rms_nm >> r.stated_nm >>
        r.within_1 >> r.within_2 >> r.rival >> r.seconds)
      rows.push_back(r);
  });
  return rows;
}

double rms(const Grid<double>& values) {
  double sum = 0;
  for (const double v : values.data()) sum += v * v;
  return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

/// By how many pixels a map is off in the SEM image's middle.
double off_px(const Affine& map, const RegistrationScene& scene) {
  const Point2 middle{scene.sem.x_nm(scene.sem.values.width() / 2),
                      scene.sem.y_nm(scene.sem.values.height() / 2)};
  const Point2 found = map(middle), there = scene.truth(middle);
  return std::hypot(found.x - there.x, found.y - there.y) / scene.sem.pitch_x_nm;
}

Row measure(const std::string& file, const std::shared_ptr<const ImageModel>& model, int number,
            Pattern pattern) {
  const RegistrationScene scene = numbered_scene(model, number, pattern);
  workflow::ReconstructJob job;
  job.afm.emplace();
  job.afm->scan = scene.scan;
  job.sem.emplace();
  job.sem->image = scene.sem;
  job.model.file = file;
  job.model.signal = "SE";
  job.corrections = 0;
  job.truth = scene.seen;
  const auto begin = std::chrono::steady_clock::now();
  const workflow::ReconstructSummary s = workflow::run(job);
  Row row{number, static_cast<int>(pattern), static_cast<int>(s.verdict), -1};
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (s.pose && s.pose->registration)
    row.registration = static_cast<int>(s.pose->registration->verdict);
  if (s.truth) {
    row.rms_nm = s.truth->rms_nm;
    row.stated_nm = rms(s.result.deviation_nm);
    row.within_1 = s.truth->coverage_1;
    row.within_2 = s.truth->coverage_2;
  }
  if (s.rival) row.rival = s.rival->probability;
  fmt::print(
      "{} {}: {}, off {:.1f} nm, stated {:.1f} nm, within one {:.0f} %, two {:.0f} %, {:.0f} s\n",
      number, surf::name_of(pattern), workflow::name(s.verdict), row.rms_nm, row.stated_nm,
      100 * row.within_1, 100 * row.within_2, row.seconds);
  if (s.pose && s.pose->registration) {
    const Registration& r = *s.pose->registration;
    fmt::print(
        "    registration {}, slides: {}, place off by {:.1f} pixels, then {:.1f}; rivals (px):",
        workflow::name(r.verdict), r.slides, off_px(r.sem_to_afm, scene),
        off_px(s.result.sem_to_afm, scene));
    for (const RegistrationRival& rival : r.rivals) fmt::print(" {:.3g}", rival.distance_px);
    fmt::print("; judged:");
    for (const workflow::JudgedPlace& place : s.pose->places)
      fmt::print(" {:.3g}", place.probability);
    fmt::print("\n");
  }
  for (const std::string& reason : s.reasons) fmt::print("    {}\n", reason);
  std::fflush(stdout);
  return row;
}

double median(std::vector<double> v) {
  if (v.empty()) return 0;
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

void sum_up(const std::vector<Row>& rows) {
  fmt::print(
      "| scene | pairs | refused | flagged | sound | with a rival | off, stated: median (nm) | "
      "within "
      "two: least, median | fewer than {:.0f} % within two: flagged, sound |\n",
      100 * fair);
  for (const Pattern p : without_place) {
    int pairs = 0, refused = 0, sound = 0, rivals = 0, tight_flagged = 0, tight_sound = 0;
    std::vector<double> off, stated, within;
    for (const Row& r : rows) {
      if (r.pattern != static_cast<int>(p)) continue;
      ++pairs;
      refused += r.refused();
      sound += r.accepted();
      rivals += r.rival > 0;
      tight_flagged += r.tight() && !r.accepted();
      tight_sound += r.tight() && r.accepted();
      if (r.refused()) continue;
      off.push_back(r.rms_nm);
      stated.push_back(r.stated_nm);
      within.push_back(r.within_2);
    }
    fmt::print("| {} | {} | {} | {} | {} | {} | {:.1f}, {:.1f} | {:.0f} %, {:.0f} % | {}, {} |\n",
               surf::name_of(p), pairs, refused, pairs - refused - sound, sound, rivals,
               median(off), median(stated),
               within.empty() ? 0 : 100 * *std::ranges::min_element(within), 100 * median(within),
               tight_flagged, tight_sound);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return fmt::print(stderr, "bench_open_pairs MODEL.json RESULTS.csv FROM TO\n"), 2;
  const auto model = make_model(io::read_model(argv[1]));
  std::vector<Row> rows = read_rows(argv[2]);
  for (int number = std::atoi(argv[3]); number < std::atoi(argv[4]); ++number) {
    if (number % 9 != 0) continue;
    for (const Pattern pattern : without_place) {
      if (std::ranges::any_of(rows, [&](const Row& r) {
            return r.number == number && r.pattern == static_cast<int>(pattern);
          }))
        continue;
      const Row r = measure(argv[1], model, number, pattern);
      rows.push_back(r);
      std::ofstream file(argv[2], std::ios::app);
      if (rows.size() == 1)
        file << "number,pattern,verdict,registration,rms_nm,stated_nm,within_1,within_2,rival,"
                "seconds\n";
      file << fmt::format("{},{},{},{},{:.4f},{:.4f},{:.5f},{:.5f},{:.5f},{:.2f}\n", r.number,
                          r.pattern, r.verdict, r.registration, r.rms_nm, r.stated_nm, r.within_1,
                          r.within_2, r.rival, r.seconds);
    }
  }
  sum_up(rows);
}
