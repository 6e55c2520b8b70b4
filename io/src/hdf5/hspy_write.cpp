// SPDX-License-Identifier: GPL-3.0-or-later
// Files of HyperSpy (https://hyperspy.org, version 3.1 of its format): HDF5, one signal per
// channel.
#include <hdf5.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hdf5_library.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

/// Something of HDF5 that is closed again. Throws FileError where HDF5 gave none.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t), const std::string& file) : id_(id), close_(close) {
    if (id < 0)
      throw FileError(file, "HDF5 cannot write it", "Check the disk's free space and the name");
  }
  ~Id() { close_(id_); }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

class Writer {
 public:
  explicit Writer(std::string file) : file_(std::move(file)) {}

  Id group(hid_t in, const std::string& name) const {
    return {H5Gcreate2(in, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, file_};
  }

  void text(hid_t of, const std::string& name, const std::string& value) const {
    const Id type(H5Tcopy(H5T_C_S1), H5Tclose, file_);
    check(H5Tset_size(type, H5T_VARIABLE));
    check(H5Tset_cset(type, H5T_CSET_UTF8));
    const char* const data = value.c_str();
    attribute(of, name, type, &data);
  }
  void number(hid_t of, const std::string& name, double value) const {
    attribute(of, name, H5T_NATIVE_DOUBLE, &value);
  }
  void count(hid_t of, const std::string& name, long long value) const {
    attribute(of, name, H5T_NATIVE_LLONG, &value);
  }
  /// As numpy's booleans are kept.
  void truth(hid_t of, const std::string& name, bool value) const {
    const Id type(H5Tenum_create(H5T_NATIVE_INT8), H5Tclose, file_);
    const signed char no = 0, yes = 1, data = value ? 1 : 0;
    check(H5Tenum_insert(type, "FALSE", &no));
    check(H5Tenum_insert(type, "TRUE", &yes));
    attribute(of, name, type, &data);
  }

  void axis(hid_t of, int number_of_axis, const char* name, int size, double pitch_nm) const {
    const Id axis = group(of, "axis-" + std::to_string(number_of_axis));
    text(axis, "_type", "UniformDataAxis");
    text(axis, "name", name);
    text(axis, "units", "nm");
    number(axis, "scale", pitch_nm);
    number(axis, "offset", 0);
    count(axis, "size", size);
    truth(axis, "navigate", false);
    truth(axis, "is_binned", false);
  }

  /// The top row first, as images are shown.
  void pixels(hid_t of, const Grid<float>& values) const {
    const auto width = std::size_t(values.width()), height = std::size_t(values.height());
    std::vector<float> turned(values.size());
    for (std::size_t y = 0; y < height; ++y)
      std::copy_n(values.data().data() + (height - 1 - y) * width, width,
                  turned.data() + y * width);
    const hsize_t extent[] = {height, width};
    const Id space(H5Screate_simple(2, extent, nullptr), H5Sclose, file_);
    const Id data(
        H5Dcreate2(of, "data", H5T_IEEE_F32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose, file_);
    check(H5Dwrite(data, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, turned.data()));
  }

  void check(herr_t done) const {
    if (done < 0)
      throw FileError(file_, "HDF5 cannot write it", "Check the disk's free space and the name");
  }

 private:
  void attribute(hid_t of, const std::string& name, hid_t type, const void* data) const {
    const Id space(H5Screate(H5S_SCALAR), H5Sclose, file_);
    const Id there(H5Acreate2(of, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                   file_);
    check(H5Awrite(there, type, data));
  }

  std::string file_;
};

/// What HyperSpy has names for: the energy in keV, the tilt in degrees.
void write_instrument(const Writer& out, hid_t metadata,
                      const std::map<std::string, std::string>& made) {
  const auto value = [&](const char* key) -> std::optional<double> {
    const auto found = made.find(key);
    double number = 0;
    if (found == made.end()) return std::nullopt;
    const std::string& text = found->second;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
    return read.ec == std::errc() ? std::optional(number) : std::nullopt;
  };
  const auto energy_ev = value("beam.energy_ev"), tilt_deg = value("beam.tilt_deg");
  if (!energy_ev) return;
  const Id instrument = out.group(metadata, "Acquisition_instrument");
  const Id sem = out.group(instrument, "SEM");
  out.number(sem, "beam_energy", *energy_ev / 1000);
  if (!tilt_deg) return;
  const Id stage = out.group(sem, "Stage");
  out.number(stage, "tilt_alpha", *tilt_deg);
}

void write_signal(const Writer& out, hid_t experiments, const Channel& channel,
                  const Image& image) {
  std::string name = channel.name;
  std::ranges::replace(name, '/', '_');
  const Id signal = out.group(experiments, name);
  out.text(signal, "package", "hyperspy");
  out.text(signal, "package_version", "1.7.3");
  out.pixels(signal, channel.values);
  out.axis(signal, 0, "y", image.height(), image.pitch_y_nm);
  out.axis(signal, 1, "x", image.width(), image.pitch_x_nm);
  const Id metadata = out.group(signal, "metadata");
  const Id general = out.group(metadata, "General");
  out.text(general, "title", channel.name);
  const Id about = out.group(metadata, "Signal");
  out.text(about, "signal_type", "");
  out.text(about, "quantity",
           channel.name +
               (channel.unit.empty() || channel.unit == "1" ? "" : " (" + channel.unit + ")"));
  write_instrument(out, metadata, image.metadata);
  const Id original = out.group(signal, "original_metadata");
  for (const auto& [key, value] : image.metadata) out.text(original, key, value);
  out.number(original, "origin_x_nm", image.origin_x_nm);
  out.number(original, "origin_y_nm", image.origin_y_nm);
}

void write_hspy(const std::filesystem::path& target, const std::string& file, const Image& image) {
  static std::mutex one_at_a_time;  // HDF5 need not be built for threads
  const std::lock_guard lock(one_at_a_time);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // our own messages
  const Writer out(file);
  const Id whole(H5Fcreate(target.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose,
                 file);
  out.text(whole, "file_format", "HyperSpy");
  out.text(whole, "file_format_version", "3.1");
  {
    const Id experiments = out.group(whole, "Experiments");
    for (const Channel& channel : image.channels) write_signal(out, experiments, channel, image);
  }
  out.check(H5Fflush(whole, H5F_SCOPE_LOCAL));
}

constexpr Hdf5Library table{write_hspy};

}  // namespace
}  // namespace surf::io

SEMSURF_MODULE(hdf5, surf::io::table)
