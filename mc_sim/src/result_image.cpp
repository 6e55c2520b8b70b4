// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose.h"
#include "surf/mc/simulate.h"

namespace surf::mc {

namespace {

class Builder {
 public:
  Builder(const SimulationResult& result, const Scan& scan) : result_(result) {
    image.pitch_x_nm = scan.pixel_x_nm;
    image.pitch_y_nm = scan.pixel_y_nm;
    image.origin_x_nm = scan.center_x_nm - 0.5 * (scan.width - 1) * scan.pixel_x_nm;
    image.origin_y_nm = scan.center_y_nm - 0.5 * (scan.height - 1) * scan.pixel_y_nm;
  }

  template <class Value>
  void channel(const std::string& name, const Value& value) {
    Grid<float> values(result_.pixels.width(), result_.pixels.height());
    for (int y = 0; y < values.height(); ++y)
      for (int x = 0; x < values.width(); ++x) values(x, y) = static_cast<float>(value(x, y));
    image.channels.push_back({name, "1", std::move(values)});
  }

  void detector(std::size_t d) {
    const Detector& detector = result_.detectors[d];
    channel(detector.name, [&](int x, int y) { return result_.yield(d, x, y).mean; });
    channel(detector.name + ".stderr",
            [&](int x, int y) { return result_.yield(d, x, y).standard_error; });
    if (result_.dose <= 0) return;
    channel(detector.name + ".shot", [&](int x, int y) {
      const auto pixel = static_cast<std::uint64_t>(y) *
                             static_cast<std::uint64_t>(result_.pixels.width()) +
                         static_cast<std::uint64_t>(x);
      const std::int64_t seen = detected(result_.counts[d](x, y).sum, detector.efficiency,
                                         result_.seed, pixel, d);
      return static_cast<double>(seen) / result_.dose;
    });
  }

  Image image;

 private:
  const SimulationResult& result_;
};

}  // namespace

Estimate SimulationResult::yield(std::size_t detector, int x, int y) const {
  Estimate e = estimate(pixels(x, y).primaries, counts[detector](x, y));
  e.mean *= detectors[detector].efficiency;
  e.standard_error *= detectors[detector].efficiency;
  return e;
}

Image make_image(const SimulationResult& result, const Scan& scan) {
  Builder builder(result, scan);
  for (std::size_t d = 0; d < result.detectors.size(); ++d) builder.detector(d);
  builder.channel("valid", [&](int x, int y) { return result.pixels(x, y).hits > 0 ? 1.0 : 0.0; });
  return std::move(builder.image);
}

}  // namespace surf::mc
