#pragma once
// What an impact, a break, a fire or an explosion sounds like, computed from what happened: no recorded sounds.
#include <vector>

#include "renderer/shapes/looks.h"
#include "renderer/snapshot.h"

namespace topple::viewer {

/// Of what is synthesised, Hz.
inline constexpr int sample_rate = 44100;
/// Frequencies of bending modes of what is struck, and what they lose.
struct Modes {
  std::vector<double> frequencies;  ///< Hz, ascending
  double loss = 0;                  ///< loss factor: a mode of frequency f decays with exp(-pi f loss t)
};
/// Of a free bar of this mass and material whose depth is a tenth of its length and as wide as deep (Euler and
/// Bernoulli's beam; Blevins, Formulas for Natural Frequency and Mode Shape, 1979, table 8-1). Those that are heard:
/// 20 Hz to 10 kHz.
[[nodiscard]] Modes modes_of(Look material, double mass);

/// One sound, from its beginning, at most 3 s, samples within -1 to 1 at the loudest; the same for the same puff's
/// kind, material, mass and `variant`. Its energy is not in it: see loudness().
[[nodiscard]] std::vector<float> synthesise(const DustPuff& puff, unsigned variant);
/// Gain at `reference_distance`, 0 to 1. Sound pressure goes with the root of the energy; ears and loudspeakers span
/// less, so that its logarithm is halved.
[[nodiscard]] double loudness(const DustPuff& puff);
inline constexpr double reference_distance = 12;  ///< m: nearer is not louder

}  // namespace topple::viewer
