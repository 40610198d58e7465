#pragma once
// Energies of the bodies over a step: what gravity did on them, what contacts took from them, and which contacts were
// hard enough to break something.
#include <span>
#include <vector>

#include "simulation/accounts/running_sums.h"
#include "simulation/debris/debris.h"
#include "simulation/impact/contact_record.h"

namespace topple::structure {

class BodyAccount {
 public:
  /// All must outlive it.
  BodyAccount(const Scene& scene, RunningSums& sums, Debris& debris) : scene_(scene), sums_(sums), debris_(debris) {}

  /// From where the weight of each body works in this step.
  void start_step();
  /// The impacts of the step are over, and the motion begins.
  void start_motion();
  /// The collision world measures what each contact took from the bodies, in the same reading of velocities.
  void count_contacts();
  /// What the step's motion was of each body.
  void count_bodies();
  /// Brings the ledger's entries that are states, not sums, up to date.
  void bring_ledger_up_to_date();
  /// Contacts of the last motion that are felt.
  [[nodiscard]] const std::vector<ContactRecord>& contacts() const { return contacts_; }

  /// Contacts are those of the step that runs.
  template <class Archive>
  void serialize(Archive&) {
    [[maybe_unused]] auto& [scene, sums, debris, contacts] = *this;
  }

 private:
  void count(BodyMotion& one);

  const Scene& scene_;
  RunningSums& sums_;
  Debris& debris_;
  std::vector<ContactRecord> contacts_;
};

}  // namespace topple::structure
