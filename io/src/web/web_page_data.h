// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "surf/io/web_page.h"

namespace surf::io {

/// A page's numbers and pictures as elements of HTML, which its description names by their
/// position.
///
/// Numbers of 32 bits (floats as their bits) are replaced by the difference from the one before,
/// split into four planes of bytes, the lowest first, and deflated: 0.2 to 0.85 of base64 alone for
/// measured heights, 0.01 for the indices of a grid-like mesh.
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
