// A building that stands under a combination and is shaken, or pushed as time goes by.
#include "analysis/motion/frame_motion.h"
#include "standing/unstable_model.h"
#include "topple/structure/analysis.h"
#include "topple/structure/error.h"

namespace topple::structure {

std::vector<std::pair<CombinationId, MotionResult>> find_motions(const Building& building,
                                                                 const std::vector<CombinationId>& combinations,
                                                                 const TimeHistory& history,
                                                                 const MotionRequest& request,
                                                                 const solver::AnalysisOptions& options) {
  constexpr const char* asked = "time histories";
  refuse_what_is_not_built(building, asked);
  const DividedBuilding divided(building);
  DamagedFrame frame(divided, {}, options);
  if (request.second_order) frame.use_second_order();
  std::vector<std::pair<CombinationId, MotionResult>> motions;
  for (const CombinationId combination : combinations) {
    const PartLoads loads = part_loads(divided.building(), combination);
    refuse_loads_that_are_not_built(divided.building(), combination, loads, asked);
    frame.load(loads);
    if (!frame.solve().stable) throw UnstableModel(building.file + ": the model is unstable before anything moves");
    if (!frame.settled()) throw UnstableModel(building.file + ": " + no_displaced_rest + " before anything moves");
    MotionStart start;
    start.displacements = start.rest = frame.analysis().displacements();
    start.history = &history;
    motions.emplace_back(combination, FrameMotion(building, divided, frame, combination, request).run(start));
  }
  return motions;
}

}  // namespace topple::structure
