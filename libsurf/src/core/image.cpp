// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/image.h"

#include <fmt/format.h>

#include <set>

#include "surf/core/error.h"

namespace surf {
const Channel* Image::find(std::string_view name) const {
  for (const Channel& channel : channels) {
    if (channel.name == name) return &channel;
  }
  return nullptr;
}

void validate(const Image& image, const char* subject) {
  if (image.channels.empty() || image.channels.front().values.empty()) {
    throw InvalidInput(subject, "it has no pixels", "Give at least one channel of at least 1 x 1");
  }
  validate(image.placement(), subject);
  std::set<std::string_view> names;
  for (const Channel& channel : image.channels) {
    if (channel.name.empty()) {
      throw InvalidInput(subject, fmt::format("channel {} has no name", names.size()),
                         "Every channel needs one");
    }
    if (!names.insert(channel.name).second) {
      throw InvalidInput(subject, fmt::format("two channels are named '{}'", channel.name),
                         "Names must be unique");
    }
    if (channel.values.width() != image.width() || channel.values.height() != image.height()) {
      throw InvalidInput(subject,
                         fmt::format("channel '{}' has {} x {} pixels, the first one {} x {}",
                                     channel.name, channel.values.width(), channel.values.height(),
                                     image.width(), image.height()),
                         "All channels must have one size");
    }
  }
}

}  // namespace surf
