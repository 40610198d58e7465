#pragma once
// The right-hand side of a structure that changes: summed up from nothing once, and then only at the nodes whose loads
// or members changed, term by term in the same order, so that it has the same bits either way.
#include <vector>

#include "assembly/frame_system.h"
#include "elements/beam.h"

namespace topple::solver {

class ChangingLoad {
 public:
  /// Without any load.
  explicit ChangingLoad(const FrameModel& model);

  /// From the next update() on.
  void set_node(int node, const Vec6& load);
  /// What its loads do to a beam, as it is now.
  void set_beam(int index, const Beam& beam, const FixedEndForces& fixed);
  /// The node leaves.
  void touch(int node) { stale_nodes_.push_back(node); }
  /// The equations are others.
  void forget() { known_ = false; }
  /// Nothing changed since the last update().
  [[nodiscard]] bool known() const { return known_ && stale_nodes_.empty(); }
  void update(const FrameSystem& system);

  /// As it was at the last update(): what the nodes and beams that stand bear.
  [[nodiscard]] const LoadVector& vector() const { return load_; }
  /// Per node, as it was at the last update().
  [[nodiscard]] const std::vector<Vec6>& on_nodes() const { return borne_; }
  /// Of a beam, local.
  [[nodiscard]] const Vec12& fixed_end(std::size_t beam) const { return fixed_end_[beam]; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [node_loads, borne, fixed_end, at_nodes, unbalanced, load, known, stale_nodes] = *this;
    archive(node_loads, borne, fixed_end, at_nodes, unbalanced, load, known, stale_nodes);
  }

 private:
  void sum_up(const FrameSystem& system);
  void sum_up_at(const FrameSystem& system, int node);

  std::vector<Vec6> node_loads_;  ///< as given
  std::vector<Vec6> borne_;       ///< the same at the last update()
  std::vector<Vec12> fixed_end_;  ///< per beam, local
  std::vector<Vec12> at_nodes_;   ///< per beam: the same reversed, on its nodes, global
  std::vector<char> unbalanced_;  ///< per beam: loaded in a loose direction
  LoadVector load_;
  bool known_ = false;
  std::vector<int> stale_nodes_;  ///< where load_ does not hold any longer
};

}  // namespace topple::solver
