// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/error.h"

namespace surf {
namespace {

std::string join(const std::string& subject, const std::string& reason, const std::string& remedy) {
  std::string text = subject.empty() ? reason : subject + ": " + reason;
  if (!remedy.empty()) text += ". " + remedy;
  return text;
}

}  // namespace

Error::Error(const std::string& subject, const std::string& reason, const std::string& remedy)
    : std::runtime_error(join(subject, reason, remedy)), subject_(subject), reason_(reason),
      remedy_(remedy) {}

}  // namespace surf
