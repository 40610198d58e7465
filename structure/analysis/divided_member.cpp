#include "analysis/divided_member.h"

#include "loads/on_pieces.h"

namespace topple::structure {

WholeMember whole_member(const Frame& frame, std::size_t member, const std::vector<solver::Beam>& beams,
                         const std::vector<solver::Vec12>& end_forces, std::vector<solver::BeamLoad> loads) {
  const std::vector<MemberPiece>& pieces = frame.pieces[member];
  WholeMember whole{beams[member], end_forces[member], std::move(loads)};
  if (pieces.empty()) return whole;
  const auto last = static_cast<std::size_t>(pieces.back().beam);
  whole.beam.node[1] = beams[last].node[1];
  whole.beam.offset[1] = beams[last].offset[1];
  whole.beam.end_stiffness[1] = beams[last].end_stiffness[1];
  whole.beam.length = pieces.back().start + beams[last].length;
  whole.end_forces.tail<6>() = end_forces[last].tail<6>();
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const auto before = static_cast<std::size_t>(pieces[i - 1].beam), after = static_cast<std::size_t>(pieces[i].beam);
    solver::BeamLoad tie;
    tie.beam = static_cast<int>(member);
    tie.kind = solver::BeamLoad::Kind::point;
    tie.from = pieces[i].start;
    tie.first = end_forces[before].tail<6>() + end_forces[after].head<6>();
    whole.loads.push_back(tie);
  }
  return whole;
}

solver::AxialState divided_state(const Frame& frame, const Frame& divided, solver::AxialState state) {
  const std::size_t beams = divided.model.beams.size();
  state.first_axial.resize(beams, 0);
  state.loads.resize(beams);
  if (!state.shell_displacements.empty()) state.shell_displacements.resize(divided.model.nodes.size(), Vec6::Zero());
  for (std::size_t m = 0; m < divided.pieces.size(); ++m) {
    if (divided.pieces[m].empty() || !frame.pieces[m].empty()) continue;
    std::vector<solver::BeamLoad> parts;
    for (const solver::BeamLoad& load : state.loads[m]) lay_on_pieces(divided.model, divided.pieces[m], load, parts);
    double tension = state.first_axial[m];
    state.loads[m].clear();
    for (const MemberPiece& piece : divided.pieces[m]) {
      const auto beam = static_cast<std::size_t>(piece.beam);
      state.first_axial[beam] = tension;
      for (const solver::BeamLoad& part : parts) {
        if (part.beam != piece.beam) continue;
        state.loads[beam].push_back(part);
        if (part.kind == solver::BeamLoad::Kind::point) tension -= part.first.x();
        if (part.kind == solver::BeamLoad::Kind::distributed)
          tension -= (part.first.x() + part.last.x()) / 2 * (part.to - part.from);
      }
    }
  }
  return state;
}

}  // namespace topple::structure
