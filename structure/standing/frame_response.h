#pragma once
// How a standing frame answers unit forces: compliance, joint demands, the mass that takes part; in full, or as far as
// it is known at little cost (response_bound.cpp). It changes nothing of the frame.
#include <span>
#include <utility>
#include <vector>

#include "failure/joint_states.h"
#include "loads/placed_load.h"
#include "standing/component_parts.h"
#include "standing/panel_superelements.h"
#include "standing/standing_parts.h"

namespace topple::structure {

class FrameResponse {
 public:
  using UnitResponse = StandingFrame::UnitResponse;
  using CoupledResponse = StandingFrame::CoupledResponse;

  /// What it looks at; all of it must outlive it.
  struct Sources {
    const StandingParts& parts;
    const PanelSuperelements& shells;
    const FrameLoads& loads;
    const FrameStatics& statics;
    const JointStates& joints;
    const ComponentParts& components;
    const std::vector<char>& node_solved;  ///< per node: the solver holds it
  };
  explicit FrameResponse(const Sources& sources);

  /// A force on a standing part as loads on members and nodes.
  [[nodiscard]] PlacedLoad load_at(const ContactPlace& place, const Vec3& force,
                                   const Vec3& moment = Vec3::Zero()) const;
  /// As StandingFrame's of the same names.
  [[nodiscard]] CoupledResponse respond(std::span<const ContactPlace> places, std::span<const Vec3> directions) const {
    return couple(places, directions, false);
  }
  [[nodiscard]] CoupledResponse respond_near(std::span<const ContactPlace> places,
                                             std::span<const Vec3> directions) const {
    return couple(places, directions, true);
  }
  /// J: a push that adds less strain energy to the component breaks no joint of it but those that bear it directly.
  [[nodiscard]] double critical_energy(int component) const;
  /// To be called when the component's demands, strengths or parts have changed.
  void forget_bounds(int component);
  /// m: how far the place has moved along the direction in the static answer.
  [[nodiscard]] double displacement_along(const ContactPlace& place, const Vec3& direction) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [building, from, critical_energies, certain_masses] = *this;
    archive(critical_energies, certain_masses);
  }

 private:
  /// Response to a force, and where the force is placed.
  struct Shape {
    const PlacedLoad& placed;
    const FrameStatics::Response& response;
  };
  using Demands = std::vector<std::pair<JointId, Vec6>>;

  [[nodiscard]] PlacedLoad load_on_shell(const ContactPlace& place, const Vec3& force) const;
  [[nodiscard]] CoupledResponse couple(std::span<const ContactPlace> places, std::span<const Vec3> directions,
                                       bool near) const;
  [[nodiscard]] FrameStatics::ResponseLoads response_loads(const PlacedLoad& placed) const;
  [[nodiscard]] double compliance(const Shape& shape) const;
  [[nodiscard]] Demands response_demands(int component, const Shape& shape) const;
  [[nodiscard]] Eigen::MatrixXd inertia(int component, std::span<const Shape> shapes) const;
  void add_inertia_of_nodes(int component, std::span<const Shape> shapes, Eigen::MatrixXd& sum) const;
  [[nodiscard]] double panel_mean_product(PanelId panel, const Shape& a, const Shape& b) const;
  [[nodiscard]] Eigen::MatrixXd least_inertia(int component, std::span<const Shape> shapes) const;
  [[nodiscard]] Demands near_demands(std::span<const Shape> shapes, std::size_t pushed) const;
  [[nodiscard]] static std::vector<MemberId> bearing_members(std::span<const Shape> shapes);
  [[nodiscard]] const std::vector<double>& certain_masses(int component) const;
  [[nodiscard]] double critical_energy(JointId joint) const;

  const Building& building_;
  Sources from_;
  /// Per component, of its state as solved last: critical energy (below 0: to be found), and per node the mass that
  /// moves with it whatever the others do (empty: to be found).
  mutable std::vector<double> critical_energies_;
  mutable std::vector<std::vector<double>> certain_masses_;
};

}  // namespace topple::structure
