#pragma once
// What lies on debris, or debris on what it lies on, presses on its joints: the forces of contacts that last, averaged
// over a stated time, whatever the length of the step. Impacts are the business of their law.
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "simulation/impact/contact_record.h"
#include "simulation/impact/free_segment.h"

namespace topple::structure {

/// Where a body's undeformed parts are now.
struct BodyPlace {
  collision::Pose pose;
  Vec3 rest_centre = Vec3::Zero();
};

class PressingForces {
 public:
  /// Reads the contacts of the last collision step. `place_of` gives nothing for bodies whose joints are not asked.
  void read(std::span<const ContactRecord> contacts, double dt,
            const std::function<std::optional<BodyPlace>(collision::BodyId)>& place_of);
  /// On a body, in the axes of the undeformed building, in a fixed order.
  [[nodiscard]] std::vector<FreePush> on(collision::BodyId body, const Building& building) const;
  /// Sum of their sizes, N.
  [[nodiscard]] double size(collision::BodyId body) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [pressing] = *this;
    archive(pressing);
  }

 private:
  static constexpr double apart = -1;
  struct Pressing {
    Vec3 force = Vec3::Zero(), point = Vec3::Zero();  ///< axes of the undeformed building
    Vec3 seen_force = Vec3::Zero(), seen_point = Vec3::Zero();
    double seen_weight = 0;
    double lasted = apart;  ///< s, at least, that they have touched
    bool touches = false;
  };
  /// What is seen is of the step that runs.
  template <class Archive>
  friend void serialize(Archive& archive, Pressing& one) {
    auto& [force, point, seen_force, seen_point, seen_weight, lasted, touches] = one;
    archive(force, point, lasted);
  }
  void gather(const ContactKey& key, const BodyPlace& place, const Vec3& force, const Vec3& point);

  std::map<ContactKey, Pressing> pressing_;
};

}  // namespace topple::structure
