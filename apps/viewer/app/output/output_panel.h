#pragma once
// Files of pictures, of the run for other programs, and of the run to take up again.
#include <array>

#include "app/controller.h"

namespace topple::viewer {

class OutputPanel {
 public:
  void draw(Controller& controller);

 private:
  std::array<char, 256> picture_{"topple.png"}, sequence_{"pictures"}, run_{"run.html"};
};

}  // namespace topple::viewer
