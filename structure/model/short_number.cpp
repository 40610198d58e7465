#include "model/short_number.h"

#include <cstdio>

namespace topple::structure {

std::string short_number(double value, int digits) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

}  // namespace topple::structure
