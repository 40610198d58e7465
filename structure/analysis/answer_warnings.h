#pragma once
// What an engineer should know of an answer before relying on it.
#include <string>
#include <vector>

#include "loads/case_loads.h"
#include "topple/structure/analysis.h"
#include "topple/structure/building.h"

namespace topple::structure {

/// Adds to the warnings: reactions that do not balance, equations that are not solved to rounding, meshes too coarse
/// for stresses, loads that lift, deflections for which nothing linear holds.
void warn_of_answer(const Building& building, AnalysisResult& result);

/// Adds a warning where elements are heated: Frame3DD takes a thermal strain for an axial force in the end forces that
/// it prints. `loads`: of the combinations.
void warn_of_heated_elements(const Building& building, const std::vector<CombinationLoads>& loads,
                             AnalysisResult& result);

}  // namespace topple::structure
