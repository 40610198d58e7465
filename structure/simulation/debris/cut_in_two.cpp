// A post that buckled inside leaves what stands in two pieces. Each is a body of its own that hangs on by the joint of
// its end, as parts on hinges do (hinges.cpp), but held in all that the joint holds: a stub that stands on its foot,
// one that hangs from the node above.
#include <algorithm>

#include "simulation/debris/debris_settings.h"
#include "simulation/debris/momentum.h"
#include "simulation/debris/release.h"

namespace topple::structure {

namespace {

/// A box from one stretch of a member's axis to the other, its centre at the origin; global axes.
fracture::Mesh box(const Vec3& half, const Mat3& axes, const Vec3& from_centre) {
  fracture::Mesh mesh;
  for (int face = 0; face < 6; ++face) {
    const int out = face / 2, first = (out + 1) % 3, second = (out + 2) % 3;
    const double side = face % 2 == 0 ? -1 : 1;
    const int corner = static_cast<int>(mesh.positions.size());
    for (const auto& [a, b] :
         {std::pair(-1.0, -1.0), std::pair(1.0, -1.0), std::pair(1.0, 1.0), std::pair(-1.0, 1.0)}) {
      Vec3 local;
      local[out] = side * half[out];
      local[first] = side * a * half[first];
      local[second] = b * half[second];
      mesh.positions.push_back(from_centre + axes.transpose() * local);
      mesh.normals.push_back(axes.transpose() * (side * Vec3::Unit(out)));
      mesh.texture.emplace_back(local[first], local[second]);
    }
    mesh.triangles.push_back({corner, corner + 1, corner + 2});
    mesh.triangles.push_back({corner, corner + 2, corner + 3});
  }
  return mesh;
}

}  // namespace

/// The piece at one end of a member that was cut at this fraction of its length. It takes along what lies on it.
Body Release::piece_of(MemberId id, int end, double cut) const {
  const Member& member = scene.building[id];
  const double at = cut * member.length, from = end == 0 ? 0 : at, to = end == 0 ? at : member.length;
  Body piece;
  piece.name = member.name + "#" + std::to_string(end + 1);
  piece.chunk_of = piece_kind(member.kind);
  piece.end_joint = scene.building.joint(id, end);
  piece.rest = debris.masses.of(scene.building, id, from, to);
  for (const Debris::Frozen& lying : debris.frozen) {
    if (lying.on != Part(id)) continue;
    const double where = (lying.mass.centre - member_start(scene.building, member)).dot(member.axes.row(0));
    if ((where < at) == (end == 0)) piece.rest.add(lying.mass);
  }
  const double share = (to - from) / member.length;
  piece.volume = share * member_volume(scene.building, member);
  for (const Vec3& corner : debris.shapes.corners(scene.building, id, from, to))
    piece.hull.push_back(corner - piece.rest.centre);
  for (const Vec3& corner : piece.hull) piece.bounds.add(corner);
  const Vec2 size = section_size(scene.building[member.section]);
  const Vec3 middle = member_start(scene.building, member) + (from + to) / 2 * member.axes.row(0).transpose();
  piece.mesh = std::make_shared<const fracture::Mesh>(
      box(Vec3(to - from, size.x(), size.y()) / 2, member.axes, middle - piece.rest.centre));
  return piece;
}

void Release::release_in_two(const Detached& part) {
  const MemberId member = part.members.front();
  // Panels that only the post bore go by themselves.
  for (const PanelId panel : part.panels) {
    Detached alone;
    alone.panels = {panel};
    release(alone);
  }
  Detached post;
  post.members = {member};
  const Body whole = break_up.describe(post);
  const Part gone(member);
  debris.stop_standing(gone);
  debris.lose(Part(member));
  SimulationEvent& event = log.record(SimulationEvent::Kind::detached, whole.name);
  event.members = whole.members;
  event.mass = whole.rest.mass;
  event.position = whole.rest.centre;
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
  release_impulses.apply(whole, velocity, spin, sums.ledger);

  std::vector<collision::BodyId> made;
  Momentum carried{whole.rest.centre}, handed_on{whole.rest.centre};
  carried.add(whole, {{whole.rest.centre, Eigen::Quaterniond::Identity()}, velocity, spin});
  for (int end = 0; end < 2; ++end) {
    Body piece = piece_of(member, end, *part.cut);
    if (!(piece.rest.mass > 0)) continue;
    const Vec3 moves = velocity + spin.cross(piece.rest.centre - whole.rest.centre);
    const NodeId node = scene.building[member].nodes[static_cast<std::size_t>(end)];
    Vec3 displacement = scene.frame->displacement(node).head<3>();
    if (displacement.norm() > debris_settings.largest_start)
      displacement *= debris_settings.largest_start / displacement.norm();
    if (piece.volume < scene.scenario.debris.smallest_volume) {
      log.record(SimulationEvent::Kind::limited, piece.name).mass = piece.rest.mass;
      handed_on.add(piece, {{piece.rest.centre, Eigen::Quaterniond::Identity()}, moves, spin});
      debris.leave_weight(piece.rest);
      continue;
    }
    const JointId joint = piece.end_joint;
    const collision::BodyId id = debris.add(std::move(piece), moves, spin, displacement);
    made.push_back(id);
    collision::BodyState state = scene.world->state(id);
    state.velocity = scene.reading().true_velocity(state.velocity);
    state.pose.position -= displacement;
    handed_on.add(debris.bodies.at(id.value), state);
    if (std::find(part.hinges.begin(), part.hinges.end(), joint) != part.hinges.end()) hinges.hang_on({joint}, id);
  }
  sums.ledger.momentum_error = std::max(sums.ledger.momentum_error, carried.error(handed_on));
  if (made.size() == 2) debris.pass(made[0], made[1]);
}

}  // namespace topple::structure
