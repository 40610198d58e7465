#pragma once
// What the parts of a scene share: rotations and places as drawings have them, the motion of a body, and how far
// what stands is drawn from where it stood.
#include <Eigen/Geometry>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <type_traits>

#include "renderer/instances/instance_batch.h"
#include "renderer/snapshot.h"
#include "renderer/view_options.h"

namespace topple::viewer {

inline glm::dvec3 to_glm(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline glm::vec3 to_glm(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }
inline glm::dquat to_glm(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }
inline glm::vec4 packed(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }

inline void bend(MemberInstance& instance, const MemberShape& shape) {
  instance.displacement1 = to_glm(Eigen::Vector3f(shape.ends[0].head<3>()));
  instance.rotation1 = to_glm(Eigen::Vector3f(shape.ends[0].tail<3>()));
  instance.displacement2 = to_glm(Eigen::Vector3f(shape.ends[1].head<3>()));
  instance.rotation2 = to_glm(Eigen::Vector3f(shape.ends[1].tail<3>()));
  instance.bulge = to_glm(shape.bulge);
}

/// Displacements as they are drawn: those of a mode when there is one, else those at the start of the run by one scale
/// and what has come to them by another.
struct DrawnShape {
  using Displacements = std::vector<Eigen::Matrix<float, 6, 1>>;
  const Displacements& displacements;
  const Displacements* at_start = nullptr;        ///< null: all by one scale
  const MemberShapes* shapes = nullptr;           ///< null: as nodes tell it
  const MemberShapes* shapes_at_start = nullptr;  ///< with at_start
  float scale, motion_scale;
  DrawnShape(const Snapshot& snapshot, const ViewOptions& options)
      : displacements(snapshot.shape ? *snapshot.shape : snapshot.answer->displacements),
        scale(snapshot.shape ? snapshot.shape_scale : options.deflection_scale),
        motion_scale(options.motion_scale_now()) {
    if (snapshot.shape) return;
    shapes = snapshot.answer->shapes.get();
    if (motion_scale == scale) return;
    at_start = snapshot.answer->at_start.get();
    shapes_at_start = snapshot.answer->shapes_at_start.get();
  }
  [[nodiscard]] Eigen::Matrix<float, 6, 1> at(structure::NodeId node) const {
    const auto i = static_cast<std::size_t>(node.index);
    const auto& now = displacements[i];
    // A node that is held, or stands no more, has not moved.
    if (at_start == nullptr || now.isZero(0)) return scale * now;
    return scale * (*at_start)[i] + motion_scale * (now - (*at_start)[i]);
  }
  [[nodiscard]] MemberShape of(const structure::Building& building, std::size_t member) const {
    const structure::MemberId id(member);
    const MemberShape* own = shapes != nullptr ? shapes->find(member) : nullptr;
    if (own == nullptr) {
      MemberShape shape;
      for (std::size_t end = 0; end < 2; ++end) {
        Displacement& d = shape.ends[end] = at(building[id].nodes[end]);
        d.head<3>() += d.tail<3>().cross(Eigen::Vector3f(building[id].offsets[end].cast<float>()));
      }
      return shape;
    }
    MemberShape shape = *own, start;
    if (at_start != nullptr) {
      const MemberShape* known = shapes_at_start != nullptr ? shapes_at_start->find(member) : nullptr;
      start = known != nullptr ? *known : structure::shape_of_nodes(building, id, *at_start);
    }
    const auto scaled = [&](const auto& now, const auto& then) -> std::decay_t<decltype(now)> {
      if (at_start == nullptr) return scale * now;
      return scale * then + motion_scale * (now - then);
    };
    for (std::size_t end = 0; end < 2; ++end) shape.ends[end] = scaled(shape.ends[end], start.ends[end]);
    shape.bulge = scaled(shape.bulge, start.bulge);
    return shape;
  }
};

/// Rigid motion of a body as a drawing needs it.
struct BodyMotion {
  glm::dvec3 position, rest_centre;
  glm::dquat turn;
  explicit BodyMotion(const BodyPose& body)
      : position(to_glm(body.position)), rest_centre(to_glm(body.rest_centre)), turn(to_glm(body.orientation)) {}
  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& point) const { return position + turn * (point - rest_centre); }
};

/// Whether the switch of its kind is on.
inline bool is_on(const PartSwitches& switches, const structure::Member& member) {
  switch (member.kind) {
    case structure::MemberKind::post:
      return switches.posts;
    case structure::MemberKind::beam:
      return switches.beams;
    case structure::MemberKind::brace:
      return switches.braces;
  }
  return true;
}
inline bool is_on(const PartSwitches& switches, const structure::Panel& panel) {
  return panel.kind == structure::PanelKind::slab ? switches.slabs : switches.walls;
}

}  // namespace topple::viewer
