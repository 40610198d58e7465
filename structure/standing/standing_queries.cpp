// What acts on a standing frame and how it bears it, for drawings; and capacities that change while it stands.
#include <algorithm>

#include "standing/shell_reading.h"
#include "standing/standing_state.h"
#include "topple/solver/beam_diagram.h"

namespace topple::structure {

std::vector<std::array<double, 8>> StandingFrame::internal_forces(MemberId member, int intervals) const {
  const State& state = *state_;
  if (!state.stands(member)) return {};
  const solver::BeamDiagram diagram(state.statics.beam(member), end_forces(member), state.in_solver.loads(member));
  std::vector<std::array<double, 8>> values;
  const double length = state.building[member].length;
  for (int i = 0; i <= intervals; ++i) values.push_back(diagram.values(length * i / intervals));
  return values;
}

std::vector<solver::BeamLoad> StandingFrame::member_loads(MemberId member) const {
  return state_->stands(member) ? state_->in_solver.loads(member) : std::vector<solver::BeamLoad>();
}

Vec6 StandingFrame::node_load(NodeId node) const {
  return state_->stands(node) ? state_->in_solver.load(node) : Vec6(Vec6::Zero());
}

Vec6 StandingFrame::reaction(std::size_t support) const {
  const NodeId node = state_->building.supports[support].node;
  if (!state_->stands(node)) return Vec6::Zero();
  if (state_->moves(state_->statics.component(node))) return state_->motion->reaction(node, support);
  return state_->statics.reaction(support);
}

std::vector<ContactLoad> StandingFrame::contact_loads() const {
  std::vector<ContactLoad> loads;
  for (const auto& [key, load] : state_->contacts.all())
    if (state_->stands(load.place)) loads.push_back(load);
  return loads;
}

std::optional<PanelStress> StandingFrame::stress(PanelId panel) const {
  const State& state = *state_;
  if (!state.stands(panel) || !state.statics.stiff(panel)) return std::nullopt;
  const bool in_motion = state.moves(state.components.of(panel));
  const Panel& own = state.building[panel];
  if (const PanelSuperelement* shell = state.shells.of(panel)) {
    const PanelLoading all = state.parts.bearings.tracks(panel) ? PanelLoading{} : state.loading(panel);
    return shell->worst_stress(
        in_motion ? node_displacements(own, *state.motion) : node_displacements(own, state.statics), all);
  }
  return mean_membrane_stress(state.building, panel,
                              in_motion ? state.motion->corner_forces(panel) : state.statics.corner_forces(panel));
}

std::vector<PlasticRotation> StandingFrame::plastic_rotations() const {
  std::vector<PlasticRotation> turned;
  for (int c = 0; c < state_->statics.components(); ++c)
    for (const PlasticHinge& hinge : state_->yielding.hinges(c))
      if (hinge.plastic_rotation != 0 && state_->parts.standing(hinge.joint))
        turned.push_back({hinge.joint, hinge.sense(), hinge.plastic_rotation, hinge.limit});
  // Components hold their joints in order, and follow each other in the order of their nodes.
  std::sort(turned.begin(), turned.end(), [](const PlasticRotation& a, const PlasticRotation& b) {
    return a.joint != b.joint ? a.joint < b.joint : a.sense < b.sense;
  });
  return turned;
}

void StandingFrame::capacity_changed(JointId joint) {
  State& state = *state_;
  const int c = state.components.of(joint);
  std::vector<JointId>& checked = state.components.joints[static_cast<std::size_t>(c)];
  const auto place = std::lower_bound(checked.begin(), checked.end(), joint);
  const bool was_checked = place != checked.end() && *place == joint;
  const bool breakable = state.building[joint].capacity.breakable;
  if (was_checked && !breakable) checked.erase(place);
  if (breakable && !was_checked) {
    checked.insert(place, joint);
    if (state.parts.standing(joint)) {
      state.joints.set_demand(joint, state.answers.solved_demand(joint));
      state.joints.accept(joint);
    }
  }
  state.joints.capacity_changed(joint);
  state.check_again(c);
  state.pending = true;
}

}  // namespace topple::structure
