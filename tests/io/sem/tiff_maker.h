// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace surf::test {

/// A TIFF file of one page of 8 bits in one strip, with whatever tags a microscope's maker adds.
class TiffMaker {
 public:
  TiffMaker(int width, int height, std::string pixels, bool low_byte_first = true)
      : low_byte_first_(low_byte_first), pixels_(std::move(pixels)) {
    whole(256, width), whole(257, height), whole(258, 8), whole(259, 1), whole(262, 1),
        whole(277, 1);
    whole(278, height);
  }

  void whole(int tag, unsigned value) { tags_[tag] = {3, 1, number(value, 2)}; }
  void text(int tag, const std::string& value) { tags_[tag] = {2, value.size() + 1, value + '\0'}; }
  void bytes(int tag, const std::string& value) { tags_[tag] = {1, value.size(), value}; }
  void ratio(int tag, unsigned above, unsigned below) {
    tags_[tag] = {5, 1, number(above, 4) + number(below, 4)};
  }

  /// Shown through a palette: `red(i)` and so on of 256 entries.
  template <class Colour>
  void palette(const Colour& colour) {
    whole(262, 3);
    std::string values;
    for (int part = 0; part < 3; ++part)
      for (int i = 0; i < 256; ++i) values += number(static_cast<unsigned>(colour(i, part)), 2);
    tags_[320] = {3, 768, values};
  }

  std::string file() const {
    auto tags = tags_;
    std::string out = (low_byte_first_ ? "II" : "MM") + number(42, 2) + number(0, 4);
    const auto append = [&](const std::string& data) {
      const std::size_t place = out.size();
      out += data;
      if (out.size() % 2) out += '\0';
      return number(static_cast<unsigned>(place), 4);
    };
    tags[273] = {4, 1, append(pixels_)};
    tags[279] = {4, 1, number(static_cast<unsigned>(pixels_.size()), 4)};
    std::string directory = number(static_cast<unsigned>(tags.size()), 2);
    for (const auto& [tag, value] : tags) {
      directory += number(static_cast<unsigned>(tag), 2) + number(value.type, 2);
      directory += number(static_cast<unsigned>(value.count), 4);
      std::string here = value.data.size() > 4 ? append(value.data) : value.data;
      here.resize(4, '\0');
      directory += here;
    }
    const std::string place = append(directory + number(0, 4));
    return out.replace(4, 4, place);
  }

  std::string number(unsigned value, int bytes) const {
    std::string text;
    for (int i = 0; i < bytes; ++i)
      text += static_cast<char>(value >> 8 * (low_byte_first_ ? i : bytes - 1 - i) & 0xff);
    return text;
  }

 private:
  struct Tag {
    unsigned type = 1;
    std::size_t count = 0;
    std::string data;
  };
  bool low_byte_first_;
  std::string pixels_;
  std::map<int, Tag> tags_;
};

}  // namespace surf::test
