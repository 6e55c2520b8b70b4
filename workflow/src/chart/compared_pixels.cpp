// SPDX-License-Identifier: GPL-3.0-or-later
#include "compared_pixels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "surf/core/error.h"

namespace surf::workflow {
namespace {

constexpr double most_rms = 1.1, most_short = 0.02, missed_by = 1.1;

// The number of pixels, taking every `step`-th, that fits with equal margins on both sides, and the
// first of them.
std::pair<int, int> fit(int pixels, int step) {
  int count = (pixels - 1) / step + 1;
  if ((pixels - 1 - step * (count - 1)) % 2 != 0) --count;
  return {count, (pixels - 1 - step * (count - 1)) / 2};
}

}  // namespace

ComparedPixels choose_pixels(const mc::Scan& scan, int about) {
  // Odd steps only: with an even step and an even number of pixels the margins cannot be equal.
  ComparedPixels best;
  for (int step = 1;; step += 2) {
    const auto [width, first_x] = fit(scan.width, step);
    const auto [height, first_y] = fit(scan.height, step);
    if (step > 1 && (width < 2 || height < 2)) return best;
    best = {step, first_x, first_y, width, height};
    if (static_cast<double>(width) * height <= 1.5 * about) return best;
  }
}

mc::ScanRequest request_for(const ComparedPixels& pixels, const mc::Scan& scan) {
  const double half_x = 0.5 * pixels.width * pixels.step * scan.pixel_x_nm;
  const double half_y = 0.5 * pixels.height * pixels.step * scan.pixel_y_nm;
  mc::ScanRequest request;
  request.width = pixels.width;
  request.height = pixels.height;
  request.region = mc::ScanRequest::Region{scan.center_x_nm - half_x, scan.center_y_nm - half_y,
                                           scan.center_x_nm + half_x, scan.center_y_nm + half_y};
  return request;
}

Reference read_reference(const Image& image, const ComparedPixels& pixels, double accuracy_floor) {
  Reference out;
  out.pixels = pixels;
  out.accuracy_floor = accuracy_floor;
  const Channel* valid = image.find("valid");
  for (std::size_t i = 0;
       i < static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height); ++i)
    out.seen.push_back(!valid || valid->values.data()[i] > 0.5f);
  if (std::find(out.seen.begin(), out.seen.end(), true) == out.seen.end())
    throw InvalidInput("scene", "the beam meets the specimen in none of the pixels",
                       "Check `scan.region` and the specimen");
  for (const char* name : {"SE", "BSE"}) {
    const Channel *value = image.find(name), *error = image.find(std::string(name) + ".stderr");
    if (!value || !error)
      throw InvalidInput("reference.exr", std::string("there is no channel ") + name,
                         "Delete the file: it is made again");
    ComparedChannel channel{name, {}, {}};
    for (std::size_t i = 0; i < out.seen.size(); ++i) {
      if (!out.seen[i]) continue;
      channel.values.push_back(value->values.data()[i]);
      channel.standard_errors.push_back(error->values.data()[i]);
    }
    out.channels.push_back(std::move(channel));
  }
  return out;
}

void judge(const Reference& reference, const std::vector<ComparedChannel>& channels,
           const std::vector<double>& accuracies, ChartPoint& point) {
  point.channels.clear();
  point.targets.clear();
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const ComparedChannel &a = channels[c], &r = reference.channels[c];
    point.channels.push_back(
        {a.name, image_error(a.values, a.standard_errors, r.values, r.standard_errors)});
  }
  for (const double accuracy : accuracies) {
    ChartTarget target;
    target.accuracy = accuracy;
    bool known = true;
    std::vector<bool> missed(channels.front().values.size(), false);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const ComparedChannel &a = channels[c], &r = reference.channels[c];
      known = known && !a.standard_errors.empty();
      double squares = 0;
      for (std::size_t i = 0; i < a.values.size(); ++i) {
        const double asked = std::max(accuracy * r.values[i], reference.accuracy_floor);
        const double off = a.values[i] - r.values[i];
        squares += (off * off - r.standard_errors[i] * r.standard_errors[i]) / (asked * asked);
        if (known && a.standard_errors[i] > missed_by * asked) missed[i] = true;
      }
      target.rms = std::max(
          target.rms, std::sqrt(std::max(0.0, squares / static_cast<double>(a.values.size()))));
    }
    target.short_of = static_cast<double>(std::count(missed.begin(), missed.end(), true)) /
                      static_cast<double>(missed.size());
    target.met = known && target.rms <= most_rms && target.short_of <= most_short;
    point.targets.push_back(target);
  }
}

}  // namespace surf::workflow
