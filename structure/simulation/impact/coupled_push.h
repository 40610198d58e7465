#pragma once
// One body that pushes into an elastic structure at several places at once, in closed form and without a time step.
//
// The body's six coordinates q (translation of its centre, rotation about it) move the contacts by d = J q along their
// normals (into the structure), which resist with F = C^-1 d, C their compliance matrix:
//   M q'' = f - J' C^-1 J q,   q = 0 and q' = the body's velocity at first touch,   f the body's weight.
// This is M_c d'' = w - C^-1 d with M_c the pseudo-inverse of J M^-1 J', written so that contacts which depend on each
// other (four corners of a plate have three freedoms) need no care. Its modes are those of a 6 x 6 matrix. A contact
// leaves when its force reaches zero; the others go on with what is left of C. Where the structure's own mass takes its
// share (A, between the places), the push goes on with M + J' A J, after a plastic first touch: as with one place,
// momentum is kept and m M/(m + M) v^2/2 is lost.
// Source: free vibration by modes (Clough and Penzien, Dynamics of Structures, ch. 12).
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

struct PushingBody {
  double mass = 0;
  Mat3 inertia = Mat3::Identity();  ///< about the centre, global axes
  Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero(), spin = Vec3::Zero();
  Vec3 weight = Vec3::Zero();  ///< N, global
};
struct PushedPlace {
  Vec3 point = Vec3::Zero(), normal = Vec3::Zero();  ///< unit, into the structure
};

class CoupledPush {
 public:
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  /// `compliance`: symmetric positive definite, m/N, along the normals, one row for each place. `structure`: masses of
  /// the structure that move with the places, kg, symmetric and not negative; empty: none. Throws std::invalid_argument
  /// when sizes differ, a mass or compliance is not positive, or there is no place.
  CoupledPush(const PushingBody& body, std::vector<PushedPlace> places, Eigen::MatrixXd compliance,
              const Eigen::MatrixXd& structure = {});

  enum class Stop {
    left,    ///< the last contact has let go
    failed,  ///< `utilisation` has reached 1
    held     ///< the contacts that are left never let go (the weight holds the body down): a full swing has been seen
  };
  /// Utilisation of what bears the forces (one for each place, N, not negative): convex in them.
  using Utilisation = std::function<double(const Eigen::VectorXd& force)>;
  /// Pushes on from where it is. Without `utilisation` nothing fails.
  Stop push(const Utilisation& utilisation = {});

  /// After a break: the compliance from now on, and by how much each unloaded place has moved along its normal.
  void weaken(Eigen::MatrixXd compliance, const Eigen::VectorXd& shift);
  /// The place is gone: it bears nothing from now on, and its row of the compliance does not matter.
  void let_go(std::size_t place);
  [[nodiscard]] bool touches(std::size_t place) const { return touches_[place] != 0; }

  [[nodiscard]] Eigen::VectorXd force() const;  ///< now
  [[nodiscard]] const Eigen::VectorXd& peak_force() const { return peak_; }
  [[nodiscard]] Vec3 velocity() const { return rate_.head<3>(); }
  [[nodiscard]] Vec3 spin() const { return rate_.tail<3>(); }
  /// Of the frequencies of its modes, the free ones aside: a swing is followed in steps of the fastest.
  [[nodiscard]] double fastest_over_slowest() const;
  [[nodiscard]] double time() const { return time_; }  ///< since first touch, s
  /// Elastic energy under the contacts, J.
  [[nodiscard]] double stored() const;
  /// Velocity and spin of the body: now, and when most energy was stored since the last break.
  [[nodiscard]] const Vec6& rates() const { return rate_; }
  [[nodiscard]] const Vec6& rates_at_most_stored() const { return rate_at_most_stored_; }

 private:
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  struct Modes {
    Mat6 shape;                 ///< columns, of unit modal mass
    Vec6 squared;               ///< circular frequencies squared
    Vec6 place, speed, weight;  ///< modal coordinates at the start, and constant force
  };
  [[nodiscard]] Modes modes() const;
  [[nodiscard]] static Vec6 coordinates(const Modes& modes, double time);
  [[nodiscard]] static Vec6 rates(const Modes& modes, double time);
  [[nodiscard]] Eigen::VectorXd force_at(const Vec6& coordinates) const;
  [[nodiscard]] double stored_at(const Vec6& coordinates) const;
  void add_share(const Eigen::MatrixXd& structure);
  void note_most_stored(const Modes& modes, double from, double to);
  void note_peaks(const Modes& modes, double from, double to);
  void drop_let_go(const Eigen::VectorXd& force);
  void refresh();

  Mat6 inverse_mass_root_;  ///< R with R' (M + J' A J) R = 1
  std::vector<PushedPlace> places_;
  Eigen::MatrixXd jacobian_, compliance_, stiffness_;  ///< stiffness: zero rows and columns where a contact let go
  std::vector<char> touches_;
  Vec6 weight_, coordinates_ = Vec6::Zero(), rate_, rate_at_most_stored_;
  double most_stored_ = 0;
  Eigen::VectorXd shift_, peak_;
  double time_ = 0;
};

}  // namespace topple::structure
