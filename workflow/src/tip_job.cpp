// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/tip_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "surf/afm/noise_estimate.h"
#include "surf/afm/tip_doubt.h"
#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf::workflow {
namespace {

constexpr Limits sizes = within(1, 1001);

void need_odd(int size) {
  if (size % 2 == 0)
    throw UsageError("`tip.size`", fmt::format("{} samples have no middle for the apex", size),
                     fmt::format("Ask for {}", size + 1));
}

double sigma_of(const AfmNoise& noise) { return std::sqrt(noise.variance_nm2()); }

double read_height(std::string_view text, const std::string& subject) {
  const Parameter height{.name = subject, .help = "", .unit = Unit::nm, .limits = at_least(0)};
  return parse_value(text, height, subject);
}

// Reads "0.1nm" or "0.1nm,0.8": standard deviation, and alpha.
AfmNoise read_noise(std::string_view text, const std::string& subject) {
  const std::size_t comma = std::min(text.find(','), text.size());
  AfmNoise noise;
  if (comma < text.size()) {
    const std::string_view alpha = text.substr(comma + 1);
    const bool negative = alpha.starts_with('-');
    const Parameter share{.name = subject, .help = "", .unit = Unit::share};
    noise.alpha = parse_value(alpha.substr(negative ? 1 : 0), share, subject) * (negative ? -1 : 1);
  }
  const double sigma = read_height(text.substr(0, comma), subject);
  noise.innovation_nm2 = sigma * sigma * (1 - noise.alpha * noise.alpha);
  try {
    validate(noise);
  } catch (const InvalidInput&) {
    throw UsageError(
        subject, fmt::format("'{}' is no noise", text),
        "Give a standard deviation above 0, as 0.1nm, or with alpha below 1, as 0.1nm,0.8");
  }
  return noise;
}

std::string write_noise(const std::optional<AfmNoise>& noise) {
  if (!noise) return {};
  return fmt::format("{:.15g}{}", sigma_of(*noise),
                     noise->alpha != 0 ? "," + format_exact(noise->alpha) : "");
}

bool sweeps_as_usual(const TipParameters& p) {
  const TipParameters usual;
  return p.sweep_least_nm == usual.sweep_least_nm && p.sweep_most_nm == usual.sweep_most_nm &&
         p.sweep_thresholds == usual.sweep_thresholds;
}

// Reads "FROM,TO,N".
void read_sweep(std::string_view text, const std::string& subject, TipParameters& p) {
  const std::size_t first = text.find(','),
                    second = first == text.npos ? first : text.find(',', first + 1);
  if (second == text.npos)
    throw UsageError(subject, fmt::format("'{}' is no sweep", text),
                     "Write the least, the most and how many, as 0.1nm,2nm,40");
  const Parameter count{.name = subject, .help = "", .limits = within(2, 10000)};
  const double thresholds = parse_value(text.substr(second + 1), count, subject);
  if (thresholds != std::floor(thresholds))
    throw UsageError(subject, fmt::format("'{}' is not a whole number", text.substr(second + 1)),
                     "Write 40, say");
  p.sweep_least_nm = read_height(text.substr(0, first), subject);
  p.sweep_most_nm = read_height(text.substr(first + 1, second - first - 1), subject);
  p.sweep_thresholds = static_cast<int>(thresholds);
}

TipAnswer answer_of(const TipParameters& p) {
  return p.answer.value_or(p.threshold_nm || p.maxima ? TipAnswer::blind : TipAnswer::sweep);
}

// The mean of all scans' estimates.
AfmNoise noise_of(const std::vector<HeightField>& scans, const Reporter& reporter) {
  AfmNoise mean{0, 0};
  double sigma2 = 0;
  bool at_limit = false;
  for (const HeightField& scan : scans) {
    const NoiseEstimate e = estimate_noise(scan);
    const double share = 1 / static_cast<double>(scans.size());
    mean.alpha += share * e.noise.alpha;
    sigma2 += share * e.noise.variance_nm2();
    at_limit = at_limit || e.alpha_at_limit;
  }
  mean.innovation_nm2 = sigma2 * (1 - mean.alpha * mean.alpha);
  if (!(mean.innovation_nm2 > 0))
    throw InvalidInput("scan", "it has no noise that could be estimated",
                       "Give `scan.height_noise`, as 0.1nm, or a `tip.threshold` of 0nm");
  for (std::size_t i = 0; i < scans.size(); ++i)
    tell_noise_doubts(mean, at_limit && i == 0, scans[i], reporter);
  return mean;
}

// Formats runs of directions 10 degrees apart: "50 to 130, 230 to 310".
std::string ranges_of(const std::vector<double>& degrees) {
  std::string text;
  for (std::size_t k = 0; k < degrees.size();) {
    std::size_t last = k;
    while (last + 1 < degrees.size() && degrees[last + 1] - degrees[last] < 10.5) ++last;
    text += fmt::format("{}{:.0f}", text.empty() ? "" : ", ", degrees[k]);
    if (last > k) text += fmt::format(" to {:.0f}", degrees[last]);
    k = last + 1;
  }
  return text;
}

BlindTipOptions blind_options(const TipParameters& p) {
  BlindTipOptions blind;
  blind.width = blind.height = p.size;
  blind.threshold_nm = p.threshold_nm.value_or(0);
  blind.threshold_y_nm = p.threshold_y_nm;
  blind.apex_tolerance_nm = p.apex_tolerance_nm;
  blind.layer_nm = p.layer_nm;
  blind.maxima_only = p.maxima;
  blind.threads = p.threads;
  return blind;
}

void sweep(const std::vector<HeightField>& scans, TipResult& result, const Reporter& reporter) {
  TipSweepOptions options;
  options.blind = blind_options(result.used);
  options.noise = *result.used.noise;
  options.least_nm = result.used.sweep_least_nm, options.most_nm = result.used.sweep_most_nm;
  options.thresholds = result.used.sweep_thresholds;
  options.seed = result.used.seed;
  options.watch = {reporter.counting("tips"), reporter.cancel};
  result.sweep = sweep_tips(scans, options);
  const SweptTip& chosen = result.sweep->curve[result.sweep->chosen];
  result.tip = chosen.tip;
  result.tip.doubt = doubt_of_tip(*result.sweep);
  result.used.threshold_nm = chosen.threshold_nm;
  if (result.sweep->verdict == TipSweepVerdict::disagreement)
    reporter.warn(
        fmt::format("the volume jumps at a threshold of {}, but the residuals choose {}: look at "
                    "the curve of both, as "
                    "'semsurf tip --plot' draws it",
                    format_length(result.sweep->curve[result.sweep->jump].threshold_nm),
                    format_length(chosen.threshold_nm)));
}

void fit_best(const std::vector<HeightField>& scans, TipResult& result, const Reporter& reporter) {
  BestTipOptions options;
  options.width = options.height = result.used.size;
  options.noise = *result.used.noise;
  options.threads = result.used.threads;
  options.watch = {reporter.counting("tips"), reporter.cancel};
  BestTip best = best_tip(scans, options);
  result.tip = std::move(best.tip);
  result.best = std::move(best.summary);
  result.used.threshold_nm = result.best->chosen.threshold_nm;
}

void reconstruct(const std::vector<HeightField>& scans, TipResult& result,
                 const Reporter& reporter) {
  TipParameters& used = result.used;
  if (used.answer == TipAnswer::outer) {
    double pixels = 0;
    for (const HeightField& s : scans) pixels += static_cast<double>(s.z_nm.size());
    used.threshold_nm = used.apex_tolerance_nm =
        outer_threshold_nm(*used.noise, pixels, used.size * used.size);
  }
  BlindTipOptions options = blind_options(used);
  options.watch = {reporter.counting("tips"), reporter.cancel};
  BlindTip blind = blind_tip(scans, options);
  result.tip = std::move(blind.tip);
  result.blind = blind.summary;
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    words.push_back(text.substr(from, comma - from));
    from = comma + 1;
  }
  return words;
}

Tip make_tip(const TipShape& s, const TipSampling& sampling) {
  const double half_angle = s.half_angle_deg * degrees_to_radians;
  switch (s.kind) {
    case TipShape::cone:
      return conical_tip(s.radius_nm, half_angle, sampling);
    case TipShape::parabola:
      return parabolic_tip(s.radius_nm, sampling);
    case TipShape::ball:  // on a cylinder any radius works
      return s.stem_radius_nm > 0 ? ball_tip(s.radius_nm, s.stem_radius_nm,
                                             s.stem_half_angle_deg * degrees_to_radians, sampling)
                                  : ball_tip(s.radius_nm, 0.5 * s.radius_nm, 0, sampling);
    case TipShape::pyramid:
      break;
  }
  PyramidShape pyramid;
  pyramid.radius_nm = s.radius_nm;
  pyramid.rotation_rad = s.rotation_deg * degrees_to_radians;
  pyramid.face_angles_rad.assign(static_cast<std::size_t>(s.faces), half_angle);
  return pyramidal_tip(pyramid, sampling);
}

}  // namespace

void describe_noise(ParameterVisitor& visit, std::optional<AfmNoise>& noise) {
  visit.form(
      {.name = "scan.height_noise",
       .help =
           "Standard deviation of the scan's noise, and its correlation from one pixel to the next",
       .unit = Unit::nm,
       .otherwise = "estimated from the scan",
       .form = "LENGTH[,ALPHA]"},
      [&noise] { return write_noise(noise); },
      [&noise](std::string_view text, const std::string& subject) {
        noise = read_noise(text, subject);
      });
}

void describe(ParameterVisitor& visit, TipParameters& p) {
  visit(p.size, {.name = "tip.size", .help = "Samples across the tip, odd", .limits = sizes});
  visit(
      p.answer, {"sweep", "outer", "best", "blind"},
      {.name = "tip.answer",
       .help = "Answer to find: the tip that the noise explains (sweep), an outer bound, the most "
               "likely one, or the "
               "one at a "
               "threshold (blind)",
       .otherwise = "sweep; blind with a threshold"});
  describe_noise(visit, p.noise);
  visit(p.threshold_nm, {.name = "tip.threshold",
                         .help = "Threshold: samples of the tip are lowered only by more than this",
                         .unit = Unit::nm,
                         .limits = at_least(0),
                         .otherwise = "found by the answer"});
  visit(p.threshold_y_nm, {.name = "tip.threshold_y",
                           .help = "Threshold across scan lines",
                           .unit = Unit::nm,
                           .limits = at_least(0),
                           .otherwise = "as along them",
                           .level = Level::advanced});
  visit(p.apex_tolerance_nm, {.name = "tip.apex_tolerance",
                              .help = "Tolerance by which the apex may stick out of the scan",
                              .unit = Unit::nm,
                              .limits = at_least(0),
                              .level = Level::advanced});
  visit(p.layer_nm, {.name = "tip.layer",
                     .help = "Half the height of the layer that the true scan lies in",
                     .unit = Unit::nm,
                     .limits = at_least(0),
                     .level = Level::advanced});
  visit(p.maxima, {.name = "tip.maxima",
                   .help = "Use only the local maxima of the scan",
                   .level = Level::advanced});
  visit.form(
      {.name = "tip.sweep",
       .help = "Thresholds to try",
       .unit = Unit::nm,
       .otherwise = fmt::format("0.3 to 8 standard deviations of the noise, {}",
                                TipSweepOptions{}.thresholds),
       .form = "FROM,TO,N",
       .level = Level::advanced},
      [&p] {
        if (sweeps_as_usual(p)) return std::string();
        return fmt::format("{},{},{}", format_exact(p.sweep_least_nm),
                           format_exact(p.sweep_most_nm), p.sweep_thresholds);
      },
      [&p](std::string_view text, const std::string& subject) { read_sweep(text, subject, p); });
  visit(p.seed, {.name = "tip.seed",
                 .help = "Seed of the noise that residuals are compared with",
                 .level = Level::advanced});
}

void describe(ParameterVisitor& visit, CharacterizerParameters& p) {
  visit(p.size, {.name = "tip.size", .help = "Samples across the tip, odd", .limits = sizes});
  visit(p.search, {.name = "tip.search",
                   .help = "Largest shift in samples between scan and characterizer",
                   .limits = within(0, 1000),
                   .level = Level::advanced});
}

void describe(ParameterVisitor& visit, TipShape& s) {
  constexpr double most_nm = 1e9;
  visit(s.kind, {"cone", "parabola", "pyramid", "ball"},
        {.name = "tip.kind",
         .help = "Shape: cone and pyramid end in a sphere without a kink, a parabola has the "
                 "radius at its apex, a ball "
                 "sits on a stem"});
  visit(s.radius_nm, {.name = "tip.radius",
                      .help = "Radius at the apex, or of the ball",
                      .unit = Unit::nm,
                      .limits = above(0, most_nm)});
  visit(s.half_angle_deg, {.name = "tip.half_angle",
                           .help = "Angle of the side with the axis, of a cone or pyramid",
                           .unit = Unit::deg,
                           .limits = from_to_below(0, 90)});
  visit(s.faces,
        {.name = "tip.faces", .help = "Number of a pyramid's faces", .limits = within(3, 100)});
  visit(s.rotation_deg, {.name = "tip.rotation",
                         .help = "Azimuth of a pyramid's first face, counter-clockwise from +x",
                         .unit = Unit::deg,
                         .limits = within(-1e6, 1e6),
                         .level = Level::advanced});
  visit(s.stem_radius_nm,
        {.name = "tip.stem_radius",
         .help = "Radius of the stem where it leaves a ball, less than the ball's; 0: never seen",
         .unit = Unit::nm,
         .limits = within(0, most_nm),
         .level = Level::advanced});
  visit(s.stem_half_angle_deg, {.name = "tip.stem_half_angle",
                                .help = "Angle by which the stem of a ball widens; 0: a cylinder",
                                .unit = Unit::deg,
                                .limits = from_to_below(0, 90),
                                .level = Level::advanced});
}

void describe(ParameterVisitor& visit, TipShapeParameters& p) {
  visit.form(
      {.name = "tip.shape",
       .help = "A tip by its shape, without a scan: parabola:RADIUS, cone:RADIUS,ANGLE, "
               "pyramid:RADIUS,ANGLE,FACES[,ROTATION], ball:RADIUS or "
               "ball:RADIUS,STEM_RADIUS,STEM_ANGLE, with angles "
               "from the axis",
       .otherwise = "found in a scan",
       .form = "SHAPE"},
      [&p] { return format_tip_shape(p.shape); },
      [&p](std::string_view text, const std::string& subject) {
        p.shape = parse_tip_shape(text, subject);
      });
  visit(p.size,
        {.name = "tip.size", .help = "Samples across the tip, odd", .limits = within(1, 4001)});
}

void check(const TipParameters& p) {
  const TipAnswer answer = answer_of(p);
  check_parameters(p);
  need_odd(p.size);
  if (answer == TipAnswer::blind && !p.threshold_nm)
    throw UsageError("`tip.threshold`", "this answer needs one",
                     "Give one, as 0.5nm, or leave out `tip.answer`");
  if (answer != TipAnswer::blind)
    for (const auto& [given, name] :
         {std::pair{p.threshold_nm.has_value(), "`tip.threshold`"},
          std::pair{p.threshold_y_nm.has_value(), "`tip.threshold_y`"},
          std::pair{p.maxima, "`tip.maxima`"}, std::pair{p.layer_nm != 0, "`tip.layer`"},
          std::pair{p.apex_tolerance_nm != 0, "`tip.apex_tolerance`"}})
      if (given)
        throw UsageError(name, "this answer finds its own", "Leave it out, or `tip.answer`");
  if (answer != TipAnswer::sweep && !sweeps_as_usual(p))
    throw UsageError("`tip.sweep`", "this answer does not sweep", "Leave it out, or `tip.answer`");
}

TipResult find_tip(const std::vector<HeightField>& scans, const TipParameters& p,
                   const Reporter& reporter) {
  const TipAnswer answer = answer_of(p);
  check(p);
  TipResult result;
  result.used = p;
  result.used.answer = answer;
  if (!p.noise && answer != TipAnswer::blind) {
    result.used.noise = noise_of(scans, reporter);
    result.noise_found = true;
  }
  if (result.used.noise) result.sigma_nm = sigma_of(*result.used.noise);
  if (answer == TipAnswer::sweep) sweep(scans, result, reporter);
  else if (answer == TipAnswer::best) fit_best(scans, result, reporter);
  else reconstruct(scans, result, reporter);
  if (answer != TipAnswer::sweep) result.tip.doubt = doubt_of_shape(result.tip);
  const std::vector<double> open_ways =
      unconstrained_directions(result.tip, *result.used.threshold_nm + 3 * result.sigma_nm);
  if (!open_ways.empty())
    reporter.warn(
        fmt::format("the scan does not tell the tip's shape towards {} degrees (counter-clockwise "
                    "from +x): nothing "
                    "there is steep enough. What is given is the bluntest tip possible",
                    ranges_of(open_ways)));
  tell_tip_doubt(result.tip, reporter);
  return result;
}

CharacterizedTip tip_by_characterizer(const HeightField& scan, const HeightField& characterizer,
                                      const CharacterizerParameters& p, const Reporter& reporter) {
  check_parameters(p);
  need_odd(p.size);
  CharacterizerOptions options;
  options.width = options.height = p.size;
  options.search = p.search;
  options.threads = p.threads;
  CharacterizedTip found = tip_from_characterizer(scan, characterizer, options);
  if (found.offset_at_limit)
    reporter.warn(fmt::format("scan and characterizer are {} samples or more apart: crop the scan",
                              p.search));
  return found;
}

TipShape parse_tip_shape(std::string_view text, const std::string& subject) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const std::string_view kind = text.substr(0, colon);
  const auto words = words_of(colon < text.size() ? text.substr(colon + 1) : std::string_view());
  const auto angle = [&](std::size_t k) { return parse_angle_deg(words[k], subject); };
  TipShape shape;
  shape.radius_nm = 0;
  const auto named = [&](const char* name, std::size_t fewest, std::size_t most) {
    if (kind != name || words.size() < fewest || words.size() > most) return false;
    shape.radius_nm = parse_length_nm(words[0], subject);
    return true;
  };
  if (named("parabola", 1, 1)) {
    shape.kind = TipShape::parabola;
    return shape;
  }
  if (named("cone", 2, 2)) {
    shape.half_angle_deg = angle(1);
    return shape;
  }
  if (named("pyramid", 3, 4)) {
    shape.kind = TipShape::pyramid;
    shape.half_angle_deg = angle(1);
    const Parameter faces{.name = subject, .help = "", .limits = within(3, 100)};
    const double number = parse_value(words[2], faces, subject);
    if (number != std::floor(number))
      throw UsageError(subject, fmt::format("'{}' is no number of faces", words[2]),
                       "Write pyramid:10nm,20deg,4");
    shape.faces = static_cast<int>(number);
    if (words.size() == 4) shape.rotation_deg = angle(3);
    return shape;
  }
  if (words.size() != 2 && named("ball", 1, 3)) {
    shape.kind = TipShape::ball;
    if (words.size() == 1) return shape;
    shape.stem_radius_nm = parse_length_nm(words[1], subject);
    shape.stem_half_angle_deg = angle(2);
    if (shape.stem_radius_nm > 0) return shape;
    throw UsageError(subject, fmt::format("{}: a stem's radius is above 0", text),
                     "Leave the stem out, or write ball:30nm,10nm,5deg");
  }
  throw UsageError(subject, fmt::format("'{}' is no shape", text),
                   "Write parabola:10nm, cone:10nm,15deg, pyramid:10nm,20deg,4 or ball:30nm");
}

std::string format_tip_shape(const TipShape& s) {
  const auto nm = [](double value) { return format_exact(value) + "nm"; };
  const auto deg = [](double value) { return format_exact(value) + "deg"; };
  switch (s.kind) {
    case TipShape::cone:
      return fmt::format("cone:{},{}", nm(s.radius_nm), deg(s.half_angle_deg));
    case TipShape::parabola:
      return fmt::format("parabola:{}", nm(s.radius_nm));
    case TipShape::ball:
      return fmt::format("ball:{}{}", nm(s.radius_nm),
                         s.stem_radius_nm > 0
                             ? "," + nm(s.stem_radius_nm) + "," + deg(s.stem_half_angle_deg)
                             : "");
    case TipShape::pyramid:
      break;
  }
  return fmt::format("pyramid:{},{},{}{}", nm(s.radius_nm), deg(s.half_angle_deg), s.faces,
                     s.rotation_deg != 0 ? "," + deg(s.rotation_deg) : "");
}

Tip tip_by_shape(const TipShapeParameters& p, const std::string& subject) {
  check_parameters(p);
  need_odd(p.size);
  try {
    return make_tip(p.shape, {p.pitch_x_nm, p.pitch_y_nm, p.size, p.size});
  } catch (const InvalidInput& e) {
    throw UsageError(subject, fmt::format("{}: {}", format_tip_shape(p.shape), e.reason()),
                     e.remedy());
  }
}

void tell_noise_doubts(const AfmNoise& noise, bool alpha_at_limit, const HeightField& scan,
                       const Reporter& reporter) {
  if (alpha_at_limit)
    reporter.warn(
        "the noise can hardly be told from the structure and may be less. Give "
        "`scan.height_noise`, from a flat scan: "
        "'semsurf noise scan'");
  if (const std::string doubt = doubt_of_noise(noise, scan); !doubt.empty())
    reporter.warn(doubt + ". Give `scan.height_noise`");
}

void tell_tip_doubt(const Tip& tip, const Reporter& reporter) {
  if (!tip.doubt.empty())
    reporter.warn(
        fmt::format("this tip is not to be trusted: {}. Is the scan level, is `scan.height_noise` "
                    "right, is `tip.size` "
                    "large enough? Another scan, or a tip by its shape, may do better",
                    tip.doubt));
}

}  // namespace surf::workflow
