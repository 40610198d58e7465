#pragma once
// What has changed of a system since a moment, as K now = K then + the sum of B D B' over places: a place is an element
// or a node, B the motions that it has (eigen/element_modes.h), D what is there more than then. Every element is
// remembered before it changes; what never changed costs nothing.
//
// Parts that left (dropped nodes) keep the stiffness they had inside, so that nothing inside them needs correcting;
// only what joined them to the rest is taken away, and one node of each is held.
#include <Eigen/Core>
#include <map>
#include <span>
#include <vector>

#include "assembly/frame_system.h"
#include "eigen/element_modes.h"

namespace topple::solver {

class SystemChanges {
 public:
  /// From now on. The system must outlive this.
  explicit SystemChanges(const FrameSystem& system);

  // To be called before the system changes.
  void remember_beam(int beam);
  void remember_shell(int shell);
  /// An element that is no beam gets another stiffness, not only none or its own: a patch, or a shell whose stiffness
  /// is given. False: it was remembered as a shell that comes and goes, and this change is none of a place's.
  [[nodiscard]] bool remember_plate(std::size_t element);
  void drop_node(int node);
  /// These nodes' supports or elements change, or have changed.
  void touch(std::span<const int> nodes) { touched_.insert(touched_.end(), nodes.begin(), nodes.end()); }

  enum class Kind { beam, shell, plate, node, ground };
  struct Place {
    Kind kind;
    int index;
    auto operator<=>(const Place&) const = default;
    template <class Archive>
    void serialize(Archive& archive) {
      auto& [of_kind, number] = *this;
      archive(of_kind, number);
    }
  };
  struct Change {
    Eigen::MatrixXd D;
    bool extracted = false;  ///< by extract_changed(), as it is
    [[nodiscard]] bool active() const { return (D.array() != 0).any(); }
    template <class Archive>
    void serialize(Archive& archive) {
      auto& [more, is_extracted] = *this;
      archive(more, is_extracted);
    }
  };
  /// Compares the system as it is now with what was remembered. False: something changed that is none of a place's.
  [[nodiscard]] bool compare();
  /// Of every place that has or had one, by the last compare().
  [[nodiscard]] const std::map<Place, Change>& all() const { return changes_; }
  [[nodiscard]] bool extracted(Place place) const { return changes_.at(place).extracted; }
  /// D of the place where it is another than when it was last extracted, else null.
  [[nodiscard]] const Eigen::MatrixXd* extract_changed(Place place);
  [[nodiscard]] ElementModes modes(Place place) const;
  /// A beam's place with a D of zero, extracted. Returns it.
  Place add_unchanged(int beam, Eigen::Index columns);
  /// A place whose D has become zero again: no need to look at it until it changes again.
  void forget(Place place);

  [[nodiscard]] bool any_dropped() const { return !dropped_.empty(); }
  /// Sets what dropped nodes have in a vector of the equations to zero.
  void clear_dropped(Eigen::VectorXd& x) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [system, beam_before, shell_before, shell_modes, plate_before, node_before, diaphragm_node_before, dropped,
           stale_beams, touched, dropped_more, changes] = *this;  // the system is its owner's
    archive(beam_before, shell_before, shell_modes, plate_before, node_before, diaphragm_node_before, dropped,
            stale_beams, touched, dropped_more, changes);
  }

 private:
  void compare_beam(int beam, const BeamModeMatrix& before);
  void compare_beams();
  void compare_shells();
  void compare_plates();
  [[nodiscard]] bool compare_nodes();
  void hold_dropped_parts();
  void set(Place place, const Eigen::Ref<const Eigen::MatrixXd>& D);
  [[nodiscard]] std::vector<int> equations_of(std::size_t element) const;
  [[nodiscard]] bool inside_dropped(std::span<const int> nodes) const;
  void find_shell_modes(int shell);

  const FrameSystem& system_;
  std::map<int, BeamModeMatrix> beam_before_;
  std::map<int, char> shell_before_;
  std::map<int, ElementModes> shell_modes_;
  std::map<std::size_t, Eigen::MatrixXd> plate_before_;
  std::map<int, Eigen::MatrixXd> node_before_;  ///< own stiffness, of nodes that have any
  std::map<int, Mat6> diaphragm_node_before_;   ///< the same, of nodes in diaphragms
  std::vector<int> dropped_;
  // Since the last compare(). When parts left, everything is looked at again.
  std::vector<int> stale_beams_, touched_;
  bool dropped_more_ = false;
  std::map<Place, Change> changes_;
};

}  // namespace topple::solver
