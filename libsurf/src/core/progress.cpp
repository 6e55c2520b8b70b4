// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/progress.h"

#include "surf/core/error.h"

namespace surf {

void Watch::check() const {
  if (cancel && cancel->cancelled()) throw Interrupted();
}

void Watch::report(double done, double total) const {
  check();
  if (progress) progress(done, total);
}

Watch Watch::part(double from, double to) const {
  if (!progress) return {{}, cancel};
  return {[whole = progress, from, to](double done, double total) {
            whole(total > 0 ? from + (to - from) * done / total : from, 1);
          },
          cancel};
}

}  // namespace surf
