#include "renderer/instances/chunk_instances.h"

#include <array>

#include "renderer/shapes/looks.h"
#include "renderer/shapes/torn_ends.h"

namespace topple::viewer {
namespace {

bool is_shown(const ViewOptions& options, structure::PieceKind kind) {
  const auto& shown = options.shown;
  return std::array{shown.slabs, shown.walls, shown.posts, shown.beams, shown.braces}[static_cast<std::size_t>(kind)];
}

}  // namespace

void ChunkInstances::update(const Snapshot& snapshot, const ViewOptions& options, bool bend) {
  for (auto& batch : batches_) batch.instances.clear();
  update_chunks(snapshot, options);
  update_broken_panels(snapshot, options, bend);
}

void ChunkInstances::update_chunks(const Snapshot& snapshot, const ViewOptions& options) {
  if (!options.debris) return;
  const bool materials = options.colouring == Colouring::materials;
  for (const BodyPose& body : snapshot.bodies) {
    if (!body.chunk) continue;
    if (!is_shown(options, body.chunk_of)) continue;
    const auto [found, is_new] = batch_of_body_.try_emplace(body.id, batches_.size());
    if (is_new) {
      batches_.emplace_back();
      batches_.back().mesh = chunk_mesh(*body.chunk);
      mark_broken(batches_.back().mesh, nullptr, nullptr);
      add_bars(batches_.back().mesh, bars_of_chunk(body.material));
    }
    batches_[found->second].instances.push_back(
        {glm::vec3(to_glm(body.position) - origin_), packed(to_glm(body.orientation)), glm::vec3(1),
         materials && body.material.valid() ? look_colour(look_of(building_[body.material]))
                                            : piece_colour(body.chunk_of),
         glm::vec3(to_glm(body.rest_centre) - origin_)});
  }
}

/// Fewer where there are many pieces, of which each is small in the picture.
std::size_t ChunkInstances::bars_of_chunk(structure::MaterialId material) const {
  if (!material.valid() || look_of(building_[material]) != Look::concrete) return 0;
  return batches_.size() < 300 ? 16 : batches_.size() < 1500 ? 6 : 0;
}

/// Between its corners as they have moved, or as they had when it let go.
void ChunkInstances::bend_broken_panel(std::size_t index, const Snapshot& snapshot, const ViewOptions& options,
                                       BrokenPanel& drawn) {
  const structure::Panel& panel = building_.panels[index];
  std::array<Eigen::Vector3f, 4> moved;
  moved.fill(Eigen::Vector3f::Zero());
  if (snapshot.membership->panel[index] == part_stands) {
    const DrawnShape shape(snapshot, options);
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
  InstanceBatch<RigidInstance>& batch = batches_[drawn.batch];
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
void ChunkInstances::update_broken_panels(const Snapshot& snapshot, const ViewOptions& options, bool bend) {
  for (std::size_t i = 0; i < building_.panels.size(); ++i) {
    const auto& mesh = snapshot.membership->broken[i];
    const int place = snapshot.membership->panel[i];
    const structure::Panel& panel = building_.panels[i];
    if (!mesh || place == part_gone || mesh->triangles.empty()) continue;
    if (!is_on(options.shown, panel)) continue;
    if (place != part_stands && !options.debris) continue;
    BrokenPanel& drawn = broken_panels_[i];
    const bool is_new = drawn.mesh != mesh;
    if (is_new) {
      drawn.mesh = mesh;
      drawn.batch = batches_.size();
      drawn.moved.fill(Eigen::Vector3f::Zero());
      batches_.emplace_back();
      batches_.back().mesh = chunk_mesh(*mesh);
      mark_broken(batches_.back().mesh, &building_, &panel);
      add_bars(batches_.back().mesh, bars_of_chunk(panel.material));
      drawn.rest.clear();
      for (const Vertex& vertex : batches_.back().mesh.vertices) drawn.rest.push_back(vertex.position);
    }
    if (bend || is_new) bend_broken_panel(i, snapshot, options, drawn);
    glm::dvec3 position(0);
    glm::dquat turn(1, 0, 0, 0);
    if (place != part_stands) {
      const BodyMotion motion(snapshot.bodies[static_cast<std::size_t>(place)]);
      position = motion(glm::dvec3(0));
      turn = motion.turn;
    }
    const Rgba colour = options.colouring == Colouring::materials ? look_colour(look_of(building_[panel.material]))
                                                                  : panel_colour(panel.kind);
    batches_[drawn.batch].instances.push_back(
        {glm::vec3(position - origin_), packed(turn), glm::vec3(1), colour, glm::vec3(-origin_)});
  }
}

}  // namespace topple::viewer
