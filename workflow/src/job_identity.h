// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

#include "resolved_job.h"

namespace surf::workflow {

/// Everything that determines a simulation's tallies, unit by unit, as keys and values: two jobs of
/// the same identity may share a checkpoint. To `settings` (see `provenance`) it adds what an image
/// does not tell: the meshes and heights themselves, how work is cut into units, and the program.
using Identity = std::map<std::string, std::string>;
Identity identity_of(const ResolvedJob& job, const std::map<std::string, std::string>& settings);

/// Of the program that runs: another build may round differently. "unknown" where the system does
/// not show the program's own file; versions must do there.
const std::string& program_hash();

/// Lower-case hexadecimal SHA-256 of an identity.
std::string fingerprint(const Identity& identity);

/// In what two identities differ, for people: "electrons 100 there and 200 here, and 2 more", or
/// "the specimen"; empty if they do not.
std::string difference(const Identity& there, const Identity& here);

}  // namespace surf::workflow
