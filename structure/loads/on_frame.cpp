// Loads of whole members and shell panels, laid on the beams and elements that they are divided into.
#include <algorithm>

#include "loads/on_pieces.h"
#include "mesh/semi_rigid_elements.h"
#include "model/index_of.h"
#include "topple/structure/frame.h"

namespace topple::structure {

namespace {

using solver::BeamLoad;

/// The piece that holds a place; a place between two belongs to the later one.
std::size_t piece_at(const std::vector<MemberPiece>& pieces, double at) {
  const auto later = std::upper_bound(pieces.begin(), pieces.end(), at,
                                      [](double place, const MemberPiece& piece) { return place < piece.start; });
  return later == pieces.begin() ? 0 : static_cast<std::size_t>(later - pieces.begin()) - 1;
}

void divide_distributed(const solver::FrameModel& model, const std::vector<MemberPiece>& pieces, const BeamLoad& load,
                        std::vector<BeamLoad>& out) {
  const auto intensity = [&](double at) -> solver::Vec6 {
    return load.first + (at - load.from) / (load.to - load.from) * (load.last - load.first);
  };
  for (const MemberPiece& piece : pieces) {
    const double length = model.beams[static_cast<std::size_t>(piece.beam)].length;
    const double from = std::max(load.from, piece.start), to = std::min(load.to, piece.start + length);
    if (!(to > from)) continue;
    BeamLoad part = load;
    part.beam = piece.beam;
    part.from = from - piece.start;
    part.to = std::min(to - piece.start, length);
    part.first = intensity(from);
    part.last = intensity(to);
    out.push_back(part);
  }
}

}  // namespace

void lay_on_pieces(const solver::FrameModel& model, const std::vector<MemberPiece>& pieces, const BeamLoad& load,
                   std::vector<BeamLoad>& out) {
  BeamLoad part = load;
  switch (load.kind) {
    case BeamLoad::Kind::distributed:
      divide_distributed(model, pieces, load, out);
      break;
    case BeamLoad::Kind::point: {
      const MemberPiece& piece = pieces[piece_at(pieces, load.from)];
      part.beam = piece.beam;
      part.from = std::clamp(load.from - piece.start, 0.0, model.beams[static_cast<std::size_t>(piece.beam)].length);
      out.push_back(part);
      break;
    }
    case BeamLoad::Kind::temperature:
      for (const MemberPiece& piece : pieces) {
        part.beam = piece.beam;
        out.push_back(part);
      }
      break;
  }
}

solver::LoadSet on_frame(const Building& building, const Frame& frame, const PartLoads& loads,
                         const solver::LoadSet& whole) {
  solver::LoadSet set = whole;
  set.beams.clear();
  for (const BeamLoad& load : whole.beams) {
    const auto& pieces = frame.pieces[static_cast<std::size_t>(load.beam)];
    if (pieces.empty())
      set.beams.push_back(load);
    else
      lay_on_pieces(frame.model, pieces, load, set.beams);
  }
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    const PanelMesh& mesh = frame.meshes[p];
    const PanelAction& action = loads.panels[p];
    const Vec3 normal = building.panels[p].axes.row(2);
    const Vec3 traction = action.body_force - action.pressure * normal;
    if (traction.isZero(0) && action.strain == 0) continue;
    for (std::size_t k = 0; k < mesh.elements.size(); ++k) {
      const int shell = mesh.first_shell + static_cast<int>(k);
      if (const SemiRigidElement* semi_rigid = semi_rigid_element(frame, shell))
        add_element_loads(frame, *semi_rigid, traction, action.strain, set);
      else
        set.shells.push_back({shell, traction, action.strain});
    }
  }
  return set;
}

}  // namespace topple::structure
