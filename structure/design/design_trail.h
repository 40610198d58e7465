#pragma once
// What a check went through, for those who follow it by hand. Off, it costs a test of one pointer.
#include <vector>

#include "topple/structure/design_check.h"

namespace topple::structure {

/// Units of a step, as powers of force and length.
struct StepUnit {
  int force = 0, length = 0;
};
inline constexpr StepUnit plain_number{0, 0}, of_length{0, 1}, of_area{0, 2}, of_modulus{0, 3}, of_inertia{0, 4},
    of_warping{0, 6}, of_force{1, 0}, of_moment{1, 1}, of_bimoment{1, 2}, of_stress{1, -2};

class Trail {
 public:
  Trail() = default;
  explicit Trail(std::vector<DesignStep>& steps) : steps_(&steps) {}
  [[nodiscard]] bool on() const { return steps_ != nullptr; }
  void add(const char* clause, const char* symbol, const char* formula, double value, StepUnit unit) const {
    if (on()) steps_->push_back({clause, symbol, formula, value, unit.force, unit.length});
  }

 private:
  std::vector<DesignStep>* steps_ = nullptr;
};

}  // namespace topple::structure
