#pragma once
// The instances' meshes and arrays on the graphics card.
#include <cstddef>
#include <vector>

#include "renderer/gl_object.h"
#include "renderer/instances/scene_instances.h"

namespace topple::viewer {

/// One mesh with its two arrays of instances, standing and moving; what stands is sent again only when it changed.
class GpuBatch {
 public:
  struct Attribute {
    GLint components;
    GLenum type;  ///< GL_FLOAT, or GL_UNSIGNED_BYTE (normalised)
    std::size_t offset;
  };
  GpuBatch(const Mesh& mesh, const std::vector<Attribute>& attributes, std::size_t stride,
           const std::vector<Mesh>& coarse = {});

  template <class Instance>
  void update(const InstanceBatch<Instance>& batch) {
    const std::size_t moving = batch.instances.size() - batch.standing;
    if (batch.revision != revision_) send(0, batch.instances.data(), batch.standing, sizeof(Instance));
    revision_ = batch.revision;
    if (batch.mesh_revision != mesh_revision_) send(batch.mesh);
    mesh_revision_ = batch.mesh_revision;
    if (moving + counts_[1] > 0) send(1, batch.instances.data() + batch.standing, moving, sizeof(Instance));
  }
  /// `level`: 0 the mesh itself, then the coarser ones, as far as there are any.
  void draw(std::size_t level = 0) const;

 private:
  void send(std::size_t which, const void* data, std::size_t count, std::size_t size);
  void send(const Mesh& mesh);
  GlBuffer vertices_, indices_;
  GlBuffer instances_[2];
  GlVertexArray arrays_[2];
  std::size_t counts_[2] = {0, 0};
  struct Range {
    std::size_t first = 0;  ///< of the indices
    GLsizei count = 0;
  };
  std::vector<Range> levels_;
  std::uint64_t revision_ = 0, mesh_revision_ = 0;
};

class GpuScene {
 public:
  explicit GpuScene(const SceneInstances& scene);
  void update(const SceneInstances& scene);
  /// `level` as GpuBatch::draw has it.
  void draw_members(std::size_t level) const {
    for (const GpuBatch& batch : members_) batch.draw(level);
  }
  void draw_panels(structure::PanelKind kind) const { draw(kind == structure::PanelKind::slab ? slabs_ : walls_); }
  /// Projectiles, piers, the chunks of broken panels, and what is drawn around the building.
  void draw_rigid() const {
    draw(projectiles_);
    draw(piers_);
    draw(chunks_);
    draw(torn_ends_);
    draw(drawn_);
  }
  /// And marks of hinges.
  void draw_arrows() const {
    arrows_[0].draw();
    arrows_[2].draw();
  }
  void draw_buried_arrows() const { arrows_[1].draw(); }

 private:
  static void draw(const std::vector<GpuBatch>& batches) {
    for (const GpuBatch& batch : batches) batch.draw();
  }
  std::vector<GpuBatch> members_, slabs_, walls_, projectiles_, piers_, chunks_, torn_ends_, drawn_, arrows_;
};

}  // namespace topple::viewer
