#pragma once
// Capacities of joints changed after a model was read: by a person in a viewer, by a script, or by the model's own key
// `joint_changes`. What was changed can be written into a copy of the model's file.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

/// Numbers in the model's units: forces and moments, of panels' edges per length of edge.
struct JointChange {
  std::string joints;                             ///< a group, a joint's name or pattern, or "*"
  std::optional<double> strength;                 ///< multiplies the capacities; 1: as in the model
  std::array<std::optional<double>, 7> capacity;  ///< per Sense, before it is multiplied by the strength
  /// Whether it changes nothing.
  [[nodiscard]] bool empty() const;
};

/// Joints that a change means: those of a group's members and panels, or those whose names match. Throws InputError
/// when there are none.
[[nodiscard]] std::vector<JointId> joints_of(const Building& building, const NameIndex& names,
                                             const std::string& selector);

/// Changes laid over a building, in their order: later ones replace what earlier ones say of the same thing.
class JointTuning {
 public:
  /// The building as read; it must outlive this and keep its joints.
  explicit JointTuning(const Building& building);

  /// Returns the joints that it means. Throws InputError for a selector that means none, and for a value that is not
  /// above 0.
  std::vector<JointId> apply(const JointChange& change);
  /// Back to the model's.
  void reset();

  /// As it is now, the strength included, SI.
  [[nodiscard]] JointCapacity capacity(JointId joint) const;
  /// The factor on the capacities as it is now.
  [[nodiscard]] double strength(JointId joint) const { return strength_[static_cast<std::size_t>(joint.index)]; }
  /// The shortest list that says the same.
  [[nodiscard]] const std::vector<JointChange>& changes() const { return changes_; }

 private:
  void keep(const JointChange& change);
  const Building& building_;
  NameIndex names_;
  std::vector<JointCapacity> base_;  ///< before the strength
  std::vector<double> strength_;
  std::vector<JointChange> changes_;
};

/// Factor from a capacity in the model's units to SI.
[[nodiscard]] double capacity_unit(const Building& building, JointId joint, Sense sense);

/// The text of a JSON model with these changes as its `joint_changes`, after those that it has; a model of another form
/// becomes JSON. Throws InputError as convert_model() does.
[[nodiscard]] std::string model_with_changes(const std::filesystem::path& model,
                                             const std::vector<JointChange>& changes);

}  // namespace topple::structure
