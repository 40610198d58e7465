// An instability of the solver in the building's own names.
#include <algorithm>
#include <string_view>

#include "analysis/instability.h"
#include "model/index_of.h"
#include "model/short_number.h"
#include "standing/unstable_model.h"

namespace topple::structure {

namespace {

/// Nodes among those that move which neither a member nor a shell reaches, but a membrane does.
std::vector<NodeId> held_by_membranes_only(const Building& building, const std::vector<NodeId>& moving) {
  std::vector<char> on_member(building.nodes.size(), 0), on_membrane(building.nodes.size(), 0);
  for (const Member& member : building.members)
    for (const NodeId node : member.nodes) on_member[index_of(node)] = 1;
  for (const Panel& panel : building.panels)
    if (panel.model != PanelModel::cladding)
      for (const NodeId node : panel.nodes)
        (panel.model == PanelModel::membrane ? on_membrane : on_member)[index_of(node)] = 1;
  std::vector<NodeId> found;
  for (const NodeId node : moving) {
    const auto n = index_of(node);
    if (on_membrane[n] != 0 && on_member[n] == 0) found.push_back(node);
  }
  return found;
}

/// The member that a beam of the frame is, or is a piece of.
std::size_t member_of(const Building& building, const Frame& frame, int beam) {
  auto member = static_cast<std::size_t>(beam);
  if (member >= building.members.size())
    for (std::size_t m = 0; m < frame.pieces.size(); ++m)
      for (const MemberPiece& piece : frame.pieces[m])
        if (piece.beam == beam) member = m;
  return member;
}

const std::string& member_name(const Building& building, const Frame& frame, int beam) {
  return building.members[member_of(building, frame, beam)].name;
}

}  // namespace

std::string describe_instability(const Building& building, const Frame& frame, const solver::Instability& instability) {
  const solver::Mechanism& mechanism = instability.mechanism;
  FrameMechanism named;
  std::size_t of_meshes = 0;
  for (const int node : mechanism.nodes) {
    if (static_cast<std::size_t>(node) < building.nodes.size())
      named.nodes.push_back(NodeId(static_cast<std::size_t>(node)));
    else
      ++of_meshes;
  }
  named.motion = mechanism.motion;
  std::string text;
  if (!named.nodes.empty()) {
    text = describe_mechanism(building, named);
    if (of_meshes > 0) text += "; and " + std::to_string(of_meshes) + " mesh nodes of shell panels with them";
  } else if (of_meshes > 0) {
    text = "the model is unstable: " + std::to_string(of_meshes) + " mesh nodes of shell panels move";
  } else {
    text = "the model is unstable:";
    constexpr std::size_t named_at_most = 8;
    for (std::size_t i = 0; i < std::min(mechanism.beams.size(), named_at_most); ++i)
      text += (i ? ", member " : " member ") + member_name(building, frame, mechanism.beams[i]);
    if (mechanism.beams.size() > named_at_most)
      text += " and " + std::to_string(mechanism.beams.size() - named_at_most) + " more";
    if (!mechanism.beams.empty())
      text += ", released at both ends, can move by itself";
    else
      text = "the model is " + std::string(instability.what());
  }
  const auto hanging = held_by_membranes_only(building, named.nodes);
  if (!hanging.empty())
    text += "; only membrane panels reach node " + building[hanging.front()].name +
            (hanging.size() > 1 ? " and " + std::to_string(hanging.size() - 1) + " more" : "") +
            ", and a membrane holds nothing across its plane";
  return text;
}

std::string describe_buckling(const Building& building, const Frame& frame, const solver::Instability& instability) {
  const solver::Mechanism& mechanism = instability.mechanism;
  if (!mechanism.nodes.empty()) {
    const std::string text = describe_instability(building, frame, instability);
    constexpr std::string_view unstable = "the model is unstable: ";
    return text.starts_with(unstable) ? text.substr(unstable.size()) : text;
  }
  if (mechanism.beams.empty()) return "a member buckles between nodes that stay at rest";
  std::string text = mechanism.beams.size() > 1 ? "members" : "member";
  constexpr std::size_t named_at_most = 8;
  for (std::size_t i = 0; i < std::min(mechanism.beams.size(), named_at_most); ++i)
    text += (i ? ", " : " ") + member_name(building, frame, mechanism.beams[i]);
  if (mechanism.beams.size() > named_at_most)
    text += " and " + std::to_string(mechanism.beams.size() - named_at_most) + " more";
  return text + (mechanism.beams.size() > 1 ? " buckle" : " buckles") + " between the ends";
}

Diagnosis diagnose(const Building& building, const Frame& frame, const solver::Instability& instability,
                   const char* kind, CombinationId combination, const std::string& message) {
  const solver::Mechanism& mechanism = instability.mechanism;
  Diagnosis result{message, combination, kind, {}, {}, mechanism.motion};
  std::vector<char> moves(building.nodes.size(), 0), alone(building.members.size(), 0);
  for (const int node : mechanism.nodes) {
    const auto n = static_cast<std::size_t>(node);
    if (n >= moves.size()) continue;
    result.nodes.push_back(NodeId(n));
    moves[n] = 1;
  }
  for (const int beam : mechanism.beams) alone[member_of(building, frame, beam)] = 1;
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    const Member& member = building.members[m];
    const bool hangs_on =
        std::any_of(member.nodes.begin(), member.nodes.end(), [&](NodeId node) { return moves[index_of(node)] != 0; });
    if (hangs_on || alone[m] != 0) result.members.push_back(MemberId(m));
  }
  return result;
}

std::string describe_unresolved(const Building& building, const solver::UnresolvedModes& unresolved) {
  const auto told = [&](const solver::UnresolvedModes::Place& place) {
    const auto node = static_cast<std::size_t>(place.second);
    return short_number(place.first) + " 1/s2" +
           (node < building.nodes.size() ? " at node " + building.nodes[node].name : "");
  };
  return building.file + ", natural modes: " + unresolved.what() + ": stiffness over mass goes from " +
         told(unresolved.least) + " to " + told(unresolved.largest) +
         (building.requested.frequency_shift > 0
              ? ", with a shift of " + short_number(building.requested.frequency_shift)
              : "") +
         "; accepted: models in which less than 1e15 lies between the two, and the shift";
}

}  // namespace topple::structure
