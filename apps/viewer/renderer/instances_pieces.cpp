// What is drawn by a mesh of its own: chunks, what remains of broken panels, a model that is drawn around the building.
#include <algorithm>
#include <array>

#include "renderer/instance_parts.h"
#include "renderer/shapes/looks.h"
#include "renderer/shapes/torn_ends.h"
#include "topple/structure/visual_mesh.h"

namespace topple::viewer {
namespace {

using structure::PanelKind;

bool is_shown(const ViewOptions& options, structure::PieceKind kind) {
  const auto& shown = options.shown;
  return std::array{shown.slabs, shown.walls, shown.posts, shown.beams, shown.braces}[static_cast<std::size_t>(kind)];
}

}  // namespace

void SceneInstances::place_chunks(const Snapshot& snapshot) {
  for (auto& batch : chunks_) batch.instances.clear();
  if (!built_options_.debris) return;
  const bool materials = built_options_.colouring == Colouring::materials;
  for (const BodyPose& body : snapshot.bodies) {
    if (!body.chunk) continue;
    if (!is_shown(built_options_, body.chunk_of)) continue;
    const auto [found, is_new] = chunk_of_body_.try_emplace(body.id, chunks_.size());
    if (is_new) {
      chunks_.emplace_back();
      chunks_.back().mesh = chunk_mesh(*body.chunk);
      mark_broken(chunks_.back().mesh, nullptr, nullptr);
      add_bars(chunks_.back().mesh, bars_of_chunk(body.material));
    }
    chunks_[found->second].instances.push_back(
        {glm::vec3(to_glm(body.position) - origin_), packed(to_glm(body.orientation)), glm::vec3(1),
         materials && body.material.valid() ? look_colour(look_of(building_[body.material]))
                                            : piece_colour(body.chunk_of),
         glm::vec3(to_glm(body.rest_centre) - origin_)});
  }
}

/// Fewer where there are many pieces, of which each is small in the picture.
std::size_t SceneInstances::bars_of_chunk(structure::MaterialId material) const {
  if (!material.valid() || look_of(building_[material]) != Look::concrete) return 0;
  return chunks_.size() < 300 ? 16 : chunks_.size() < 1500 ? 6 : 0;
}

Rgba SceneInstances::broken_colour(std::size_t panel) const {
  return built_options_.colouring == Colouring::materials
             ? look_colour(look_of(building_[building_.panels[panel].material]))
             : panel_colour(building_.panels[panel].kind);
}

/// Between its corners as they have moved, or as they had when it let go.
void SceneInstances::bend_broken_panel(std::size_t index, const Snapshot& snapshot, BrokenPanel& drawn) {
  const structure::Panel& panel = building_.panels[index];
  std::array<Eigen::Vector3f, 4> moved;
  moved.fill(Eigen::Vector3f::Zero());
  if (snapshot.membership->panel[index] == part_stands) {
    const DrawnShape shape(snapshot, built_options_);
    for (std::size_t c = 0; c < 4; ++c) moved[c] = shape.at(panel.nodes[c]).head<3>();
  } else if (const auto& kept = snapshot.membership->panel_shape; index < kept.size() && kept[index]) {
    moved = *kept[index];
  }
  constexpr float seen = 1e-3F;  // m
  bool bends = false;
  for (std::size_t c = 0; c < 4; ++c) bends = bends || (moved[c] - drawn.moved[c]).norm() > seen;
  if (!bends) return;
  drawn.moved = moved;
  // Shares of the ways from the first corner to its two neighbours.
  const structure::Vec3 corner = building_[panel.nodes[0]].position;
  Eigen::Matrix<double, 3, 2> sides;
  sides << building_[panel.nodes[1]].position - corner, building_[panel.nodes[3]].position - corner;
  const Eigen::Matrix<double, 2, 3> shares = (sides.transpose() * sides).inverse() * sides.transpose();
  InstanceBatch<RigidInstance>& batch = chunks_[drawn.batch];
  for (std::size_t v = 0; v < drawn.rest.size(); ++v) {
    const glm::vec3 rest = drawn.rest[v];
    const Eigen::Vector2f at = (shares * (Eigen::Vector3d(static_cast<double>(rest.x), static_cast<double>(rest.y),
                                                          static_cast<double>(rest.z)) -
                                          corner))
                                   .cast<float>();
    const Eigen::Vector3f way = (1 - at.y()) * ((1 - at.x()) * moved[0] + at.x() * moved[1]) +
                                at.y() * ((1 - at.x()) * moved[3] + at.x() * moved[2]);
    batch.mesh.vertices[v].position = rest + to_glm(way);
  }
  ++batch.mesh_revision;
}

/// What remains of panels that are broken in part: at rest where it stood, else moved with its body. `bend`: what
/// stands is bent otherwise than before.
void SceneInstances::place_broken_panels(const Snapshot& snapshot, bool bend) {
  for (std::size_t i = 0; i < building_.panels.size(); ++i) {
    const auto& mesh = snapshot.membership->broken[i];
    const int place = snapshot.membership->panel[i];
    const PanelKind kind = building_.panels[i].kind;
    if (!mesh || place == part_gone || mesh->triangles.empty()) continue;
    if (!(kind == PanelKind::slab ? built_options_.shown.slabs : built_options_.shown.walls)) continue;
    if (place != part_stands && !built_options_.debris) continue;
    BrokenPanel& drawn = broken_panels_[i];
    const bool is_new = drawn.mesh != mesh;
    if (is_new) {
      drawn.mesh = mesh;
      drawn.batch = chunks_.size();
      drawn.moved.fill(Eigen::Vector3f::Zero());
      chunks_.emplace_back();
      chunks_.back().mesh = chunk_mesh(*mesh);
      mark_broken(chunks_.back().mesh, &building_, &building_.panels[i]);
      add_bars(chunks_.back().mesh, bars_of_chunk(building_.panels[i].material));
      drawn.rest.clear();
      for (const Vertex& vertex : chunks_.back().mesh.vertices) drawn.rest.push_back(vertex.position);
    }
    if (bend || is_new) bend_broken_panel(i, snapshot, drawn);
    glm::dvec3 position(0);
    glm::dquat turn(1, 0, 0, 0);
    if (place != part_stands) {
      const Motion motion(snapshot.bodies[static_cast<std::size_t>(place)]);
      position = motion(glm::dvec3(0));
      turn = motion.turn;
    }
    chunks_[drawn.batch].instances.push_back(
        {glm::vec3(position - origin_), packed(turn), glm::vec3(1), broken_colour(i), glm::vec3(-origin_)});
  }
}

/// Its vertices follow the parts that they hang on, as these are drawn.
void SceneInstances::bend_drawn(const DrawnPiece& piece, const Snapshot& snapshot,
                                InstanceBatch<RigidInstance>& batch) const {
  const DrawnShape shape(snapshot, built_options_);
  const structure::BentBuilding bent{
      [&](structure::NodeId node) -> structure::Vec6 { return shape.at(node).cast<double>(); },
      [&](structure::JointId joint) { return snapshot.answer->joints[static_cast<std::size_t>(joint.index)].intact; }};
  for (std::size_t v = 0; v < piece.mesh->positions.size(); ++v) {
    const Eigen::Vector3d& at = piece.mesh->positions[v];
    const Eigen::Vector3f now =
        (at + structure::displacement_with(building_, (*piece.bones)[v], at, bent)).cast<float>();
    batch.mesh.vertices[v].position = {now.x(), now.y(), now.z()};
  }
  ++batch.mesh_revision;
}

/// A model that is drawn around the building. `bend`: what stands is bent otherwise than before.
void SceneInstances::place_drawn(const Snapshot& snapshot, bool bend) {
  for (auto& batch : drawn_) batch.instances.clear();
  if (!snapshot.drawn || !built_options_.drawn) return;
  for (const DrawnPiece& piece : *snapshot.drawn) {
    const auto body = std::lower_bound(snapshot.bodies.begin(), snapshot.bodies.end(), piece.body,
                                       [](const BodyPose& pose, std::int64_t id) { return pose.id < id; });
    const bool stands = piece.body == part_stands;
    if (!stands && (!built_options_.debris || body == snapshot.bodies.end() || body->id != piece.body)) continue;
    const auto [found, is_new] = batch_of_drawn_.try_emplace(piece.mesh, DrawnBatch{drawn_.size(), false});
    if (is_new) {
      drawn_.emplace_back();
      drawn_.back().mesh = chunk_mesh(*piece.mesh);
    }
    DrawnBatch& own = found->second;
    InstanceBatch<RigidInstance>& batch = drawn_[own.batch];
    if (stands && piece.bones && (bend || !own.bent)) {
      bend_drawn(piece, snapshot, batch);
      own.bent = true;
    } else if (!stands && own.bent) {
      batch.mesh = chunk_mesh(*piece.mesh);
      ++batch.mesh_revision;
      own.bent = false;
    }
    glm::dvec3 position(0);
    glm::dquat turn(1, 0, 0, 0);
    if (!stands) {
      const Motion motion(*body);
      position = motion(glm::dvec3(0));
      turn = motion.turn;
    }
    const Rgba colour = built_options_.colouring == Colouring::materials ? look_colour(Look::plaster) : drawn_colour;
    batch.instances.push_back({glm::vec3(position - origin_), packed(turn), glm::vec3(1), colour, glm::vec3(-origin_)});
  }
}

}  // namespace topple::viewer
