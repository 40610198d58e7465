#pragma once
// What broke in a standing frame since it was last handed out, in order, and the generation that runs.
#include <utility>
#include <vector>

#include "failure/joint_states.h"
#include "standing/standing_parts.h"

namespace topple::structure {

class BreakLog {
 public:
  /// Both must outlive it.
  BreakLog(const StandingParts& parts, JointStates& joints) : parts_(parts), joints_(joints) {}

  /// A line of a joint that is about to break, with what it bears now.
  JointBreak& add(JointId joint, BreakCause cause);
  /// A line of what breaks otherwise, in the generation that runs.
  JointBreak& add(const JointBreak& line);

  [[nodiscard]] std::vector<JointBreak>& lines() { return lines_; }
  [[nodiscard]] std::size_t size() const { return lines_.size(); }
  /// Handed out once.
  [[nodiscard]] std::vector<JointBreak> extract() { return std::exchange(lines_, {}); }

  /// Stays where it is.
  [[nodiscard]] const int& generation() const { return generation_; }
  void start_generations() { generation_ = 0; }
  void next_generation() { ++generation_; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [parts, joints, lines, generation] = *this;
    archive(lines, generation);
  }

 private:
  const StandingParts& parts_;
  JointStates& joints_;
  std::vector<JointBreak> lines_;
  int generation_ = 0;
};

}  // namespace topple::structure
