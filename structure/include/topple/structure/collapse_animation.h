#pragma once
// A collapse as a glTF animation: one node for each member, panel, chunk and ball, by its name, for what remains of a
// panel after each break, and for each piece of a visual mesh.
#include <memory>
#include <string>

#include "topple/structure/simulation.h"
#include "topple/structure/visual_mesh.h"

namespace topple::structure {

/// Records poses and bends frame by frame, as StandingShapes and KeptShapes have them, to drawn_tolerance; pieces of a
/// visual mesh as they were drawn, moved with their bodies.
class CollapseAnimation {
 public:
  /// `rate`: frames for each simulated second, above 0. `drawn`: recorded as it is when frames are added; it has to
  /// outlive this. Records the first frame.
  CollapseAnimation(const Simulation& simulation, double rate, const VisualMesh* drawn = nullptr);
  ~CollapseAnimation();

  /// Records the frames that are due up to the simulation's time; call after every step and after steps were skipped.
  void add_due(const Simulation& simulation);
  /// Recorded so far.
  [[nodiscard]] int frames() const;
  /// glTF 2.0 in its binary form, y up, m and s. Poses are keyed where they change, so that linear interpolation gives
  /// every frame's own; a node has scale 1 from its birth to its removal, else 0. Members of one
  /// section, kind and length share a mesh, and those of them that bend another with morph targets.
  [[nodiscard]] std::string glb() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::structure
