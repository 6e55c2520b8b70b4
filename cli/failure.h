// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace surf::cli {

/// For a catch block: prints what the exception that is being handled says, and returns the exit
/// code that it stands for.
int report_failure();

}  // namespace surf::cli
