// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/web_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "files/lower_extension.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "web_page_data.h"
#include "web_page_template.h"

namespace surf::io {
namespace {

std::size_t places_of(const WebSurface& surface) {
  if (const auto* field = std::get_if<HeightField>(&surface.shape)) return field->z_nm.size();
  return std::get<TriangleMesh>(surface.shape).vertices_nm.size();
}

void check_surface(const WebSurface& surface) {
  const char* const name = surface.name.c_str();
  if (const auto* field = std::get_if<HeightField>(&surface.shape)) {
    validate(*field, name);
    if (!field->valid.empty() &&
        std::none_of(field->valid.data().begin(), field->valid.data().end(),
                     [](unsigned char valid) { return valid != 0; }))
      throw InvalidInput(surface.name, "every sample is a hole", "Give a surface with heights");
  } else {
    validate(std::get<TriangleMesh>(surface.shape), name);
  }
  std::set<std::string> names;
  for (const WebScalar& scalar : surface.scalars) {
    if (scalar.name.empty() || !names.insert(scalar.name).second)
      throw InvalidInput(surface.name,
                         fmt::format("a scalar's name '{}' is empty or used twice", scalar.name),
                         "Name each differently");
    if (scalar.values.size() != places_of(surface))
      throw InvalidInput(surface.name,
                         fmt::format("scalar '{}' has {} values for {} places", scalar.name,
                                     scalar.values.size(), places_of(surface)),
                         "Give one for each vertex or sample");
    if (std::any_of(scalar.values.begin(), scalar.values.end(),
                    [](float value) { return std::isinf(value); }))
      throw InvalidInput(surface.name,
                         fmt::format("scalar '{}' has an infinite value", scalar.name),
                         "Use NaN where nothing is known");
  }
}

void check_first_view(const WebPage& page) {
  const auto has_scalar = [&](const WebSurface& surface) {
    return std::any_of(surface.scalars.begin(), surface.scalars.end(),
                       [&](const WebScalar& scalar) { return scalar.name == page.scalar; });
  };
  if (!page.scalar.empty() && std::none_of(page.surfaces.begin(), page.surfaces.end(), has_scalar))
    throw InvalidInput("page",
                       fmt::format("no surface has a scalar '{}' to show first", page.scalar),
                       "Name one of its scalars");
  if (!page.drape) return;
  if (page.drape->image >= page.images.size() || !page.images[page.drape->image].has_scale ||
      !page.images[page.drape->image].image.find(page.drape->channel))
    throw InvalidInput(
        "page",
        fmt::format("there is no image with a scale and a channel '{}' to lay on the surfaces",
                    page.drape->channel),
        "Name a channel of one of its images");
}

void check_page(const WebPage& page) {
  if (page.surfaces.empty() && page.images.empty())
    throw InvalidInput("page", "there is nothing to show", "Give a surface or an image");
  std::set<std::string> names;
  for (const WebSurface& surface : page.surfaces) {
    if (surface.name.empty() || !names.insert(surface.name).second)
      throw InvalidInput("page",
                         fmt::format("a surface's name '{}' is empty or used twice", surface.name),
                         "Name each differently");
    check_surface(surface);
  }
  for (const WebImage& image : page.images) {
    validate(image.image, image.name.c_str());
    if (image.image.width() < 1 || image.image.height() < 1)
      throw InvalidInput(image.name, "the image has no pixels", "Give it at least one");
  }
  check_first_view(page);
}

std::string escape(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<') safe += "&lt;";
    else if (c == '&') safe += "&amp;";
    else safe += c;
  }
  return safe;
}

// JSON inside an element of HTML: "</script" and "<!--" may not appear. Text of instruments may be
// no UTF-8.
std::string to_text(const nlohmann::json& description) {
  const std::string text =
      description.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') safe += "\\u003c";
    else safe += c;
  }
  return safe;
}

}  // namespace

WebPageSummary write_web_page(const std::filesystem::path& path, const WebPage& page,
                              const Watch& watch) {
  check_web_page_target(path);
  check_page(page);
  const double total = static_cast<double>(page.surfaces.size() + page.images.size());
  double done = 0;
  const auto next = [&] { watch.report(done++, total); };
  WebBlobs blobs;
  nlohmann::json description = {{"format", 1},
                                {"title", page.title},
                                {"metadata", page.metadata},
                                {"surfaces", nlohmann::json::array()},
                                {"images", nlohmann::json::array()},
                                {"scalar", page.scalar}};
  for (const WebSurface& surface : page.surfaces) {
    next();
    description["surfaces"].push_back(describe(surface, blobs));
  }
  for (const WebImage& image : page.images) {
    next();
    description["images"].push_back(describe(image, blobs));
  }
  if (page.drape)
    description["drape"] = {{"image", page.drape->image}, {"channel", page.drape->channel}};
  next();

  const std::string_view viewer = web_page_template();
  const std::size_t title = viewer.find(web_page_title_mark);
  const std::size_t data = viewer.find(web_page_data_mark);
  std::string html(viewer.substr(0, title));
  html += escape(page.title);
  const std::size_t after_title = title + web_page_title_mark.size();
  html += viewer.substr(after_title, data - after_title);
  html += "<script type=\"application/json\" id=\"scene\">" + to_text(description) + "</script>\n";
  html += blobs.html();
  html += viewer.substr(data + web_page_data_mark.size());
  write_text(path, html);
  return {html.size(), viewer.size()};
}

void check_web_page_target(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension != ".html" && extension != ".htm")
    throw UsageError(path.string(), fmt::format("a page's name ends in .html, not '{}'", extension),
                     "Use a name as page.html");
  if (web_page_template().empty())
    throw Unsupported(path.string(),
                      "this semsurf was built without Node.js, which bundles the viewer",
                      "Install nodejs and npm, then configure and build again with a network");
  check_writable(path);
}

}  // namespace surf::io
