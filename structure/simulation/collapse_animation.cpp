#include "topple/structure/collapse_animation.h"

#include <map>
#include <set>

#include "simulation/mass_properties.h"
#include "simulation/part.h"
#include "simulation/part_shapes.h"
#include "topple/structure/animated_scene.h"

namespace topple::structure {

namespace {

/// An instant counts as reached this much early (in frames), whatever the rounding of step times.
constexpr double frame_tolerance = 1e-6;

enum Colour { post, beam, brace, slab, wall, ball };

Vec3 displaced(const StandingFrame& frame, const Member& member, std::size_t end) {
  const Vec6& u = frame.displacement(member.nodes[end]);
  const Vec3& arm = member.offsets[end];
  return frame.building()[member.nodes[end]].position + arm + u.head<3>() + u.tail<3>().cross(arm);
}

Eigen::Quaterniond rest_turn(const Member& member) { return Eigen::Quaterniond(Mat3(member.axes.transpose())); }

Vec3 middle(const Building& building, Part part) {
  if (part.member.valid()) {
    const Member& member = building[part.member];
    return member_start(building, member) + member.axes.row(0).transpose() * (member.length / 2);
  }
  Vec3 sum = Vec3::Zero();
  for (const NodeId node : building[part.panel].nodes) sum += building[node].position;
  return sum / 4;
}

}  // namespace

struct CollapseAnimation::State {
  State(const Simulation& simulation, double rate) : building(simulation.building()) {
    scene.rate = rate;
    scene.materials = {{"posts", {0.55f, 0.57f, 0.60f}},  {"beams", {0.45f, 0.50f, 0.58f}},
                       {"braces", {0.50f, 0.45f, 0.40f}}, {"slabs", {0.75f, 0.74f, 0.70f}},
                       {"walls", {0.70f, 0.55f, 0.45f}},  {"balls", {0.15f, 0.15f, 0.17f}}};
    for (std::size_t i = 0; i < part_count(building); ++i) {
      const Part part = part_of_number(building, static_cast<std::int64_t>(i));
      AnimatedNode node;
      node.name = part_name(building, part);
      node.mesh = mesh_of(part);
      scene.nodes.push_back(std::move(node));
    }
  }

  int mesh_of(Part part) {
    if (part.panel.valid()) {
      const Panel& panel = building[part.panel];
      std::array<Vec3, 4> corners;
      for (std::size_t i = 0; i < 4; ++i) corners[i] = building[panel.nodes[i]].position;
      scene.meshes.push_back(plate_mesh(corners, middle(building, part), panel.axes.row(2).transpose(), panel.thickness,
                                        panel.kind == PanelKind::slab ? slab : wall));
      return static_cast<int>(scene.meshes.size()) - 1;
    }
    const Member& member = building[part.member];
    const Vec2 size = section_size(building[member.section]);
    const int material = member.kind == MemberKind::post ? post : member.kind == MemberKind::beam ? beam : brace;
    const auto [known, made] = boxes.try_emplace({member.length, size.x(), size.y(), static_cast<double>(material)},
                                                 static_cast<int>(scene.meshes.size()));
    if (made) scene.meshes.push_back(box_mesh(Vec3(member.length, size.x(), size.y()) / 2, material));
    return known->second;
  }

  AnimatedNode& node_of(Part part) { return scene.nodes[static_cast<std::size_t>(part_number(building, part))]; }

  /// A chunk or a ball: a node of its own from its birth.
  AnimatedNode& node_of(const BodyView& body) {
    const auto [known, made] = of_body.try_emplace(body.id.value, scene.nodes.size());
    if (!made) return scene.nodes[known->second];
    AnimatedNode& node = scene.nodes.emplace_back();
    node.name = body.name;
    node.mesh = static_cast<int>(scene.meshes.size());
    if (body.chunk) {
      SceneMesh mesh;
      mesh.positions = body.chunk->positions;
      mesh.normals = body.chunk->normals;
      mesh.triangles = body.chunk->triangles;
      mesh.material = body.chunk_of == PanelKind::slab ? slab : wall;
      scene.meshes.push_back(std::move(mesh));
    } else {
      scene.meshes.push_back(sphere_mesh(body.radius, ball));
    }
    return node;
  }

  void add_standing(const StandingFrame& frame, Part part, int at) {
    AnimatedPose pose;
    if (part.member.valid()) {
      const Member& member = building[part.member];
      const Vec3 first = displaced(frame, member, 0), second = displaced(frame, member, 1);
      pose.position = (first + second) / 2;
      pose.orientation =
          Eigen::Quaterniond::FromTwoVectors(member.axes.row(0).transpose(), second - first) * rest_turn(member);
    } else {
      pose.position = middle(building, part);
      for (const NodeId node : building[part.panel].nodes) pose.position += frame.displacement(node).head<3>() / 4;
    }
    node_of(part).pose(at, pose);
    node_of(part).show(at, true);
  }

  void add_moving(const BodyView& body, Part part, int at) {
    AnimatedPose pose;
    pose.position = body.pose * (middle(building, part) - body.rest_centre);
    pose.orientation = body.pose.orientation;
    if (part.member.valid()) pose.orientation = pose.orientation * rest_turn(building[part.member]);
    node_of(part).pose(at, pose);
    node_of(part).show(at, true);
  }

  void add(const Simulation& simulation, int at) {
    const StandingFrame& frame = simulation.frame();
    for (std::size_t i = 0; i < part_count(building); ++i) {
      const Part part = part_of_number(building, static_cast<std::int64_t>(i));
      const bool stands = part.member.valid() ? frame.stands(part.member) : frame.stands(part.panel);
      if (stands)
        add_standing(frame, part, at);
      else if ((part.member.valid() ? simulation.body_of(part.member) : simulation.body_of(part.panel)).value < 0)
        node_of(part).show(at, false);
    }
    std::set<std::int64_t> seen;
    for (const BodyView& body : simulation.bodies()) {
      for (const MemberId member : body.members) add_moving(body, Part(member), at);
      for (const PanelId panel : body.panels) add_moving(body, Part(panel), at);
      if (!body.chunk && !(body.radius > 0)) continue;
      AnimatedNode& node = node_of(body);
      node.pose(at, {body.pose.position, body.pose.orientation});
      node.show(at, true);
      seen.insert(body.id.value);
    }
    for (const auto& [id, number] : of_body)
      if (!seen.contains(id)) scene.nodes[number].show(at, false);
  }

  const Building& building;
  AnimatedScene scene;
  std::map<std::array<double, 4>, int> boxes;
  std::map<std::int64_t, std::size_t> of_body;
  int next = 0;
};

CollapseAnimation::CollapseAnimation(const Simulation& simulation, double rate)
    : state_(std::make_unique<State>(simulation, rate)) {
  add_due(simulation);
}
CollapseAnimation::~CollapseAnimation() = default;

void CollapseAnimation::add_due(const Simulation& simulation) {
  State& state = *state_;
  const double due = simulation.time() * state.scene.rate + frame_tolerance;
  if (state.next > due) return;
  // Frames that fell into steps that were passed over look like this one.
  const int first = state.next;
  state.next = static_cast<int>(due) + 1;
  state.add(simulation, first);
  if (state.next - 1 > first) state.add(simulation, state.next - 1);
}

int CollapseAnimation::frames() const { return state_->next; }

std::string CollapseAnimation::glb() const { return glb_of(state_->scene); }

}  // namespace topple::structure
