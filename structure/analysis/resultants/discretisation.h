#pragma once
// How far the meshes of shell panels are from fine enough: stress resultants recovered by superconvergent patches
// (Zienkiewicz and Zhu, The superconvergent patch recovery and a posteriori error estimates, Int. J. Numer. Methods
// Eng. 33, 1992) against those of the elements, in the energy norm (their estimator of 1987).
#include <vector>

#include "topple/structure/analysis.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// Sets `nodes` and `discretisation_error` of every shell panel and returns that of all of them: sqrt(sum of the
/// errors' energy / energy of the shells). A panel that is loaded across its plane and has no node inside cannot tell:
/// its error is 1. 0 without shells, or where they bear nothing.
double recover_resultants(const Building& building, const Frame& frame, const PartLoads& loads,
                          const solver::StaticSolution& solution, std::vector<PanelResult>& panels);

}  // namespace topple::structure
