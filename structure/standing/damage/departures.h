#pragma once
// What leaves a standing frame: panels that fall once they have lost what they lay on, and the list of all that left
// and has not been handed out.
#include <utility>
#include <vector>

#include "standing/structural_state.h"

namespace topple::structure {

class Departures {
 public:
  /// `state` must outlive it.
  explicit Departures(StructuralState& state) : state_(state) {}

  /// Panels go on by what happened to their bearings. `leaving`: parts that leave in the same change, by their numbers;
  /// null where none does.
  void follow(const PanelBearings::Changes& changes, std::vector<Detached>* leaving = nullptr);
  /// Nothing stands at the node any more that is not about to leave: membranes cannot hang there, and the solver has no
  /// stiffness for it.
  void lay_bare(NodeId node);

  void add(Detached part) { detached_.push_back(std::move(part)); }
  [[nodiscard]] bool any() const { return !detached_.empty(); }
  /// Handed out once, in the order in which they left.
  [[nodiscard]] std::vector<Detached> extract() { return std::exchange(detached_, {}); }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [state, detached] = *this;
    archive(detached);
  }

 private:
  void lose_edges(PanelId panel);

  StructuralState& state_;
  std::vector<Detached> detached_;
};

}  // namespace topple::structure
