// SPDX-License-Identifier: GPL-3.0-or-later
// The only source that knows Cairo.
#include "canvas.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <numbers>

#include "surf/core/error.h"

namespace surf::io {
namespace {

constexpr double points_per_pixel = 72.0 / 96.0;   // PDF and SVG surfaces measure in points

using SurfacePointer = std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)>;
using ContextPointer = std::unique_ptr<cairo_t, void (*)(cairo_t*)>;

cairo_surface_t* make_surface(const std::string& target, const std::string& extension, int width,
                              int height) {
  const double w = width * points_per_pixel, h = height * points_per_pixel;
  if (extension == ".svg") return cairo_svg_surface_create(target.c_str(), w, h);
  if (extension == ".pdf") {
    cairo_surface_t* const surface = cairo_pdf_surface_create(target.c_str(), w, h);
    // No clock in files: the same input gives the same bytes.
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "");
    return surface;
  }
  return cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
}

}  // namespace

struct Canvas::Impl {
  std::string target;
  std::string file;
  bool is_raster;
  SurfacePointer surface;
  ContextPointer context;

  void check(cairo_status_t status) const {
    if (status == CAIRO_STATUS_SUCCESS) return;
    throw FileError(file, fmt::format("cannot be drawn: {}", cairo_status_to_string(status)),
                    "Check the free space and memory, or choose another place or a smaller size");
  }

  cairo_t* use(Color color, double line_width) {
    cairo_t* const c = context.get();
    cairo_set_source_rgba(c, color.red, color.green, color.blue, color.alpha);
    cairo_set_line_width(c, line_width);
    return c;
  }

  void set_font(double size, bool bold) {
    // Where there is no such font, Cairo takes another, in the end one of its own.
    cairo_select_font_face(context.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context.get(), size);
  }
};

Canvas::Canvas(const std::filesystem::path& target, const std::string& file,
               const std::string& extension, int width, int height)
    : impl_(new Impl{target.string(), file, extension == ".png",
                     {make_surface(target.string(), extension, width, height),
                      &cairo_surface_destroy},
                     {nullptr, &cairo_destroy}}) {
  impl_->check(cairo_surface_status(impl_->surface.get()));
  impl_->context.reset(cairo_create(impl_->surface.get()));
  impl_->check(cairo_status(impl_->context.get()));
  cairo_t* const c = impl_->context.get();
  if (!impl_->is_raster) cairo_scale(c, points_per_pixel, points_per_pixel);
  cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(c, CAIRO_LINE_CAP_ROUND);
  fill_rectangle({0, 0}, width, height, {1, 1, 1});
}

Canvas::~Canvas() = default;

void Canvas::fill_rectangle(Point corner, double width, double height, Color color) {
  cairo_t* const c = impl_->use(color, 1);
  cairo_rectangle(c, corner.x, corner.y, width, height);
  cairo_fill(c);
}

void Canvas::stroke_rectangle(Point corner, double width, double height, double line_width,
                              Color color) {
  cairo_t* const c = impl_->use(color, line_width);
  cairo_rectangle(c, corner.x, corner.y, width, height);
  cairo_stroke(c);
}

void Canvas::polyline(std::span<const Point> points, double line_width, Color color) {
  cairo_t* const c = impl_->use(color, line_width);
  cairo_new_path(c);
  for (const Point& p : points) cairo_line_to(c, p.x, p.y);
  cairo_stroke(c);
}

void Canvas::segments(std::span<const Point> ends, double line_width, Color color) {
  cairo_t* const c = impl_->use(color, line_width);
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
    cairo_move_to(c, ends[i].x, ends[i].y);
    cairo_line_to(c, ends[i + 1].x, ends[i + 1].y);
  }
  cairo_stroke(c);
}

void Canvas::text(const std::string& text, Point at, double size, Align align, Color color,
                  bool bold, bool upwards) {
  const double width = align == Align::left ? 0 : text_width(text, size, bold);
  cairo_t* const c = impl_->use(color, 1);
  cairo_save(c);
  cairo_translate(c, at.x, at.y);
  if (upwards) cairo_rotate(c, -std::numbers::pi / 2);
  impl_->set_font(size, bold);
  cairo_move_to(c, align == Align::center ? -width / 2 : -width, 0);
  cairo_show_text(c, text.c_str());
  cairo_restore(c);
  cairo_new_path(c);
}

double Canvas::text_width(const std::string& text, double size, bool bold) {
  cairo_t* const c = impl_->context.get();
  cairo_save(c);
  impl_->set_font(size, bold);
  cairo_text_extents_t extents;
  cairo_text_extents(c, text.c_str(), &extents);
  cairo_restore(c);
  return extents.x_advance;
}

void Canvas::clip(Point corner, double width, double height) {
  cairo_t* const c = impl_->context.get();
  cairo_save(c);
  cairo_rectangle(c, corner.x, corner.y, width, height);
  cairo_clip(c);
}

void Canvas::unclip() { cairo_restore(impl_->context.get()); }

void Canvas::finish() {
  impl_->check(cairo_status(impl_->context.get()));
  cairo_surface_t* const surface = impl_->surface.get();
  if (impl_->is_raster) {
    impl_->check(cairo_surface_write_to_png(surface, impl_->target.c_str()));
  }
  impl_->context.reset();
  cairo_surface_finish(surface);
  impl_->check(cairo_surface_status(surface));
}

}  // namespace surf::io
