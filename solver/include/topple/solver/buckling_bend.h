#pragma once
// Where a compressed member bends most in the shape in which a structure buckles.
//
// Under a uniform compression P a member without loads across it has, in each bending plane, the deflection
//   v = c0 + c1 x + c2 cos kx + c3 sin kx,   k^2 = P/(E I (1 - P/(G As))),   M = -P (c2 cos kx + c3 sin kx)
// (Timoshenko and Gere, Theory of Elastic Stability, sections 2.1 and 2.17); the four constants follow from the motion
// of the rigid ends through the springs or releases at its ends. Between rigid ends at rest there is a shape only under
// the load at which the member buckles by itself, where the four conditions are linearly dependent.
#include <array>

#include "topple/solver/frame_model.h"

namespace topple::solver {

/// Where and how much a member bends in a buckling shape.
struct BucklingBend {
  double moment = 0;  ///< the largest, in the plane where it is larger; N m, in the scale of the rigid ends' motion
  double place =
      0;  ///< of it: distance from the first end, m; 0 or the length when an end bends more than any place inside
  std::array<double, 2> at_ends{};  ///< the larger of both planes at each end
};

/// The load (above 0) under which the member buckles while its rigid ends rest; infinite when its ends hold it in
/// neither plane or it cannot buckle below 4 pi2 E I/L2.
[[nodiscard]] double buckling_load_between_resting_ends(const Beam& beam);

/// `compression`: above 0, at the critical factor. `rigid_ends`: displacements of the rigid ends at the member's ends,
/// local axes. When these are all zero: in the shape in which it buckles between them, of a size that means nothing.
[[nodiscard]] BucklingBend buckling_bend(const Beam& beam, double compression, const Vec12& rigid_ends);

}  // namespace topple::solver
