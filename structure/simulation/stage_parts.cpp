#include "simulation/stage_parts.h"

#include <utility>

namespace topple::structure {

StageParts::StageParts(Building building, Scenario scenario, SimulationOptions options)
    : scene(std::move(building), std::move(scenario), std::move(options)),
      log(scene),
      debris(scene),
      hinges(scene, log, sums, debris),
      panels(scene, debris),
      tools(scene, log, sums, debris),
      views(scene, debris),
      break_up({scene, log, sums, debris, hinges, panels, views}),
      sweep(scene, debris, break_up),
      standing_fracture(scene, log, sums, debris, panels),
      standing_impacts({scene, log, sums, debris, panels, standing_fracture, release_impulses, struck}),
      body_impacts({scene, log, sums, debris, break_up, standing_impacts, struck}),
      hosts({scene, sums, debris, standing_impacts, body_impacts, struck}),
      debris_fracture({scene, log, sums, debris, hinges, panels, views, break_up, release_impulses}),
      release{scene, log, sums, debris, hinges, panels, break_up, release_impulses, standing_fracture, debris_fracture},
      bodies(scene, sums, debris),
      overlaps(scene, debris),
      progress(scene, log, tools, hosts),
      actions(scene) {}

}  // namespace topple::structure
