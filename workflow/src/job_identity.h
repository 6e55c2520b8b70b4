// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

#include "resolved_job.h"

namespace surf::workflow {

/// Everything that determines the tallies of a simulation's units, as keys and values. Two jobs
/// with the same identity may share a checkpoint. It extends `settings` (see `provenance`) by data
/// that an image does not record: the meshes and heights themselves, the division of the work into
/// units, and the program.
using Identity = std::map<std::string, std::string>;
Identity identity_of(const ResolvedJob& job, const std::map<std::string, std::string>& settings);

/// Hash of the running program: another build may round differently. "unknown" if the system does
/// not show the program's file; then versions must suffice.
const std::string& program_hash();

/// Lower-case hexadecimal SHA-256 of an identity.
std::string fingerprint(const Identity& identity);

/// The difference between two identities, for people: "electrons 100 there and 200 here, and 2
/// more", or "the specimen"; empty if they are equal.
std::string difference(const Identity& there, const Identity& here);

}  // namespace surf::workflow
