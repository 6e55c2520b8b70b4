// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/results/serialize.h"

#include <bit>
#include <type_traits>
#include <utility>

#include "surf/core/error.h"

namespace surf::mc {

namespace {

// Whole numbers take seven bits a byte, lowest first, the eighth says that more follow. The sign is
// the lowest bit, so that small numbers of either sign are short.
class Packer {
 public:
  void number(std::int64_t value) {
    auto bits = (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63);
    for (; bits >= 0x80; bits >>= 7) bytes.push_back(static_cast<char>(bits | 0x80));
    bytes.push_back(static_cast<char>(bits));
  }
  void number(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int shift = 0; shift < 64; shift += 8) bytes.push_back(static_cast<char>(bits >> shift));
  }
  std::size_t length(std::size_t value) {
    number(static_cast<std::int64_t>(value));
    return value;
  }
  void expect(std::size_t /*numbers*/) {}

  std::string bytes;
};

class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : rest_(bytes) {}

  void number(std::int64_t& value) {
    std::uint64_t bits = 0;
    for (int shift = 0;; shift += 7) {
      const std::uint64_t byte = next();
      if (shift == 63 && byte > 1) refuse();
      bits |= (byte & 0x7f) << shift;
      if (byte < 0x80) break;
    }
    value = static_cast<std::int64_t>((bits >> 1) ^ (~(bits & 1) + 1));
  }
  void number(double& value) {
    std::uint64_t bits = 0;
    for (int shift = 0; shift < 64; shift += 8) bits |= std::uint64_t{next()} << shift;
    value = std::bit_cast<double>(bits);
  }
  std::size_t length(std::size_t) {
    std::int64_t value = 0;
    number(value);
    if (value < 0) refuse();
    expect(static_cast<std::size_t>(value));
    return static_cast<std::size_t>(value);
  }
  // No more of anything than the bytes that are left can hold: each number takes one at least.
  void expect(std::size_t numbers) const {
    if (numbers > rest_.size()) refuse();
  }
  void finish() const {
    if (!rest_.empty()) refuse();
  }

 private:
  [[noreturn]] static void refuse() {
    throw InvalidInput("packed tally", "its bytes are damaged or cut off",
                       "Simulate the unit anew");
  }
  unsigned char next() {
    if (rest_.empty()) refuse();
    const auto byte = static_cast<unsigned char>(rest_.front());
    rest_.remove_prefix(1);
    return byte;
  }

  std::string_view rest_;
};

// One walk through the fields serves both directions: `Tally` is const for packing.

template <class Way, class EnergySum>
void energy(Way& way, EnergySum& sum) {
  std::int64_t parts = sum.parts();
  way.number(parts);
  if constexpr (!std::is_const_v<EnergySum>) sum = EnergySum::of_parts(parts);
}

template <class Way, class Balance>
void balance(Way& way, Balance& b) {
  for (auto* count : {&b.incident, &b.missed, &b.generated, &b.se, &b.bse, &b.transmitted,
                      &b.absorbed, &b.dropped, &b.steps, &b.rays, &b.handed_over})
    way.number(*count);
  for (auto& count : b.lost) way.number(count);
  for (auto* sum : {&b.incident_energy, &b.generated_energy, &b.escaped_energy, &b.deposited_energy,
                    &b.lost_energy})
    energy(way, *sum);
}

template <class Way, class Counts>
void counts(Way& way, Counts& c) {
  way.number(c.sum);
  way.number(c.squares);
}

template <class Way, class Histogram>
void histogram(Way& way, Histogram& h) {
  way.number(h.lower);
  way.number(h.upper);
  const std::size_t bins = way.length(h.bins.size());
  if constexpr (!std::is_const_v<Histogram>) h.bins.resize(bins);
  for (auto& bin : h.bins) counts(way, bin);
}

template <class Way, class Tally>
void walk(Way& way, Tally& t) {
  const std::size_t width = way.length(static_cast<std::size_t>(t.pixels.width()));
  const std::size_t height = way.length(static_cast<std::size_t>(t.pixels.height()));
  way.expect(width * height);
  const std::size_t detectors = way.length(t.counts.size());
  way.expect(width * height * detectors);
  const std::size_t odd = way.length(t.odd_counts.size());
  way.expect(width * height * odd);
  const std::size_t controls = way.length(t.controls.size());
  way.expect(width * height * controls);
  const std::size_t spectra = way.length(t.spectra.size());
  if constexpr (!std::is_const_v<Tally>) {
    const int w = static_cast<int>(width), h = static_cast<int>(height);
    t.pixels = Grid<PixelTally>(w, h);
    t.counts.assign(detectors, Grid<Counts>(w, h));
    t.odd_counts.assign(odd, Grid<Counts>(w, h));
    t.controls.assign(controls, Grid<Control>(w, h));
    t.spectra.resize(spectra);
  }
  for (auto& pixel : t.pixels.data()) {
    way.number(pixel.primaries);
    way.number(pixel.hits);
    auto model = static_cast<std::int64_t>(pixel.model);
    way.number(model);
    if constexpr (!std::is_const_v<Tally>) pixel.model = static_cast<PixelModel>(model);
  }
  for (auto* grids : {&t.counts, &t.odd_counts})
    for (auto& grid : *grids)
      for (auto& pixel : grid.data()) counts(way, pixel);
  for (auto& grid : t.controls)
    for (auto& c : grid.data())
      for (auto* value : {&c.mean, &c.standard_error, &c.variance_left}) way.number(*value);
  for (auto& s : t.spectra) {
    histogram(way, s.energy_ev);
    histogram(way, s.polar_deg);
    histogram(way, s.azimuth_deg);
  }
  balance(way, t.balance);
}

}  // namespace

std::string serialize(const UnitTally& tally) {
  Packer packer;
  walk(packer, tally);
  return std::move(packer.bytes);
}

UnitTally deserialize(std::string_view bytes) {
  Unpacker unpacker(bytes);
  UnitTally tally;
  walk(unpacker, tally);
  unpacker.finish();
  return tally;
}

}  // namespace surf::mc
