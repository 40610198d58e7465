#include "analysis/second_order_member.h"

#include <algorithm>
#include <cmath>

namespace topple::structure {

namespace {

using solver::BeamDiagram;

/// Along y and z, of the section at a beam's end: where the rigid end is, less what a spring there gives. Behind a
/// release the section is taken to go with its rigid end.
Vec2 section_moves(const solver::Beam& beam, std::size_t end, const solver::Vec12& rigid_ends,
                   const solver::Vec12& forces) {
  Vec2 moves;
  for (int k = 0; k < 2; ++k) {
    const int component = 6 * static_cast<int>(end) + 1 + k;
    const double spring = beam.end_stiffness[end](1 + k);
    moves(k) = rigid_ends(component) - (spring > 0 && std::isfinite(spring) ? forces(component) / spring : 0);
  }
  return moves;
}

}  // namespace

SecondOrderMember::SecondOrderMember(const Frame& frame, std::size_t member, const std::vector<solver::Beam>& beams,
                                     const solver::AxialState& axial, const solver::StaticSolution& solution) {
  std::vector<MemberPiece> pieces = frame.pieces[member];
  if (pieces.empty()) pieces.push_back({static_cast<int>(member), 0});
  for (const MemberPiece& piece : pieces) {
    const auto b = static_cast<std::size_t>(piece.beam);
    const solver::Beam& beam = beams[b];
    const solver::Vec12& forces = solution.beam_end_forces[b];
    const solver::Vec12 rigid_ends = solver::beam_rigid_end_displacements(beam, solution.displacements);
    pieces_.push_back({piece.start, beam.length, section_moves(beam, 0, rigid_ends, forces),
                       section_moves(beam, 1, rigid_ends, forces),
                       solver::SecondOrderDiagram(beam, axial, piece.beam, forces, rigid_ends)});
  }
  const double length = pieces_.back().start + pieces_.back().length;
  const Vec2 from = pieces_.front().first, slope = (pieces_.back().last - from) / length;
  for (Piece& piece : pieces_) {
    piece.first -= from + piece.start * slope;
    piece.last -= from + (piece.start + piece.length) * slope;
  }
  if (pieces_.size() == 1) pieces_[0].first = pieces_[0].last = Vec2::Zero();
}

double SecondOrderMember::value(const Piece& piece, BeamDiagram::Quantity quantity, double within, bool beyond) {
  double value = piece.diagram.values(within, beyond)[static_cast<std::size_t>(quantity)];
  if (quantity >= BeamDiagram::deflection_y) {
    const int axis = quantity - BeamDiagram::deflection_y;
    value += piece.first(axis) + within / piece.length * (piece.last(axis) - piece.first(axis));
  }
  return value;
}

std::array<double, 8> SecondOrderMember::values(double distance, bool beyond) const {
  const Piece* at = &pieces_.front();
  for (const Piece& piece : pieces_)
    if (beyond ? piece.start <= distance : piece.start < distance) at = &piece;
  std::array<double, 8> result{};
  for (int q = 0; q < BeamDiagram::quantities; ++q)
    result[static_cast<std::size_t>(q)] =
        value(*at, static_cast<BeamDiagram::Quantity>(q), std::clamp(distance - at->start, 0.0, at->length), beyond);
  return result;
}

std::vector<double> SecondOrderMember::breaks() const {
  std::vector<double> places;
  for (const Piece& piece : pieces_) {
    if (piece.start > 0) places.push_back(piece.start);
    for (const double within : piece.diagram.breaks()) places.push_back(piece.start + within);
  }
  return places;
}

/// Of sign times a smooth quantity: the best of equal steps, then golden sections about it.
BeamDiagram::Extreme SecondOrderMember::highest(const Piece& piece, BeamDiagram::Quantity quantity, double sign) {
  constexpr int steps = 16, sections = 60;
  const auto height = [&](double x) { return sign * value(piece, quantity, x); };
  int best = 0;
  for (int i = 1; i <= steps; ++i)
    if (height(piece.length * i / steps) > height(piece.length * best / steps)) best = i;
  double low = piece.length * std::max(0, best - 1) / steps, high = piece.length * std::min(steps, best + 1) / steps;
  const double golden = (std::sqrt(5.0) - 1) / 2;
  for (int i = 0; i < sections; ++i) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    (height(a) < height(b) ? low : high) = height(a) < height(b) ? a : b;
  }
  double at = piece.length * best / steps;
  if (height((low + high) / 2) > height(at)) at = (low + high) / 2;
  return {sign * height(at), piece.start + at};
}

BeamDiagram::Range SecondOrderMember::extremes(BeamDiagram::Quantity quantity) const {
  BeamDiagram::Range range;
  bool first = true;
  for (const Piece& piece : pieces_) {
    BeamDiagram::Range own = piece.diagram.extremes(quantity);
    own.least.at += piece.start;
    own.greatest.at += piece.start;
    if (pieces_.size() > 1 && quantity >= BeamDiagram::deflection_y)
      own = {highest(piece, quantity, -1), highest(piece, quantity, 1)};
    if (first || own.least.value < range.least.value) range.least = own.least;
    if (first || own.greatest.value > range.greatest.value) range.greatest = own.greatest;
    first = false;
  }
  return range;
}

}  // namespace topple::structure
