// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace surf {

/// A spectrum of edges: power density, nm^3, at frequencies above 0, 1 / nm, two-sided.
struct EdgeSpectrum {
  std::vector<double> frequency_per_nm, density_nm3;
};

/// What an edge's roughness is, without the noise of finding it: the spectrum of Palasantzas,
/// density = c sigma^2 xi / (1 + (2 pi f xi)^2)^(H + 1/2), plus a level of noise (Palasantzas,
/// Phys. Rev. B 48, 14472, 1993, doi:10.1103/PhysRevB.48.14472; Lorusso et al., J. Micro/Nanolith.
/// MEMS MOEMS 17, 041009, 2018, doi:10.1117/1.JMM.17.4.041009).
struct EdgeRoughness {
  double sigma_nm = 0;         ///< root mean square over all frequencies; 3 sigma is quoted
  double sigma_error_nm = 0;   ///< its standard error, at most sigma itself
  double correlation_nm = 0;   ///< xi
  double hurst = 0.5;          ///< H, 0.1 to 1
  double noise_nm = 0;         ///< standard deviation of the noise of each place
  double biased_sigma_nm = 0;  ///< that of the places as they were found, noise included
  bool found = false;          ///< whether there is more than noise
};

/// The mean of the spectra of edges, whose places are given at equal distances; each less its mean
/// and slope. Throws InvalidInput for fewer than 16 places, edges of different lengths, or places
/// that are not finite.
EdgeSpectrum edge_spectrum(const std::vector<std::vector<double>>& edges_nm, double distance_nm);

/// Fits roughness and noise to the spectrum of so many edges by Whittle's likelihood.
/// `biased_sigma_nm` is taken from the spectrum.
EdgeRoughness fit_roughness(const EdgeSpectrum& spectrum, int edges, double distance_nm);

/// The density that a roughness and its noise have at a frequency, nm^3.
double roughness_density(const EdgeRoughness& roughness, double frequency_per_nm,
                         double distance_nm);

}  // namespace surf
