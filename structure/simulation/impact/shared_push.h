#pragma once
// Numbers, and the search for an extreme, that the two pushes of an impact share: CoupledPush on a structure that
// answers statically, Impact of bodies and of what stands and moves.

namespace topple::structure::shared_push {

inline constexpr double pi = 3.14159265358979323846;
/// Samples in a period of the fastest mode when a peak, a failure or a parting is looked for: between two of them a
/// force has at most one extreme.
inline constexpr int samples_per_period = 48;
/// Of the largest squared frequency: below it a mode is a free motion.
inline constexpr double free_motion = 1e-12;
/// A force below this share of the largest peak is none.
inline constexpr double no_force = 1e-12;

/// Where a rate that is positive at `from` and negative at `to` passes through zero: by chords, halved where
/// those are slow.
template <typename Rate>
double passes_zero(double from, double to, double at_from, double at_to, const Rate& rate) {
  for (int k = 0; k < 100 && to - from > 1e-14 * to; ++k) {
    const double chord = from + (to - from) * at_from / (at_from - at_to);
    const double at = k % 3 == 2 || !(chord > from && chord < to) ? from + (to - from) / 2 : chord;
    const double value = rate(at);
    if (value == 0) return at;
    (value > 0 ? from : to) = at;
    (value > 0 ? at_from : at_to) = value;
  }
  return from + (to - from) / 2;
}

/// The first time in (from, to] at which `passed` holds, which it does at `to`.
template <typename Passed>
double first_time(double from, double to, const Passed& passed) {
  for (int k = 0; k < 100 && to - from > 1e-15 * to; ++k) {
    const double middle = from + (to - from) / 2;
    (passed(middle) ? to : from) = middle;
  }
  return to;
}

}  // namespace topple::structure::shared_push
