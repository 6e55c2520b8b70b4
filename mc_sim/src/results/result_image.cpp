// SPDX-License-Identifier: GPL-3.0-or-later
#include <functional>
#include <utility>

#include "results/shot_noise.h"
#include "surf/mc/results/simulation_result.h"

namespace surf::mc {

namespace {

constexpr std::size_t most_read = std::size_t{32} << 20;  // bytes of tallies between releases

// The channels of a result, each as a function of the pixel.
class Builder {
 public:
  using Value = std::function<double(int x, int y)>;

  Builder(const SimulationResult& result, const Scan& scan) : result_(result) {
    Image& head = rows.head;
    head.pitch_x_nm = scan.pixel_x_nm;
    head.pitch_y_nm = scan.pixel_y_nm;
    head.origin_x_nm = scan.center_x_nm - 0.5 * (scan.width - 1) * scan.pixel_x_nm;
    head.origin_y_nm = scan.center_y_nm - 0.5 * (scan.height - 1) * scan.pixel_y_nm;
    rows.width = result.pixels.width();
    rows.height = result.pixels.height();
  }

  void channel(const std::string& name, Value value) {
    rows.head.channels.push_back({name, "1", {}});
    values_.push_back(std::move(value));
  }

  void detector(std::size_t d) {
    const SimulationResult& r = result_;
    const std::string& name = r.detectors[d].name;
    channel(name, [&r, d](int x, int y) { return r.yield(d, x, y).mean; });
    channel(name + ".stderr", [&r, d](int x, int y) { return r.yield(d, x, y).standard_error; });
    const double dose = dose_of(r.budget);
    if (dose <= 0) return;
    channel(name + ".shot", [&r, d, dose](int x, int y) {
      const auto pixel =
          static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(r.pixels.width()) +
          static_cast<std::uint64_t>(x);
      const std::int64_t seen =
          detected(r.counts[d](x, y).sum, r.detectors[d].efficiency, r.seed, pixel, d);
      return static_cast<double>(seen) / dose;
    });
  }

  ImageRows finish() {
    rows.read = [&r = result_, values = std::move(values_), bytes = std::size_t{0}](
                    std::size_t channel, int y, std::span<float> row) mutable {
      for (std::size_t x = 0; x < row.size(); ++x)
        row[x] = static_cast<float>(values[channel](static_cast<int>(x), y));
      bytes += row.size() * (sizeof(PixelTally) + sizeof(Counts));
      if (bytes < most_read) return;
      r.release();
      bytes = 0;
    };
    return std::move(rows);
  }

  ImageRows rows;

 private:
  const SimulationResult& result_;
  std::vector<Value> values_;
};

}  // namespace

ImageRows make_image_rows(const SimulationResult& result, const Scan& scan) {
  Builder builder(result, scan);
  for (std::size_t d = 0; d < result.detectors.size(); ++d) builder.detector(d);
  builder.channel("valid",
                  [&r = result](int x, int y) { return r.pixels(x, y).hits > 0 ? 1.0 : 0.0; });
  return builder.finish();
}

Image make_image(const SimulationResult& result, const Scan& scan) {
  return to_image(make_image_rows(result, scan));
}

}  // namespace surf::mc
