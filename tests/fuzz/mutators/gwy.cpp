// SPDX-License-Identifier: GPL-3.0-or-later
// Gwyddion's files are trees of components (io/src/afm/gwy_file.cpp): the sizes of all objects
// around a change have to follow it.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "mutators.h"

namespace surf::test {
namespace {

struct Object;

struct Component {
  std::string name;
  char type = 0;
  std::string value;            ///< of everything but objects
  std::vector<Object> objects;  ///< of 'o' and 'O'
};

struct Object {
  std::string type;
  std::vector<Component> components;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  bool good() const { return good_; }
  bool at_end() const { return bytes_.empty(); }

  std::string take(std::size_t size) {
    if (size > bytes_.size()) return fail();
    std::string taken(bytes_.substr(0, size));
    bytes_.remove_prefix(size);
    return taken;
  }
  std::string text() {
    const std::size_t end = bytes_.find('\0');
    if (end == std::string_view::npos) return fail();
    std::string taken = take(end);
    take(1);
    return taken;
  }
  std::uint32_t count() {
    std::uint32_t value = 0;
    const std::string taken = take(4);
    for (std::size_t i = 0; i < taken.size(); ++i)
      value |= std::uint32_t{static_cast<unsigned char>(taken[i])} << 8 * i;
    return value;
  }
  Object object(int depth) {
    Object read{text(), {}};
    const std::size_t size = count();
    if (size > bytes_.size()) fail();
    Reader inside(bytes_.substr(0, size));
    bytes_.remove_prefix(std::min(size, bytes_.size()));
    constexpr int deepest = 16;
    while (good_ && inside.good() && !inside.at_end() && depth < deepest)
      read.components.push_back(inside.component(depth));
    good_ = good_ && inside.good() && inside.at_end();
    return read;
  }

 private:
  Component component(int depth) {
    Component read{text(), 0, {}, {}};
    const std::string type = take(1);
    read.type = type.empty() ? '\0' : type[0];
    const bool is_array = read.type >= 'A' && read.type <= 'Z';
    const std::uint32_t items = is_array ? count() : 1;
    switch (read.type | 0x20) {
      case 'o':
        for (std::uint32_t i = 0; good_ && i < items; ++i)
          read.objects.push_back(object(depth + 1));
        break;
      case 's':
        for (std::uint32_t i = 0; good_ && i < items; ++i) read.value += text() + '\0';
        break;
      case 'b':
      case 'c':
        read.value = take(items);
        break;
      case 'i':
        read.value = take(std::size_t{4} * items);
        break;
      case 'd':
      case 'q':
        read.value = take(std::size_t{8} * items);
        break;
      default:
        fail();
    }
    return read;
  }
  std::string fail() {
    good_ = false;
    bytes_ = {};
    return {};
  }

  std::string_view bytes_;
  bool good_ = true;
};

std::string little(std::size_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i);
  return bytes;
}

std::size_t items_of(const Component& c) {
  switch (c.type) {
    case 'S': {
      std::size_t texts = 0;
      for (const char letter : c.value) texts += letter == '\0';
      return texts;
    }
    case 'I':
      return c.value.size() / 4;
    case 'D':
    case 'Q':
      return c.value.size() / 8;
    case 'O':
      return c.objects.size();
    default:
      return c.value.size();
  }
}

std::string bytes_of(const Object& object) {
  std::string inside;
  for (const Component& c : object.components) {
    inside += c.name + '\0' + c.type;
    if (c.type >= 'A' && c.type <= 'Z') inside += little(items_of(c));
    inside += c.value;
    for (const Object& child : c.objects) inside += bytes_of(child);
  }
  return object.type + '\0' + little(inside.size()) + inside;
}

void change(Object& object, Chance& chance) {
  auto& all = object.components;
  if (all.empty()) return;
  const std::size_t at = chance.below(all.size());
  Component& c = all[at];
  if (!c.objects.empty() && !chance.one_in(8))
    return change(c.objects[chance.below(c.objects.size())], chance);
  switch (chance.below(10)) {
    case 0:
      all.push_back(Component(c));
      break;
    case 1:
      all.erase(all.begin() + static_cast<std::ptrdiff_t>(at));
      break;
    case 2:
      c.name = mutate_text(c.name, chance);
      std::erase(c.name, '\0');
      break;
    default:
      if (c.type == 's')
        c.value = mutate_text(c.value.substr(0, c.value.size() - 1), chance) + '\0';
      else if (c.objects.empty()) c.value = mutate_numbers(c.value, chance);
  }
}

}  // namespace

std::string mutate_gwy(std::string_view content, Chance& chance) {
  constexpr std::string_view magic = "GWYP";
  if (!content.starts_with(magic) || chance.one_in(16)) return mutate_numbers(content, chance);
  Reader reader(content.substr(magic.size()));
  Object root = reader.object(0);
  if (!reader.good()) return mutate_numbers(content, chance);
  change(root, chance);
  return std::string(magic) + bytes_of(root);
}

}  // namespace surf::test
