#pragma once
// Bodies that touch or hang together, taken through one step in sub-steps: collide once, then in each sub-step
// velocities by gravity and the last impulses, contacts that stop what closes, friction; and positions by these
// velocities and by damped springs that push overlaps apart, which are neither speed nor force (Macklin et al., "Small
// steps in physics simulation", 2019; Catto, "Solver2D", 2024; the split of velocities is that of Guendelman et al.,
// "Nonconvex rigid bodies with stacking", 2003).
//
// Velocities inside are those of the middle of a sub-step, so that free flight is exact. Forces are the sums over
// sub-steps of what was applied: they balance weight and momentum to rounding.
#include <cstdint>
#include <span>
#include <vector>

#include "solver/cable_row.h"
#include "solver/contact_packing.h"
#include "solver/hinge_rows.h"
#include "solver/parallel_region.h"
#include "solver/solver_body.h"
#include "solver/solver_settings.h"

namespace topple::collision {

class Equilibrium;
struct RestContact;

class StepSolver {
 public:
  /// Shares its loops in `region`, when that is open.
  StepSolver(const SolverSettings& settings, ParallelRegion& region) : settings_(settings), region_(region) {}

  void clear();
  /// Numbers from 1.
  int add(const SolverBody& body);
  /// Into how many domains a heap of so many contacts is cut: with more than one, bodies are added in their order along
  /// it, and `end_of_order` called after the last.
  [[nodiscard]] int domains_of(std::size_t contacts) const;
  void end_of_order() { ordered_ = static_cast<int>(body_count()); }
  /// So many more, to be filled in.
  [[nodiscard]] std::span<SolverContact> add_contacts(std::size_t count) {
    contacts_.resize(contacts_.size() + count);
    return std::span(contacts_).last(count);
  }
  void add(HingeRows* hinge) { hinges_.push_back(hinge); }
  void add(CableRow* cable) { cables_.push_back(cable); }
  /// `dt` in `substeps` parts.
  void run(double dt, int substeps);

  /// Whether the bodies can stay where they are: contacts, hinges and cables then hold the forces that keep them there,
  /// as those of a step `dt` long; nothing has moved. `sizes`: of each body (by its number), m. Those that `moves`
  /// marks (by number) are not asked to rest; bodies that no forces hold are left out, when they are few, and marked
  /// there as well: the others rest under the forces that these ended the last step with.
  [[nodiscard]] bool rest(double dt, const Vec3& gravity, std::span<const double> sizes, std::vector<char>& moves);

  [[nodiscard]] const SolverBody& body(int index) const { return bodies_[static_cast<std::size_t>(index)]; }
  [[nodiscard]] std::span<const SolverContact> contacts() const { return contacts_; }
  [[nodiscard]] std::span<SolverContact> contacts() { return contacts_; }
  [[nodiscard]] std::size_t body_count() const { return bodies_.size() - 1; }

 private:
  struct Softness {
    double bias_rate, mass_scale, impulse_scale;
  };
  [[nodiscard]] static Softness softness(double frequency, double damping, double h);
  void prepare(SolverContact& contact, double dt);
  void shift_by_rolling(SolverContact& contact, double dt) const;
  void prepare_points(SolverContact& contact, ContactPack& pack, double h);
  void prepare_friction(SolverContact& contact, ContactPack& pack, double h);
  void scale_bodies(double dt);
  void sub_step(int number);
  void begin_sub_step(int number);
  bool each_pack(ContactKernels::Pass pass, const SubStep& step) { return each_pack(pass, step, velocity_); }
  bool each_pack(ContactKernels::Pass pass, const SubStep& step, std::vector<Motion6>& velocity);
  [[nodiscard]] ContactPack& pack_of(const SolverContact& contact) {
    return packing_.packs()[static_cast<std::size_t>(contact.pack)];
  }
  /// Calls work(number), and work(contact), side by side.
  template <class Work>
  void each_body(const Work& work);
  template <class Begin, class Work>
  void each_contact(const Begin& begin, const Work& work);
  [[nodiscard]] double energy_of_changes();
  void stop_closing(SubStep step);
  void relax(SubStep step);
  void move(SubStep step);
  void repeat(ContactKernels::Pass pass, SubStep step, std::vector<Motion6>& velocity, int fewest);
  struct RestPoint {
    Vec3 place;
    double start = 0;  ///< N: the normal force that the step ended with
    int point = 0;     ///< of the manifold
  };
  [[nodiscard]] std::vector<RestPoint> rest_points(const SolverContact& contact) const;
  void add_to(Equilibrium& equilibrium, const SolverContact& contact) const;
  void store_rest(const RestContact& found, SolverContact& contact, double dt) const;
  /// Only what touches may bear.
  [[nodiscard]] bool bears_at_rest(const ManifoldPoint& point) const { return point.separation <= settings_.touching; }
  void find_friction_centre(SolverContact& contact) const;
  void store_contact(SolverContact& contact, double dt);
  void unscale_bodies(double dt);
  [[nodiscard]] Vec3 place_moves(const SolverContact& contact) const;
  void keep_angular_momentum();

  const SolverSettings& settings_;
  ParallelRegion& region_;
  double h_ = 0;
  int ordered_ = 0;  ///< bodies that were added in order
  std::vector<SolverBody> bodies_;
  std::vector<SolverContact> contacts_;
  std::vector<HingeRows*> hinges_;
  std::vector<CableRow*> cables_;

  // Hot.
  std::vector<Motion6> velocity_, displacement_, kick_, pushed_, begun_;
  std::vector<Motion6> moving_, ignored_;  ///< velocities by which bodies move, and what joints changed of those
  ContactPacking packing_;
  std::vector<PackWide> changes_, ways_, energies_;  ///< of points, where passes are repeated
  std::vector<double> colour_energies_;
  std::vector<unsigned char> moved_, moves_;  ///< of bodies, where passes are repeated
};

}  // namespace topple::collision
