#pragma once
// What is wrong with settings that are in range, but not for this panel.
#include <stdexcept>

namespace topple::fracture {

/// Thrown where a panel or its cells are made. The message names the setting and says what is accepted.
class UnfitSettings : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

}  // namespace topple::fracture
