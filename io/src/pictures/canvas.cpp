// SPDX-License-Identifier: GPL-3.0-or-later
// The module `cairo`: the only source that knows it.
#include "canvas.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <numbers>

#include "surf/core/error.h"

namespace surf::io {
namespace {

constexpr double points_per_pixel = 72.0 / 96.0;  // PDF and SVG surfaces measure in points

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

class CairoCanvas final : public Canvas {
 public:
  CairoCanvas(const std::filesystem::path& target, const std::string& file,
              const std::string& extension, int width, int height);

  void fill_rectangle(Point corner, double width, double height, Color color) override;
  void stroke_rectangle(Point corner, double width, double height, double line_width,
                        Color color) override;
  void polyline(std::span<const Point> points, double line_width, Color color) override;
  void segments(std::span<const Point> ends, double line_width, Color color) override;
  void text(const std::string& text, Point at, double size, Align align, Color color, bool bold,
            bool upwards) override;
  double text_width(const std::string& text, double size, bool bold) override;
  void clip(Point corner, double width, double height) override;
  void unclip() override;
  void finish() override;

 private:
  std::string target_;
  std::string file_;
  bool is_raster_;
  SurfacePointer surface_;
  ContextPointer context_;

  void check(cairo_status_t status) const {
    if (status == CAIRO_STATUS_SUCCESS) return;
    throw FileError(file_, fmt::format("it cannot be drawn: {}", cairo_status_to_string(status)),
                    "Check the free space and memory, or choose another place or a smaller size");
  }

  cairo_t* use(Color color, double line_width) {
    cairo_t* const c = context_.get();
    cairo_set_source_rgba(c, color.red, color.green, color.blue, color.alpha);
    cairo_set_line_width(c, line_width);
    return c;
  }

  void set_font(double size, bool bold) {
    // Where there is no such font, Cairo takes another, in the end one of its own.
    cairo_select_font_face(context_.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context_.get(), size);
  }
};

CairoCanvas::CairoCanvas(const std::filesystem::path& target, const std::string& file,
                         const std::string& extension, int width, int height)
    : target_(target.string()), file_(file), is_raster_(extension == ".png"),
      surface_(make_surface(target.string(), extension, width, height), &cairo_surface_destroy),
      context_(nullptr, &cairo_destroy) {
  check(cairo_surface_status(surface_.get()));
  context_.reset(cairo_create(surface_.get()));
  check(cairo_status(context_.get()));
  cairo_t* const c = context_.get();
  if (!is_raster_) cairo_scale(c, points_per_pixel, points_per_pixel);
  cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(c, CAIRO_LINE_CAP_ROUND);
  fill_rectangle({0, 0}, width, height, {1, 1, 1});
}

void CairoCanvas::fill_rectangle(Point corner, double width, double height, Color color) {
  cairo_t* const c = use(color, 1);
  cairo_rectangle(c, corner.x, corner.y, width, height);
  cairo_fill(c);
}

void CairoCanvas::stroke_rectangle(Point corner, double width, double height, double line_width,
                                   Color color) {
  cairo_t* const c = use(color, line_width);
  cairo_rectangle(c, corner.x, corner.y, width, height);
  cairo_stroke(c);
}

void CairoCanvas::polyline(std::span<const Point> points, double line_width, Color color) {
  cairo_t* const c = use(color, line_width);
  cairo_new_path(c);
  for (const Point& p : points) cairo_line_to(c, p.x, p.y);
  cairo_stroke(c);
}

void CairoCanvas::segments(std::span<const Point> ends, double line_width, Color color) {
  cairo_t* const c = use(color, line_width);
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
    cairo_move_to(c, ends[i].x, ends[i].y);
    cairo_line_to(c, ends[i + 1].x, ends[i + 1].y);
  }
  cairo_stroke(c);
}

void CairoCanvas::text(const std::string& text, Point at, double size, Align align, Color color,
                       bool bold, bool upwards) {
  const double width = align == Align::left ? 0 : text_width(text, size, bold);
  cairo_t* const c = use(color, 1);
  cairo_save(c);
  cairo_translate(c, at.x, at.y);
  if (upwards) cairo_rotate(c, -std::numbers::pi / 2);
  set_font(size, bold);
  cairo_move_to(c, align == Align::center ? -width / 2 : -width, 0);
  cairo_show_text(c, text.c_str());
  cairo_restore(c);
  cairo_new_path(c);
}

double CairoCanvas::text_width(const std::string& text, double size, bool bold) {
  cairo_t* const c = context_.get();
  cairo_save(c);
  set_font(size, bold);
  cairo_text_extents_t extents;
  cairo_text_extents(c, text.c_str(), &extents);
  cairo_restore(c);
  return extents.x_advance;
}

void CairoCanvas::clip(Point corner, double width, double height) {
  cairo_t* const c = context_.get();
  cairo_save(c);
  cairo_rectangle(c, corner.x, corner.y, width, height);
  cairo_clip(c);
}

void CairoCanvas::unclip() { cairo_restore(context_.get()); }

void CairoCanvas::finish() {
  check(cairo_status(context_.get()));
  cairo_surface_t* const drawn = surface_.get();
  if (is_raster_) {
    check(cairo_surface_write_to_png(drawn, target_.c_str()));
  }
  context_.reset();
  cairo_surface_finish(drawn);
  check(cairo_surface_status(drawn));
}

std::unique_ptr<Canvas> make_canvas(const std::filesystem::path& target, const std::string& file,
                                    const std::string& extension, int width, int height) {
  return std::make_unique<CairoCanvas>(target, file, extension, width, height);
}

constexpr CanvasLibrary table{make_canvas};

}  // namespace
}  // namespace surf::io

SEMSURF_MODULE(cairo, surf::io::table)
