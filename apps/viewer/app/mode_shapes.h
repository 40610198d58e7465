#pragma once
// Modes of vibration and of buckling of the undamaged building, worked out beside everything else when first asked for.
#include <Eigen/Core>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "topple/structure/building.h"

namespace topple::viewer {

enum class ModeKind { vibration, buckling };

struct ModeShape {
  double value = 0;  ///< frequency in Hz, or the factor on the loads
  std::shared_ptr<const std::vector<Eigen::Matrix<float, 6, 1>>> shape;  ///< per node; largest translation 1
  std::shared_ptr<const std::vector<Eigen::Vector3f>> bulge;             ///< per member, as Snapshot has it; null: none
};

class ModeShapes {
 public:
  static constexpr int count = 8;
  /// Buckling under this combination. The building is shared with the thread that works.
  ModeShapes(std::shared_ptr<const structure::Building> building, structure::CombinationId combination)
      : building_(std::move(building)), combination_(combination) {}

  /// Lowest first; null while they are being worked out, which the first call starts.
  [[nodiscard]] const std::vector<ModeShape>* find(ModeKind kind);
  /// The same, but waits.
  [[nodiscard]] const std::vector<ModeShape>& wait_for(ModeKind kind);
  /// Why there are none; empty when there is no such reason.
  [[nodiscard]] const std::string& error(ModeKind kind) const { return of(kind).error; }

 private:
  struct Work {
    std::future<std::vector<ModeShape>> future;
    std::optional<std::vector<ModeShape>> modes;
    std::string error;
  };
  Work& of(ModeKind kind) { return work_[static_cast<std::size_t>(kind)]; }
  [[nodiscard]] const Work& of(ModeKind kind) const { return work_[static_cast<std::size_t>(kind)]; }
  void start(ModeKind kind);
  void store(Work& work);

  std::shared_ptr<const structure::Building> building_;
  structure::CombinationId combination_;
  std::array<Work, 2> work_;
};

}  // namespace topple::viewer
