#pragma once
// A joint that holds some of the six components between a body and another, or space: up to six rows, solved together.
#include <array>

#include "solver/equilibrium.h"
#include "solver/solver_body.h"

namespace topple::collision {

struct HingeRows {
  static constexpr int most = 6;
  using Rows = Eigen::Matrix<double, most, 1>;
  using Jacobian = Eigen::Matrix<double, most, 6>;

  // What it is. Axes are columns, in each one's frame, that were one when it was made.
  std::array<bool, 6> held{};
  Vec3 point_in_body = Vec3::Zero(), point_in_holder = Vec3::Zero();
  Mat3 axes_in_body = Mat3::Identity(), axes_in_holder = Mat3::Identity();
  int body = 0, holder = 0;  ///< of the step's solver; holder 0: space

  // Of the step.
  Rows impulse = Rows::Zero();       ///< of a sub-step, to begin the next with; between steps as a force, N
  Vec3 force_total = Vec3::Zero();   ///< on the body over the step, N s, global
  Vec3 moment_total = Vec3::Zero();  ///< on the body about the joint's point, N m s
  Vec3 body_moment = Vec3::Zero(), holder_moment = Vec3::Zero();  ///< on each about its own centre, N m s
  Vec3 moment_where_it_was = Vec3::Zero();  ///< on the holder about where its centre was when the step began, N m s

  void begin_step(double h);
  void end_step(double h) { impulse /= h; }
  /// Rows where the two are now.
  void prepare(const SolverBody& body, const SolverBody& holder, const Motion6& body_moved,
               const Motion6& holder_moved);
  void warm_start(Motion6* velocity, Motion6* changed) { apply(impulse, velocity, changed); }
  /// With springs (`frequency` Hz, `damping` ratio) or, at zero, without.
  void solve(double frequency, double damping, double h, Motion6* velocity, Motion6* changed);
  /// Adds what was applied in the sub-step to the totals.
  void add_up();
  /// Rows and forces as an equilibrium takes them; after prepare().
  [[nodiscard]] RestJoint at_rest() const;
  void store_rest(const Rows& force, double dt);

  /// Between steps.
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [holds, in_body, in_holder, of_body, of_holder, number, holder_number, begin_with, force, moment,
           on_body_moment, on_holder_moment, where_it_was, count, body_rows, holder_rows, gap, along, about, body_arm,
           holder_arm, holder_way, inverse_mass] = *this;
    archive(holds, in_body, in_holder, of_body, of_holder, begin_with);  // a step sets the others before it reads them
  }

 private:
  void add_row(const Vec3& along, const Vec3& about, double gap, const SolverBody& body, const SolverBody& holder);
  void apply(const Rows& change, Motion6* velocity, Motion6* changed) const;

  int count_ = 0;
  Jacobian on_body_, on_holder_;
  Rows gap_ = Rows::Zero();
  std::array<Vec3, most> along_, about_;  ///< of each row, global: unit force, or unit moment
  Vec3 body_arm_ = Vec3::Zero(), holder_arm_ = Vec3::Zero();
  Vec3 holder_way_ = Vec3::Zero();  ///< of its centre since the step began, m
  Eigen::Matrix<double, most, most> inverse_mass_;
};

}  // namespace topple::collision
