#pragma once
// How a building moves after the loss of a member, or under a ground that shakes: what `topple analyse --dynamic` and
// `--time-history` ask for and get.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "topple/structure/building.h"
#include "topple/structure/joint_check.h"

namespace topple::structure {

/// Factors that go with time, linear between their times: ground acceleration along the global axes, or load cases.
struct TimeHistory {
  std::string file;           ///< that it was read from
  std::vector<double> times;  ///< s, ascending
  /// One quantity over time.
  struct Series {
    int axis = -1;               ///< 0 to 2: ground acceleration (m/s2) along it; -1: the factor of a load case
    LoadCaseId load_case;        ///< then
    std::vector<double> values;  ///< one for each time
  };
  std::vector<Series> series;  ///< in the order of the file's columns
};
/// A CSV file whose first column is `time` (s); the others `ax`, `ay`, `az` (the ground's acceleration, in the model's
/// length per s2) or names of the model's load cases (factors by which they act beside the combination). Throws
/// InputError with file and line.
[[nodiscard]] TimeHistory read_time_history(const std::string& path, const Building& building);

/// How a motion is followed, and what is told of it.
struct MotionRequest {
  bool asked = false;              ///< false: no motion
  double over = 0;                 ///< s through which the member is lost: its forces go down evenly; 0: at once
  std::optional<double> duration;  ///< s; else `over` and two of the lowest period, or the time history's length
  double damping = 0.02;           ///< share of the critical damping
  /// Axial forces of the moment act on the members as they lie, by the cubic geometric stiffness, one for each piece
  /// of a member; the states before and after a loss are found so as well. Membrane forces of panels do not.
  bool second_order = false;
  std::vector<NodeId> nodes;    ///< whose displacements are wanted over time
  std::vector<JointId> joints;  ///< whose demands are
};

/// A value and the time, in s from the loss, at which it is reached.
struct InTime {
  double value = 0;  ///< the largest
  double at = 0;     ///< s
};
/// A joint's largest utilisation in a motion.
struct JointPeak {
  JointId joint;               ///< that is meant
  Utilisation utilisation;     ///< the largest over time
  Vec6 demand = Vec6::Zero();  ///< then
  double at = 0;               ///< s
  /// Of the demand in the governing sense: the change from before the loss to the peak, over the change to the static
  /// state after it. None where that is below a hundredth of the capacity.
  std::optional<double> amplification;
};
/// Forces at the member's first end, tension positive: axial, two shears, torsion, two moments, as MemberResult's.
struct MemberMotion {
  MemberId member;            ///< that is meant
  std::array<InTime, 6> min;  ///< N and N m
  std::array<InTime, 6> max;  ///< N and N m
};
/// Of the nodes and joints asked for, in their order.
struct MotionSample {
  double time = 0;                  ///< s from the loss
  std::vector<Vec6> displacements;  ///< per node, global axes
  std::vector<Vec6> demands;        ///< per joint, in its axes
  std::vector<double> uses;         ///< per joint
};

/// One motion, SI.
struct MotionResult {
  double period = 0;           ///< lowest, s
  double damping = 0;          ///< share of the critical damping at the lowest frequency, and at `shape_frequency`
  double shape_frequency = 0;  ///< Hz: Rayleigh's, of the static shape under the loads
  double duration = 0;         ///< s that were followed
  double substep = 0;          ///< s, the last one taken
  int halvings = 0;            ///< of the first substep
  /// Second order: substeps (of the last course) in which a member was pressed beyond what it bears as it lay.
  long unsettled = 0;
  double change = 0;                  ///< of the peaks by the last halving, at most, as a share
  std::vector<JointPeak> joints;      ///< per joint with a capacity
  std::vector<MemberMotion> members;  ///< per member that is left
  std::vector<Vec6> displacements;    ///< per node: greatest sizes, component by component
  std::vector<MotionSample> history;  ///< one for each substep
};

/// Peaks count as settled when a halving of the substep changes none of them by more; those below a tenth of the
/// largest are measured against that tenth.
inline constexpr double settled_peak = 0.005;

}  // namespace topple::structure
