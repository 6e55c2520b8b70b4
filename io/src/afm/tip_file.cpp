// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/tip_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include "surf/core/error.h"
#include "surf/io/height_field_file.h"

namespace surf::io {
namespace {

constexpr double nothing = -std::numeric_limits<double>::infinity();
constexpr const char* tip_key = "tip";
constexpr const char* apex_key = "tip.apex";
constexpr const char* doubt_key = "tip.doubt";

struct Place {
  int x = 0, y = 0;
};

std::string text_of(const std::map<std::string, std::string>& metadata, const std::string& key) {
  for (const auto& [name, value] : metadata) {
    std::string lower = name;
    for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (lower == key) return value;
  }
  return {};
}

/// Whether the tip points down: then the rim is higher than the rest.
bool points_down(const HeightField& field) {
  double rim = 0, all = 0, rim_count = 0, count = 0;
  const int w = field.z_nm.width(), h = field.z_nm.height();
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      if (!field.is_valid(x, y)) continue;
      const bool last = x == 0 || y == 0 || x == w - 1 || y == h - 1 || !field.is_valid(x - 1, y) ||
                        !field.is_valid(x + 1, y) || !field.is_valid(x, y - 1) ||
                        !field.is_valid(x, y + 1);
      all += field.z_nm(x, y);
      ++count;
      if (!last) continue;
      rim += field.z_nm(x, y);
      ++rim_count;
    }
  }
  return rim_count > 0 && rim / rim_count > all / count;
}

std::vector<Place> highest(const Grid<double>& z) {
  const double top = *std::max_element(z.data().begin(), z.data().end());
  std::vector<Place> places;
  for (int y = 0; y < z.height(); ++y)
    for (int x = 0; x < z.width(); ++x)
      if (z(x, y) == top) places.push_back({x, y});
  return places;
}

/// Whether the places hang together, by edges or corners.
bool touch(const std::vector<Place>& places, const Grid<double>& z) {
  Mask waiting(z.width(), z.height());
  for (const Place p : places) waiting(p.x, p.y) = 1;
  std::vector<Place> open{places.front()};
  waiting(open[0].x, open[0].y) = 0;
  std::size_t reached = 0;
  while (!open.empty()) {
    const Place p = open.back();
    open.pop_back();
    ++reached;
    for (int y = std::max(p.y - 1, 0); y <= std::min(p.y + 1, z.height() - 1); ++y) {
      for (int x = std::max(p.x - 1, 0); x <= std::min(p.x + 1, z.width() - 1); ++x) {
        if (!waiting(x, y)) continue;
        waiting(x, y) = 0;
        open.push_back({x, y});
      }
    }
  }
  return reached == places.size();
}

/// Of a flat apex the sample nearest to its middle.
Place middle_of(const std::vector<Place>& places) {
  double x = 0, y = 0;
  for (const Place p : places) {
    x += p.x;
    y += p.y;
  }
  x /= double(places.size());
  y /= double(places.size());
  const auto distance = [&](const Place p) { return std::hypot(p.x - x, p.y - y); };
  return *std::min_element(places.begin(), places.end(),
                           [&](const Place a, const Place b) { return distance(a) < distance(b); });
}

/// The apex that the file names, where it is one of the highest.
bool named_apex(const std::string& text, const std::vector<Place>& places, Place& apex) {
  int values[2];
  const char *at = text.data(), *const end = at + text.size();
  for (int& value : values) {
    const auto [stop, error] = std::from_chars(at, end, value);
    if (error != std::errc{}) return false;
    at = stop == end ? stop : stop + 1;
  }
  for (const Place p : places) {
    if (p.x != values[0] || p.y != values[1]) continue;
    apex = p;
    return true;
  }
  return false;
}

}  // namespace

Tip to_tip(HeightField field, const std::map<std::string, std::string>& metadata,
           const std::string& subject) {
  const std::string kind = text_of(metadata, tip_key);
  const bool physical = kind == "physical";
  const double sign = physical && points_down(field) ? -1 : 1;
  Tip tip;
  tip.pitch() = field.pitch();
  tip.z_nm = std::move(field.z_nm);
  for (int y = 0; y < tip.z_nm.height(); ++y)
    for (int x = 0; x < tip.z_nm.width(); ++x)
      tip.z_nm(x, y) = field.is_valid(x, y) ? sign * tip.z_nm(x, y) : nothing;
  const bool empty = std::ranges::all_of(tip.z_nm.data(), [](double z) { return z == nothing; });
  if (empty)
    throw InvalidInput(subject, "it has no samples, only holes",
                       "Give a tip with at least an apex");
  const std::vector<Place> places = highest(tip.z_nm);
  Place apex = middle_of(places);
  if (!named_apex(text_of(metadata, apex_key), places, apex) && !touch(places, tip.z_nm)) {
    throw InvalidInput(
        subject,
        fmt::format("its highest value is found in {} places that do not touch, as at ({}, {}) "
                    "and ({}, {}): no apex can be told",
                    places.size(), places.front().x, places.front().y, places.back().x,
                    places.back().y),
        "Give a tip with one apex");
  }
  const double top = tip.z_nm(apex.x, apex.y);
  for (double& z : tip.z_nm.data()) z -= top;
  tip.apex_x = apex.x;
  tip.apex_y = apex.y;
  tip.doubt = text_of(metadata, doubt_key);
  if (physical) tip = reflected(tip);
  validate(tip, subject.c_str());
  return tip;
}

Tip read_tip(const std::filesystem::path& path) {
  HeightFieldFile read = read_height_field(path);
  return to_tip(std::move(read.field), read.metadata, path.string());
}

TipHeights to_heights(const Tip& tip, const char* subject) {
  validate(tip, subject);
  // Fields of heights have at least 2 x 2 samples: a narrower tip gets samples that it does not
  // have.
  const int w = std::max(tip.z_nm.width(), 2), h = std::max(tip.z_nm.height(), 2);
  TipHeights heights;
  HeightField& field = heights.field;
  field.pitch() = tip.pitch();
  field.origin_x_nm = -tip.apex_x * tip.pitch_x_nm;
  field.origin_y_nm = -tip.apex_y * tip.pitch_y_nm;
  field.z_nm = Grid<double>(w, h);
  Mask valid(w, h);
  bool whole = true;
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const bool there = x < tip.z_nm.width() && y < tip.z_nm.height() && tip.z_nm(x, y) != nothing;
      valid(x, y) = there;
      whole = whole && there;
      if (there) field.z_nm(x, y) = tip.z_nm(x, y);
    }
  }
  if (!whole) field.valid = std::move(valid);
  heights.metadata = {{tip_key, "structuring function"},
                      {apex_key, fmt::format("{} {}", tip.apex_x, tip.apex_y)}};
  if (!tip.doubt.empty()) heights.metadata[doubt_key] = tip.doubt;
  return heights;
}

void write_tip(const std::filesystem::path& path, const Tip& tip,
               const std::map<std::string, std::string>& metadata) {
  TipHeights heights = to_heights(tip, path.string().c_str());
  heights.metadata.insert(metadata.begin(), metadata.end());
  write_height_field(path, heights.field, heights.metadata);
}

}  // namespace surf::io
