#pragma once
// What acts on each member: of one set of loads, or of a combination as the sum of its cases, whose loads need not be
// written out again for each of many combinations.
#include <deque>
#include <span>
#include <vector>

#include "loads/case_loads.h"
#include "topple/solver/frame_model.h"

namespace topple::structure {

/// The loads of each member together: those given where they lie in the members' order, as mostly they do.
class LoadsByMember {
 public:
  /// Borrows the loads.
  LoadsByMember(std::size_t members, const std::vector<solver::BeamLoad>& loads);
  LoadsByMember(LoadsByMember&&) = delete;
  [[nodiscard]] std::span<const solver::BeamLoad> on(std::size_t member) const {
    return {loads_->data() + start_[member], start_[member + 1] - start_[member]};
  }

 private:
  std::vector<std::size_t> start_;
  std::vector<solver::BeamLoad> sorted_;
  const std::vector<solver::BeamLoad>* loads_;
};

class CaseLoadsByMember {
 public:
  /// Borrows the cases.
  CaseLoadsByMember(std::size_t members, const CaseLoads& cases);
  /// Sets `sum` to what acts on a member in a combination; loads over the same length are one.
  void add_up(std::size_t combination, std::size_t member, std::vector<solver::BeamLoad>& sum) const;

 private:
  const CaseLoads& cases_;
  std::deque<LoadsByMember> by_case_;
};

}  // namespace topple::structure
