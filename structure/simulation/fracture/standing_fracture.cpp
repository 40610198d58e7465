// A punch fails along a cone at 45 degrees around the body: tensile strength times the cone's area seen along the
// impact, pi t (2 r + t) for a round body of radius r (ACI 349, appendix D, with the tensile strength itself in place
// of 4 sqrt(f'c)). An impact that is faster than what crushes the material (shatter.cpp) feels the panel alone: it is
// through before the rest of the structure has moved, and the punch costs it the work of that force, falling to nothing
// over the thickness. What is broken out has to be taken along: body and chunks leave with one speed, which keeps
// momentum.
#include "simulation/fracture/standing_fracture.h"
#include "model/index_of.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/debris/debris_settings.h"

namespace topple::structure {

double StandingFracture::punching_force(const Strike& hit) const {
  return hit.part.panel.valid() ? panels_.punching_force(hit.part.panel, hit.normal, hit.body->radius) : unlimited;
}

/// Speed that the punch leaves an impact that is fast enough to feel the panel alone; 0 for one that is not.
double StandingFracture::speed_through(const Strike& hit, double force) const {
  if (force == unlimited) return 0;
  const std::size_t panel = index_of(hit.part.panel);
  const double work = force * scene_.building.panels[panel].thickness / 2;
  const double left = hit.speed * hit.speed - 2 * work / hit.mass;
  return hit.speed > panels_.of(hit.part.panel).breaking_speed && left > 0 ? std::sqrt(left) : 0;
}

/// With the speed that is left. True when it went through.
bool StandingFracture::punch_at_once(Strike& hit, double force, double left) {
  const double plug = break_out(hit);
  if (!(plug > 0)) return false;
  hit.through = true;
  hit.structure_mass = 0;
  hit.peak_force = force;
  hit.speed_out = left * hit.mass / (hit.mass + plug);
  return true;
}

double StandingFracture::break_out(Strike& hit) {
  const PanelId panel = hit.part.panel;
  auto radius = hit.body->radius > 0 ? std::optional(hit.body->radius) : std::nullopt;
  // Local damage has lengths of its own; only a larger body makes it larger.
  const auto& settings = panels_.of(panel).settings;
  if (radius && settings->method == fracture::Method::local && *radius < settings->local.length[1]) radius.reset();
  std::vector<PanelChunk> chunks = hit.body->radius > 0
                                       ? panels_.breaking(panel).hit_through(hit.place.point, radius, hit.body->radius)
                                       : panels_.breaking(panel).hit(hit.place.point, radius);
  if (chunks.empty()) return 0;
  const RigidMotion moves = motion_of(panel);
  double plug = 0, momentum = 0;
  for (const PanelChunk& chunk : chunks) {
    if (!chunk.hit) continue;
    plug += chunk.rest.mass;
    momentum += chunk.rest.mass * moves.at(chunk.rest.centre).dot(hit.normal);
  }
  if (plug > 0) hit.chunk_speed = momentum / plug;
  log_.record(SimulationEvent::Kind::panel_fractured, scene_.building[panel].name).position = hit.place.point;
  hit.chunks = break_standing(panel, std::move(chunks));
  return plug;
}

/// Where the stress passes what the material bears, a panel cracks at its largest; what that leaves is looked at
/// again.
void StandingFracture::crack() {
  for (std::size_t p = 0; p < scene_.building.panels.size(); ++p) {
    const PanelId panel(p);
    const BreakablePanel& breakable = panels_.of(panel);
    if (!breakable.settings || !scene_.frame->stands(panel)) continue;
    const std::optional<PanelStress> stress = scene_.frame->stress(panel);
    if (!stress) continue;
    const double tension = stress->tension / breakable.tensile_strength;
    const double compression = stress->compression / breakable.compressive_strength;
    if (std::max(tension, compression) <= 1) continue;
    const Vec3 at = tension >= compression ? stress->tension_at : stress->compression_at;
    std::vector<PanelChunk> chunks = panels_.breaking(panel).hit(at, std::nullopt);
    if (chunks.empty()) continue;
    log_.record(SimulationEvent::Kind::panel_fractured, scene_.building[panel].name).position = at;
    (void)break_standing(panel, std::move(chunks));
  }
}

StandingFracture::RigidMotion StandingFracture::motion_of(PanelId panel) const {
  const StandingFrame::PanelMotion motion = scene_.frame->motion(panel);
  return {debris_.masses.of(panel).centre, motion.velocity, motion.spin};
}

/// These chunks of a standing panel become bodies that move as their places in it did; everybody hears of what remains.
/// Returns the bodies of those that a hit broke out.
std::vector<collision::BodyId> StandingFracture::break_standing(PanelId panel, std::vector<PanelChunk> chunks) {
  const BrokenPanel& left = panels_.breaking(panel);
  const Part part(panel);
  Vec3 sunk = Vec3::Zero();
  for (const NodeId node : scene_.building[panel].nodes) sunk += scene_.frame->displacement(node).head<3>() / 4;
  if (sunk.norm() > debris_settings.largest_start) sunk *= debris_settings.largest_start / sunk.norm();

  const RigidMotion moves = motion_of(panel);
  Vec3 taken = Vec3::Zero();
  for (const PanelChunk& chunk : chunks) taken += chunk.rest.mass * moves.at(chunk.rest.centre);
  scene_.frame->fracture(panel, left.remains(), taken);
  if (left.hulls().empty()) {
    debris_.stop_standing(part);
    debris_.lose(part);
  } else {
    debris_.masses.set(panel, left.rest());
    debris_.shapes.set_broken(panel, left.hulls());
    debris_.renew_shape(part);
  }

  std::vector<collision::BodyId> out;
  int number = left.chunks_out() - static_cast<int>(chunks.size());
  double dust = 0;
  for (PanelChunk& chunk : chunks) {
    const bool of_hit = chunk.hit;
    Body piece = chunk_body(scene_.building, panel, std::move(chunk), ++number);
    if (piece.volume < scene_.scenario.debris.smallest_volume) {
      dust += piece.rest.mass;
      continue;
    }
    const Vec3 velocity = moves.at(piece.rest.centre);
    sums_.kinetic_released +=
        (piece.rest.mass * velocity.squaredNorm() + moves.spin.dot(piece.rest.inertia * moves.spin)) / 2;
    const collision::BodyId id = debris_.add(std::move(piece), velocity, moves.spin, sunk);
    if (of_hit) out.push_back(id);
  }
  if (dust > 0) log_.record(SimulationEvent::Kind::limited, scene_.building[panel].name).mass = dust;
  return out;
}

/// What a hit broke out of a standing panel leaves with the speed of the body, which flies on through the hole.
void StandingFracture::push_chunks(const Strike& hit) {
  if (!hit.part.panel.valid() || !hit.through) return;
  if (const collision::ObstacleId panel = debris_.obstacles.obstacle_of(hit.part); panel.value >= 0) {
    collision::Touched touched;
    touched.kind = collision::Touched::Kind::obstacle;
    touched.obstacle = panel;
    debris_.pass(hit.body->id, touched);
  }
  for (const collision::BodyId id : hit.chunks) {
    debris_.pass(hit.body->id, id);
    collision::BodyState state = scene_.world->state(id);
    const Vec3 came = scene_.reading().true_velocity(state.velocity);
    const Vec3 gained = (hit.speed_out - came.dot(hit.normal)) * hit.normal;
    state.velocity += gained;
    sums_.ledger.lost_in_impacts -= debris_.bodies.at(id.value).rest.mass * gained.dot(came + gained / 2);
    scene_.world->set_state(id, state);
  }
}

/// Where edges of broken panels have failed since, pieces that only they held leave.
void StandingFracture::drop_loose_pieces() {
  for (auto& [panel, broken] : panels_.all_broken()) {
    if (!scene_.frame->stands(panel)) continue;
    const std::array<bool, 4> now = panels_.held(panel);
    if (now == broken.held()) continue;
    std::vector<PanelChunk> loose = broken.hold(now);
    if (loose.empty()) continue;
    log_.record(SimulationEvent::Kind::panel_fractured, scene_.building[panel].name).position =
        loose.front().rest.centre;
    (void)break_standing(panel, std::move(loose));
  }
}

}  // namespace topple::structure
