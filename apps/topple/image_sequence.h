#pragma once
// The pictures of `demolish --images`: frame-00000.png and so on, so many for each simulated second.
#include <filesystem>
#include <memory>

#include "topple/structure/formats/output_files.h"
#include "topple/structure/simulation.h"
#include "topple/structure/visual_mesh.h"

namespace topple::app {

class ImageSequence {
 public:
  /// `drawn`: around the building, null for nothing; it has to outlive this. Throws std::runtime_error when this
  /// program or machine cannot draw.
  ImageSequence(const structure::Simulation& simulation, std::filesystem::path folder, double rate,
                structure::VisualMesh* drawn = nullptr);
  ~ImageSequence();
  /// Writes the pictures that are due up to the simulation's time.
  void write_due(const structure::Simulation& simulation);
  /// Takes away the pictures of an earlier, longer run.
  void finish(const structure::OutputFolder& folder) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::app
