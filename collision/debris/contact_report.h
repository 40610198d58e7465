#pragma once
// The contacts of a step as the world reports them: places, impulses, and the work that was lost. Together with hinges
// and cables that is all the energy which the step took from the bodies.
#include <span>
#include <vector>

#include "debris/solved_islands.h"

namespace topple::collision {

/// Contacts of a step, as World::contacts() gives them at its end.
class ContactReport {
 public:
  /// Shares its loops in `region`, when that is open.
  ContactReport(const DebrisScene& scene, const SolvedIslands& solved, ParallelRegion& region)
      : scene_(scene), solved_(solved), region_(region) {}

  void clear() { contacts_.clear(); }
  /// Adds those that the solver holds, where things were when the step began; but those of bodies that are left out, by
  /// their numbers in the solver.
  void add(std::span<SolverContact> solved, double dt, std::span<const char> left_out = {});
  /// Once the bodies have moved on by `dt`.
  void account_work(std::span<Island* const> islands, double dt);
  /// In order of ids and tags, one for each pair of parts.
  void merge_parts();
  /// Of what has gone.
  void forget(Touched::Kind kind, std::int64_t id);
  /// Contact::persistent, of contacts that are foreseen.
  void mark_persistent(std::vector<Contact>& found) const;
  [[nodiscard]] const std::vector<Contact>& all() const { return contacts_; }
  /// Of the same, in a world that is a copy.
  void copy(const ContactReport& of) { contacts_ = of.contacts_; }
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [scene, solved, region, contacts] = *this;
    archive(contacts);
  }

 private:
  [[nodiscard]] bool touches(const SolverContact& solved) const;
  void fill(const SolverContact& solved, double dt, Contact& contact) const;
  void locate(const SolverContact& solved, double dt, Contact& contact) const;

  const DebrisScene& scene_;
  const SolvedIslands& solved_;
  ParallelRegion& region_;
  std::vector<Contact> contacts_;
};

}  // namespace topple::collision
