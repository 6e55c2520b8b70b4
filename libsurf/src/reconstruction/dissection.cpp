// SPDX-License-Identifier: GPL-3.0-or-later
#include "dissection.h"

#include <algorithm>
#include <cstdlib>

namespace surf::reconstruction {
namespace {

constexpr int reach = 2;
// Parts of at most so many samples are not divided.
constexpr int undivided = 24;

class Builder {
 public:
  explicit Builder(Dissection& to) : to_(to) {}

  /// Adds the fronts of a part. Returns the last one, which is the parent of the others.
  int add(const Area& part, int depth) {
    int children[2] = {-1, -1};
    Area own = part;
    if (part.samples() > undivided && std::max(part.width(), part.height()) > 2 * reach) {
      Area before = part, after = part;
      if (part.width() >= part.height()) {
        before.x_end = own.x_begin = part.x_begin + (part.width() - reach) / 2;
        own.x_end = after.x_begin = own.x_begin + reach;
      } else {
        before.y_end = own.y_begin = part.y_begin + (part.height() - reach) / 2;
        own.y_end = after.y_begin = own.y_begin + reach;
      }
      children[0] = add(before, depth + 1);
      children[1] = add(after, depth + 1);
    }
    Front front;
    front.depth = depth;
    front.first = static_cast<int>(to_.sample.size());
    front.own = own.samples();
    for (int y = own.y_begin; y < own.y_end; ++y)
      for (int x = own.x_begin; x < own.x_end; ++x) {
        to_.place[y * to_.width + x] = static_cast<int>(to_.sample.size());
        to_.sample.push_back(y * to_.width + x);
      }
    const int at = static_cast<int>(to_.fronts.size());
    to_.fronts.push_back(std::move(front));
    parts_.push_back(part);
    for (const int child : children)
      if (child >= 0) to_.fronts[child].parent = at;
    return at;
  }

  /// All samples within reach of a part and outside of it belong to later separators.
  void add_borders() {
    for (std::size_t i = 0; i < to_.fronts.size(); ++i) {
      const Area& p = parts_[i];
      std::vector<int>& border = to_.fronts[i].border;
      for (int y = std::max(0, p.y_begin - reach); y < std::min(to_.height, p.y_end + reach); ++y)
        for (int x = std::max(0, p.x_begin - reach); x < std::min(to_.width, p.x_end + reach);
             ++x) {
          const int dx = std::max({p.x_begin - x, x - p.x_end + 1, 0}),
                    dy = std::max({p.y_begin - y, y - p.y_end + 1, 0});
          if (dx + dy > 0 && dx + dy <= reach) border.push_back(to_.place[y * to_.width + x]);
        }
      std::sort(border.begin(), border.end());
    }
    for (Front& f : to_.fronts) {
      if (f.parent < 0) continue;
      const Front& p = to_.fronts[f.parent];
      for (const int place : f.border)
        f.in_parent.push_back(
            place < p.first + p.own
                ? place - p.first
                : p.own +
                      static_cast<int>(std::lower_bound(p.border.begin(), p.border.end(), place) -
                                       p.border.begin()));
    }
  }

 private:
  Dissection& to_;
  std::vector<Area> parts_;
};

}  // namespace

Dissection::Dissection(int w, int h) : width(w), height(h), place(static_cast<std::size_t>(w) * h) {
  Builder builder(*this);
  builder.add({0, 0, width, height}, 0);
  builder.add_borders();
}

double Dissection::flops() const {
  double sum = 0;
  for (const Front& f : fronts) {
    const double own = f.own, left = static_cast<double>(f.border.size());
    sum += own * own * own / 3 + own * own * left + own * left * left;
  }
  return sum;
}

}  // namespace surf::reconstruction
