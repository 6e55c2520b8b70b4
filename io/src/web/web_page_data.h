// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "surf/io/web_page.h"

namespace surf::io {

/// A page's numbers and pictures as HTML elements. The page's description refers to them by
/// position.
///
/// 32-bit numbers (floats as their bits) are replaced by the difference from the previous number,
/// split into four planes of bytes, the lowest first, and deflated. For measured heights this takes
/// 0.2 to 0.85 of the bytes of base64 alone, for the indices of a grid-like mesh 0.01.
class WebBlobs {
 public:
  nlohmann::json add_numbers(const std::vector<float>& values);
  nlohmann::json add_numbers(const std::vector<std::uint32_t>& values);
  nlohmann::json add_png(const std::string& bytes);

  const std::string& html() const { return html_; }

 private:
  nlohmann::json add(const std::string& kind, const std::string& bytes);
  nlohmann::json add_words(const std::string& type, const std::vector<std::uint32_t>& words);

  int count_ = 0;
  std::string html_;
};

/// Descriptions for the viewer; see web/src/scene_data.js.
nlohmann::json describe(const WebSurface& surface, WebBlobs& blobs);
nlohmann::json describe(const WebImage& image, WebBlobs& blobs);

}  // namespace surf::io
