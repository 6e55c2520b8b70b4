// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/track_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "canvas.h"
#include "files/lower_extension.h"
#include "files/module_for.h"
#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

using Window = TrackPictureOptions::Window;
using Point = Canvas::Point;
using Color = Canvas::Color;

constexpr Color ink{0.13, 0.13, 0.13};
constexpr Color faint{0.5, 0.5, 0.5};
constexpr Color grid{0.9, 0.9, 0.9};

/// A line of the legend. The palette is that of Okabe and Ito, "Color universal design" (2008);
/// what is left in the specimen is drawn first and lightest, what leaves it on top.
struct Group {
  const char* label;
  Color color;
  double weight;  ///< of the line, relative
};

constexpr std::array<Group, 6> groups{{
    {"secondaries, absorbed", {0.902, 0.624, 0.000}, 0.7},  // orange
    {"primaries, absorbed", {0.000, 0.447, 0.698}, 0.9},    // blue
    {"lost", {0.35, 0.35, 0.35}, 0.9},
    {"transmitted", {0.800, 0.475, 0.655}, 1.1},              // reddish purple
    {"SE, escaped below 50 eV", {0.000, 0.620, 0.451}, 1.3},  // bluish green
    {"BSE, backscattered", {0.835, 0.369, 0.000}, 1.3},       // vermillion
}};

std::size_t group_of(const Track& track) {
  switch (track.kind) {
    case TrackKind::absorbed:
      return track.secondary ? 0 : 1;
    case TrackKind::lost:
      return 2;
    case TrackKind::transmitted:
      return 3;
    case TrackKind::se:
      return 4;
    case TrackKind::bse:
      return 5;
  }
  return 2;
}

const CanvasLibrary& canvases(const std::string& file) { return module_for<CanvasLibrary>(file); }

void check_name(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".png" || extension == ".svg" || extension == ".pdf") return;
  throw UsageError(
      path.string(),
      fmt::format("pictures of tracks are not written as '{}'", path.extension().string()),
      "Use .png, .svg or .pdf");
}

void check_options(const TrackPictureOptions& options, const std::string& file) {
  for (const int size : {options.width_px, options.height_px}) {
    if (size >= 200 && size <= 20000) continue;
    throw InvalidInput(file, fmt::format("a picture of {} pixels cannot be drawn", size),
                       "Give 200 to 20000");
  }
  for (const auto& piece : options.outline_nm) {
    if (is_finite(piece[0]) && is_finite(piece[1])) continue;
    throw InvalidInput(file, "the outline is not finite", "Give finite corners");
  }
  const auto& w = options.window_nm;
  if (w && !(w->x1_nm > w->x0_nm && w->z1_nm > w->z0_nm && std::isfinite(w->x1_nm - w->x0_nm) &&
             std::isfinite(w->z1_nm - w->z0_nm))) {
    throw InvalidInput(file, "the window is empty", "Give x0 < x1 and z0 < z1, in nm");
  }
}

/// The pieces inside matter; where there is none, everything.
Box interesting_box(std::span<const Track> tracks, const TrackPictureOptions& options) {
  Box inside, all;
  for (const Track& track : tracks) {
    for (std::size_t i = 0; i < track.points_nm.size(); ++i) all.extend(track.points_nm[i]);
    for (std::size_t i = 0; i < track.material.size(); ++i) {
      if (track.material[i] < 0) continue;
      inside.extend(track.points_nm[i]);
      inside.extend(track.points_nm[i + 1]);
    }
  }
  if (!inside.empty()) return inside;
  for (const auto& piece : options.outline_nm) {
    all.extend(piece[0]);
    all.extend(piece[1]);
  }
  return all;
}

Window choose_window(std::span<const Track> tracks, const TrackPictureOptions& options,
                     const std::string& file) {
  if (options.window_nm) return *options.window_nm;
  const Box box = interesting_box(tracks, options);
  if (box.empty()) {
    throw InvalidInput(file, "there is nothing to draw", "Give tracks, an outline or a window");
  }
  const double size = std::max({box.size_nm().x, box.size_nm().z, 1e-3});
  return {box.lower_nm.x - 0.06 * size, box.lower_nm.z - 0.06 * size, box.upper_nm.x + 0.06 * size,
          box.upper_nm.z + 0.22 * size};
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `step`.
double nice_step(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= step * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

class Picture {
 public:
  Picture(Canvas& canvas, const TrackPictureOptions& options, const Window& window)
      : canvas_(canvas), options_(options), window_(window),
        unit_(std::min(options.width_px, options.height_px) / 1200.0) {
    left_ = 118 * unit_;
    top_ = (28 + (options.title.empty() ? 0 : 52) + (options.subtitle.empty() ? 0 : 36)) * unit_;
    width_ = options.width_px - left_ - 34 * unit_;
    height_ = options.height_px - top_ - 100 * unit_;
    fit();
  }

  void draw(std::span<const Track> tracks) {
    draw_title();
    draw_grid();
    canvas_.clip({left_, top_}, width_, height_);
    draw_tracks(tracks);
    draw_outline();
    canvas_.unclip();
    canvas_.stroke_rectangle({left_, top_}, width_, height_, 1.5 * unit_, ink);
    draw_legend(tracks);
  }

 private:
  /// One scale for both axes: the direction with room to spare shows more.
  void fit() {
    double w = window_.x1_nm - window_.x0_nm, h = window_.z1_nm - window_.z0_nm;
    scale_ = std::min(width_ / w, height_ / h);
    const double more_x = width_ / scale_ - w, more_z = height_ / scale_ - h;
    window_.x0_nm -= more_x / 2;
    window_.x1_nm += more_x / 2;
    window_.z0_nm -= more_z / 2;
    window_.z1_nm += more_z / 2;
  }

  double across(double x_nm) const { return left_ + (x_nm - window_.x0_nm) * scale_; }
  double down(double z_nm) const { return top_ + (window_.z1_nm - z_nm) * scale_; }
  Point place(const Vec3& p) const { return {across(p.x), down(p.z)}; }

  void draw_title() {
    double y = 20 * unit_;
    if (!options_.title.empty()) {
      canvas_.text(options_.title, {left_, y += 38 * unit_}, 34 * unit_, Canvas::Align::left, ink,
                   true);
      y += 14 * unit_;
    }
    if (!options_.subtitle.empty()) {
      canvas_.text(options_.subtitle, {left_, y + 22 * unit_}, 23 * unit_, Canvas::Align::left,
                   faint);
    }
  }

  void draw_grid() {
    const double span_nm = std::max(window_.x1_nm - window_.x0_nm, window_.z1_nm - window_.z0_nm);
    const bool micrometres = span_nm >= 3000;
    const double nm = micrometres ? 1e3 : 1;
    const char* const name = micrometres ? "\xC2\xB5m" : "nm";
    const double step = nice_step(110 * unit_ / scale_ / nm);
    const double size = 22 * unit_;
    const auto ticks = [&](double from_nm, double to_nm, const auto& draw) {
      const auto last = static_cast<long>(std::floor(to_nm / nm / step + 1e-9));
      for (auto i = static_cast<long>(std::ceil(from_nm / nm / step - 1e-9)); i <= last; ++i) {
        draw(static_cast<double>(i) * step);
      }
    };
    ticks(window_.x0_nm, window_.x1_nm, [&](double value) {
      const double x = across(value * nm);
      canvas_.segments(std::array{Point{x, top_}, Point{x, top_ + height_}}, unit_, grid);
      canvas_.text(label(value), {x, top_ + height_ + 34 * unit_}, size, Canvas::Align::center,
                   ink);
    });
    ticks(window_.z0_nm, window_.z1_nm, [&](double value) {
      const double y = down(value * nm);
      canvas_.segments(std::array{Point{left_, y}, Point{left_ + width_, y}}, unit_, grid);
      canvas_.text(label(value), {left_ - 12 * unit_, y + 8 * unit_}, size, Canvas::Align::right,
                   ink);
    });
    canvas_.text(fmt::format("x ({})", name), {left_ + width_ / 2, top_ + height_ + 76 * unit_},
                 25 * unit_, Canvas::Align::center, ink);
    canvas_.text(fmt::format("z ({})", name), {36 * unit_, top_ + height_ / 2}, 25 * unit_,
                 Canvas::Align::center, ink, false, true);
  }

  /// Without rounding noise, and with a true minus sign.
  static std::string label(double value) {
    const std::string text = fmt::format("{:.10g}", value);
    return text.starts_with('-') ? "\xE2\x88\x92" + text.substr(1) : text;
  }

  void draw_tracks(std::span<const Track> tracks) {
    std::array<std::size_t, groups.size()> counts{};
    for (const Track& track : tracks) ++counts[group_of(track)];
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const double crowd = std::max(1.0, static_cast<double>(counts[g]) / 40);
      Color color = groups[g].color;
      color.alpha = std::max(0.9 * std::pow(crowd, -0.35), 0.06);
      const double width = unit_ * groups[g].weight * std::max(2.0 * std::pow(crowd, -0.18), 0.8);
      for (const Track& track : tracks) {
        if (group_of(track) == g) draw_track(track, width, color);
      }
    }
  }

  void draw_track(const Track& track, double width, Color color) {
    line_.clear();
    for (std::size_t i = 0; i < track.points_nm.size(); ++i) {
      const Point p = place(track.points_nm[i]);
      const bool is_last = i + 1 == track.points_nm.size();
      // Steps below a third of a pixel cannot be seen, and there can be millions.
      if (!line_.empty() && !is_last &&
          std::hypot(p.x - line_.back().x, p.y - line_.back().y) < 0.33) {
        continue;
      }
      line_.push_back(limited(p));
    }
    canvas_.polyline(line_, width, color);
  }

  /// Cairo counts in 24 bits of pixels: what lies far outside is pulled nearer.
  Point limited(const Point& p) const {
    const double far = 20.0 * (options_.width_px + options_.height_px);
    const double x = p.x - left_, y = p.y - top_;
    const double size = std::max(std::abs(x), std::abs(y));
    return size <= far ? p : Point{left_ + x * far / size, top_ + y * far / size};
  }

  void draw_outline() {
    line_.clear();
    for (const auto& piece : options_.outline_nm) {
      for (const Vec3& end : piece) line_.push_back(limited(place(end)));
    }
    canvas_.segments(line_, 3 * unit_, ink);
  }

  void draw_legend(std::span<const Track> tracks) {
    std::array<std::size_t, groups.size()> counts{};
    std::set<std::int64_t> electrons;
    for (const Track& track : tracks) {
      ++counts[group_of(track)];
      electrons.insert(track.electron);
    }
    std::vector<std::pair<std::string, const Group*>> lines;
    lines.emplace_back(
        fmt::format("{} primar{}", electrons.size(), electrons.size() == 1 ? "y" : "ies"), nullptr);
    for (std::size_t g = groups.size(); g-- > 0;) {
      if (counts[g] == 0) continue;
      lines.emplace_back(fmt::format("{}: {}", groups[g].label, counts[g]), &groups[g]);
    }
    const double size = 21 * unit_, step = 33 * unit_, sample = 44 * unit_, gap = 14 * unit_;
    double widest = 0;
    for (const auto& line : lines) widest = std::max(widest, canvas_.text_width(line.first, size));
    const double box_width = widest + sample + 3.5 * gap;
    const double box_height = step * static_cast<double>(lines.size()) + 1.6 * gap;
    const Point corner{left_ + width_ - box_width - gap, top_ + height_ - box_height - gap};
    canvas_.fill_rectangle(corner, box_width, box_height, {1, 1, 1, 0.88});
    canvas_.stroke_rectangle(corner, box_width, box_height, unit_, {0.75, 0.75, 0.75});
    double y = corner.y + gap / 2;
    for (const auto& [text, group] : lines) {
      y += step;
      const double x = corner.x + gap;
      if (group) {
        const double middle = y - 0.36 * size;
        canvas_.segments(std::array{Point{x, middle}, Point{x + sample, middle}}, 4 * unit_,
                         group->color);
      }
      canvas_.text(text, {group ? x + sample + gap : x, y}, size, Canvas::Align::left, ink, !group);
    }
  }

  Canvas& canvas_;
  const TrackPictureOptions& options_;
  Window window_;
  double unit_;  ///< of fonts, lines and margins: 1 at 1200 pixels
  double left_ = 0, top_ = 0, width_ = 0, height_ = 0;  ///< of the plot, in pixels
  double scale_ = 1;                                    ///< pixels per nm
  std::vector<Point> line_;
};

}  // namespace

void write_track_picture(const std::filesystem::path& path, std::span<const Track> tracks,
                         const TrackPictureOptions& options) {
  check_name(path);
  const std::string file = path.string();
  check_options(options, file);
  for (const Track& track : tracks) validate(track, file.c_str());
  const Window window = choose_window(tracks, options, file);
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    const auto canvas = canvases(file).make_canvas(temporary, file, lower_extension(path),
                                                   options.width_px, options.height_px);
    Picture(*canvas, options, window).draw(tracks);
    canvas->finish();
  });
}

void check_track_picture_target(const std::filesystem::path& path) {
  check_name(path);
  canvases(path.string());
  check_writable(path);
}

}  // namespace surf::io
