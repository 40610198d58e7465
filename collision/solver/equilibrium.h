#pragma once
// Forces that hold bodies at rest: of all that lie within the friction cones and balance each body's weight, the
// nearest to those that a step ended with, by the energy of springs at the contacts (least complementary energy).
//
// A contact has up to four normal forces, two of friction and a twist about the normal. With l the mean distance of its
// points from where friction acts, and T = (t1, t2, twist/l), all (n, T) with n >= 0 and |T| <= mu (sum of n) are a
// convex cone. With D the contacts' effective masses and J their rows, what is sought is
//   min (lambda - lambda0)' D^-1 (lambda - lambda0) / 2   with   w + J' lambda = 0   and lambda in the cones.
// Its dual has six unknowns a body, y, the way that it gives: lambda = P(lambda0 - D J y), P the projection on the
// cones, and y minimises |lambda|^2/2 (in D^-1) - w'y, which is convex and smooth, with what is out of balance as its
// gradient. Newton's steps with the projection's derivative (how the bound of friction follows the normal force is in
// it) and a line search find it from anywhere (Zhao, Sun, Toh, "A Newton-CG augmented Lagrangian method", SIAM J.
// Optim. 20, 2010). Where there are no such forces, y grows without bound: there is no rest.
// What grows is the motion of the bodies that are not held (a theorem of the alternative).
#include <vector>

#include "topple/collision/world.h"

namespace topple::collision {

/// One contact; rows on scaled velocities (contact_packs.h): up to four normal ones (zero where there is no point), two
/// of friction, and the twist times its lever.
struct RestContact {
  using Rows = Eigen::Matrix<double, 7, 1>;
  using Jacobian = Eigen::Matrix<double, 7, 6>;
  using Square = Eigen::Matrix<double, 7, 7>;
  int first = 0, second = 0;  ///< bodies; 0: what stands
  int count = 0;              ///< normal rows
  double friction = 0;
  Jacobian on_first = Jacobian::Zero(), on_second = Jacobian::Zero();
  Rows stiffness = Rows::Ones();  ///< effective masses, the last three equal
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

/// The point of the cone n >= 0, |T| <= friction (sum of n) that is nearest to z = (n, T), distances measured in
/// D^-1 = 1/stiffness; and how it changes with z, times D (symmetric, at least zero).
void project_on_cone(const RestContact::Rows& z, const RestContact::Rows& stiffness, int count, double friction,
                     RestContact::Rows& nearest, RestContact::Square& gives);

class Equilibrium {
 public:
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  struct Body {
    Vec6 weight = Vec6::Zero();  ///< scaled
    Vec6 scale = Vec6::Zero();   ///< a residual of this size counts as one (its weight; its weight times its size)
    bool moves = false;          ///< nothing is asked of its balance: it presses with the forces of the start
  };

  std::vector<Body> bodies;  ///< 0: what stands
  std::vector<RestContact> contacts;
  std::vector<RestJoint> joints;

  /// True when every body's residual is below `tolerance`. `passes`: matrix products at most.
  [[nodiscard]] bool solve(double tolerance, int passes);
  /// After a search in vain: bodies that give most by far, in the mechanism that no forces hold (y without bound).
  /// Marks them as moving; false when they are more than `share` of all that do not yet, or hang on joints.
  [[nodiscard]] bool leave_out_what_gives(double share);
  /// Largest share of a body's weight (or weight times size) that is out of balance.
  [[nodiscard]] double residual() const { return residual_; }
  [[nodiscard]] int newton_steps() const { return newton_steps_; }
  [[nodiscard]] int passes() const { return passes_; }

 private:
  using Vectors = std::vector<Vec6>;
  struct Link {  ///< of two bodies that give: the matrix's block on the second from the first
    int first = 0, second = 0;
    Mat6 block;
  };
  /// Forces for y, what is out of balance, and the function that is least at balance.
  double respond(const Vectors& y, Vectors& out);
  [[nodiscard]] bool either_moves(int first, int second) const {
    return bodies[static_cast<std::size_t>(first)].moves || bodies[static_cast<std::size_t>(second)].moves;
  }
  /// The matrix at the y of the last respond().
  void assemble(double loose);
  void multiply(const Vectors& p, Vectors& out) const;
  [[nodiscard]] double size(const Vectors& out) const;
  /// Returns matrix products.
  int newton_step(const Vectors& out, double enough, Vectors& step, int passes);

  Vectors y_;
  std::vector<RestContact::Square> gives_;  ///< stiffness of each contact that acts where it is
  std::vector<char> pulls_;
  std::vector<Mat6> blocks_, inverses_;
  std::vector<Link> links_;
  double residual_ = 0;
  int newton_steps_ = 0, passes_ = 0;
};

}  // namespace topple::collision
