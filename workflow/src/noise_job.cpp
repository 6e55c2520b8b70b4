// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/noise_job.h"

#include <utility>

#include "surf/afm/background.h"
#include "surf/afm/substrate_noise.h"

namespace surf::workflow {
namespace {

ScanNoise of_flat_scan(const HeightField& scan, const FlatNoiseOptions& options, const Mask& use) {
  ScanNoise noise;
  noise.estimate = estimate_flat_noise(scan, options, use);
  HeightField residual = scan;
  subtract(residual, fit_polynomial(scan, options.degree, use));
  noise.residual_nm = std::move(residual.z_nm);
  noise.samples = Mask(scan.z_nm.width(), scan.z_nm.height(), 1);
  for (std::size_t i = 0; i < noise.samples.size(); ++i)
    noise.samples.data()[i] = use.includes(i) && (scan.valid.includes(i));
  return noise;
}

ScanNoise of_substrate(const HeightField& scan, const FlatNoiseOptions& options, const Mask& use,
                       const Reporter& reporter) {
  SubstrateNoise s = estimate_substrate_noise(scan, options, use);
  if (s.plane.verdict != HoughVerdict::clear)
    reporter.warn(
        "no plane holds a clear majority of the image, so there may be no substrate to take the "
        "noise from. Give "
        "`scan.use` or `scan.exclude`, crop the image, say `noise.flat` of a flat scan, or trust "
        "the noise of the "
        "differences instead");
  ScanNoise noise;
  noise.estimate = s.estimate;
  noise.samples = std::move(s.substrate);
  noise.residual_nm = std::move(s.residual_nm);
  noise.substrate_share = s.substrate_share;
  noise.plane = std::move(s.plane);
  return noise;
}

}  // namespace

void describe(ParameterVisitor& visit, ScanNoiseParameters& p) {
  visit(p.flat,
        {.name = "noise.flat", .help = "All of the scan is flat: a calibration scan, as of mica"});
  visit(p.degree, {.name = "noise.degree",
                   .help = "Degree of the polynomial that is taken off first",
                   .limits = within(0, 6)});
  visit(p.lags, {.name = "noise.lags",
                 .help = "Distance in pixels up to which whiteness is tested",
                 .limits = within(1, 1000),
                 .level = Level::advanced});
}

ScanNoise noise_of_scan(const HeightField& scan, const ScanNoiseParameters& p, const Mask& use,
                        const Reporter& reporter) {
  check_parameters(p);
  const FlatNoiseOptions options{p.degree, reporter.watch(0, 0.9)};
  ScanNoise noise =
      p.flat ? of_flat_scan(scan, options, use) : of_substrate(scan, options, use, reporter);
  if (!(noise.estimate.noise.innovation_nm2 > 0)) {
    reporter.warn("there is no noise at all in these heights: they may be simulated or filtered");
    return noise;
  }
  noise.white = whiten(noise.residual_nm, noise.estimate.noise, noise.samples);
  noise.check = check_noise(noise.white, noise.samples, {.lags = p.lags});
  return noise;
}

}  // namespace surf::workflow
