#pragma once
// The tab of what is played with: the goals and their score, the earthquake, the camera's path, the sound.
#include <array>

#include "app/controller.h"
#include "app/tools/score.h"

namespace topple::viewer {

class PlayPanel {
 public:
  void draw(Controller& controller);

 private:
  void goals(Controller& controller);
  void earthquake(Controller& controller);

  Score score_;
  std::int64_t scored_step_ = -1;
  std::array<char, 256> ground_{};
};

}  // namespace topple::viewer
