#pragma once
// What contacts do to panels of debris while these land: the impulse since two parts met, over as many steps as their
// impact takes, so that no step's length decides what it breaks.
#include <map>
#include <span>
#include <vector>

#include "simulation/impact/contact_record.h"

namespace topple::structure {

class LandingImpulses {
 public:
  /// The contacts of a step of `dt` (s), each with its impulse since the two met, for ImpactSettings::landing_time;
  /// then it is flagged persistent, and has that of the last such time.
  [[nodiscard]] std::vector<ContactRecord> read(std::span<const ContactRecord> contacts, double dt);

  /// The impulses on this part of a body have broken what they could: what comes yet counts alone.
  void spend(collision::BodyId body, std::int64_t part);

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [landings] = *this;
    archive(landings);
  }

 private:
  static constexpr double apart = -1;
  struct Landing {
    Vec3 impulse = Vec3::Zero();  ///< N s, as in the record
    double lasted = apart;        ///< s, at least, that they have touched
    bool touches = false;
  };
  /// What touches is of the step that runs.
  template <class Archive>
  friend void serialize(Archive& archive, Landing& one) {
    auto& [impulse, lasted, touches] = one;
    archive(impulse, lasted);
  }

  std::map<ContactKey, Landing> landings_;
};

}  // namespace topple::structure
