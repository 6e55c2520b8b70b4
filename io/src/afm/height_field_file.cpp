// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/height_field_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "afm/scan_dispatch.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/sem_file.h"

namespace surf::io {
namespace {

std::string names_of(const Scan& scan, bool heights_only) {
  std::string names;
  int number = 0;
  for (const ScanChannel& channel : scan.channels) {
    ++number;
    if (heights_only && !holds_heights(channel)) continue;
    names += fmt::format("{}{} {}{}", names.empty() ? "" : ", ", number,
                         channel.name.empty() ? "(without a name)" : channel.name,
                         channel.z_unit.empty() ? "" : " in " + channel.z_unit);
  }
  return names;
}

/// By name, by name in small letters, by number, or the first of heights.
const ScanChannel& choose(const std::string& file, const Scan& scan, const std::string& wanted) {
  const auto& all = scan.channels;
  if (all.empty())
    throw FileError(file, "there is no image in it", "Give a scan with an image of heights");
  if (wanted.empty()) {
    const auto known = [](const ScanChannel& c) {
      return holds_heights(c) && scan_length_nm(c.z_unit);
    };
    auto found = std::find_if(all.begin(), all.end(), known);
    if (found == all.end()) found = std::find_if(all.begin(), all.end(), holds_heights);
    if (found != all.end()) return *found;
    throw InvalidInput(file,
                       fmt::format("none of its channels holds heights: {}", names_of(scan, false)),
                       "Choose one by name, and give the nm of its unit with `scan.height_unit`");
  }
  for (const ScanChannel& channel : all)
    if (channel.name == wanted) return channel;
  for (const ScanChannel& channel : all)
    if (lower_case(channel.name) == lower_case(wanted)) return channel;
  const auto number = scan_number(wanted);
  if (number && *number >= 1 && *number <= double(all.size()) && *number == std::floor(*number))
    return all[static_cast<std::size_t>(*number) - 1];
  throw UsageError(file, fmt::format("there is no channel '{}'", wanted),
                   fmt::format("Choose one by name or number: {}", names_of(scan, false)));
}

/// The nm of the channel's unit.
double z_unit_nm(const std::string& file, const Scan& scan, const ScanChannel& channel,
                 const HeightReadOptions& options, std::vector<std::string>& notes) {
  if (options.z_unit_nm && !(*options.z_unit_nm > 0 && std::isfinite(*options.z_unit_nm)))
    throw UsageError(file, fmt::format("{} nm cannot be the unit of heights", *options.z_unit_nm),
                     "Give a positive length");
  if (const auto nm = scan_length_nm(channel.z_unit)) {
    if (options.z_unit_nm)
      notes.push_back(fmt::format(
          "the file says that heights are in {}: `scan.height_unit` is not used", channel.z_unit));
    return *nm;
  }
  if (trimmed(channel.z_unit).empty()) {
    if (!options.z_unit_nm)
      notes.push_back("the file does not say the unit of its heights: nm are assumed");
    return options.z_unit_nm.value_or(1);
  }
  if (options.z_unit_nm) {
    notes.push_back(fmt::format("1 {} of '{}' is taken as {} nm", channel.z_unit, channel.name,
                                format_exact(*options.z_unit_nm)));
    return *options.z_unit_nm;
  }
  const std::string heights = names_of(scan, true);
  throw InvalidInput(
      file,
      fmt::format("its channel '{}' is in {}, which is no length", channel.name, channel.z_unit),
      heights.empty()
          ? fmt::format("Give the nm of one {} with `scan.height_unit`", channel.z_unit)
          : fmt::format("Choose heights ({}), or give the nm of one {} with `scan.height_unit`",
                        heights, channel.z_unit));
}

double pitch_nm(const std::string& file, char axis, double of_file, bool guessed,
                std::optional<double> given, std::vector<std::string>& notes) {
  if (given && !(*given > 0 && std::isfinite(*given)))
    throw UsageError(file, fmt::format("{} nm cannot be the distance of pixels", *given),
                     "Give a positive length");
  if (of_file > 0 && !guessed) {
    if (given && axis == 'x')
      notes.push_back(fmt::format("the file says that pixels are {} wide: `pixel_size` is not used",
                                  format_length(of_file)));
    return of_file;
  }
  if (given) return *given;
  if (axis == 'x')
    notes.push_back(
        of_file > 0
            ? fmt::format("the file gives lengths without a unit, taken as nm: a pixel is {} wide",
                          format_length(of_file))
            : std::string("the file does not say the size of its pixels: 1 nm is assumed"));
  return of_file > 0 ? of_file : 1;
}

/// From the channel's unit to nm; what is not finite becomes a hole.
void set_heights(const std::string& file, const ScanChannel& channel, double unit_nm,
                 HeightField& field) {
  field.z_nm = channel.values();
  Mask valid(field.z_nm.width(), field.z_nm.height(), 1);
  std::size_t holes = 0;
  for (std::size_t i = 0; i < valid.size(); ++i) {
    double& z = field.z_nm.data()[i];
    z *= unit_nm;
    if (std::isfinite(z)) continue;
    z = 0;
    valid.data()[i] = 0;
    ++holes;
  }
  if (holes == valid.size())
    throw InvalidInput(file, fmt::format("no pixel of its channel '{}' has a height", channel.name),
                       "Choose another channel or scan again");
  if (holes > 0) field.valid = std::move(valid);
}

}  // namespace

struct HeightFile::Content {
  std::string file;
  ScanFile opened;
};

HeightFile::HeightFile(const std::filesystem::path& path)
    : content_(std::make_unique<const Content>(Content{path.string(), open_scan(path)})) {}
HeightFile::~HeightFile() = default;
HeightFile::HeightFile(HeightFile&&) noexcept = default;
HeightFile& HeightFile::operator=(HeightFile&&) noexcept = default;

HeightFieldFile HeightFile::read(const HeightReadOptions& options) const {
  const std::string& file = content_->file;
  const Scan& scan = content_->opened.scan;
  const ScanChannel& channel = choose(file, scan, options.channel);
  HeightFieldFile result{{}, channel.name, scan.format, scan.metadata, scan.notes};
  for (const auto& [key, value] : channel.metadata) result.metadata.emplace(key, value);
  const double unit_nm = z_unit_nm(file, scan, channel, options, result.notes);
  result.field.pitch_x_nm = pitch_nm(file, 'x', channel.pitch_x_nm, channel.pitch_guessed,
                                     options.pitch_x_nm, result.notes);
  result.field.pitch_y_nm = pitch_nm(file, 'y', channel.pitch_y_nm, channel.pitch_guessed,
                                     options.pitch_y_nm, result.notes);
  result.field.origin_x_nm = scan.origin_x_nm;
  result.field.origin_y_nm = scan.origin_y_nm;
  set_heights(file, channel, unit_nm, result.field);
  validate(result.field, file.c_str());
  return result;
}

std::vector<HeightChannel> HeightFile::channels() const {
  std::vector<HeightChannel> channels;
  for (const ScanChannel& c : content_->opened.scan.channels)
    channels.push_back({c.name, c.z_unit, c.width, c.height, holds_heights(c)});
  return channels;
}

HeightFieldFile read_height_field(const std::filesystem::path& path,
                                  const HeightReadOptions& options) {
  if (!options.z_unit_nm) refuse_as_heights(path);
  return HeightFile(path).read(options);
}

std::vector<HeightChannel> height_channels(const std::filesystem::path& path) {
  return HeightFile(path).channels();
}

bool is_height_field_file(const std::filesystem::path& path) { return is_scan_file(path); }

}  // namespace surf::io
