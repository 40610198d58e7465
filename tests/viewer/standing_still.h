#pragma once
// Scenes in which what stands goes from one state of rest to the next: for tests of what such states have.
#include <utility>

#include "app/open_scene.h"

namespace topple::viewer {

inline Scene standing_still(Scene scene) {
  scene.scenario.standing = structure::StandingRule::statics;
  return scene;
}

}  // namespace topple::viewer
