// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction_state.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace surf::workflow {
namespace {

constexpr char mark[] = "semsurf reconstruction 3\n";

/// Writes numbers as 8 bytes each, lowest first.
class Writer {
 public:
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
  std::string bytes = mark;
};

class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes), at_(sizeof mark - 1) {
    good_ = bytes.compare(0, at_, mark) == 0;
  }
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
  bool good_ = true;
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
  Writer out;
  write(out, state.surface);
  const Affine& m = state.sem_to_afm;
  for (const double value : {m.xx, m.xy, m.x0, m.yx, m.yy, m.y0, state.offset}) out.number(value);
  out.numbers(state.gains);
  out.numbers(state.tip_change);
  out.whole(state.scales.size());
  for (const ScaleReport& scale : state.scales) write(out, scale);
  return std::move(out.bytes);
}

std::optional<ReconstructionState> unpack(const std::string& bytes) {
  Reader in(bytes);
  ReconstructionState state;
  state.surface = read_field(in);
  Affine& m = state.sem_to_afm;
  for (double* value : {&m.xx, &m.xy, &m.x0, &m.yx, &m.yy, &m.y0, &state.offset})
    *value = in.number();
  state.gains = in.numbers();
  state.tip_change = in.numbers();
  const std::uint64_t scales = in.whole();
  for (std::uint64_t i = 0; in.good() && i < scales; ++i) state.scales.push_back(read_scale(in));
  if (!in.finished() || state.surface.z_nm.empty()) return std::nullopt;
  return state;
}

}  // namespace surf::workflow
