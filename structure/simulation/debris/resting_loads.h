#pragma once
// What lies on the standing frame loads it. At rest: the contact forces of bodies on each part, smoothed over a tenth
// of a second (impacts are the business of the law of impact), laid on only when they differ by more than a dead band
// from what is already there. The band is a share of what the part can still bear. What moves bears them as they are,
// in each substep.
#include <map>
#include <span>

#include "simulation/debris/obstacles.h"
#include "simulation/impact/contact_record.h"

namespace topple::structure {

class RestingLoads {
 public:
  /// Reads the contacts of the last collision step. `awake` tells whether a body moves (contacts of sleeping ones
  /// stay); it is asked in order of id.
  template <class Awake>
  void read(std::span<const ContactRecord> contacts, const Obstacles& obstacles, double dt, const Awake& awake);
  /// For a substep of `dt`: what moves bears the mean forces of these contacts, and of sleeping bodies those that they
  /// rest with. `awake` as for read().
  template <class Awake>
  void act(std::span<const collision::Contact> contacts, const Obstacles& obstacles, double dt, StandingFrame& frame,
           const Awake& awake);
  /// Hands to the frame what changed beyond the band; returns how many changes the band ignored. `at_once`: what has
  /// changed by more than any band within the last step is not averaged first; it sets the frame in motion.
  template <class Weight>
  std::uint64_t lay(StandingFrame& frame, std::span<const double> strength_factors, bool at_once,
                    const Weight& weight_of);
  /// The parts stand no more: their loads are dropped. Returns the bodies that lay on them.
  std::vector<collision::BodyId> drop(std::span<const Part> parts, StandingFrame& frame);
  /// The bodies that lie on a part.
  [[nodiscard]] std::vector<collision::BodyId> on(Part part) const;
  /// What lies on a part for good.
  struct Kept {
    Part on;
    Vec3 force, point;
  };
  /// The body is gone. `keep`: its weight stays where it lay, and is told.
  std::vector<Kept> forget(collision::BodyId body, StandingFrame& frame, bool keep);
  /// A weight that stays.
  void lay_for_good(const Kept& weight, StandingFrame& frame) {
    frame.set_contact_load({next_key_++, {weight.on.member, weight.on.panel, weight.point}, weight.force});
  }
  [[nodiscard]] std::size_t size() const { return resting_.size(); }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [resting, next_key] = *this;
    archive(resting, next_key);
  }

 private:
  struct Key {
    std::int64_t body;
    Part part;
    auto operator<=>(const Key&) const = default;
  };
  struct Resting {
    std::int64_t load_key = 0;
    Vec3 force = Vec3::Zero(), point = Vec3::Zero();  ///< smoothed
    Vec3 applied = Vec3::Zero(), applied_at = Vec3::Zero();
    Vec3 seen_force = Vec3::Zero(), seen_point = Vec3::Zero();
    double seen_weight = 0;
    bool laid = false;
  };
  template <class Archive>
  friend void serialize(Archive& archive, Key& key) {
    auto& [body, part] = key;
    archive(body, part);
  }
  template <class Archive>
  friend void serialize(Archive& archive, Resting& one) {
    auto& [load_key, force, point, applied, applied_at, seen_force, seen_point, seen_weight, laid] = one;
    archive(load_key, force, point, applied, applied_at, seen_force, seen_point, seen_weight, laid);
  }
  [[nodiscard]] static bool moves(const StandingFrame& frame, Part part) {
    return frame.moves({part.member, part.panel});
  }
  template <class Contacts>
  void see(const Contacts& contacts, const Obstacles& obstacles, double dt);
  void forget_seen();
  void gather(collision::BodyId body, Part part, const Vec3& impulse, const Vec3& point, double dt);
  void act(const Key& key, Resting& resting, StandingFrame& frame);
  static void skip_average(Resting& resting, double weight);
  static void smooth(Resting& resting, double dt);
  static double band(const StandingFrame& frame, std::span<const double> strength_factors, Part part, double weight);
  bool lay_one(const Key& key, Resting& resting, StandingFrame& frame, std::span<const double> strength_factors,
               double weight);

  std::map<Key, Resting> resting_;
  std::int64_t next_key_ = 0;
};

/// All that bodies do to what stands now, in place of what was seen before.
template <class Contacts>
void RestingLoads::see(const Contacts& contacts, const Obstacles& obstacles, double dt) {
  forget_seen();
  for (const auto& contact : contacts)
    if (contact.other.kind == collision::Touched::Kind::obstacle)
      gather(contact.body, obstacles.part_of(contact.other.obstacle), contact.impulse, contact.point, dt);
}

template <class Awake>
void RestingLoads::read(std::span<const ContactRecord> contacts, const Obstacles& obstacles, double dt,
                        const Awake& awake) {
  see(contacts, obstacles, dt);
  for (auto& [key, resting] : resting_)
    if (awake(collision::BodyId{key.body})) smooth(resting, dt);
}

template <class Awake>
void RestingLoads::act(std::span<const collision::Contact> contacts, const Obstacles& obstacles, double dt,
                       StandingFrame& frame, const Awake& awake) {
  see(contacts, obstacles, dt);
  for (auto& [key, resting] : resting_)
    if (moves(frame, key.part) && awake(collision::BodyId{key.body})) act(key, resting, frame);
}

template <class Weight>
std::uint64_t RestingLoads::lay(StandingFrame& frame, std::span<const double> strength_factors, bool at_once,
                                const Weight& weight_of) {
  std::uint64_t ignored = 0;
  for (auto entry = resting_.begin(); entry != resting_.end();) {
    auto& [key, resting] = *entry;
    const double weight = weight_of(collision::BodyId{key.body});
    if (at_once) skip_average(resting, weight);
    if (lay_one(key, resting, frame, strength_factors, weight)) {
      ++entry;
    } else if (resting.seen_weight == 0 && !resting.laid) {
      entry = resting_.erase(entry);
    } else {
      if (resting.force != resting.applied) ++ignored;
      ++entry;
    }
  }
  return ignored;
}

}  // namespace topple::structure
