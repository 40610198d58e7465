#pragma once
// Masses for natural modes beside those that the solver's elements have by themselves.
#include <vector>

#include "topple/solver/modes.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// Masses of nodes; of members (half at either node); of panels without elements (what they hand to members and nodes);
/// and vertical load cases turned into mass with their factors, their self weight left out because elements bring
/// theirs: what acts along a member goes to its nodes by the lever rule,
/// pressure on a shell's element in equal parts to its corners. Throws InputError where loads push upwards on
/// balance, or where there is no gravity to turn them by. `to_pieces`: what is on a member goes to the nodes of its
/// pieces, else to its ends alone.
[[nodiscard]] std::vector<solver::NodeMass> modal_masses(const Building& building, const Frame& frame,
                                                         const EdgeMembers& edges, bool to_pieces);

/// MassModel::beam_lengths: of members that are shorter than their ends lie apart, as a Frame3DD file's radii make
/// them, that distance; empty where there are none.
[[nodiscard]] std::vector<double> mass_lengths(const Building& building, const Frame& frame);

}  // namespace topple::structure
