// SPDX-License-Identifier: GPL-3.0-or-later
#include "failure.h"

#include <exception>
#include <new>
#include <system_error>

#include "exit_codes.h"
#include "surf/core/error.h"
#include "terminal.h"

namespace surf::cli {

int report_failure() {
  try {
    throw;
  } catch (const UsageError& error) {
    print_error(error.what());
    return exit_usage;
  } catch (const Interrupted&) {
    print_note("stopped; nothing was written");
    return exit_interrupted;
  } catch (const std::bad_alloc&) {
    print_error("memory: there is not enough for this. Use fewer pixels or a smaller mesh");
  } catch (const std::system_error& error) {
    print_error(error.code() == std::errc::resource_unavailable_try_again
                    ? "threads: the system cannot start another one. Give `job.threads=1`, or "
                      "raise the limits of "
                      "processes and memory (ulimit -u, ulimit -v)"
                    : error.what());
  } catch (const std::exception& error) {
    print_error(error.what());
  }
  return exit_unusable;
}

}  // namespace surf::cli
