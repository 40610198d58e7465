#include "topple/structure/collapse_animation.h"

#include <map>
#include <set>

#include "simulation/debris/mass_properties.h"
#include "simulation/debris/part.h"
#include "simulation/debris/part_shapes.h"
#include "topple/fracture/panel.h"
#include "topple/structure/animated_scene.h"
#include "topple/structure/bent_part.h"
#include "topple/structure/shape_watcher.h"

namespace topple::structure {

namespace {

/// An instant counts as reached this much early (in frames), whatever the rounding of step times.
constexpr double frame_tolerance = 1e-6;

enum Colour { post, beam, brace, slab, wall, ball, drawn_surface };

Vec3 middle(const Building& building, Part part) {
  if (part.member.valid()) {
    const Member& member = building[part.member];
    return member_start(building, member) + member.axes.row(0).transpose() * (member.length / 2);
  }
  Vec3 sum = Vec3::Zero();
  for (const NodeId node : building[part.panel].nodes) sum += building[node].position;
  return sum / 4;
}

/// As it is drawn when it breaks, so that a picture on it stays where it was; global axes.
fracture::Mesh whole_panel(const Building& building, const Panel& panel) {
  const Vec3 origin = building[panel.nodes[0]].position;
  fracture::PanelShape shape;
  for (const NodeId node : panel.nodes)
    shape.outline.push_back((panel.axes * (building[node].position - origin)).head<2>());
  shape.thickness = panel.thickness;
  shape.openings = panel.openings;
  fracture::Mesh mesh = fracture::BreakablePanel(shape, {}).mesh();
  for (Vec3& position : mesh.positions) position = origin + panel.axes.transpose() * position;
  for (Vec3& normal : mesh.normals) normal = panel.axes.transpose() * normal;
  return mesh;
}

}  // namespace

struct CollapseAnimation::State {
  State(const Simulation& simulation, double rate, const VisualMesh* model)
      : building(simulation.building()), drawn(model) {
    scene.rate = rate;
    scene.materials = {{"posts", {0.55f, 0.57f, 0.60f}},  {"beams", {0.45f, 0.50f, 0.58f}},
                       {"braces", {0.50f, 0.45f, 0.40f}}, {"slabs", {0.75f, 0.74f, 0.70f}},
                       {"walls", {0.70f, 0.55f, 0.45f}},  {"balls", {0.15f, 0.15f, 0.17f}},
                       {"drawn", {0.80f, 0.76f, 0.68f}}};
    for (std::size_t i = 0; i < part_count(building); ++i) {
      const Part part = part_of_number(building, static_cast<std::int64_t>(i));
      AnimatedNode node;
      node.name = part_name(building, part);
      const auto remains = part.panel.valid() ? simulation.broken_panel(part.panel) : nullptr;
      if (remains) of_panel[part.panel] = {remains, i, 0};
      node.mesh =
          remains ? mesh_of(*remains, middle(building, part), colour_of(building[part.panel].kind)) : mesh_of(part);
      scene.nodes.push_back(std::move(node));
      steady_parts.push_back(part.member.valid() ? steady(building, part.member) : steady(building, part.panel));
    }
  }

  static int colour_of(PieceKind kind) {
    constexpr std::array<Colour, 5> colours{slab, wall, post, beam, brace};
    return colours[static_cast<std::size_t>(kind)];
  }
  static int colour_of(PanelKind kind) { return colour_of(piece_kind(kind)); }

  /// About `centre`.
  int mesh_of(const fracture::Mesh& mesh, const Vec3& centre, int material) {
    SceneMesh own;
    for (const Vec3& position : mesh.positions) own.positions.push_back(position - centre);
    own.normals = mesh.normals;
    own.texture = mesh.texture;
    own.triangles = mesh.triangles;
    own.material = material;
    scene.meshes.push_back(std::move(own));
    return static_cast<int>(scene.meshes.size()) - 1;
  }

  int mesh_of(Part part, bool bends = false) {
    if (part.panel.valid())
      return mesh_of(whole_panel(building, building[part.panel]), middle(building, part),
                     colour_of(building[part.panel].kind));
    const Member& member = building[part.member];
    const Vec2 size = section_size(building[member.section]);
    const int material = colour_of(piece_kind(member.kind));
    const auto [known, made] =
        boxes.try_emplace({member.length, size.x(), size.y(), static_cast<double>(material), bends ? 1.0 : 0.0},
                          static_cast<int>(scene.meshes.size()));
    if (!made) return known->second;
    const Vec3 half = Vec3(member.length, size.x(), size.y()) / 2;
    scene.meshes.push_back(box_mesh(half, material, bends ? bent_segments : 1));
    if (!bends) return known->second;
    SceneMesh& mesh = scene.meshes.back();
    mesh.bends = member_bends(member.length, mesh.positions);
    mesh.bend_normals = member_bend_normals(member.length, mesh.positions, mesh.normals);
    return known->second;
  }

  /// A part that is seen bent gets a mesh that can be.
  void bend(AnimatedNode& node, Part part, const BendWeights& weights, int at) {
    node.bend(at, weights);
    if (node.bends.empty()) return;
    SceneMesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    if (!mesh.bends.empty()) return;
    if (!part.panel.valid()) {
      node.mesh = mesh_of(part, true);
      return;
    }
    // Each has a mesh of its own.
    mesh.bends = panel_bends(building, part.panel, mesh.positions);
    mesh.bend_normals = panel_bend_normals(building, part.panel, mesh.positions, mesh.normals);
  }

  AnimatedNode& node_of(Part part) { return scene.nodes[static_cast<std::size_t>(part_number(building, part))]; }

  /// The node that shows the part now: of a panel that broke in part, one for what remains after each break.
  AnimatedNode* node_of(Part part, const Simulation& simulation, int at) {
    const auto remains = part.panel.valid() ? simulation.broken_panel(part.panel) : nullptr;
    if (!remains) return &node_of(part);
    const auto [known, made] =
        of_panel.try_emplace(part.panel, Remains{nullptr, static_cast<std::size_t>(part_number(building, part)), 0});
    Remains& now = known->second;
    if (now.mesh != remains) {
      scene.nodes[now.node].show(at, false);
      now.mesh = remains;
      if (!remains->triangles.empty()) {
        now.node = scene.nodes.size();
        AnimatedNode& node = scene.nodes.emplace_back();
        node.name = part_name(building, part) + " rest " + std::to_string(++now.breaks);
        node.mesh = mesh_of(*remains, middle(building, part), colour_of(building[part.panel].kind));
      }
    }
    return remains->triangles.empty() ? nullptr : &scene.nodes[now.node];
  }

  void hide(Part part, int at) {
    const auto known = part.panel.valid() ? of_panel.find(part.panel) : of_panel.end();
    (known == of_panel.end() ? node_of(part) : scene.nodes[known->second.node]).show(at, false);
  }

  /// A chunk or a ball: a node of its own from its birth.
  AnimatedNode& node_of(const BodyView& body) {
    const auto [known, made] = of_body.try_emplace(body.id.value, scene.nodes.size());
    if (!made) return scene.nodes[known->second];
    AnimatedNode& node = scene.nodes.emplace_back();
    node.name = body.name;
    node.mesh = static_cast<int>(scene.meshes.size());
    if (body.chunk)
      (void)mesh_of(*body.chunk, Vec3::Zero(), colour_of(body.chunk_of));
    else
      scene.meshes.push_back(sphere_mesh(body.radius, ball));
    return node;
  }

  /// Where the part stands, or stood when it let go, and how it is bent there.
  const BentPart& shape_of(Part part) {
    const StandingShapes& standing = *shapes.standing();
    const KeptShapes& parts = *shapes.parts();
    SteadyPart& drawn_as = steady_parts[static_cast<std::size_t>(part_number(building, part))];
    if (part.member.valid())
      return drawn_as.at(bent_member(building, part.member, drawn_shape(building, part.member, standing, parts)));
    return drawn_as.at(bent_panel(building, part.panel, moved_corners(building, part.panel, standing, parts)));
  }

  void show(const Simulation& simulation, Part part, int at, const BodyView* body = nullptr) {
    AnimatedNode* node = node_of(part, simulation, at);
    if (!node) return;
    const BentPart& shape = shape_of(part);
    AnimatedPose pose = shape.pose;
    if (body != nullptr) {
      pose.position = body->pose * (pose.position - body->rest_centre);
      pose.orientation = body->pose.orientation * pose.orientation;
    }
    bend(*node, part, shape.bend, at);
    show(node, at, pose);
  }

  static void show(AnimatedNode* node, int at, const AnimatedPose& pose) {
    node->pose(at, pose);
    node->show(at, true);
  }

  /// Pieces of the visual mesh: each cut makes new ones.
  void add_drawn(const Simulation& simulation, int at) {
    std::map<std::int64_t, const BodyView*> bodies;
    for (const BodyView& body : simulation.bodies()) bodies.emplace(body.id.value, &body);
    std::set<const fracture::Mesh*> seen;
    for (const VisualMesh::Piece& piece : drawn->pieces()) {
      const auto body = bodies.find(piece.body.value);
      if (piece.body.value != -1 && body == bodies.end()) continue;
      const auto [known, made] = of_piece.try_emplace(piece.mesh, scene.nodes.size());
      if (made) {
        AnimatedNode& node = scene.nodes.emplace_back();
        // Pieces are numbered anew by each cut.
        const int earlier = piece_names[piece.name]++;
        node.name = earlier == 0 ? piece.name : piece.name + " after cut " + std::to_string(earlier);
        node.mesh = mesh_of(*piece.mesh, Vec3::Zero(), drawn_surface);
      }
      AnimatedPose pose;
      if (body != bodies.end()) {
        pose.orientation = body->second->pose.orientation;
        pose.position = body->second->pose * Vec3(-body->second->rest_centre);
      }
      show(&scene.nodes[known->second], at, pose);
      seen.insert(piece.mesh.get());
    }
    for (const auto& [mesh, node] : of_piece)
      if (!seen.contains(mesh.get())) scene.nodes[node].show(at, false);
  }

  void add(const Simulation& simulation, int at) {
    const StandingFrame& frame = simulation.frame();
    for (std::size_t i = 0; i < part_count(building); ++i) {
      const Part part = part_of_number(building, static_cast<std::int64_t>(i));
      const bool stands = part.member.valid() ? frame.stands(part.member) : frame.stands(part.panel);
      if (stands)
        show(simulation, part, at);
      else if ((part.member.valid() ? simulation.body_of(part.member) : simulation.body_of(part.panel)).value < 0)
        hide(part, at);
    }
    std::set<std::int64_t> seen;
    for (const BodyView& body : simulation.bodies()) {
      for (const MemberId member : body.members) show(simulation, Part(member), at, &body);
      for (const PanelId panel : body.panels) show(simulation, Part(panel), at, &body);
      if (!body.chunk && !(body.radius > 0)) continue;
      AnimatedNode& node = node_of(body);
      node.pose(at, {body.pose.position, body.pose.orientation});
      node.show(at, true);
      seen.insert(body.id.value);
    }
    for (const auto& [id, number] : of_body)
      if (!seen.contains(id)) scene.nodes[number].show(at, false);
    if (drawn) add_drawn(simulation, at);
  }

  const Building& building;
  const VisualMesh* drawn;
  AnimatedScene scene;
  std::map<std::array<double, 5>, int> boxes;
  ShapeWatcher shapes;
  std::vector<SteadyPart> steady_parts;  ///< by the part's number
  std::map<std::int64_t, std::size_t> of_body;
  struct Remains {
    std::shared_ptr<const fracture::Mesh> mesh;
    std::size_t node = 0;
    int breaks = 0;
  };
  std::map<PanelId, Remains> of_panel;  ///< that are broken in part
  std::map<std::shared_ptr<const fracture::Mesh>, std::size_t> of_piece;
  std::map<std::string, int> piece_names;
  int next = 0;
};

CollapseAnimation::CollapseAnimation(const Simulation& simulation, double rate, const VisualMesh* drawn)
    : state_(std::make_unique<State>(simulation, rate, drawn)) {
  add_due(simulation);
}
CollapseAnimation::~CollapseAnimation() = default;

void CollapseAnimation::add_due(const Simulation& simulation) {
  State& state = *state_;
  state.shapes.watch(simulation);
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
