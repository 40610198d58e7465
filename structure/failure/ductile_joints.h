#pragma once
// Joints that bend and twist before they break. Each ductile sense of a joint is a plastic hinge that may form: it
// holds its capacity while it turns (it yields), unloads as soon as it would turn back, and keeps the angle by which
// it has turned (its plastic rotation: rotation of the rigid end less that of the member's end, beyond what the joint's
// spring gives).
//
// Loads are followed from a base, the last state reached, towards the static answer under the loads as they are:
// base + x (answer - base). Between two events (a hinge forms, turns back, a joint breaks) everything is linear in x.
#include <vector>

#include "failure/panel_bearings.h"
#include "failure/segmentation.h"
#include "standing/statics/frame_statics.h"

namespace topple::structure {

struct PlasticHinge {
  JointId joint;
  int axis = 4;                 ///< component of the member's end: 3 torsion, 4 and 5 moments
  double limit = 0;             ///< of the plastic rotation, rad
  double plastic_rotation = 0;  ///< in the base state
  double held = 0;              ///< while it yields: what the rigid end gives to the member
  bool yields = false;
  bool told = false;  ///< that it yielded
  [[nodiscard]] Sense sense() const { return static_cast<Sense>(axis + 1); }
};
template <class Archive>
void serialize(Archive& archive, PlasticHinge& hinge) {
  auto& [joint, axis, limit, plastic_rotation, held, yields, told] = hinge;
  archive(joint, axis, limit, plastic_rotation, held, yields, told);
}

/// How a component gets from one state of rest to the next when hinges form on the way.
struct PlasticPath {
  bool active = false;     ///< a hinge has formed since it rested
  bool returning = false;  ///< the peak of a sudden change is past: the rest is slow
  double surplus = 0;      ///< work done by the loads so far less what the structure has taken up, J
  double direction = 1;    ///< of the way from the base: towards the static answer, or (-1) beyond it
  int events = 0;
};
template <class Archive>
void serialize(Archive& archive, PlasticPath& path) {
  auto& [active, returning, surplus, direction, events] = path;
  archive(active, returning, surplus, direction, events);
}

class DuctileJoints {
 public:
  DuctileJoints(const Building& building, const FrameStatics& statics, const Segmentation& segments,
                const PanelBearings& bearings, const std::vector<std::vector<solver::BeamLoad>>& applied);

  [[nodiscard]] bool any(int component) const { return !hinges_[static_cast<std::size_t>(component)].empty(); }
  [[nodiscard]] std::vector<PlasticHinge>& hinges(int component) {
    return hinges_[static_cast<std::size_t>(component)];
  }
  [[nodiscard]] PlasticPath& path(int component) { return paths_[static_cast<std::size_t>(component)]; }
  /// The joint broke: its hinges are no more.
  void lose(JointId joint, int component);

  /// The answer as solved now is the base.
  void base_is_answer(int component);
  /// The base moves by `part` of the way to the answer.
  void move_base(int component, double part);
  /// The base moves as a mechanism does: nothing is strained.
  void move_base(int component, const std::vector<Vec6>& motion, double amount);
  /// Elastic energy of the difference between the answer and the base: half of what the loads of the way do along it.
  [[nodiscard]] double difference_energy(int component) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [building, statics, segments, bearings, applied, hinges, paths, end_forces, loads, displacement,
           plate_forces] = *this;
    archive(hinges, paths, end_forces, loads, displacement, plate_forces);
  }

 private:
  [[nodiscard]] std::vector<solver::BeamLoad> mixed_loads(MemberId member, double base, double now) const;

  const Building& building_;
  const FrameStatics& statics_;
  const Segmentation& segments_;
  const PanelBearings& bearings_;
  const std::vector<std::vector<solver::BeamLoad>>& applied_;
  std::vector<std::vector<PlasticHinge>> hinges_;  ///< per component, in order of joint
  std::vector<PlasticPath> paths_;
  // The base, of components with hinges.
  std::vector<solver::Vec12> end_forces_;
  std::vector<std::vector<solver::BeamLoad>> loads_;
  std::vector<Vec6> displacement_;
  std::vector<std::vector<Vec6>> plate_forces_;  ///< per panel, at its nodes
};

}  // namespace topple::structure
