// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "surf/core/track.h"

namespace surf::io {

/// Writes electron tracks for ParaView: a VTP file (inline binary) with one polyline per track in
/// nm. Points carry `energy_ev` and `material`: the material of the piece that ends there; the
/// first point has that of the piece after it; -1 is vacuum. Lines carry `kind` (the number of the
/// TrackKind: absorbed 0, se 1, bse 2, transmitted 3, lost 4), `secondary`, `generation`,
/// `electron`, `number`, `parent`. Each entry of `metadata` becomes a text in the field data, an
/// empty value as "". The file appears under its name only when it is complete. Without tracks the
/// data set is empty. Throws UsageError for an extension other than .vtp, InvalidInput for an
/// invalid track, FileError, Unsupported if this build lacks VTK.
void write_tracks(const std::filesystem::path& path, std::span<const Track> tracks,
                  const std::map<std::string, std::string>& metadata = {});

/// Reads the files of `write_tracks`. Throws FileError.
std::vector<Track> read_tracks(const std::filesystem::path& path);

/// Throws what `write_tracks` would throw for the name or folder, before any work is spent.
void check_tracks_target(const std::filesystem::path& path);

}  // namespace surf::io
