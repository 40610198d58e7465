// Shatter: a panel that has come off breaks into chunks where something hits it hard enough.
//
// The chunks move on as the parts of one rigid body, so that momentum and energy go over exactly; what hit the panel
// out of the frame then pushes the chunks that it broke out. Hard enough is an impact whose elastic wave carries more
// than the compressive strength: the stress at the front of a wave is v sqrt(E rho), v the change of speed (K. Graff,
// "Wave Motion in Elastic Solids", 1975, section 2.1).
#include <algorithm>
#include <cmath>

#include "simulation/debris/momentum.h"
#include "simulation/fracture/debris_fracture.h"
#include "simulation/fracture/panel_chunks.h"
#include "topple/structure/error.h"

namespace topple::structure {

DebrisFracture::DebrisFracture(const Sources& sources)
    : scene_(sources.scene),
      log_(sources.log),
      sums_(sources.sums),
      debris_(sources.debris),
      hinges_(sources.hinges),
      panels_(sources.panels),
      views_(sources.views),
      break_up_(sources.break_up),
      release_impulses_(sources.release_impulses) {}

/// Replaces the body by chunks that move as it did. Returns those that became bodies, what was hit out first; `out`:
/// how many these are. Nothing when the impact falls where nothing can break.
std::vector<collision::BodyId> DebrisFracture::shatter(collision::BodyId id, const Vec3& point,
                                                       std::optional<double> radius, std::size_t& out) {
  const Body one = debris_.bodies.at(id.value);
  const PanelId panel = panels_.breakable_of(one);
  scene_.world->wake(id);
  const collision::BodyState state = scene_.world->state(id);
  const Mat3 turn = state.pose.orientation.toRotationMatrix();
  const Vec3 at = one.rest.centre + turn.transpose() * (point - state.pose.position);
  const BrokenPanel* left = panels_.broken(panel);
  const int before = left ? left->chunks_out() : 0;
  std::vector<PanelChunk> chunks =
      left ? break_up(*left, at, radius)
           : break_panel(scene_.building, panel, one.rest.mass, debris_.shapes.corners(panel), at, radius,
                         *panels_.of(panel).settings);
  out = 0;
  if (chunks.empty()) return {};
  log_.record(SimulationEvent::Kind::panel_fractured, scene_.building[panel].name).position = point;
  (void)debris_.resting.forget(id, *scene_.frame, false);
  (void)hinges_.unhook(id);
  debris_.remove(id);
  debris_.lose(Part(panel));

  std::vector<collision::BodyId> made;
  Momentum carried{state.pose.position}, handed_on{state.pose.position};
  carried.add(one, state);
  double dust = 0;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    const bool of_hit = chunks[i].hit;
    Body piece = chunk_body(scene_.building, panel, std::move(chunks[i]), before + static_cast<int>(i) + 1);
    const Vec3 arm = turn * (piece.rest.centre - one.rest.centre);
    collision::BodyState moving = state;
    moving.pose.position += arm;
    moving.velocity += state.angular_velocity.cross(arm);
    if (piece.volume < scene_.scenario.debris.smallest_volume) {
      const Kinetic lost = kinetic_energy(piece, moving, scene_.reading());
      sums_.ledger.removed += lost.translation + lost.rotation;
      handed_on.add(piece, moving);
      dust += piece.rest.mass;
      continue;
    }
    if (of_hit) ++out;
    made.push_back(debris_.add(std::move(piece), moving));
  }
  for (const collision::BodyId piece : made) {
    handed_on.add(debris_.bodies.at(piece.value), scene_.world->state(piece));
    views_.record_split(id, piece);
  }
  sums_.ledger.momentum_error = std::max(sums_.ledger.momentum_error, carried.error(handed_on));
  if (dust > 0) log_.record(SimulationEvent::Kind::limited, scene_.building[panel].name).mass = dust;
  return made;
}

void DebrisFracture::push_whole(collision::BodyId id) {
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
  release_impulses_.apply(debris_.bodies.at(id.value), velocity, spin, sums_.ledger);
  collision::BodyState state = scene_.world->state(id);
  state.velocity += velocity;
  state.angular_velocity += spin;
  scene_.world->set_state(id, state);
}

/// A panel that an impact broke off the frame: what hit it pushes the chunks that it broke out, each by its share of
/// the mass, and flies on through the gap.
void DebrisFracture::shatter_struck(collision::BodyId id) {
  const Body& one = debris_.bodies.at(id.value);
  if (!panels_.breakable_of(one).valid()) return;
  const ReleaseImpulse* const first = release_impulses_.first_on(one);
  if (first == nullptr) return;
  const ReleaseImpulse given = *first;
  const Body* by = debris_.find(given.by);
  const std::optional<double> radius = by && by->radius > 0 ? std::optional(by->radius) : std::nullopt;
  std::size_t out = 0;
  const std::vector<collision::BodyId> made = shatter(id, given.point, radius, out);
  if (made.empty()) {  // hit where there is nothing to break: it is pushed as a whole
    if (debris_.bodies.contains(id.value)) push_whole(id);
    return;
  }
  double struck_mass = 0;
  for (std::size_t i = 0; i < out; ++i) struck_mass += debris_.bodies.at(made[i].value).rest.mass;
  const double size = given.impulse.norm();
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (debris_.bodies.contains(given.by.value)) debris_.pass(given.by, made[i]);
    if (i >= out || size == 0) continue;
    const double mass = debris_.bodies.at(made[i].value).rest.mass;
    const Vec3 gained = std::min(size / struck_mass, given.speed) * given.impulse / size;
    collision::BodyState state = scene_.world->state(made[i]);
    const Vec3 before = scene_.reading().true_velocity(state.velocity);
    state.velocity += gained;
    sums_.ledger.lost_in_impacts -= mass * gained.dot(before + gained / 2);
    scene_.world->set_state(made[i], state);
  }
}

std::vector<ContactRecord> DebrisFracture::landings(std::span<const ContactRecord> contacts) {
  if (!panels_.any()) return {};
  return landing_.read(contacts, scene_.scenario.step);
}

bool DebrisFracture::shatter_landed(std::span<const ContactRecord> landings) {
  if (!panels_.any()) return false;
  std::map<std::int64_t, Landing> hardest_of;  // by body
  std::vector<std::int64_t> awake;
  for (const std::int64_t id : debris_.bodies.single_panels())
    if (!debris_.bodies.motion(id).asleep && panels_.breakable_of(debris_.bodies.at(id)).valid()) awake.push_back(id);
  const auto feel = [&](collision::BodyId id, const ContactRecord& contact) {
    if (!std::binary_search(awake.begin(), awake.end(), id.value)) return;
    const Body* one = debris_.find(id);
    const collision::BodyState state = scene_.world->state(id);
    const Mat3 inverse = world_inertia(*one, state.pose.orientation).inverse();
    const double mass = effective_mass(one->rest.mass, inverse, contact.point - state.pose.position, contact.normal);
    const double change = std::abs(contact.impulse.dot(contact.normal)) / mass;
    const PanelId panel = one->panels.front();
    if (change < panels_.of(panel).breaking_speed) return;
    Landing& hardest = hardest_of[id.value];
    if (change > hardest.speed)
      hardest = {change, state.pose.orientation.conjugate() * (contact.point - state.pose.position)};
  };
  if (!awake.empty())
    for (const ContactRecord& contact : landings) {
      feel(contact.body, contact);
      if (contact.other.kind == collision::Touched::Kind::body) feel(contact.other.body, contact);
    }
  for (const auto& [id, landing] : hardest_of) {
    std::size_t out = 0;
    (void)shatter({id}, scene_.world->state({id}).pose * landing.at, std::nullopt, out);
  }
  return !hardest_of.empty();
}

}  // namespace topple::structure
