#pragma once
// Loads that go with time: distributions in space times values that change linearly within each substep.
#include <Eigen/Core>
#include <map>
#include <vector>

#include "assembly/frame_system.h"

namespace topple::solver {

class LoadPatterns {
 public:
  // Each returns its number; its value is 0.
  [[nodiscard]] int add(const LoadSet& loads);
  /// Inertia of what stands, against a ground that accelerates along this direction.
  [[nodiscard]] int add_ground(const Vec3& direction);
  /// A force on the scaled equations, as it is. It stays with the nodes: a freedom that a support holds from then on
  /// takes none of it, one that a support lets go is given none.
  [[nodiscard]] int add_holding(const FrameSystem& system, Eigen::VectorXd force);
  /// At the end of the next substep.
  void set(int pattern, double value_at_end) { patterns_.at(static_cast<std::size_t>(pattern)).next = value_at_end; }
  /// At once.
  void jump(int pattern, double value);
  void begin_substep();
  /// The substep under way is the last one.
  void accept();

  /// For the structure as it stands: those that are not known.
  void find(const FrameSystem& system);
  /// The structure is another one.
  void forget();
  /// So are its equations, or their scale.
  void forget_equations();

  /// Adds the scaled forces at the share `start` of the start of the substep and the rest of its end.
  void add_to(double start, Eigen::VectorXd& load) const;
  /// Of a beam, local, at either end of the substep under way, or of the last one.
  void add_fixed_end(int beam, bool at_end, Vec12& fixed_end) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [patterns] = *this;
    archive(patterns);
  }

 private:
  struct Pattern {
    enum class Kind { loads, ground, holding } kind = Kind::loads;
    LoadSet loads;  ///< of a holding force: on nodes
    Vec3 direction = Vec3::Zero();
    std::map<int, Vec12> fixed_end;  ///< per loaded beam, local, for a value of 1
    Eigen::VectorXd force;           ///< scaled; empty: to be found
    double current = 0, next = 0;    ///< values now, and at the end of the next substep
    double before = 0, now = 0;      ///< at both ends of the substep under way, or the last one
    template <class Archive>
    void serialize(Archive& archive) {
      auto& [of_kind, in_space, along, on_beams, on_equations, value, value_at_end, at_start, at_end] = *this;
      archive(of_kind, in_space, along, on_beams, on_equations, value, value_at_end, at_start, at_end);
    }
  };
  [[nodiscard]] int add(Pattern pattern);
  static void find(const FrameSystem& system, Pattern& pattern);

  std::vector<Pattern> patterns_;
};

}  // namespace topple::solver
