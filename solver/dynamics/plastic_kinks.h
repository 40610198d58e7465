#pragma once
// Plastic rotations of beams' ends. Each is a kink of its beam, whose loads on the beam's nodes follow its angle.
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <vector>

#include "assembly/frame_system.h"
#include "dynamics/generalized_alpha.h"
#include "dynamics/motion_state.h"
#include "topple/solver/frame_dynamics.h"

namespace topple::solver {

struct Kink {
  int beam = -1;
  std::size_t end = 0;
  int component = 4;
  double before = 0, now = 0;  ///< rad, at both ends of the substep under way, or the last one
  double current = 0;          ///< now
  double started_at = 0;       ///< rad, where the motion began
  double held = 0;     ///< N m, where it turned in the substep under way, or the last one: of the sign of its turn
  double tried = 0;    ///< N m, at the end of that substep had nothing turned
  bool known = false;  ///< what follows, for the structure as it stands
  Vec12 fixed_end = Vec12::Zero();    ///< of its beam, local, for 1 rad
  Eigen::SparseVector<double> force;  ///< of its beam on the nodes, scaled, for 1 rad
  Eigen::VectorXd response;           ///< of w in a substep to 1 rad more at its end; empty: to be found
  [[nodiscard]] Eigen::Index component_index() const { return static_cast<Eigen::Index>(6 * end) + component; }
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [of_beam, at_end, of_component, at_start, at_substep_end, turned, turned_at_start, holds, was_tried, is_known,
           on_beam, on_nodes, answer] = *this;
    archive(of_beam, at_end, of_component, at_start, at_substep_end, turned, turned_at_start, holds, was_tried,
            is_known, on_beam, on_nodes, answer);
  }
};

class PlasticKinks {
 public:
  /// Fixed-end forces of a beam, local, under its loads without kinks.
  using LoadsOfBeam = std::function<Vec12(std::size_t beam)>;

  /// The number of a kink; a new one is straight.
  [[nodiscard]] std::size_t number(const FrameModel& model, int beam, std::size_t end, int component);
  [[nodiscard]] const Kink& operator[](std::size_t kink) const { return kinks_[kink]; }
  /// Of a beam's both ends, now.
  [[nodiscard]] Vec12 rotations(std::size_t beam) const;
  /// Sets what it has turned as part of the state.
  void set(const FrameSystem& system, std::size_t kink, double rotation);
  /// The motion begins here.
  void start_here();

  /// Finds its loads for the structure as it stands.
  void find(const FrameSystem& system, std::size_t kink);
  /// The structure is another one: finds those of all that have turned.
  void find_anew(const FrameSystem& system);

  void begin_substep();
  /// What was tried in the substep under way is tried again: nothing has turned.
  void restore();
  void hold_nothing();
  void set_response(std::size_t kink, Eigen::VectorXd response) { kinks_[kink].response = std::move(response); }
  void set_tried(std::size_t kink, double moment) { kinks_[kink].tried = moment; }
  /// In the substep under way, at this moment of either sign.
  void turn(std::size_t kink, double turn, double capacity);
  /// The substep under way is the last one. True: something turned in it.
  bool accept();

  /// By how much the moment of one falls at the end of a substep for 1 rad that another has turned more by then.
  [[nodiscard]] double resistance(std::size_t of, std::size_t by, const GeneralizedAlpha& method) const;
  /// Adds the fixed-end forces of a beam, local, at either end of the substep under way, or of the last one.
  void add_fixed_end(std::size_t beam, bool at_end, Vec12& fixed_end) const;
  /// Adds the scaled forces of what had turned at the start of the substep under way.
  void add_start(const FrameSystem& system, Eigen::VectorXd& load);
  /// And those of what turned in it, times `share`.
  void add_turned(double share, Eigen::VectorXd& load) const;
  /// Takes away the scaled forces of what has turned by now.
  void subtract(Eigen::VectorXd& load) const;

  /// What the elastic energy has because of them, beside 1/2 u'Ku.
  [[nodiscard]] double elastic(const Eigen::VectorXd& u) const;
  /// Adds what loads on the beams did along them since the motion began.
  void add_work(const LoadsOfBeam& loads, double& work) const;
  /// Of the substep under way, before it is accepted.
  void account(const Eigen::VectorXd& u_start, const Eigen::VectorXd& u_end, const GeneralizedAlpha& method,
               double stiffness_damping, const LoadsOfBeam& loads, DynamicEnergy& energy) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [kinks, of_beam] = *this;
    archive(kinks, of_beam);
  }

 private:
  std::vector<Kink> kinks_;
  std::vector<std::vector<std::size_t>> of_beam_;  ///< empty while there is none
};

}  // namespace topple::solver
