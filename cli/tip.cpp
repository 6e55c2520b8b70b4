// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "afm_options.h"
#include "commands.h"
#include "common_options.h"
#include "exit_codes.h"
#include "options.h"
#include "surf/afm/best_tip.h"
#include "surf/afm/characterizer.h"
#include "surf/afm/height_range.h"
#include "surf/afm/noise_estimate.h"
#include "surf/afm/tip_doubt.h"
#include "surf/afm/tip_measure.h"
#include "surf/afm/tip_sweep.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/plot.h"
#include "surf/io/tip_file.h"
#include "terminal.h"
#include "tip_plot.h"
#include "tip_shape_option.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(Without --threshold, thresholds are swept, and the tip is chosen that leaves of the scan what its
noise explains; the chart shows the whole curve, so that you can disagree:
  semsurf tip scan.gsf -o tip.gsf --plot tip.svg
Level the scan first ('semsurf level'). Two other answers, named as such:
  semsurf tip scan.gsf --answer outer -o bound.gsf
      an outer bound: in 95 % of noise draws nowhere sharper than the tip, but blunt
  semsurf tip a.gsf --also b.gsf --also c.gsf --answer best -o tip.gsf
      the most likely tip, from several scans by it, with standard errors; best for noisy frames
A tip by its shape, from the scan of a known surface, or at a threshold of your own:
  semsurf tip --shape cone:10nm,15deg --size 41 --pixel-size 2nm -o tip.gsf
  semsurf tip grating_scan.gsf --characterizer grating.gsf -o tip.gsf
  semsurf tip scan.gsf --threshold 0.5nm --apex-tolerance 0.5nm -o tip.gsf)";

struct Options {
  ScanInput input;
  std::vector<std::string> also;
  std::optional<std::string> size, answer, threshold, threshold_y, apex_tolerance, layer, sweep, noise;
  std::optional<std::string> shape, characterizer, search, plot, seed, output, threads;
  bool maxima = false, quiet = false;
};

double parse_height(const std::string& text, const char* subject) {
  const double nm = parse_length_nm(text, subject);
  if (nm >= 0) return nm;
  throw UsageError(subject, fmt::format("'{}' is below 0", text), "Give a length, as 0.5nm");
}

enum class Answer { sweep, outer, best, blind };

struct Plan {
  Answer answer = Answer::sweep;
  BlindTipOptions blind;
  std::optional<AfmNoise> noise;
  TipSweepOptions sweep;
};

double parse_correlation(const std::string& text) {
  const bool negative = text.starts_with('-');
  const double size = parse_share(text.substr(negative ? 1 : 0), "--noise");
  return negative ? -size : size;
}

// "0.1nm" or "0.1nm,0.8": standard deviation, and alpha.
AfmNoise parse_noise(const std::string& text) {
  const std::size_t comma = std::min(text.find(','), text.size());
  AfmNoise noise;
  if (comma < text.size()) noise.alpha = parse_correlation(text.substr(comma + 1));
  const double sigma = parse_height(text.substr(0, comma), "--noise");
  noise.innovation_nm2 = sigma * sigma * (1 - noise.alpha * noise.alpha);
  try {
    validate(noise);
  } catch (const InvalidInput&) {
    throw UsageError("--noise", fmt::format("'{}' is no noise", text),
                     "Give a standard deviation above 0, as 0.1nm, or with alpha below 1, as 0.1nm,0.8");
  }
  return noise;
}

// "FROM,TO,N".
void parse_sweep(const std::string& text, TipSweepOptions& o) {
  const std::size_t first = text.find(','), second = text.find(',', first + 1);
  if (first == std::string::npos || second == std::string::npos)
    throw UsageError("--sweep", fmt::format("'{}' is no sweep", text), "Write --sweep 0.1nm,2nm,40");
  o.least_nm = parse_height(text.substr(0, first), "--sweep");
  o.most_nm = parse_height(text.substr(first + 1, second - first - 1), "--sweep");
  o.thresholds = static_cast<int>(parse_whole(text.substr(second + 1), "--sweep", 2, 10000));
}

Plan make_plan(const Options& o) {
  Plan p;
  const std::string answer = o.answer.value_or(o.threshold || o.maxima ? "blind" : "sweep");
  if (answer == "sweep") p.answer = Answer::sweep;
  else if (answer == "outer") p.answer = Answer::outer;
  else if (answer == "best") p.answer = Answer::best;
  else if (answer == "blind") p.answer = Answer::blind;
  else throw UsageError("--answer", fmt::format("'{}' is none", answer), "Choose sweep, outer, best or blind");
  if (p.answer == Answer::blind && !o.threshold)
    throw UsageError("--threshold", "this answer needs one", "Add --threshold 0.5nm, or leave out --answer");
  if (p.answer != Answer::blind && (o.threshold || o.threshold_y || o.maxima || o.apex_tolerance || o.layer))
    throw UsageError(o.threshold ? "--threshold" : o.threshold_y ? "--threshold-y" : o.maxima ? "--maxima"
                     : o.layer ? "--layer" : "--apex-tolerance",
                     "this answer finds its own", "Leave it out, or --answer");
  if (o.sweep && p.answer != Answer::sweep)
    throw UsageError("--sweep", "this answer does not sweep", "Leave out one of the two");
  const auto size = parse_whole(o.size.value_or(std::to_string(BlindTipOptions{}.width)), "--size", 1, 1001);
  if (size % 2 == 0)
    throw UsageError("--size", fmt::format("{} samples have no middle for the apex", size),
                     fmt::format("Ask for {}", size + 1));
  p.blind.width = p.blind.height = static_cast<int>(size);
  if (o.threshold) p.blind.threshold_nm = parse_height(*o.threshold, "--threshold");
  if (o.threshold_y) p.blind.threshold_y_nm = parse_height(*o.threshold_y, "--threshold-y");
  if (o.apex_tolerance) p.blind.apex_tolerance_nm = parse_height(*o.apex_tolerance, "--apex-tolerance");
  if (o.layer) p.blind.layer_nm = parse_height(*o.layer, "--layer");
  p.blind.maxima_only = o.maxima;
  p.blind.threads = parse_threads(o.threads);
  if (o.noise) p.noise = parse_noise(*o.noise);
  if (o.sweep) parse_sweep(*o.sweep, p.sweep);
  if (o.seed) p.sweep.seed = parse_seed(*o.seed, "--seed");
  return p;
}

std::vector<HeightField> read_scans(const Options& o) {
  std::vector<HeightField> scans{read_scan(o.input, o.quiet).field};
  for (const std::string& file : o.also) {
    ScanInput other = o.input;
    other.file = file;
    scans.push_back(read_scan(other, o.quiet).field);
  }
  return scans;
}

// The mean of all scans' estimates.
AfmNoise noise_of(const std::vector<HeightField>& scans) {
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
    throw InvalidInput("scan", "it has no noise that could be estimated", "Say --noise 0.1nm, or --threshold 0nm");
  if (at_limit)
    print_warning("the noise can hardly be told from the structure and may be less. Say --noise, from a flat "
                  "scan: 'semsurf noise'");
  for (const HeightField& scan : scans)
    if (const std::string doubt = doubt_of_noise(mean, scan); !doubt.empty())
      print_warning(doubt + ". Say --noise");
  return mean;
}

// "50 to 130, 230 to 310": runs of directions 10 degrees apart.
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

// Of the samples that the tip has; above 0 for all but a flat one.
double depth_of(const Tip& tip) {
  double lowest = 0;
  for (const double z : tip.z_nm.data())
    if (std::isfinite(z)) lowest = std::min(lowest, z);
  return -lowest;
}

void print_tip(const Tip& tip, double depth_nm) {
  print("{:<10} {} x {} samples of {}, down to {}\n", "tip", tip.z_nm.width(), tip.z_nm.height(),
             format_length(tip.pitch_x_nm), format_length(-depth_of(tip)));
  try {
    TipMeasures m = measure_tip(tip);
    // Thresholds leave ends flat: what lies deeper may tell a radius.
    if (const double whole_nm = depth_of(tip); !std::isfinite(m.radius_nm) && whole_nm > 0)
      m = measure_tip(tip, {.fit_depth_nm = whole_nm});
    if (std::isfinite(m.radius_nm))
      print("{:<10} {} (fitted down to {}, residual {})", "radius", format_length(m.radius_nm),
            format_length(m.fit_depth_nm), format_length(m.radius_residual_nm));
    else
      print("{:<10} infinite: the tip is flat", "radius");
    if (m.half_angle_rad) print(", half angle {:.1f} degrees", *m.half_angle_rad / degrees_to_radians);
    print("\n");
  } catch (const InvalidInput& e) {   // a flat end, or too few samples
    print("{:<10} not known: {}\n", "radius", e.reason());
  }
  print("{:<10} {:.4g} nm^3 down to {}\n", "volume", tip_volume_nm3(tip, depth_nm), format_length(depth_nm));
}

void print_sweep(const TipSweep& sweep, bool quiet) {
  const SweptTip& c = sweep.curve[sweep.chosen];
  if (!quiet)
    print("{:<10} {} of {} to {}; residual {}, expected {}; largest jump of volume below {}\n", "threshold",
               format_length(c.threshold_nm), format_length(sweep.curve.front().threshold_nm),
               format_length(sweep.curve.back().threshold_nm), format_length(c.residual_nm),
               format_length(c.expected_nm), format_length(sweep.curve[sweep.jump].threshold_nm));
  if (sweep.verdict == TipSweepVerdict::disagreement)
    print_warning(fmt::format("the volume jumps at {}, but the residuals choose {}. Look at --plot",
                              format_length(sweep.curve[sweep.jump].threshold_nm), format_length(c.threshold_nm)));
}

/// 4: there is a result, but not to be trusted.
int report_doubt(const Tip& tip) {
  if (tip.doubt.empty()) return 0;
  print_warning(fmt::format("this tip is not to be trusted, and its file says so: {}. Is the scan level, is --noise right, "
                            "is --size large enough? Another scan, or a tip by its shape, may do better", tip.doubt));
  return exit_untrustworthy;
}

std::map<std::string, std::string> made_by(const Options& o, const Plan& p, const AfmNoise* noise,
                                           double threshold_nm) {
  constexpr const char* answers[] = {"sweep", "outer bound", "best estimate", "blind"};
  std::map<std::string, std::string> made{{"answer", answers[static_cast<int>(p.answer)]},
                                          {"size", fmt::format("{}", p.blind.width)},
                                          {"threshold_nm", fmt::format("{:.9g}", threshold_nm)}};
  if (noise) {
    made["noise_nm"] = fmt::format("{:.9g}", std::sqrt(noise->variance_nm2()));
    made["noise_alpha"] = fmt::format("{:.9g}", noise->alpha);
  }
  if (o.threshold_y) made["threshold_y_nm"] = fmt::format("{:.9g}", *p.blind.threshold_y_nm);
  if (p.answer == Answer::blind) {
    made["apex_tolerance_nm"] = fmt::format("{:.9g}", p.blind.apex_tolerance_nm);
    made["layer_nm"] = fmt::format("{:.9g}", p.blind.layer_nm);
    made["maxima_only"] = p.blind.maxima_only ? "true" : "false";
  }
  if (p.answer == Answer::sweep) made["seed"] = fmt::format("{}", p.sweep.seed);
  if (o.input.channel) made["channel"] = *o.input.channel;
  return made;
}

std::vector<std::filesystem::path> files_of(const Options& o) {
  std::vector<std::filesystem::path> files{*o.output};
  if (o.plot) files.emplace_back(*o.plot);
  return files;
}

int by_shape(const Options& o) {
  if (!o.input.file.empty())
    throw UsageError("--shape", "it takes no scan", "Leave out one of the two");
  const Tip tip = parse_tip_shape(*o.shape, o.size.value_or(std::to_string(CharacterizerOptions{}.width)), o.input.pixel_size);
  io::write_tip(*o.output, tip, provenance_of("tip", {{"shape", *o.shape}}, {}));
  if (o.plot) io::write_plot(*o.plot, tip_plot(tip));
  if (o.quiet) return 0;
  print_tip(tip, depth_of(tip));
  print_written(files_of(o));
  return 0;
}

int by_characterizer(const Options& o) {
  const std::vector<HeightField> scans = read_scans(o);
  if (scans.size() > 1) throw UsageError("--also", "a characterizer takes one scan", "Leave it out");
  ScanInput known;
  known.file = *o.characterizer;
  CharacterizerOptions options;
  options.width = options.height = make_plan(o).blind.width;
  if (o.search) options.search = static_cast<int>(parse_whole(*o.search, "--search", 0, 1000));
  options.threads = parse_threads(o.threads);
  const CharacterizedTip found = tip_from_characterizer(scans[0], read_scan(known, o.quiet).field, options);
  io::write_tip(*o.output, found.tip,
                provenance_of("tip", {{"answer", "characterizer"}, {"size", fmt::format("{}", options.width)},
                                       {"search", fmt::format("{}", options.search)}},
                              {o.input.file, *o.characterizer}));
  if (o.plot) io::write_plot(*o.plot, tip_plot(found.tip));
  if (found.offset_at_limit)
    print_warning(fmt::format("scan and characterizer are {} samples or more apart: crop the scan",
                              options.search));
  if (o.quiet) return 0;
  print("{:<10} found at sample ({}, {}) of the scan, {} above; residual {}\n", "known", found.offset_x,
             found.offset_y, format_length(found.offset_z_nm), format_length(found.residual_nm));
  print_tip(found.tip, std::max(height_range(scans).span_nm(), 1e-9));
  print_written(files_of(o));
  return 0;
}

int work(const Options& o) {
  if (!o.output) throw UsageError("--output", "no output file is given", "Add -o tip.gsf");
  io::check_height_field_target(*o.output);
  if (o.plot) io::check_plot_target(*o.plot);
  if (o.shape) return by_shape(o);
  if (o.input.file.empty()) throw UsageError("tip", "no scan is given", "Name a file to read, or --shape");
  if (o.characterizer) return by_characterizer(o);
  Plan p = make_plan(o);
  const std::vector<HeightField> scans = read_scans(o);
  if (!p.noise && p.answer != Answer::blind) p.noise = noise_of(scans);
  if (p.noise && !o.quiet)
    print("{:<10} {}, alpha {:.2f}{}\n", "noise", format_length(std::sqrt(p.noise->variance_nm2())), p.noise->alpha,
          o.noise ? "" : ", from differences of neighbouring rows and columns");

  InterruptGuard interrupt;
  ProgressBar bar(!o.quiet);
  const auto progress = [&](double done, double total) { bar.show(done, total, "tips"); };
  const CancelToken* cancel = interrupt.token();
  Tip tip;
  double threshold_nm = p.blind.threshold_nm;
  io::Plot plot;
  if (p.answer == Answer::sweep) {
    p.sweep.blind = p.blind;
    p.sweep.noise = *p.noise;
    const TipSweep sweep = sweep_tips(scans, p.sweep, progress, cancel);
    if (sweep.verdict == TipSweepVerdict::cancelled) return exit_interrupted;
    bar.clear();
    tip = sweep.curve[sweep.chosen].tip;
    tip.doubt = doubt_of_tip(sweep);
    threshold_nm = sweep.curve[sweep.chosen].threshold_nm;
    print_sweep(sweep, o.quiet);
    plot = tip_plot(sweep);
  } else if (p.answer == Answer::best) {
    BestTipOptions best;
    best.width = p.blind.width;
    best.height = p.blind.height;
    best.noise = *p.noise;
    best.threads = p.blind.threads;
    BestTipSummary summary;
    tip = best_tip(scans, best, summary, progress, cancel);
    if (cancel->cancelled()) return exit_interrupted;
    bar.clear();
    threshold_nm = summary.chosen.threshold_nm;
    if (!o.quiet)
      print("{:<10} misfit {:.2f} with {:.2f} free surface pixels per pixel, {} samples touched\n", "fit",
                 summary.chosen.misfit, summary.chosen.freedom, summary.touched);
    plot = tip_plot(tip, summary);
  } else {
    if (p.answer == Answer::outer) {
      double pixels = 0;
      for (const HeightField& s : scans) pixels += static_cast<double>(s.z_nm.size());
      p.blind.threshold_nm = p.blind.apex_tolerance_nm = threshold_nm =
          outer_threshold_nm(*p.noise, pixels, p.blind.width * p.blind.height);
      if (!o.quiet)
        print("{:<10} {}: at 95 % an outer bound\n", "threshold", format_length(threshold_nm));
    }
    BlindTipSummary summary;
    tip = blind_tip(scans, p.blind, summary, progress, cancel);
    if (summary.end == BlindTipEnd::cancelled) return exit_interrupted;
    bar.clear();
    plot = tip_plot(tip);
  }
  if (p.answer != Answer::sweep) tip.doubt = doubt_of_shape(tip);
  io::write_tip(*o.output, tip, [&] {
    std::vector<std::string> inputs{o.input.file};
    inputs.insert(inputs.end(), o.also.begin(), o.also.end());
    return provenance_of("tip", made_by(o, p, p.noise ? &*p.noise : nullptr, threshold_nm), inputs);
  }());
  if (o.plot) io::write_plot(*o.plot, plot);
  const double sigma = p.noise ? std::sqrt(p.noise->variance_nm2()) : 0;
  const std::vector<double> open_ways = unconstrained_directions(tip, threshold_nm + 3 * sigma);
  if (!o.quiet) print_tip(tip, std::max(height_range(scans).span_nm(), 1e-9));
  if (!open_ways.empty())
    print_warning(fmt::format("the scan does not tell the tip's shape towards {} degrees (counter-clockwise "
                              "from +x): nothing there is steep enough. What is given is the bluntest tip "
                              "possible", ranges_of(open_ways)));
  const int code = report_doubt(tip);
  if (!o.quiet) print_written(files_of(o));
  return code;
}

}  // namespace

void add_tip(CLI::App& app, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("tip", "Find the tip that made a scan, or make one by its shape");
  sub->group("Commands");
  add_scan_input(*sub, o->input);
  sub->add_option("--also", o->also, "Another scan by the same tip; may be repeated")->type_name("FILE");
  const char* tip = "Tip";
  sub->add_option("--size", o->size, "Samples across, odd (21; 41 with --shape)")->type_name("N")->group(tip);
  sub->add_option("--answer", o->answer, "How it is found (sweep; blind with --threshold)")
      ->type_name("sweep|outer|best|blind")->group(tip);
  sub->add_option("--noise", o->noise, "Of the scan: standard deviation, and its correlation from one pixel\n"
                                       "to the next (estimated from the scan)")
      ->type_name("LENGTH")->option_text("LENGTH[,ALPHA]")->group(tip);
  sub->add_option("--shape", o->shape,
                  "No scan: parabola:RADIUS, cone:RADIUS,ANGLE, pyramid:RADIUS,ANGLE,FACES,\n"
                  "ball:RADIUS or ball:RADIUS,STEM_RADIUS,STEM_ANGLE (angles from the axis)")
      ->type_name("SHAPE")->group(tip);
  sub->add_option("--characterizer", o->characterizer, "The known surface that the scan shows, as heights")
      ->type_name("FILE")->group(tip);
  sub->add_option("--search", o->search, "Samples that scan and characterizer may be apart (10)")
      ->type_name("N")->group(tip);
  const char* blind = "Blind reconstruction";
  sub->add_option("--threshold", o->threshold, "Lower samples of the tip only by more than this")
      ->type_name("LENGTH")->group(blind);
  sub->add_option("--threshold-y", o->threshold_y, "The same across scan lines (as --threshold)")
      ->type_name("LENGTH")->group(blind);
  sub->add_option("--apex-tolerance", o->apex_tolerance, "How far the apex may stick out of the scan (0nm)")
      ->type_name("LENGTH")->group(blind);
  sub->add_option("--layer", o->layer, "Half the height of the layer that the true scan lies in (0nm)")
      ->type_name("LENGTH")->group(blind);
  sub->add_flag("--maxima", o->maxima, "Use local maxima only")->group(blind);
  sub->add_option("--sweep", o->sweep, "Thresholds to try (0.3 to 8 standard deviations of the noise, 40)")
      ->type_name("FROM,TO,N")->group(blind);
  sub->add_option("--seed", o->seed, "Of the noise that residuals are compared with (1)")
      ->type_name("N")->group(blind);
  const char* output = "Output";
  sub->add_option("-o,--output", o->output, "Tip to write: .gsf .tif .txt .vti")->type_name("FILE")->group(output);
  sub->add_option("--plot", o->plot, "Chart of the choice and the tip: .svg .png")->type_name("FILE")->group(output);
  add_threads_option(*sub, o->threads)->group(output);
  add_quiet_flag(*sub, o->quiet)->group(output);
  sub->footer(examples);
  sub->callback([o, &action] { action = [o] { return work(*o); }; });
}

}  // namespace surf::cli
