#pragma once
// Momentum that the impacts of a step gave to what they broke off, handed over when that part becomes a body.
#include <algorithm>
#include <vector>

#include "simulation/accounts/running_sums.h"
#include "simulation/debris/debris.h"
#include "simulation/debris/momentum.h"

namespace topple::structure {

struct ReleaseImpulse {
  Part part;
  Vec3 impulse, point;  ///< N s, where; global axes
  double speed = 0;     ///< of the contact place along the impulse, m/s: no part is thrown faster
  collision::BodyId by;
};

class ReleaseImpulses {
 public:
  void clear() { all_.clear(); }
  void add(const ReleaseImpulse& given) { all_.push_back(given); }

  /// The first that struck this body off; null: none did.
  [[nodiscard]] const ReleaseImpulse* first_on(const Body& one) const;
  /// Bodies that go on through what they broke off.
  [[nodiscard]] std::vector<collision::BodyId> breakers_of(const Body& one, const Bodies& bodies) const;
  /// A part that an impact broke off takes the momentum of the share of the structure that moved with the body.
  void apply(const Body& one, Vec3& velocity, Vec3& spin, Ledger& ledger) const;
  /// What apply() gave to a body whose centre is at `centre`.
  void add_to(Momentum& sum, const Body& one, const Vec3& centre) const;

  /// All are of the step that runs.
  template <class Archive>
  void serialize(Archive&) {
    [[maybe_unused]] auto& [all] = *this;
  }

 private:
  [[nodiscard]] static bool struck(const ReleaseImpulse& given, const Body& one);

  std::vector<ReleaseImpulse> all_;
};

}  // namespace topple::structure
