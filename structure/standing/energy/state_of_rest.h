#pragma once
// A standing frame as it was when it rested last: displacements, internal forces, stiffness and loads, component by
// component. It is kept while the frame changes, so that energies need no sum before somebody asks for one.
#include <map>
#include <span>
#include <vector>

#include "standing/energy/solved_frame.h"

namespace topple::structure {

/// A panel that has stiffness, as it was at rest.
struct PanelAtRest {
  std::vector<Vec6> forces;  ///< at its nodes (Panel::all_nodes()), global; those of what is left of it
  double energy = 0;         ///< J, of all that it was
};
template <class Archive>
void serialize(Archive& archive, PanelAtRest& panel) {
  auto& [forces, energy] = panel;
  archive(forces, energy);
}

class StateOfRest {
 public:
  /// `now` must outlive it.
  explicit StateOfRest(const SolvedFrame& now);

  // The state as solved becomes the one in which it rests.
  /// All but the loads, which are written down where they change.
  void record(int component);
  void record_loads(MemberId member);
  void record_loads(NodeId node);
  /// The joint broke on the way here.
  void lose_joint(JointId joint);

  /// Global axes.
  [[nodiscard]] const Vec6& displacement(NodeId node) const;
  /// On the member by its nodes, local axes.
  [[nodiscard]] const solver::Vec12& end_forces(MemberId member) const;
  [[nodiscard]] solver::Vec12 plastic_rotations(MemberId member) const;
  [[nodiscard]] bool stands(MemberId member) const;
  /// Factor on E and G.
  [[nodiscard]] double stiffness(MemberId member) const;
  /// Contacts included, local axes.
  [[nodiscard]] const std::vector<solver::BeamLoad>& loads(MemberId member) const;
  [[nodiscard]] const std::map<std::int64_t, PlacedLoad>& contacts() const { return contacts_; }
  /// As it held.
  [[nodiscard]] solver::Beam beam(MemberId member) const;
  [[nodiscard]] SolvedMember shape(MemberId member) const;
  /// By the stiffness that it has in the answer.
  [[nodiscard]] PanelAtRest panel(PanelId panel) const;

  // Sums over what stood of a component, J.
  /// Loads times displacements, contacts apart.
  [[nodiscard]] LoadWork load_work(int component) const;
  [[nodiscard]] double contact_work(int component) const;
  /// Elastic energy, from internal forces; `changed`: panels whose stiffness is no more what it was.
  [[nodiscard]] double elastic(int component, const std::map<PanelId, PanelAtRest>& changed) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [now, members, nodes, springs, contacts, plastic_rotations] = *this;
    archive(members, nodes, springs, contacts, plastic_rotations);
  }

 private:
  /// A support that gives.
  struct Spring {
    NodeId node;
    Vec6 stiffness = Vec6::Zero();  ///< infinite where it does not give
  };
  struct OfMember {
    solver::Vec12 end_forces = solver::Vec12::Zero(), elastic_end_forces = solver::Vec12::Zero();
    std::vector<solver::BeamLoad> loads;
    std::size_t own_loads = 0;  ///< those of `loads` that are no contacts, which come first
    double stiffness = 1;
    bool stands = false;
    std::array<bool, 2> holds{true, true};  ///< its joints
  };
  struct OfNode {
    Vec6 displacement = Vec6::Zero();
    Vec6 loads = Vec6::Zero();        ///< contacts and events apart
    Vec6 event_loads = Vec6::Zero();  ///< those of events
    bool stands = false;
  };
  template <class Archive>
  friend void serialize(Archive& archive, Spring& spring) {
    auto& [node, stiffness] = spring;
    archive(node, stiffness);
  }
  template <class Archive>
  friend void serialize(Archive& archive, OfMember& member) {
    auto& [end_forces, elastic_end_forces, loads, own_loads, stiffness, stands, holds] = member;
    archive(end_forces, elastic_end_forces, loads, own_loads, stiffness, stands, holds);
  }
  template <class Archive>
  friend void serialize(Archive& archive, OfNode& node) {
    auto& [displacement, loads, event_loads, stands] = node;
    archive(displacement, loads, event_loads, stands);
  }
  void record_contacts(int component);

  const SolvedFrame& now_;
  std::vector<OfMember> members_;
  std::vector<OfNode> nodes_;
  std::vector<std::vector<Spring>> springs_;  ///< per component
  std::map<std::int64_t, PlacedLoad> contacts_;
  std::map<MemberId, solver::Vec12> plastic_rotations_;  ///< of members with plastic hinges
};

}  // namespace topple::structure
