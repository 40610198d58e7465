#pragma once
// One body that pushes into an elastic structure at one place: the law of impact, in closed form and without a time
// step.
//
// Along the normal n (into the structure) the body has an effective mass m, an approach speed v and a weight w = m g.n.
// The place gives way by F times its compliance. Energy decides:
//   peak, if nothing breaks      F = w + sqrt(w^2 + m v^2 / compliance)       (w = F at rest; h = 0 gives 2 W)
//   speed when a joint fails at F_c   v'^2 = v^2 - (F_c^2 - 2 w F_c) compliance / m
// After a break the place has another compliance and, unloaded, lies further in by the shift D; the pushing goes on
// with F = max(0, (d - D) / compliance').
//
// Source: energy of a mass on a spring (weight dropped on a light elastic beam, Timoshenko and Young, Vibration
// Problems in Engineering); the share of the structure's own mass is that of a plastic first contact with its Rayleigh
// mass.

namespace topple::structure {

class Indentation {
 public:
  /// `structure_mass`: Rayleigh mass M of what is hit, in its static shape; the push goes on with m + M at v m / (m +
  /// M).
  Indentation(double body_mass, double approach_speed, double weight, double structure_mass);

  enum class Stop {
    stood,   ///< the body came to a stop; the peak force was borne
    failed,  ///< the force reached `failure_force` while the body was still moving
    missed   ///< the place moved away and the body's weight turns it round before it catches up, or it gives way by
             ///< more than 3 m, which is no elastic push: the body goes on with its speed
  };
  /// Pushes from where it is until one of these. `failure_force` may be infinite. A force that is above it already
  /// fails at once.
  Stop push(double compliance, double failure_force);
  /// The unloaded place moved by `by` along n (a break released it).
  void shift(double by) { unloaded_ += by; }

  [[nodiscard]] double speed() const { return speed_; }  ///< along n, now
  [[nodiscard]] double force() const { return force_; }
  [[nodiscard]] double peak_force() const { return peak_force_; }
  [[nodiscard]] double indentation() const { return depth_; }
  [[nodiscard]] double pushing_mass() const { return mass_; }
  /// Elastic energy under the contact when the place gives way by `compliance`, as deep as the body is now.
  [[nodiscard]] double stored(double compliance) const;
  /// Speed at which the stored energy would throw the body back from where it stopped (0 when its weight holds it
  /// down).
  [[nodiscard]] double elastic_rebound_speed() const;
  /// Lost at the first contact, m M / (m + M) v^2 / 2.
  [[nodiscard]] double lost_at_contact() const { return lost_at_contact_; }

 private:
  double mass_, weight_, speed_;
  double lost_at_contact_;
  double depth_ = 0, unloaded_ = 0, compliance_ = 0, force_ = 0, peak_force_ = 0;
};

}  // namespace topple::structure
