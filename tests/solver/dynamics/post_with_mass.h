#pragma once
// A post with a mass on top, and what its ledger leaves open.
#include "frames.h"
#include "topple/solver/frame_dynamics.h"

namespace topple::test {

/// A post of 3 m without mass, held at its foot, with a mass on top that a force pushes along x.
constexpr double height = 3, tip_mass = 1200;
[[nodiscard]] inline FrameModel post() {
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0), Vec3(0, 0, height)};
  model.supports = {{0, fixed()}};
  add_beam(model, 0, 1);
  model.beams[0].density = 0;
  return model;
}
[[nodiscard]] inline MassModel mass_on_post() {
  MassModel masses;
  masses.nodes = {{1, tip_mass, Vec3::Zero()}};
  return masses;
}

/// J; `at_start`: kinetic and elastic energy then.
[[nodiscard]] inline double balance(const DynamicEnergy& now, double at_start) {
  return now.kinetic + now.elastic + now.damped + now.numerical + now.dissipated + now.freed - now.external_work -
         now.struck - at_start;
}

}  // namespace topple::test
