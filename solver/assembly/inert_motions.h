#pragma once
// Directions in which nodes of a frame move without straining anything, which are held at zero.
#include <array>
#include <span>
#include <vector>

#include "assembly/dof_map.h"
#include "topple/solver/frame_model.h"

namespace topple::solver {

class InertMotions {
 public:
  enum class Kind : std::size_t { translation, rotation };
  static constexpr std::array<Kind, 2> kinds{Kind::translation, Kind::rotation};
  struct Node {
    int count = 0;
    double stiffness = 0;            ///< that holds it
    Mat3 directions = Mat3::Zero();  ///< columns, as many as `count`
    template <class Archive>
    void serialize(Archive& archive) {
      auto& [how_many, held_by, columns] = *this;
      archive(how_many);
      if (how_many > 0) archive(held_by, columns);
    }
  };

  /// None.
  explicit InertMotions(std::size_t nodes) : of_{std::vector<Node>(nodes), std::vector<Node>(nodes)} {}
  void forget(std::size_t node);
  void add(Kind kind, std::size_t node, const Vec3& direction, double stiffness);

  [[nodiscard]] bool any(Kind kind) const { return counts_[static_cast<std::size_t>(kind)] > 0; }
  [[nodiscard]] const Node& of(Kind kind, std::size_t node) const { return of_[static_cast<std::size_t>(kind)][node]; }
  /// Adds the stiffness that holds the node, in its six components.
  void add_stiffness(std::size_t node, Mat6& K) const;
  /// Takes away the parts along these directions of a vector of forces (no `scale`), or of scaled displacements.
  void drop(const DofMap& dofs, std::span<const double> scale, Eigen::VectorXd& values) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [of, counts] = *this;
    archive(of, counts);
  }

 private:
  std::array<std::vector<Node>, 2> of_;  ///< per kind and node
  std::array<int, 2> counts_{};          ///< nodes with a count above 0
};

}  // namespace topple::solver
