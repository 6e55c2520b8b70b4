// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/core/image.h"
#include "surf/io/sim/scene_file.h"
#include "surf/mc/geometry/beam.h"
#include "surf/workflow/chart_job.h"

namespace surf::workflow {

/// Pixels of a scan that are evenly spread and symmetric about its middle, so that they form a scan
/// of their own at the same places: every `step`-th along x and y from `first_x`, `first_y`.
struct ComparedPixels {
  int step = 1, first_x = 0, first_y = 0, width = 0, height = 0;
};

/// Chooses approximately `about` pixels.
ComparedPixels choose_pixels(const mc::Scan& scan, int about);

/// The request for a scan of these pixels alone.
mc::ScanRequest request_for(const ComparedPixels& pixels, const mc::Scan& scan);

/// One channel at the compared pixels where the reference is seen.
struct ComparedChannel {
  std::string name;
  std::vector<double> values, standard_errors;  ///< standard_errors may be empty
};

/// The reference, as stored in its file.
struct Reference {
  ComparedPixels pixels;
  std::vector<bool> seen;                 ///< whether the beam meets the specimen
  std::vector<ComparedChannel> channels;  ///< SE and BSE
  double accuracy_floor = 0;
};

/// Reads the reference from the image of the compared pixels. Throws InvalidInput if no pixel sees
/// anything.
Reference read_reference(const Image& image, const ComparedPixels& pixels, double accuracy_floor);

/// Takes the compared pixels from an image of the whole scan: `value(channel, x, y)` gives a value,
/// and `error`, unless null, its standard error.
template <class Value, class Error>
std::vector<ComparedChannel> take_compared(const Reference& reference, const Value& value,
                                           const Error* error) {
  std::vector<ComparedChannel> out;
  const ComparedPixels& p = reference.pixels;
  for (std::size_t c = 0; c < reference.channels.size(); ++c) {
    ComparedChannel channel{reference.channels[c].name, {}, {}};
    for (int j = 0; j < p.height; ++j)
      for (int i = 0; i < p.width; ++i) {
        if (!reference.seen[static_cast<std::size_t>(j) * static_cast<std::size_t>(p.width) +
                            static_cast<std::size_t>(i)])
          continue;
        const int x = p.first_x + i * p.step, y = p.first_y + j * p.step;
        channel.values.push_back(value(c, x, y));
        if (error) channel.standard_errors.push_back((*error)(c, x, y));
      }
    out.push_back(std::move(channel));
  }
  return out;
}

/// Fills in a point's errors and compares them with each accuracy.
void judge(const Reference& reference, const std::vector<ComparedChannel>& channels,
           const std::vector<double>& accuracies, ChartPoint& point);

}  // namespace surf::workflow
