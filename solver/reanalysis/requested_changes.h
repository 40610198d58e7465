#pragma once
// Changes that were requested and not applied yet: what each part is to be in the next answer, and which parts differ
// from that now. Numbers are those of the model, and exist.
#include <array>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "elements/shell.h"
#include "topple/solver/frame_model.h"

namespace topple::solver {

/// What a beam is to be.
struct BeamTarget {
  std::array<Vec6, 2> end_stiffness;
  bool removed = false;
  double factor = 1;
  double density = 0;  ///< of a frame that moves
  std::vector<BeamLoad> loads;
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [stiffness, is_removed, on_moduli, of_mass, of_weight] = *this;
    archive(stiffness, is_removed, on_moduli, of_mass, of_weight);
  }
};

class RequestedChanges {
 public:
  /// Nothing is to change.
  explicit RequestedChanges(const FrameModel& model);

  // What is as it was to be already is no change.
  void set_end_stiffness(std::size_t beam, std::size_t end, const Vec6& stiffness);
  void set_beam_removed(std::size_t beam, bool removed);
  void set_beam_factor(std::size_t beam, double factor);
  void set_beam_density(std::size_t beam, double density);
  void set_beam_loads(std::size_t beam, std::vector<BeamLoad> loads);
  void set_shell_removed(std::size_t shell, bool removed);
  void set_shell_stiffness(int shell, const Mat24& stiffness) { shell_stiffness_[shell] = stiffness; }
  void set_patch_stiffness(int patch, Eigen::MatrixXd stiffness) { patch_stiffness_[patch] = std::move(stiffness); }
  /// Where the frame moves.
  void set_patch_mass(int patch, Eigen::MatrixXd mass) { patch_mass_[patch] = std::move(mass); }
  void set_support(int support, const Vec6& stiffness) { supports_.emplace_back(support, stiffness); }
  void drop_node(int node) { dropped_nodes_.push_back(node); }
  /// What becomes of it goes by something else that changes: a node of it leaves.
  void mark_beam(int beam) { beams_.push_back(beam); }
  void mark_shell(int shell) { shells_.push_back(shell); }

  [[nodiscard]] bool none() const;
  /// All were carried out.
  void clear();

  [[nodiscard]] const BeamTarget& beam(std::size_t beam) const { return targets_[beam]; }
  [[nodiscard]] bool shell_removed(std::size_t shell) const { return shell_removed_[shell] != 0; }
  /// In the order in which they were asked for; some may come twice.
  [[nodiscard]] std::span<const int> beams() const { return beams_; }
  /// Ascending, each once.
  [[nodiscard]] std::span<const int> sorted_beams();
  [[nodiscard]] std::span<const int> shells() const { return shells_; }
  [[nodiscard]] std::span<const int> dropped_nodes() const { return dropped_nodes_; }
  [[nodiscard]] std::span<const std::pair<int, Vec6>> supports() const { return supports_; }
  [[nodiscard]] const std::map<int, Mat24>& shell_stiffness() const { return shell_stiffness_; }
  [[nodiscard]] const std::map<int, Eigen::MatrixXd>& patch_stiffness() const { return patch_stiffness_; }
  [[nodiscard]] const std::map<int, Eigen::MatrixXd>& patch_mass() const { return patch_mass_; }
  /// What it has in the model, or is to have. Null: a shell whose stiffness is its own.
  [[nodiscard]] const Mat24* stiffness_of_shell(const FrameModel& model, int shell) const;
  [[nodiscard]] const Eigen::MatrixXd& stiffness_of_patch(const FrameModel& model, int patch) const;
  [[nodiscard]] const Eigen::MatrixXd& mass_of_patch(const FrameModel& model, int patch) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [targets, shell_removed, beams, shells, dropped_nodes, supports, shell_stiffness, patch_stiffness,
           patch_mass] = *this;
    archive(targets, shell_removed, beams, shells, dropped_nodes, supports, shell_stiffness, patch_stiffness,
            patch_mass);
  }

 private:
  template <class Value>
  void set(std::size_t beam, Value& target, const Value& value);

  std::vector<BeamTarget> targets_;
  std::vector<char> shell_removed_;
  std::vector<int> beams_, shells_, dropped_nodes_;
  std::vector<std::pair<int, Vec6>> supports_;
  std::map<int, Mat24> shell_stiffness_;
  std::map<int, Eigen::MatrixXd> patch_stiffness_, patch_mass_;
};

}  // namespace topple::solver
