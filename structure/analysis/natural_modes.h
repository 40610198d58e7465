#pragma once
// Natural modes of an analysed building, and the scale of mode shapes.
#include <optional>

#include "topple/solver/jointed_shell.h"
#include "topple/structure/analysis.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// The structure whose modes are sought. All of it must outlive the call.
struct ModalStructure {
  const Building& building;
  const AnalysisRequest& request;
  const Frame& frame;
  const EdgeMembers& edges;
  const std::vector<solver::JointedShell>& jointed;
  bool floats = false;  ///< nothing but the shift of the modes keeps it in place
};

/// The structure under load, about which it vibrates.
struct ModalTangent {
  const std::vector<solver::Beam>& beams;
  const solver::AxialState& state;
};

/// Natural modes without load, or about the loaded state `tangent`; all one-way members are taut. Fills modes,
/// mode_cuts, moving_mass and warnings. Throws InputError for modes that rounding hides.
void find_natural_modes(const ModalStructure& structure, const std::optional<ModalTangent>& tangent,
                        AnalysisResult& result);

/// Scales a mode shape so that no point of any node or member, bent between its ends, moves by more than 1. What is
/// noise beside that is set to zero. `cuts`: as AnalysisResult::mode_cuts.
void scale_to_largest(const Building& building, const Frame& frame, const std::vector<std::vector<int>>& cuts,
                      std::vector<Vec6>& shape);

}  // namespace topple::structure
