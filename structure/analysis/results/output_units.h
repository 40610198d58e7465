#pragma once
// From SI to the units of the model's file.
#include "topple/structure/building.h"

namespace topple::structure {

class OutputUnits {
 public:
  explicit OutputUnits(const Units& units) : length_(units.length), force_(units.force) {}

  [[nodiscard]] double load_factor(int component) const { return component < 3 ? force_ : force_ * length_; }
  /// Of diagram_names: axial, two shears, torsion, two moments, two deflections.
  [[nodiscard]] double diagram_factor(std::size_t quantity) const {
    return quantity < 3 ? force_ : quantity < 6 ? force_ * length_ : length_;
  }
  [[nodiscard]] Vec6 load(const Vec6& six) const {
    Vec6 result;
    for (int c = 0; c < 6; ++c) result(c) = six(c) / load_factor(c);
    return result;
  }
  [[nodiscard]] Vec6 movement(const Vec6& six) const {
    Vec6 result = six;
    result.head<3>() /= length_;
    return result;
  }

 private:
  double length_, force_;
};

}  // namespace topple::structure
