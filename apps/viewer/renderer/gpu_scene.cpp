#include "renderer/gpu_scene.h"

#include <algorithm>
#include <cstdint>

namespace topple::viewer {
namespace {

using Attributes = std::vector<GpuBatch::Attribute>;

/// The last that OpenGL 3.3 has for certain; instances have those between.
constexpr GLuint broken_location = 15;

const Attributes& member_attributes() {
  static const Attributes list{
      {3, GL_FLOAT, offsetof(MemberInstance, first_end)},    {4, GL_FLOAT, offsetof(MemberInstance, rotation)},
      {1, GL_FLOAT, offsetof(MemberInstance, length)},       {3, GL_FLOAT, offsetof(MemberInstance, displacement1)},
      {3, GL_FLOAT, offsetof(MemberInstance, rotation1)},    {3, GL_FLOAT, offsetof(MemberInstance, displacement2)},
      {3, GL_FLOAT, offsetof(MemberInstance, rotation2)},    {3, GL_FLOAT, offsetof(MemberInstance, bulge)},
      {4, GL_UNSIGNED_BYTE, offsetof(MemberInstance, base)}, {4, GL_UNSIGNED_BYTE, offsetof(MemberInstance, end1)},
      {4, GL_UNSIGNED_BYTE, offsetof(MemberInstance, end2)}};
  return list;
}
const Attributes& panel_attributes() {
  static const Attributes list = [] {
    Attributes a;
    for (std::size_t c = 0; c < 4; ++c)
      a.push_back({3, GL_FLOAT, offsetof(PanelInstance, corner) + c * sizeof(glm::vec3)});
    a.push_back({1, GL_FLOAT, offsetof(PanelInstance, thickness)});
    a.push_back({4, GL_UNSIGNED_BYTE, offsetof(PanelInstance, base)});
    for (std::size_t e = 0; e < 4; ++e)
      a.push_back({4, GL_UNSIGNED_BYTE, offsetof(PanelInstance, edge) + e * sizeof(Rgba)});
    for (std::size_t c = 0; c < 3; ++c)
      a.push_back({3, GL_FLOAT, offsetof(PanelInstance, rest) + c * sizeof(glm::vec3)});
    return a;
  }();
  return list;
}
const Attributes& rigid_attributes() {
  static const Attributes list{{3, GL_FLOAT, offsetof(RigidInstance, position)},
                               {4, GL_FLOAT, offsetof(RigidInstance, rotation)},
                               {3, GL_FLOAT, offsetof(RigidInstance, scale)},
                               {4, GL_UNSIGNED_BYTE, offsetof(RigidInstance, colour)},
                               {3, GL_FLOAT, offsetof(RigidInstance, rest)}};
  return list;
}

const void* at(std::size_t offset) { return reinterpret_cast<const void*>(offset); }

template <class Instance>
void update_all(std::vector<GpuBatch>& gpu, const std::vector<InstanceBatch<Instance>>& batches) {
  for (std::size_t i = 0; i < gpu.size(); ++i) gpu[i].update(batches[i]);
}

}  // namespace

GpuBatch::GpuBatch(const Mesh& mesh, const Attributes& attributes, std::size_t stride, const std::vector<Mesh>& coarse)
    : vertices_(make_buffer()), indices_(make_buffer()) {
  Mesh all = mesh;
  levels_.push_back({0, static_cast<GLsizei>(mesh.indices.size())});
  for (const Mesh& other : coarse) {
    levels_.push_back({all.indices.size(), static_cast<GLsizei>(other.indices.size())});
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    for (const std::uint32_t index : other.indices) all.indices.push_back(first + index);
    all.vertices.insert(all.vertices.end(), other.vertices.begin(), other.vertices.end());
  }
  for (std::size_t which = 0; which < 2; ++which) {
    arrays_[which] = make_vertex_array();
    instances_[which] = make_buffer();
    glBindVertexArray(arrays_[which].get());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
    for (GLuint a = 0; a < 2; ++a) {
      glEnableVertexAttribArray(a);
      glVertexAttribPointer(a, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), at(a * sizeof(glm::vec3)));
    }
    glEnableVertexAttribArray(broken_location);
    glVertexAttribPointer(broken_location, 1, GL_FLOAT, GL_FALSE, sizeof(Vertex), at(offsetof(Vertex, broken)));
    glBindBuffer(GL_ARRAY_BUFFER, instances_[which].get());
    GLuint location = 2;
    for (const Attribute& a : attributes) {
      glEnableVertexAttribArray(location);
      glVertexAttribPointer(location, a.components, a.type, a.type == GL_FLOAT ? GL_FALSE : GL_TRUE,
                            static_cast<GLsizei>(stride), at(a.offset));
      glVertexAttribDivisor(location++, 1);
    }
  }
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(all.indices.size() * sizeof(std::uint32_t)),
               all.indices.data(), GL_STATIC_DRAW);
  glBindVertexArray(0);
  send(all);
}

void GpuBatch::send(const Mesh& mesh) {
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(Vertex)), mesh.vertices.data(),
               GL_STATIC_DRAW);
}

void GpuBatch::send(std::size_t which, const void* data, std::size_t count, std::size_t size) {
  counts_[which] = count;
  glBindBuffer(GL_ARRAY_BUFFER, instances_[which].get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(count * size), data, GL_STREAM_DRAW);
}

void GpuBatch::draw(std::size_t level) const {
  const Range& range = levels_[std::min(level, levels_.size() - 1)];
  for (std::size_t which = 0; which < 2; ++which) {
    if (counts_[which] == 0) continue;
    glBindVertexArray(arrays_[which].get());
    glDrawElementsInstanced(GL_TRIANGLES, range.count, GL_UNSIGNED_INT, at(range.first * sizeof(std::uint32_t)),
                            static_cast<GLsizei>(counts_[which]));
  }
  glBindVertexArray(0);
}

GpuScene::GpuScene(const SceneInstances& scene) {
  for (const auto& batch : scene.members())
    members_.emplace_back(batch.mesh, member_attributes(), sizeof(MemberInstance), batch.coarse);
  for (const auto& batch : scene.panels(structure::PanelKind::slab))
    slabs_.emplace_back(batch.mesh, panel_attributes(), sizeof(PanelInstance));
  for (const auto& batch : scene.panels(structure::PanelKind::wall))
    walls_.emplace_back(batch.mesh, panel_attributes(), sizeof(PanelInstance));
  projectiles_.emplace_back(scene.projectiles().mesh, rigid_attributes(), sizeof(RigidInstance));
  piers_.emplace_back(scene.piers().mesh, rigid_attributes(), sizeof(RigidInstance));
  for (const auto* batch : {&scene.arrows(), &scene.buried_arrows(), &scene.hinges()})
    arrows_.emplace_back(batch->mesh, rigid_attributes(), sizeof(RigidInstance));
}

void GpuScene::update(const SceneInstances& scene) {
  update_all(members_, scene.members());
  update_all(slabs_, scene.panels(structure::PanelKind::slab));
  update_all(walls_, scene.panels(structure::PanelKind::wall));
  projectiles_[0].update(scene.projectiles());
  piers_[0].update(scene.piers());
  arrows_[0].update(scene.arrows());
  arrows_[1].update(scene.buried_arrows());
  arrows_[2].update(scene.hinges());
  const auto follow = [](std::vector<GpuBatch>& gpu, const std::vector<InstanceBatch<RigidInstance>>& batches) {
    for (std::size_t i = gpu.size(); i < batches.size(); ++i)
      gpu.emplace_back(batches[i].mesh, rigid_attributes(), sizeof(RigidInstance));
    update_all(gpu, batches);
  };
  follow(chunks_, scene.chunks());
  follow(torn_ends_, scene.torn_ends());
  follow(drawn_, scene.drawn());
}

}  // namespace topple::viewer
