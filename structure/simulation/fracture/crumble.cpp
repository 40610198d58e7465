// Crumble: a panel of a body that has other parts as well breaks where the body comes down hard on it. What the impact
// breaks out, and what then hangs on nothing, leaves as chunks; what its edges still hold stays with the body. All move
// on as the body did, so that momentum and kinetic energy go over exactly.
//
// Hard is an impact whose energy bends the panel to the force that punches it and punches it then, or one that is
// faster than what crushes the material (shatter.cpp). What lies on a panel presses on it without an impact.
#include <algorithm>

#include "loads/placed_load.h"
#include "simulation/fracture/debris_fracture.h"

namespace topple::structure {

std::map<PanelId, DebrisFracture::PanelImpact> DebrisFracture::impacts_on_panels(
    std::span<const ContactRecord> landings) const {
  std::map<PanelId, PanelImpact> impacts;
  if (!panels_.any()) return impacts;
  const auto feel = [&](collision::BodyId id, std::int64_t tag, const ContactRecord& contact, collision::BodyId other) {
    if (tag < 0) return;
    const PanelId panel = part_of_number(scene_.building, tag).panel;
    if (!panel.valid() || !panels_.of(panel).settings) return;
    const auto found = debris_.bodies.find(id.value);
    if (found == debris_.bodies.end() || debris_.bodies.motion(id.value).asleep ||
        panels_.breakable_of(found->second).valid())
      return;
    const Body& one = found->second;
    const collision::BodyState state = scene_.world->state(id);
    const Vec3 arm = contact.point - state.pose.position;
    const double impulse = std::abs(contact.impulse.dot(contact.normal));
    const Mat3 turn = state.pose.orientation.toRotationMatrix();
    const Mat3 inverse = world_inertia(one, state.pose.orientation).inverse();
    const double own = effective_mass(one.rest.mass, inverse, arm, contact.normal);
    const auto by = debris_.bodies.find(other.value);
    const Vec3 across = turn.transpose() * contact.normal;
    PanelImpact impact;
    impact.at = one.rest.centre + turn.transpose() * arm;
    impact.radius = by == debris_.bodies.end() ? 0 : by->second.radius;
    // The energy with which the two came together: the impulse is (1 + e) times what stops them.
    const double inverse_mass =
        1 / own + (by == debris_.bodies.end() ? 0 : inverse_effective_mass(by->second, contact));
    const double stops = impulse / (1 + scene_.scenario.debris.restitution);
    impact.energy = stops * stops * inverse_mass / 2;
    const bool crushes = impulse / own >= panels_.of(panel).breaking_speed;
    if (!crushes &&
        (contact.persistent || impact.energy < panels_.punching_energy(panel, impact.at, across, impact.radius)))
      return;
    PanelImpact& hardest = impacts[panel];
    if (impact.energy > hardest.energy) hardest = impact;
  };
  for (const ContactRecord& contact : landings) {
    const bool two = contact.other.kind == collision::Touched::Kind::body;
    feel(contact.body, contact.part_tag, contact, two ? contact.other.body : collision::BodyId());
    if (two) feel(contact.other.body, contact.other.part_tag, contact, contact.body);
  }
  return impacts;
}

double DebrisFracture::inverse_effective_mass(const Body& one, const ContactRecord& contact) const {
  const collision::BodyState state = scene_.world->state(one.id);
  const Mat3 inverse = world_inertia(one, state.pose.orientation).inverse();
  return 1 / effective_mass(one.rest.mass, inverse, contact.point - state.pose.position, contact.normal);
}

/// An edge holds by what the body still has at its nodes.
std::array<bool, 4> DebrisFracture::held_in_flight(PanelId panel, const Body& one) const {
  const Panel& own = scene_.building[panel];
  const auto bears = [&](NodeId node) {
    for (const MemberId member : one.members)
      for (int end = 0; end < 2; ++end)
        if (scene_.building[member].nodes[static_cast<std::size_t>(end)] == node &&
            break_up_.holds(scene_.building.joint(member, end)))
          return true;
    for (const PanelId other : one.panels) {
      if (other == panel || scene_.building[other].model != PanelModel::shell) continue;
      const std::vector<NodeId> nodes = scene_.building[other].all_nodes();
      if (std::find(nodes.begin(), nodes.end(), node) != nodes.end()) return true;
    }
    return false;
  };
  std::array<bool, 4> edges{};
  for (std::size_t edge = 0; edge < 4; ++edge)
    edges[edge] = break_up_.holds(scene_.building.joint(panel, static_cast<int>(edge))) &&
                  (bears(own.nodes[edge]) || bears(own.nodes[(edge + 1) % 4]) ||
                   std::any_of(own.edge_nodes[edge].begin(), own.edge_nodes[edge].end(), bears));
  return edges;
}

/// The chunks that leave the panel, as bodies where they were in the undeformed building.
std::vector<Body> DebrisFracture::break_out_in_flight(PanelId panel, const PanelImpact& impact) {
  const Body& one = debris_.bodies.at(debris_.body_of(Part(panel)));
  const std::array<bool, 4> holding = held_in_flight(panel, one);
  BrokenPanel& left = panels_.breaking(panel);
  const int before = left.chunks_out();
  std::vector<PanelChunk> chunks = left.hit(impact.at, impact.radius > 0 ? std::optional(impact.radius) : std::nullopt);
  if (chunks.empty()) return {};
  if (holding != left.held())
    for (PanelChunk& loose : left.hold(holding)) chunks.push_back(std::move(loose));
  std::vector<Body> pieces;
  for (PanelChunk& chunk : chunks)
    pieces.push_back(
        chunk_body(scene_.building, panel, std::move(chunk), before + static_cast<int>(pieces.size()) + 1));
  debris_.masses.set(panel, left.rest());
  debris_.shapes.set_broken(panel, left.hulls());
  return pieces;
}

void DebrisFracture::crumble(const std::map<PanelId, PanelImpact>& impacts) {
  std::map<std::int64_t, std::vector<Body>> chunks;  // by the body that they leave
  for (const auto& [hit, impact] : impacts) {
    const PanelId panel = hit;
    const std::int64_t id = debris_.body_of(Part(panel));
    if (!debris_.bodies.contains(id)) continue;
    // What lies frozen on it could not go with any one chunk.
    if (std::any_of(debris_.frozen.begin(), debris_.frozen.end(),
                    [&](const Debris::Frozen& lying) { return lying.on == Part(panel); }))
      continue;
    const Body& one = debris_.bodies.at(id);
    const collision::BodyState state = scene_.world->state(one.id);
    const Vec3 at = state.pose * (impact.at - one.rest.centre);
    std::vector<Body> pieces = break_out_in_flight(panel, impact);
    if (pieces.empty()) continue;
    landing_.spend(one.id, part_number(scene_.building, Part(panel)));
    log_.record(SimulationEvent::Kind::panel_fractured, scene_.building[panel].name).position = at;
    for (Body& piece : pieces) chunks[id].push_back(std::move(piece));
  }
  for (auto& [id, pieces] : chunks) {
    FreeSegmentParts left = break_up_.parts_of(debris_.bodies.at(id));
    for (std::size_t p = left.panels.size(); p-- > 0;) {
      const BrokenPanel* broken = panels_.broken(left.panels[p]);
      if (!broken || !broken->hulls().empty()) continue;
      debris_.lose(Part(left.panels[p]));
      left.panels.erase(left.panels.begin() + static_cast<std::ptrdiff_t>(p));
      left.panel_mass.erase(left.panel_mass.begin() + static_cast<std::ptrdiff_t>(p));
    }
    (void)break_up_.split({id},
                          connected_parts(
                              scene_.building, left, [&](JointId joint) { return break_up_.holds(joint); },
                              [&](PanelId panel) { return break_up_.free_panel_edges(panel); }),
                          std::move(pieces));
  }
}

}  // namespace topple::structure
