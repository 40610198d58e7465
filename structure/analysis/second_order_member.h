#pragma once
// Internal forces and deflections along a member in a second-order state, in one piece or divided by a mesh.
#include <vector>

#include "topple/solver/second_order.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// As solver::SecondOrderDiagram, with deflections from the straight line between the ends of the whole member.
class SecondOrderMember {
 public:
  SecondOrderMember(const Frame& frame, std::size_t member, const std::vector<solver::Beam>& beams,
                    const solver::AxialState& axial, const solver::StaticSolution& solution);

  [[nodiscard]] std::array<double, 8> values(double distance, bool beyond = false) const;
  [[nodiscard]] std::vector<double> breaks() const;
  [[nodiscard]] solver::BeamDiagram::Range extremes(solver::BeamDiagram::Quantity quantity) const;

 private:
  struct Piece {
    double start, length;
    /// Displacements of its ends along local y and z, less those of the whole member's chord there.
    Vec2 first = Vec2::Zero(), last = Vec2::Zero();
    solver::SecondOrderDiagram diagram;
  };
  [[nodiscard]] static double value(const Piece& piece, solver::BeamDiagram::Quantity quantity, double within,
                                    bool beyond = false);
  static solver::BeamDiagram::Extreme highest(const Piece& piece, solver::BeamDiagram::Quantity quantity, double sign);

  std::vector<Piece> pieces_;
};

}  // namespace topple::structure
