#pragma once
// Loads on beams as the joints at their ends feel them. An element has mass at its ends alone, so that a push between
// them is at its joints at once, whole, however short it is: one of a substep would break what a substep half as long
// breaks twice as easily. A beam of mass lets it through by its own vibration.
#include <map>
#include <vector>

#include "topple/solver/frame_model.h"

namespace topple::solver {

/// 1/w of a beam with both ends held, s, by component of its end forces: its first angular frequencies in bending
/// (22.37/L^2 sqrt(EI/(density A))), in extension (pi/L sqrt(E/density)) and torsion (pi/L sqrt(G J/(density (Iy +
/// Iz)))). A short push of impulse J excites a mode by w J, which is the mean of that push over 1/w; and one that stays
/// is felt whole after 1/w, a sixth of the period. (R. W. Clough, J. Penzien, Dynamics of Structures, 5-3 and 18-3.) 0
/// where the beam has no mass or no stiffness.
[[nodiscard]] Vec6 times_to_feel(const Beam& beam);

/// Fixed-end forces of pushes (not of temperatures, which bend the beam itself), local, in their means over these
/// times.
class RecentLoads {
 public:
  /// `times`: per beam; none: what acts is felt.
  explicit RecentLoads(std::vector<Vec6> times = {}) : times_(std::move(times)) {}

  /// A beam, and how it holds on.
  struct Held {
    Beam beam;          ///< with the end stiffness that it has
    double factor = 1;  ///< on its E and G
  };
  /// The loads of a beam are about to change in a substep of length h.
  void change(int beam, const Held& held, const std::vector<BeamLoad>& from, const std::vector<BeamLoad>& to, double h);
  /// It holds on otherwise than it did.
  void hold_otherwise(int beam, const Held& held);
  /// A substep of length h has passed.
  void accept(double h);

  /// At the end of a substep of length h, or at its start. `acting`: what acts in it; `accepted`: it has passed.
  [[nodiscard]] Vec12 felt(int beam, const Vec12& acting, double h, bool at_end, bool accepted) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [times, histories] = *this;
    archive(histories);
  }

 private:
  struct Stretch {
    double duration = 0;  ///< s; of the one under way, until that began
    std::vector<BeamLoad> pushes;
    Vec12 fixed_end = Vec12::Zero();
    template <class Archive>
    void serialize(Archive& archive) {
      archive(duration, pushes, fixed_end);
    }
  };
  using History = std::vector<Stretch>;  ///< the newest first, which is the one under way
  /// Of a component, over `length` s that end `ago` s before the newest stretch does, which goes on for `under_way` s.
  [[nodiscard]] static double mean_of(const History& history, Eigen::Index component, double under_way, double ago,
                                      double length);

  std::vector<Vec6> times_;
  std::map<int, History> histories_;
};

}  // namespace topple::solver
