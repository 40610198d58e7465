#pragma once
// Finite numbers in a range: one rule for files, the command line and the calls of a host. NaN and infinities lie in no
// range, so that a comparison that is false for NaN can never let one in.
#include <optional>
#include <string>
#include <string_view>

namespace topple::structure {

/// The numbers that something may take.
struct NumberRange {
  double least = 0;          ///< smallest
  double most = 0;           ///< largest, itself accepted
  bool above_least = false;  ///< `least` itself is not accepted

  /// False for NaN and infinities.
  [[nodiscard]] constexpr bool contains(double value) const {
    return (above_least ? value > least : value >= least) && value <= most;
  }
  /// "a number from 0 to 1", "a number above 0, at most 1000", for messages.
  [[nodiscard]] std::string text() const;
};

/// The decimal number that makes up all of `text`; none for anything else: nan, inf, what is too large to hold,
/// hexadecimal, spaces, nothing at all.
[[nodiscard]] std::optional<double> number_of(std::string_view text);

/// The value, when the range has it. Throws InputError: `what`, what was found, what is accepted.
double require_in(const NumberRange& range, double value, std::string_view what);

/// What physics has a use for, in SI units. Wider than any scene needs, and narrow enough that no product of them
/// leaves what a double holds and no loop over them is without end.
namespace ranges {

inline constexpr NumberRange anything{-1e100, 1e100};      ///< of any unit
inline constexpr NumberRange positive{1e-100, 1e100};      ///< of any unit, where only numbers above 0 have a meaning
inline constexpr NumberRange step{1e-6, 1};                ///< s: of a simulation
inline constexpr NumberRange duration{0, 1e6, true};       ///< s: of a run; eleven days
inline constexpr NumberRange instant{0, 1e6};              ///< s: when something happens, how long it takes
inline constexpr NumberRange session{0, 1e9, true};        ///< s: of a run that a host ends itself
inline constexpr NumberRange rate{1e-3, 1e4};              ///< pictures for each second
inline constexpr NumberRange place{-1e6, 1e6};             ///< m: a coordinate
inline constexpr NumberRange length{1e-3, 1e6};            ///< m
inline constexpr NumberRange radius{1e-3, 1e3};            ///< m: of a body
inline constexpr NumberRange mass{1e-6, 1e9};              ///< kg: of a body
inline constexpr NumberRange speed{0, 1e4};                ///< m/s: what the fastest solid projectiles have
inline constexpr NumberRange plastic_rotation{1e-6, 100};  ///< rad: that a ductile joint holds
inline constexpr NumberRange turning_speed{0, 1e6};        ///< rad/s
inline constexpr NumberRange gravity{0, 1e5};              ///< m/s2; mm/s2 where a model counts in mm
inline constexpr NumberRange density{0, 1e6};              ///< kg/m3: fifty times that of the densest metal
inline constexpr NumberRange modulus{1, 1e15};             ///< Pa: of elasticity; a thousand times that of diamond
inline constexpr NumberRange force{-1e18, 1e18};           ///< N or N m
inline constexpr NumberRange strength_factor{0, 1e6};      ///< on capacities
inline constexpr NumberRange stiffness_factor{1e-6, 1};    ///< on E and G
inline constexpr NumberRange sudden{1, 10};                ///< factor f of R0 + f (R1 - R0)
inline constexpr NumberRange unit{0, 1};                   ///< a share, a coefficient of restitution
inline constexpr NumberRange friction{0, 100};             ///< coefficient
inline constexpr NumberRange volume{0, 1e9};               ///< m3

}  // namespace ranges

}  // namespace topple::structure
