// SPDX-License-Identifier: GPL-3.0-or-later
// Reads electron tracks from VTK's polylines, without VTK.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "surf/core/error.h"
#include "vtk_xml.h"
#include "vtp_format.h"

namespace surf::io {
namespace {

using Element = VtkXml::Element;

/// The numbers of an array, which must be as many as there are cells or points.
std::vector<double> numbers(const Element& piece, const char* kind, const char* name,
                            std::size_t count, std::size_t components = 1) {
  const auto owner = piece.child(kind);
  const auto array = owner ? owner->array(name) : std::nullopt;
  if (!array || array->is_text || array->components != components ||
      array->values.size() != components * count) {
    piece.fail(fmt::format("the array '{}' in {} does not have {} values", name, kind, count));
  }
  return array->values;
}

int whole(double value, const Element& piece) {
  const bool is_whole = std::abs(value) <= 0x1p31 - 1 && value == std::floor(value);
  if (!is_whole) piece.fail(fmt::format("{} is not a whole number", value));
  return static_cast<int>(value);
}

struct Lines {
  std::vector<double> corners, ends;
};

Lines read_lines(const Element& piece, std::size_t count) {
  const auto element = piece.child("Lines");
  const auto corners = element ? element->array("connectivity") : std::nullopt;
  const auto ends = element ? element->array("offsets") : std::nullopt;
  if (!corners || !ends || ends->values.size() < count) piece.fail("its lines are missing");
  return {corners->values, ends->values};
}

void read_piece(const Element& piece, std::vector<Track>& tracks) {
  const auto points = static_cast<std::size_t>(piece.count("NumberOfPoints"));
  const auto count = static_cast<std::size_t>(piece.count("NumberOfLines"));
  if (count == 0) return;
  const auto place = numbers(piece, "Points", "", points, 3);
  const auto energy = numbers(piece, "PointData", "energy_ev", points);
  const auto material = numbers(piece, "PointData", "material", points);
  const auto kind = numbers(piece, "CellData", "kind", count);
  const auto secondary = numbers(piece, "CellData", "secondary", count);
  const auto generation = numbers(piece, "CellData", "generation", count);
  const auto electron = numbers(piece, "CellData", "electron", count);
  const auto number = numbers(piece, "CellData", "number", count);
  const auto parent = numbers(piece, "CellData", "parent", count);
  const Lines lines = read_lines(piece, count);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double end = lines.ends[i];
    if (!(end >= static_cast<double>(begin) && end <= static_cast<double>(lines.corners.size()))) {
      piece.fail(fmt::format("line {} ends at corner {}", i, end));
    }
    Track track;
    const int what = whole(kind[i], piece);
    if (what < 0 || what > static_cast<int>(TrackKind::lost)) {
      piece.fail(fmt::format("{} is no kind of track", what));
    }
    track.kind = static_cast<TrackKind>(what);
    track.secondary = secondary[i] != 0;
    track.generation = whole(generation[i], piece);
    if (!(std::abs(electron[i]) <= 0x1p53)) {
      piece.fail(fmt::format("{} is no electron's number", electron[i]));
    }
    track.electron = static_cast<std::int64_t>(electron[i]);
    track.number = whole(number[i], piece);
    track.parent = whole(parent[i], piece);
    for (std::size_t c = begin; c < static_cast<std::size_t>(end); ++c) {
      const double corner = lines.corners[c];
      if (!(corner >= 0 && corner < static_cast<double>(points))) {
        piece.fail(fmt::format("a corner names point {} of {}", corner, points));
      }
      const auto p = static_cast<std::size_t>(corner);
      track.points_nm.push_back({place[3 * p], place[3 * p + 1], place[3 * p + 2]});
      track.energy_ev.push_back(energy[p]);
      if (c > begin)
        track.material.push_back(whole(material[p], piece));  // of the piece that ends there
    }
    begin = static_cast<std::size_t>(end);
    try {
      validate(track);
    } catch (const InvalidInput& error) {
      piece.fail(fmt::format("track {}: {}", i, error.reason()));
    }
    tracks.push_back(std::move(track));
  }
}

}  // namespace

std::vector<Track> parse_tracks(const std::string& file, std::string_view content) {
  const VtkXml xml(file, content, "PolyData");
  std::vector<Track> tracks;
  for (const Element& piece : xml.data().children("Piece")) read_piece(piece, tracks);
  return tracks;
}

}  // namespace surf::io
