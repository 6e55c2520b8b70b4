// SPDX-License-Identifier: GPL-3.0-or-later
#include "cascades/cascade_check.h"

#include "cascades/cascade_format.h"

namespace surf::mc {

namespace {

constexpr int coarsest_exponent = 30;  // 1e9 nm
constexpr int finest_exponent = -16;
// Nodes inside each other; at 30 keV there are a few dozen.
constexpr int most_nested = 1000;

class Check {
 public:
  explicit Check(const CascadePage& page) : words_(page.words.data()) {}

  /// Whether a branch fills [begin, end).
  bool branch(std::size_t begin, std::size_t end) {
    if (end - begin < header_words) return false;
    const PackedNode root = read_node(words_ + begin);
    std::uint32_t generated = 0;
    std::uint16_t energy = EnergyCode::energy_part(root.start.energy);
    return node(begin, end, root.level, root.exponent, energy, generated, 0);
  }

 private:
  // Whether a node of this level and exponent fills [begin, end), and starts with at most `energy`,
  // which becomes what it ends with. Adds what it generates.
  bool node(std::size_t begin, std::size_t end, int level, int exponent, std::uint16_t& energy,
            std::uint32_t& generated, int nested) {
    if (nested > most_nested || end - begin < header_words) return false;
    const NodeView view(words_ + begin);
    const PackedNode& n = view.node;
    if (n.level != level || n.words != end - begin || n.exponent != exponent ||
        n.exponent < finest_exponent || n.exponent > coarsest_exponent ||
        !(n.generated_ev >= 0 && n.generated_ev < 1e30f) ||
        EnergyCode::energy_part(n.start.energy) > energy)
      return false;
    if (n.count > (level > 0 ? nodes_per_node : segments_per_node) ||
        (level > 0 ? n.births != 0 || n.count == 0 : n.births >> n.count != 0))
      return false;
    const auto children = static_cast<std::size_t>(view.children());
    const std::size_t own =
        header_words + (level > 0 ? 0 : n.count) + children + (children + 1) / 2;
    if (end - begin < own) return false;
    energy = EnergyCode::energy_part(n.start.energy);
    std::uint32_t inside = 0;
    const bool sound = level > 0 ? nodes(view, begin + own, end, energy, inside, nested)
                                 : segments(view, begin + own, end, energy, inside, nested);
    if (!sound || inside != n.generated) return false;
    generated += inside;
    return true;
  }

  bool nodes(const NodeView& view, std::size_t at, std::size_t end, std::uint16_t& energy,
             std::uint32_t& generated, int nested) {
    for (int i = 0; i < view.node.count; ++i) {
      std::size_t next = 0;
      if (!child(view, i, at, end, next) ||
          !node(at, next, view.node.level - 1, view.node.exponent, energy, generated, nested + 1))
        return false;
      at = next;
    }
    return at == end;
  }

  bool segments(const NodeView& view, std::size_t at, std::size_t end, std::uint16_t& energy,
                std::uint32_t& generated, int nested) {
    int birth = 0;
    for (int i = 0; i < view.node.count; ++i) {
      const std::uint16_t here = EnergyCode::energy_part(read_vertex(view.vertex(i)).energy);
      if (here > energy) return false;
      std::uint16_t theirs = energy;  // a secondary has no more than the electron before the event
      energy = here;
      if (!(view.node.births & 1u << i)) continue;
      std::size_t next = 0;
      if (!child(view, birth++, at, end, next)) return false;
      const PackedNode root = read_node(words_ + at);
      ++generated;
      if (!node(at, next, root.level, root.exponent, theirs, generated, nested + 1)) return false;
      at = next;
    }
    return at == end;
  }

  // Whether child i begins at `at` and has its header before `end`; sets where it ends, at most
  // there.
  bool child(const NodeView& view, int i, std::size_t at, std::size_t end,
             std::size_t& next) const {
    if (view.child(i) != words_ + at || end - at < header_words) return false;
    const std::uint32_t words = read_node(words_ + at).words;
    next = at + words;
    return words >= header_words && words <= end - at;
  }

  const std::uint64_t* words_;
};

}  // namespace

bool is_page(const CascadePage& page) {
  const auto& s = page.starts;
  if (s.size() != CascadeLibrary::page_cascades + 1 || s.front() != 0 ||
      s.back() != page.words.size())
    return false;
  for (std::size_t i = 0; i + 1 < s.size(); ++i)
    if (s[i + 1] <= s[i] || s[i + 1] > page.words.size()) return false;
  Check check(page);
  for (std::size_t i = 0; i + 1 < s.size(); ++i)
    if (!check.branch(s[i], s[i + 1])) return false;
  return true;
}

}  // namespace surf::mc
