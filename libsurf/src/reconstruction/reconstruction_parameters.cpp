// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/some_parameters.h"
#include "surf/core/units.h"
#include "surf/reconstruction/reconstruct.h"

namespace surf {
namespace {

/// Describes a number for which 0 means the optimiser's own choice.
template <class Number>
void show_or_own(ParameterVisitor& visit, Number& number, const Parameter& about) {
  std::optional<Number> given = number != 0 ? std::optional(number) : std::nullopt;
  visit(given, about);
  number = given.value_or(0);
}

/// Describes a step that is done unless a flag disables it.
void show_unless(ParameterVisitor& visit, bool& done, const Parameter& about) {
  bool left_out = !done;
  visit(left_out, about);
  done = !left_out;
}

class ScalesField final : public Field {
 public:
  explicit ScalesField(std::vector<double>& scales) : scales_(scales) {}
  FieldKind kind() const override { return FieldKind::text; }
  bool given() const override { return !scales_.empty(); }
  std::string text() const override {
    std::string text;
    for (const double scale : scales_) text += (text.empty() ? "" : ",") + format_exact(scale);
    return text;
  }
  void read(std::string_view text, const std::string& subject) override {
    scales_ = parse_values(text, {.name = "scale", .help = ""}, subject);
    check(subject);
  }
  void clear() override { scales_.clear(); }
  void check(const std::string& subject) const override {
    for (std::size_t i = 0; i < scales_.size(); ++i)
      if (!(scales_[i] > 0) || (i > 0 && !(scales_[i] < scales_[i - 1])))
        throw UsageError(subject, fmt::format("'{}' does not fall, or is not above 0", text()),
                         "Give pixels, as 16,8,4,2,1");
  }

 private:
  std::vector<double>& scales_;
};

}  // namespace

void describe(ParameterVisitor& visit, ReconstructionOptions& o) {
  visit(o.method, {"gauss-newton", "conjugate-gradients", "lbfgs"},
        {.name = "reconstruction.optimiser", .help = "Optimiser of the surface"});
  ScalesField scales(o.scales_px);
  visit.visit(
      {.name = "reconstruction.scales",
       .help =
           "Standard deviations of the Gaussians that the surface is a sum of, falling, in pixels",
       .otherwise = "the optimiser's own",
       .form = "PX,PX..."},
      scales);
  show_or_own(visit, o.iterations,
              {.name = "reconstruction.iterations",
               .help = "Largest number of iterations at each scale",
               .limits = within(1, 1'000'000),
               .otherwise = "the optimiser's own"});
  show_or_own(visit, o.tolerance,
              {.name = "reconstruction.optimiser_tolerance",
               .help = "Gain of the objective per pixel below which an iteration ends its scale",
               .limits = above(0),
               .otherwise = "the optimiser's own"});
  show_or_own(visit, o.curvature_prior_per_nm,
              {.name = "reconstruction.prior",
               .help = "Expected second derivative of the surface where the images do not "
                       "determine it, in 1/nm",
               .limits = above(0),
               .otherwise = "0.001, more on rough ground"});
  show_unless(visit, o.refine_transform,
              {.name = "reconstruction.fixed_transform",
               .help = "Keep the map as registered instead of fitting it with the surface"});
  visit(o.refine_drift, {.name = "reconstruction.fit_drift",
                         .help = "Fit a drift of the scan that bends its slow axis, with the map"});
  show_unless(visit, o.refine_calibration,
              {.name = "reconstruction.fixed_calibration",
               .help = "Keep gains and offset instead of fitting them with the surface"});
  visit(o.refine_spot, {.name = "reconstruction.fit_spot",
                        .help = "Fit how much wider the spot is than the model's, as by defocus"});
  visit(o.refine_tip, {.name = "reconstruction.refine_tip",
                       .help = "Fit the tip with the surface, even one that is given"});
  show_unless(visit, o.uncertainty,
              {.name = "reconstruction.no_uncertainty",
               .help = "Leave out the standard deviations of heights, to save time"});
  visit(o.probes, {.name = "reconstruction.probes",
                   .help = "Random vectors that the uncertainty is estimated from",
                   .limits = within(2, 100'000)});
  visit(o.seed, {.name = "reconstruction.seed",
                 .help = "Seed of random vectors, and of the noise that tips are judged by"});
}

}  // namespace surf
