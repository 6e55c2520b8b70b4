// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/cascades/cascade_library.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include <fmt/format.h>
#include <sys/mman.h>

#include "cascades/cascade_check.h"
#include "cascades/cascade_format.h"
#include "cascades/cascade_recorder.h"
#include "cascades/cascade_sample.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "surf/mc/cascades/library_source.h"
#include "transport/detection.h"
#include "transport/endless.h"
#include "transport/random_streams.h"
#include "transport/transport.h"

namespace surf::mc {

namespace {

// Of all that is in a page from where its cascades start.
double page_reach_nm(const CascadePage& page) {
  double farthest = 0;
  for (std::size_t i = 0; i + 1 < page.starts.size(); ++i) {
    const NodeView root(page.words.data() + page.starts[i]);
    const double unit = power_of_two(root.node.exponent);
    const auto distance = [&](double x, double y, double z) {
      return unit * std::sqrt(x * x + y * y + z * z);
    };
    for (int k = 0; root.node.level == 0 && k < root.node.count; ++k) {
      const PackedVertex v = read_vertex(root.vertex(k));
      farthest = std::max(farthest, distance(v.x, v.y, v.z));
    }
    for (int k = 0; k < root.children(); ++k) {
      const auto s = std::bit_cast<PackedSphere>(root.spheres()[k]);
      farthest = std::max(farthest, distance(s.x, s.y, s.z) + unit * s.radius);
    }
  }
  return farthest;
}

// Streams of libraries are apart from those of pixels.

class Maker {
 public:
  explicit Maker(const CascadeLibrary& library)
      : settings_(library.settings()), media_{&library.medium()},
        recorder_(EnergyCode(library.medium().cutoff_ev(), settings_.start_energy_ev),
                  library.medium().barrier_ev(), library.medium().loses_in_events()),
        detection_(default_detectors(), {}, false),
        transport_(endless_, media_, settings_.physics.barrier, false, recorder_, detection_,
                   balance_) {}

  void make(std::uint64_t number, CascadePage& out) {
    RandomStream random(settings_.seed, random_streams::cascades, number);
    transport_.run({}, {0, 0, -1}, settings_.start_energy_ev, 0, random);
    out.starts.push_back(static_cast<std::uint32_t>(out.words.size()));
    recorder_.finish(out.words);
    balance_ = {};
  }

 private:
  const CascadeSettings& settings_;
  std::vector<const Medium*> media_;
  Endless endless_;
  CascadeRecorder recorder_;
  Detection detection_;
  Balance balance_;
  Transport<Endless, CascadeRecorder> transport_;
};

}  // namespace

CascadeLibrary::CascadeLibrary(CascadeSettings settings)
    : settings_(std::move(settings)),
      medium_(std::make_shared<Medium>(make_medium(settings_.material, settings_.physics))) {
  if (!can_replay(*medium_))
    throw UsageError("cascade library", "without a loss cascades never end and cannot be stored",
                     "Choose loss=joy-luo or inelastic=dielectric, or direct simulation");
  if (!(settings_.start_energy_ev > medium_->cutoff_ev()) ||
      settings_.start_energy_ev > 2 * max_beam_energy_ev)
    throw UsageError(
        "cascade library",
        fmt::format("cascades cannot start at {:g} eV", settings_.start_energy_ev),
        fmt::format("Choose an energy above the cutoff of {:g} eV", medium_->cutoff_ev()));
}

std::size_t CascadeLibrary::bytes() const {
  std::size_t bytes = 0;
  for (const auto& page : pages_) bytes += page->words.size() * 8 + page->starts.size() * 4;
  return bytes;
}

namespace {

// Cascades are read here and there all over a library: with large memory pages the processor finds
// them without searching its tables. Before the memory is first used.
void ask_for_large_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t page = 4096;
  const auto from = (reinterpret_cast<std::uintptr_t>(begin) + page - 1) & ~(page - 1);
  const auto to = (reinterpret_cast<std::uintptr_t>(begin) + bytes) & ~(page - 1);
  if (to > from) madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);
#endif
}

}  // namespace

namespace {

// Makes pages on some threads. Who finishes a page's last unit puts it together, while the others
// are at the next page; what units lay in is used again, as getting memory takes as long as filling
// it.
class PageMaker {
 public:
  PageMaker(const CascadeLibrary& library, std::size_t first_page, std::size_t pages)
      : library_(library), first_page_(first_page), drafts_(pages) {}

  /// The pages, up to the first that was not finished when cancelled. Progress counts cascades.
  std::vector<std::shared_ptr<CascadePage>> make(int threads, const Watch& watch) {
    threads = resolve_threads(threads);
    std::vector<std::unique_ptr<Maker>> makers(static_cast<std::size_t>(threads));
    parallel_for(drafts_.size() * units_per_page, threads, [&](std::size_t unit, int worker) {
      if (watch.cancelled()) return;
      auto& maker = makers[static_cast<std::size_t>(worker)];
      if (!maker) maker = std::make_unique<Maker>(library_);
      Draft& draft = drafts_[unit / units_per_page];
      CascadePage& part = draft.units[unit % units_per_page];
      part = blank();
      const std::size_t first = first_page_ * CascadeLibrary::page_cascades + unit * unit_cascades;
      for (std::size_t i = 0; i < unit_cascades; ++i) maker->make(first + i, part);
      if (is_last(draft, watch.progress)) finish(draft);
    });
    std::vector<std::shared_ptr<CascadePage>> pages;
    for (Draft& draft : drafts_) {
      if (!draft.page) break;
      pages.push_back(std::move(draft.page));
    }
    return pages;
  }

 private:
  static constexpr std::size_t unit_cascades = 32;
  static constexpr std::size_t units_per_page = CascadeLibrary::page_cascades / unit_cascades;
  static_assert(CascadeLibrary::page_cascades % unit_cascades == 0);

  struct Draft {
    std::array<CascadePage, units_per_page> units;
    std::size_t done = 0;
    std::shared_ptr<CascadePage> page;
  };

  CascadePage blank() {
    const std::lock_guard lock(mutex_);
    if (blanks_.empty()) return {};
    CascadePage blank = std::move(blanks_.back());
    blanks_.pop_back();
    return blank;
  }

  // Counts a unit; whether it was the page's last.
  bool is_last(Draft& draft, const ProgressCallback& progress) {
    const std::lock_guard lock(mutex_);
    cascades_ += unit_cascades;
    if (progress)
      progress(static_cast<double>(cascades_),
               static_cast<double>(drafts_.size() * CascadeLibrary::page_cascades));
    return ++draft.done == units_per_page;
  }

  void finish(Draft& draft) {
    auto page = std::make_shared<CascadePage>();
    std::size_t words = 0;
    for (const CascadePage& unit : draft.units) words += unit.words.size();
    page->words.reserve(words);
    ask_for_large_pages(page->words.data(), words * sizeof(std::uint64_t));
    page->starts.reserve(CascadeLibrary::page_cascades + 1);
    for (const CascadePage& unit : draft.units) {
      const auto base = static_cast<std::uint32_t>(page->words.size());
      for (const std::uint32_t start : unit.starts) page->starts.push_back(base + start);
      page->words.insert(page->words.end(), unit.words.begin(), unit.words.end());
    }
    page->starts.push_back(static_cast<std::uint32_t>(page->words.size()));
    draft.page = std::move(page);
    const std::lock_guard lock(mutex_);
    for (CascadePage& unit : draft.units) {
      unit.words.clear();
      unit.starts.clear();
      blanks_.push_back(std::move(unit));
    }
  }

  const CascadeLibrary& library_;
  std::size_t first_page_;
  std::vector<Draft> drafts_;
  std::mutex mutex_;  // of all that follows, and of the drafts' counts
  std::size_t cascades_ = 0;
  std::vector<CascadePage> blanks_;  // empty, with memory
};

}  // namespace

CascadePage CascadeLibrary::make_page(std::size_t number, int threads, const Watch& watch) const {
  const auto pages = PageMaker(*this, number, 1).make(threads, watch);
  watch.check();
  return std::move(*pages.front());
}

void CascadeLibrary::add_page(std::shared_ptr<const CascadePage> page) {
  if (!is_page(*page))
    throw InvalidInput("cascade library", "this is not a page of cascades", "Build it again");
  reaches_nm_.push_back(page_reach_nm(*page));
  pages_.push_back(std::move(page));
}

bool CascadeLibrary::would_make(const CascadePage& page, std::size_t number,
                                std::size_t sample_bytes) const {
  Maker maker(*this);
  CascadePage sample;
  for (std::size_t i = 0; i < page_cascades && sample.words.size() * 8 < sample_bytes; ++i)
    maker.make(number * page_cascades + i, sample);
  return sample.starts.size() <= page.starts.size() && sample.words.size() <= page.words.size() &&
         std::equal(sample.starts.begin(), sample.starts.end(), page.starts.begin()) &&
         std::equal(sample.words.begin(), sample.words.end(), page.words.begin());
}

CascadeLibrary CascadeLibrary::first(std::size_t pages) const {
  CascadeLibrary library = *this;
  library.pages_.resize(std::min(pages, pages_.size()));
  library.reaches_nm_.resize(library.pages_.size());
  return library;
}

void CascadeLibrary::grow(std::size_t cascades, int threads, const Watch& watch) {
  watch.check();
  const std::size_t old = this->cascades();
  if (old >= cascades) return;
  const std::size_t pages = (cascades - old + page_cascades - 1) / page_cascades;
  const auto report = [&](double made, double) {
    watch.progress(std::min(static_cast<double>(old) + made, static_cast<double>(cascades)),
                   static_cast<double>(cascades));
  };
  PageMaker maker(*this, this->pages(), pages);
  for (auto& page :
       maker.make(threads, {watch.progress ? report : ProgressCallback{}, watch.cancel})) {
    reaches_nm_.push_back(page_reach_nm(*page));
    pages_.push_back(std::move(page));
  }
  watch.check();
}

std::shared_ptr<const CascadeLibrary> FreshLibraries::library(const CascadeSettings& settings,
                                                              std::size_t cascades, int threads,
                                                              const Watch& watch) {
  CascadeLibrary& library =
      kept_.try_emplace(cascade_page_key(settings, 0), settings).first->second;
  library.grow(cascades, threads, watch);
  constexpr std::size_t page = CascadeLibrary::page_cascades;
  return std::make_shared<const CascadeLibrary>(library.first((cascades + page - 1) / page));
}

double CascadeLibrary::reach_nm() const {
  if (medium_->loses_continuously()) return medium_->range_nm(settings_.start_energy_ev);
  return reaches_nm_.empty() ? 0 : *std::ranges::max_element(reaches_nm_);
}

bool can_replay(const Medium& medium) {
  return medium.loses_continuously() || medium.loses_in_events();
}

bool can_replay(const Physics& physics, std::span<const Material> materials) {
  return std::ranges::any_of(
      materials, [&](const Material& m) { return can_replay(make_medium(m, physics)); });
}

namespace {

// Adds up a node; `primary` collects its depth and extent.
void survey(const NodeView& view, bool primary, CascadeStatistics& out, double& depth,
            double& extent) {
  const PackedNode& node = view.node;
  for (int i = 0; i < view.children(); ++i)
    survey(NodeView(view.child(i)), primary && node.level > 0, out, depth, extent);
  if (node.level > 0) return;
  out.segments_per_cascade += node.count;
  out.electrons_per_cascade += view.children();
  for (int i = 0; primary && i < node.count; ++i) {
    const PackedVertex v = read_vertex(view.vertex(i));
    const Vec3 p =
        Vec3{double(v.x), double(v.y), double(v.z)} * double(power_of_two(node.exponent));
    depth = std::max(depth, -p.z);
    extent = std::max(extent, length(p));
  }
}

}  // namespace

CascadeSample sample_cascades(const CascadeSettings& settings) {
  constexpr std::size_t fewest = 4, enough_words = (std::size_t{1} << 20) / 8;
  const CascadeLibrary library(settings);
  Maker maker(library);
  CascadePage page;
  std::size_t made = 0;
  while (made < fewest ||
         (page.words.size() < enough_words && made < CascadeLibrary::page_cascades))
    maker.make(made++, page);
  CascadeStatistics counted;
  double depth = 0, extent = 0;
  for (const std::uint32_t start : page.starts)
    survey(NodeView(page.words.data() + start), false, counted, depth, extent);
  const auto n = static_cast<double>(made);
  return {8.0 * static_cast<double>(page.words.size()) / n + 4, counted.segments_per_cascade / n};
}

CascadeStatistics describe(const CascadeLibrary& library, std::size_t cascades) {
  CascadeStatistics out;
  out.cascades = std::min(cascades, library.cascades());
  for (std::size_t i = 0; i < out.cascades; ++i) {
    const auto words = library.cascade(i);
    double depth = 0, extent = 0;
    out.electrons_per_cascade += 1;
    survey(NodeView(words.data()), true, out, depth, extent);
    out.primary_depth_nm.push_back(depth);
    out.primary_extent_nm.push_back(extent);
    out.bytes_per_cascade += static_cast<double>(words.size_bytes());
  }
  const double n = static_cast<double>(std::max<std::size_t>(out.cascades, 1));
  out.electrons_per_cascade /= n;
  out.segments_per_cascade /= n;
  out.bytes_per_cascade /= n;
  return out;
}

}  // namespace surf::mc
