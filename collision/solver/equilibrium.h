#pragma once
// Forces that hold bodies at rest: of all that lie within the friction cones and balance each body's weight, near those
// that a step ended with.
//
// Contacts are taken as springs in series with the forces that they have: the bodies give way by y, and a row carries
//   lambda = P(lambda0 - D J y),
// D its effective mass, P onto what it can carry (a normal force only pushes, friction stays within its cone). What is
// sought is the y for which every body is in balance; Newton's steps with the rows that give way, each solved by
// conjugate gradients with the bodies' own blocks as preconditioner. The energy of such springs is what is least. Where
// no y is found, there is no such rest near by.
#include <array>
#include <vector>

#include "topple/collision/world.h"

namespace topple::collision {

/// The rows of one contact: up to four normal ones, two of friction, one of twist; all on scaled velocities
/// (contact_packs.h).
struct RestContact {
  using Rows = Eigen::Matrix<double, 7, 1>;
  using Jacobian = Eigen::Matrix<double, 7, 6>;
  int first = 0, second = 0;  ///< bodies; 0: what stands
  int points = 0;
  Jacobian on_first = Jacobian::Zero(), on_second = Jacobian::Zero();
  Rows stiffness = Rows::Zero();  ///< effective masses; friction: of its matrix's diagonal
  double coupling = 0;            ///< of the two rows of friction
  double friction = 0;
  std::array<double, 4> lever{};
  Rows start = Rows::Zero(), force = Rows::Zero();
};

/// Rows without bounds, or (a cable) one that only pulls.
struct RestJoint {
  using Rows = Eigen::Matrix<double, 6, 1>;
  using Jacobian = Eigen::Matrix<double, 6, 6>;
  int first = 0, second = 0;
  bool pulls_only = false;
  Jacobian on_first = Jacobian::Zero(), on_second = Jacobian::Zero(), stiffness = Jacobian::Zero();
  Rows start = Rows::Zero(), force = Rows::Zero();
};

class Equilibrium {
 public:
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  struct Body {
    Vec6 weight = Vec6::Zero();  ///< scaled
    Vec6 scale = Vec6::Zero();   ///< a residual of this size counts as one (its weight; its weight times its size)
  };

  std::vector<Body> bodies;  ///< 0: what stands
  std::vector<RestContact> contacts;
  std::vector<RestJoint> joints;

  /// True when every body's residual is below `tolerance`. `passes`: matrix products at most.
  [[nodiscard]] bool solve(double tolerance, int passes);
  /// Largest share of a body's weight (or weight times size) that is out of balance.
  [[nodiscard]] double residual() const { return residual_; }

 private:
  using Vectors = std::vector<Vec6>;
  /// Forces for y, and what is out of balance.
  void respond(const Vectors& y, Vectors& out);
  void multiply(const Vectors& p, Vectors& out) const;
  void precondition();
  [[nodiscard]] double size(const Vectors& out) const;
  [[nodiscard]] double sum_of_squares(const Vectors& out) const;
  /// Returns matrix products.
  int newton_step(const Vectors& out, Vectors& step, int passes);

  std::vector<RestContact::Rows> gives_;  ///< share of a row's stiffness that acts where it is
  std::vector<Eigen::Matrix2d> slides_;   ///< the same for friction
  std::vector<char> pulls_;
  std::vector<Mat6> blocks_;
  double residual_ = 0;
};

}  // namespace topple::collision
