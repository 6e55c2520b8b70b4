// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction_state.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

namespace surf::workflow {
namespace {

constexpr std::string_view mark = "semsurf reconstruction 6\n",
                           corrections_mark = "semsurf corrections 2\n";

/// Writes numbers as 8 bytes each, lowest first.
class Writer {
 public:
  explicit Writer(std::string_view first) : bytes(first) {}
  void number(double value) { whole(std::bit_cast<std::uint64_t>(value)); }
  void whole(std::uint64_t value) {
    for (int shift = 0; shift < 64; shift += 8) bytes += static_cast<char>(value >> shift & 0xff);
  }
  void text(const std::string& value) {
    whole(value.size());
    bytes += value;
  }
  template <class Numbers>
  void numbers(const Numbers& values) {
    whole(values.size());
    for (const auto value : values) number(static_cast<double>(value));
  }
  std::string bytes;
};

class Reader {
 public:
  Reader(const std::string& bytes, std::string_view first)
      : bytes_(bytes), at_(first.size()), good_(bytes.starts_with(first)) {}
  double number() { return std::bit_cast<double>(whole()); }
  std::uint64_t whole() {
    if (!enough(8)) return 0;
    std::uint64_t value = 0;
    for (int i = 0; i < 8; ++i)
      value |= std::uint64_t{static_cast<unsigned char>(bytes_[at_++])} << 8 * i;
    return value;
  }
  int small() {
    const std::uint64_t value = whole();
    good_ = good_ && value <= std::numeric_limits<int>::max();
    return good_ ? static_cast<int>(value) : 0;
  }
  std::string text() {
    const std::uint64_t size = whole();
    if (!enough(size)) return {};
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }
  std::vector<double> numbers() {
    const std::uint64_t size = whole();
    good_ = good_ && size <= (bytes_.size() - at_) / 8;
    std::vector<double> values;
    for (std::uint64_t i = 0; good_ && i < size; ++i) values.push_back(number());
    return values;
  }
  bool finished() const { return good_ && at_ == bytes_.size(); }
  bool good() const { return good_; }

 private:
  bool enough(std::uint64_t size) { return good_ = good_ && size <= bytes_.size() - at_; }

  const std::string& bytes_;
  std::size_t at_;
  bool good_;
};

void write(Writer& out, const ResidualReport& r) {
  for (const double value : {r.mean, r.deviation, r.along, r.across}) out.number(value);
  out.whole(static_cast<std::uint64_t>(r.pixels));
  out.whole(r.like_noise);
}

ResidualReport read_residual(Reader& in) {
  ResidualReport r;
  for (double* value : {&r.mean, &r.deviation, &r.along, &r.across}) *value = in.number();
  r.pixels = static_cast<std::int64_t>(in.whole());
  r.like_noise = in.whole() != 0;
  return r;
}

void write(Writer& out, const ScaleReport& s) {
  for (const double value :
       {s.sigma_px, s.curvature_prior_per_nm, s.afm, s.sem, s.prior, s.gradient_norm})
    out.number(value);
  for (const int value : {s.iterations, s.evaluations, s.products, s.factors, s.double_factors})
    out.whole(static_cast<std::uint64_t>(value));
  out.text(s.ended);
  write(out, s.afm_residual);
  write(out, s.sem_residual);
}

ScaleReport read_scale(Reader& in) {
  ScaleReport s;
  for (double* value :
       {&s.sigma_px, &s.curvature_prior_per_nm, &s.afm, &s.sem, &s.prior, &s.gradient_norm})
    *value = in.number();
  for (int* value : {&s.iterations, &s.evaluations, &s.products, &s.factors, &s.double_factors})
    *value = in.small();
  s.ended = in.text();
  s.afm_residual = read_residual(in);
  s.sem_residual = read_residual(in);
  return s;
}

void write(Writer& out, const HeightField& f) {
  out.whole(static_cast<std::uint64_t>(f.z_nm.width()));
  out.whole(static_cast<std::uint64_t>(f.z_nm.height()));
  for (const double value : {f.pitch_x_nm, f.pitch_y_nm, f.origin_x_nm, f.origin_y_nm})
    out.number(value);
  out.numbers(f.z_nm.data());
  out.numbers(f.valid.data());
}

HeightField read_field(Reader& in) {
  HeightField f;
  const int width = in.small(), height = in.small();
  for (double* value : {&f.pitch_x_nm, &f.pitch_y_nm, &f.origin_x_nm, &f.origin_y_nm})
    *value = in.number();
  const std::vector<double> z = in.numbers(), valid = in.numbers();
  if (!in.good() || z.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    return {};
  f.z_nm = Grid<double>(width, height);
  f.z_nm.data() = z;
  if (valid.size() == z.size()) {
    f.valid = Mask(width, height);
    for (std::size_t i = 0; i < z.size(); ++i) f.valid.data()[i] = valid[i] != 0;
  }
  return f;
}

}  // namespace

std::string pack(const ReconstructionState& state) {
  Writer out(mark);
  write(out, state.surface);
  const Affine& m = state.sem_to_afm;
  for (const double value : {m.xx, m.xy, m.x0, m.yx, m.yy, m.y0, state.offset, state.blur_px2,
                             state.film_nm, state.scan_drift_px.x, state.scan_drift_px.y})
    out.number(value);
  out.numbers(state.gains);
  out.numbers(state.tip_change);
  out.whole(state.scales.size());
  for (const ScaleReport& scale : state.scales) write(out, scale);
  out.whole(state.views.size());
  for (const ViewState& view : state.views) {
    out.numbers(view.pose_change);
    out.numbers(view.gains);
    out.number(view.offset);
  }
  return std::move(out.bytes);
}

std::optional<ReconstructionState> unpack(const std::string& bytes) {
  Reader in(bytes, mark);
  ReconstructionState state;
  state.surface = read_field(in);
  Affine& m = state.sem_to_afm;
  for (double* value : {&m.xx, &m.xy, &m.x0, &m.yx, &m.yy, &m.y0, &state.offset, &state.blur_px2,
                        &state.film_nm, &state.scan_drift_px.x, &state.scan_drift_px.y})
    *value = in.number();
  state.gains = in.numbers();
  state.tip_change = in.numbers();
  const std::uint64_t scales = in.whole();
  for (std::uint64_t i = 0; in.good() && i < scales; ++i) state.scales.push_back(read_scale(in));
  const std::uint64_t views = in.whole();
  for (std::uint64_t i = 0; in.good() && i < views; ++i) {
    ViewState view{in.numbers(), in.numbers(), 0};
    view.offset = in.number();
    state.views.push_back(std::move(view));
  }
  if (!in.finished() || state.surface.z_nm.empty()) return std::nullopt;
  return state;
}

namespace {

void write(Writer& out, const ModelCorrection& correction) {
  out.whole(static_cast<std::uint64_t>(correction.primaries));
  out.number(correction.seconds);
  out.numbers(correction.mean);
  out.whole(correction.off.size());
  for (const ModelImages* images : {&correction.off, &correction.error})
    for (const Grid<double>& image : *images) {
      out.whole(static_cast<std::uint64_t>(image.width()));
      out.numbers(image.data());
    }
}

std::optional<ModelCorrection> read_correction(Reader& in) {
  ModelCorrection out;
  out.primaries = static_cast<std::int64_t>(in.whole());
  out.seconds = in.number();
  out.mean = in.numbers();
  const std::uint64_t channels = in.whole();
  for (ModelImages* images : {&out.off, &out.error})
    for (std::uint64_t c = 0; in.good() && c < channels; ++c) {
      const auto width = static_cast<std::size_t>(std::max(in.small(), 1));
      std::vector<double> values = in.numbers();
      Grid<double> image(static_cast<int>(width), static_cast<int>(values.size() / width));
      if (image.size() != values.size()) return std::nullopt;
      image.data() = std::move(values);
      images->push_back(std::move(image));
    }
  return in.good() ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace

std::string pack(const std::vector<ModelCorrection>& corrections) {
  Writer out(corrections_mark);
  out.whole(corrections.size());
  for (const ModelCorrection& correction : corrections) write(out, correction);
  return std::move(out.bytes);
}

std::optional<std::vector<ModelCorrection>> unpack_corrections(const std::string& bytes) {
  Reader in(bytes, corrections_mark);
  std::vector<ModelCorrection> out;
  const std::uint64_t images = in.whole();
  for (std::uint64_t i = 0; in.good() && i < images; ++i) {
    std::optional<ModelCorrection> one = read_correction(in);
    if (!one) return std::nullopt;
    out.push_back(std::move(*one));
  }
  if (!in.finished()) return std::nullopt;
  return out;
}

}  // namespace surf::workflow
