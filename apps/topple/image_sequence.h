#pragma once
// The pictures of `demolish --images`: frame-00000.png and so on, so many for each simulated second.
#include <filesystem>
#include <memory>

#include "topple/structure/simulation.h"

namespace topple::app {

class ImageSequence {
 public:
  /// Throws std::runtime_error when this program or machine cannot draw.
  ImageSequence(const structure::Simulation& simulation, std::filesystem::path folder, double rate);
  ~ImageSequence();
  /// Writes the pictures that are due up to the simulation's time.
  void write_due(const structure::Simulation& simulation);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::app
