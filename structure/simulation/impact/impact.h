#pragma once
// The law of impact: two things that push into each other at one instant, at one place or at several, in closed form
// and without a time step.
//
// With d the indentations along the contacts' normals, v their closing speeds, f the contact forces, C the compliance
// of both sides between the places (m/N) and L their mobility (relative acceleration under unit forces, 1/kg: the sum
// of J M^-1 J' of both sides; a side that cannot move brings none),
//   d'' = a - L f,   f = C^-1 (d - D) over the places that touch, zero elsewhere,   d = 0 and d' = v at first touch,
// a being the relative acceleration without contacts (gravity against something that stands; nothing between two free
// bodies) and D how far breaks have moved the unloaded places. With C = G G' the modes of G^-1 L G^-T give d, f and the
// impulses at any time. For one place with m = 1/L, k = 1/C, w = m a this is
//   peak, if nothing breaks      F = w + sqrt(w^2 + k m v^2)        (a weight laid down: 2 w)
//   speed when a joint fails     v'^2 = v^2 - (F^2 - 2 w F)/(k m).
// A place whose force comes to zero has let go. One that a break has left behind is met again when d reaches D and what
// the other forces move it by.
// Coordinates that hold both ways may be `bound` behind the places: springs that the push moves and that never let go
// (the nodes of what is struck, by modes), with d their displacement from rest.
// Source: free vibration by modes (Clough and Penzien, Dynamics of Structures, ch. 12); a weight dropped on an elastic
// beam (Timoshenko and Young, Vibration Problems in Engineering).
#include <Eigen/Core>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace topple::structure {

class Impact {
 public:
  /// Mobility symmetric positive semidefinite with a positive diagonal, 1/kg; compliance symmetric positive definite,
  /// m/N; closing speeds, m/s, and accelerations, m/s2, one for each place, positive into each other. Throws
  /// std::invalid_argument when sizes differ, there is no place, or a matrix is not of its kind. The last `bound` are
  /// no places but coordinates that hold both ways.
  Impact(Eigen::MatrixXd mobility, Eigen::MatrixXd compliance, Eigen::VectorXd closing_speed,
         Eigen::VectorXd acceleration, int bound = 0);

  enum class Stop {
    parted,  ///< nothing touches any more, nor will
    failed,  ///< `utilisation` has reached 1
    held,    ///< the places that touch never let go (a weight holds them together): a full swing has been seen
    deep     ///< a place is pressed in as far as it may be
  };
  /// Utilisation of what bears the forces (one for each place, N, not negative): convex in them.
  using Utilisation = std::function<double(const Eigen::VectorXd& force)>;
  /// Goes on from where it is. Without `utilisation` nothing fails. `deepest`: m, of each place from where it touches.
  Stop push(const Utilisation& utilisation = {}, double deepest = std::numeric_limits<double>::infinity());

  /// The same, of forces and of their rates, N/s: of places that touch, and of what is bound.
  using Watch = std::function<double(const Eigen::VectorXd& force, const Eigen::VectorXd& rate)>;
  Stop push_watched(const Watch& watch, double deepest = std::numeric_limits<double>::infinity());

  /// Something behind the places begins to turn plastically, or unloads: compliance from now on, of all, and by how
  /// much each unloaded place, and what is bound, has moved. How long the push lasts at most is told by how it gives
  /// way elastically.
  void yield(Eigen::MatrixXd compliance, const Eigen::VectorXd& shift);
  /// After a break: mobility and compliance from now on, and by how much each unloaded place has moved (positive away
  /// from what pushes it). Speeds stay. The same errors as the constructor's.
  void change(Eigen::MatrixXd mobility, Eigen::MatrixXd compliance, const Eigen::VectorXd& shift);
  /// After a break, with places alone: coordinates that hold both ways are bound behind them, as they are and move
  /// now. Mobility and compliance of all.
  void bind(Eigen::MatrixXd mobility, Eigen::MatrixXd compliance, const Eigen::VectorXd& coordinates,
            const Eigen::VectorXd& rates);
  /// Only these places from now on, in this order; what was bound is let go.
  void keep(const std::vector<int>& places);
  [[nodiscard]] bool touches(std::size_t place) const { return state_[place] == Touch::touching; }
  /// It touches, or a break has moved it ahead of what will meet it again.
  [[nodiscard]] bool may_touch(std::size_t place) const { return state_[place] != Touch::gone; }
  /// Whether any place touches or may still come to.
  [[nodiscard]] bool goes_on() const;

  // Of places and, behind them, of what is bound.
  [[nodiscard]] Eigen::VectorXd force() const;                               ///< now, N
  [[nodiscard]] Eigen::VectorXd force_rate() const;                          ///< now, N/s; 0 of what does not touch
  [[nodiscard]] const Eigen::VectorXd& peak_force() const { return peak_; }  ///< so far, N; of what is bound either way
  [[nodiscard]] const Eigen::VectorXd& impulse() const { return impulse_; }  ///< of each place since taken last, N s
  /// Hands them out: from now on they are counted anew.
  [[nodiscard]] Eigen::VectorXd extract_impulse() {
    return std::exchange(impulse_, Eigen::VectorXd::Zero(impulse_.size()));
  }
  [[nodiscard]] const Eigen::VectorXd& closing_speed() const { return speed_; }  ///< now, m/s
  [[nodiscard]] const Eigen::VectorXd& indentation() const { return depth_; }    ///< now, m
  [[nodiscard]] double time() const { return time_; }                            ///< since first touch, s
  /// Elastic energy under the contacts now, J.
  [[nodiscard]] double stored() const;
  /// Of the frequencies of its modes, those without any aside.
  [[nodiscard]] double fastest_over_slowest() const;

 private:
  /// Behind: a break moved it ahead of what pushed it.
  enum class Touch { touching, behind, gone };
  struct Modes;
  struct Sample;
  [[nodiscard]] Modes modes() const;
  void check() const;
  void advance(const Modes& modes, double time);
  bool fly_to_next_touch();
  Stop swing(const Watch& watch, bool by_rates, double deepest, bool& changed);
  Stop push(const Watch& watch, bool by_rates, double deepest);
  [[nodiscard]] double largest_overlap(const Modes& modes, double time, Eigen::Index* which) const;
  void note_peaks(const Modes& modes, const Sample& from, const Sample& to);
  void part(const Modes& modes, double at, Eigen::Index touching);
  [[nodiscard]] bool any(Touch state) const;  ///< of places
  [[nodiscard]] Eigen::Index place_count() const { return depth_.size() - bound_; }
  [[nodiscard]] double longest_swing(const Modes& modes) const;

  Eigen::MatrixXd mobility_, compliance_;
  Eigen::VectorXd elastic_;  ///< compliance of each by itself, without what yields
  Eigen::VectorXd depth_, speed_, acceleration_, unloaded_, impulse_, peak_;
  std::vector<Touch> state_;
  Eigen::Index bound_ = 0;
  double time_ = 0;
};

}  // namespace topple::structure
