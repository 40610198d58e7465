#include "topple/structure/direct_analysis.h"

#include <array>
#include <cmath>

#include "model/panel_area.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

struct Direction {
  const char* name;
  std::size_t axis;
  double sign;
};
constexpr std::array<Direction, 4> directions{{{"+x", 0, 1}, {"-x", 0, -1}, {"+y", 1, 1}, {"-y", 1, -1}}};

/// What is downward of a load along a member, turned sideways, global; a load along the axes of the member or of its
/// projection is taken as it acts.
MemberLoad sideways(const MemberLoad& load, const Member& member, Eigen::Index axis) {
  MemberLoad turned = load;
  turned.frame = LoadFrame::global;
  const double level =
      std::hypot(member.axes(0, 0), member.axes(0, 1));  // of a projected load's length to the member's
  for (const auto& [from, to] : {std::pair(&load.first, &turned.first), std::pair(&load.last, &turned.last)}) {
    Vec3 force = from->head<3>();
    if (load.frame == LoadFrame::local) force = member.axes.transpose() * force;
    if (load.frame == LoadFrame::projected && load.kind == MemberLoad::Kind::distributed) force *= level;
    to->setZero();
    (*to)(axis) = -notional_share * force.z();
  }
  return turned;
}

/// A case's downward loads, sideways.
LoadCase notional_case(const Building& building, const LoadCase& whole, std::size_t direction) {
  const auto axis = static_cast<Eigen::Index>(direction);
  LoadCase turned;
  turned.name = whole.name + (direction == 0 ? " notional x" : " notional y");
  turned.self_weight(axis) = -notional_share * whole.self_weight.z();
  const auto at_node = [&](NodeId node, double downward) {
    NodeLoad load{node, Vec6::Zero()};
    load.load(axis) = notional_share * downward;
    if (downward != 0) turned.nodes.push_back(load);
  };
  for (const NodeLoad& load : whole.nodes) at_node(load.node, -load.load(2));
  for (const MemberLoad& load : whole.members)
    if (load.kind != MemberLoad::Kind::temperature)
      turned.members.push_back(sideways(load, building[load.member], axis));
  for (const PanelLoad& load : whole.panels) {
    const Panel& panel = building[load.panel];
    // Pressure acts against the normal.
    const double downward = load.pressure * panel.axes(2, 2) * panel_area(building, panel, true);
    for (const NodeId node : panel.nodes) at_node(node, downward / 4);
  }
  return turned;
}

}  // namespace

Building with_notional_loads(const Building& building, const std::vector<CombinationId>& combinations) {
  Building leaning = building;
  const std::size_t cases = building.cases.size();
  for (std::size_t direction = 0; direction < 2; ++direction)
    for (std::size_t c = 0; c < cases; ++c)
      leaning.cases.push_back(notional_case(building, building.cases[c], direction));
  leaning.combinations.clear();
  for (const CombinationId id : combinations)
    for (const Direction& to : directions) {
      Combination combination{building[id].name + " " + to.name, building[id].factors};
      for (const auto& [load, factor] : building[id].factors)
        combination.factors.emplace_back(LoadCaseId(cases + to.axis * cases + static_cast<std::size_t>(load.index)),
                                         to.sign * factor);
      for (const Combination& other : leaning.combinations)
        if (other.name == combination.name)
          throw InputError(building.file + ": combination " + combination.name +
                           " is there twice with the notional loads of the direct analysis; accepted: other names");
      leaning.combinations.push_back(std::move(combination));
    }
  return leaning;
}

Building with_reduced_stiffness(Building building) {
  for (Material& material : building.materials) {
    material.youngs_modulus *= stiffness_share;
    material.shear_modulus *= stiffness_share;
  }
  return building;
}

}  // namespace topple::structure
