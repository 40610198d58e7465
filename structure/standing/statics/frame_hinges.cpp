// Plastic hinges in the statics of a standing frame. One that yields is a release, with the moment that it holds as a
// load on the member's end and, reversed, on the rigid end; one that unloads is a joint with an angle in it.
#include <type_traits>

#include "model/index_of.h"
#include "standing/statics/frame_statics.h"

namespace topple::structure {

void FrameStatics::write_loads(MemberId member) {
  const Place& place = member_place_[index(member)];
  std::vector<solver::BeamLoad> loads = with_hinges(member, member_loads_[index(member)]);
  for (solver::BeamLoad& load : loads) load.beam = place.local;
  change(place, [&](auto& frame) {
    // One that moves turns its own hinges.
    if constexpr (std::is_same_v<std::remove_reference_t<decltype(frame)>, solver::FrameDynamics>)
      frame.set_beam_loads(place.local, member_loads_[index(member)]);
    else
      frame.set_beam_loads(place.local, loads);
  });
  if (!hinges_.contains(member)) return;
  for (const int node : beam(member).node) write_load(nodes(place.component)[static_cast<std::size_t>(node)]);
}

void FrameStatics::write_load(NodeId node) {
  const Place& place = node_place_[index(node)];
  Vec6 load = node_loads_[index(node)];
  for (const auto& [member, hinges] : hinges_) {
    if (member_place_[index(member)].component != place.component) continue;
    const solver::Beam& own = beam(member);
    for (std::size_t end = 0; end < 2; ++end)
      if (own.node[end] == place.local)
        load.tail<3>() -= own.axes.transpose() * hinges.held.segment<3>(static_cast<Eigen::Index>(6 * end + 3));
  }
  // A frame that moves finds the geometric forces of its own motion.
  const Vec6 at_rest = second_order_ ? Vec6(load + geometric_[index(node)]) : load;
  change(place, [&](auto& frame) {
    constexpr bool rests = std::is_same_v<std::decay_t<decltype(frame)>, solver::Reanalysis>;
    frame.set_node_load(place.local, rests ? at_rest : load);
  });
}

void FrameStatics::set_hinge(MemberId member, int end, int axis, double stiffness, double held,
                             double plastic_rotation) {
  const Place& place = member_place_[index(member)];
  const auto [found, made] = hinges_.try_emplace(member);
  Hinges& hinges = found->second;
  if (made) hinges.stiffness = beam(member).end_stiffness;
  Vec6& own = hinges.stiffness[static_cast<std::size_t>(end)];
  own(axis) = stiffness;
  hinges.held(6 * end + axis) = held;
  hinges.plastic_rotation(6 * end + axis) = plastic_rotation;
  change(place, [&](auto& frame) { frame.set_end_stiffness(place.local, end, own); });
  write_loads(member);
}

void FrameStatics::let_yield(MemberId member, int end, int axis, double held) {
  set_hinge(member, end, axis, 0, held, 0);
}

void FrameStatics::unload(MemberId member, int end, int axis, double stiffness, double plastic_rotation) {
  set_hinge(member, end, axis, stiffness, 0, plastic_rotation);
}

}  // namespace topple::structure
