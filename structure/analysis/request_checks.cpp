#include "analysis/request_checks.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/index_of.h"
#include "model/short_number.h"
#include "topple/structure/number_range.h"

namespace topple::structure {

/// What a caller asks for beside the model: ids of its own, numbers that mean something.
void require_request(const Building& building, const AnalysisRequest& request) {
  const auto require_ids = [](const auto& ids, std::size_t count, const char* kind) {
    for (const auto id : ids)
      if (!id.valid() || index_of(id) >= count)
        throw std::out_of_range("analyse: there is no " + std::string(kind) + " with index " +
                                std::to_string(id.index) + " (there are " + std::to_string(count) + ")");
  };
  require_ids(request.combinations, building.combinations.size(), "combination");
  require_ids(request.losses.named, building.members.size(), "member");
  require_ids(request.losses.each, building.members.size(), "member");
  require_in(ranges::sudden, request.losses.sudden, "sudden");
  const MotionRequest& motion = request.losses.motion;
  require_in(ranges::instant, motion.over, "seconds through which a member is lost");
  if (motion.duration) require_in({1e-6, ranges::duration.most}, *motion.duration, "seconds to follow");
  require_in({0, 10}, motion.damping, "damping");
  require_in({0, 100'000}, request.stations, "stations");
  require_in({0, 1'000'000}, request.buckling, "buckling");
  require_in({0, 1'000'000}, request.modes, "modes");
  require_in({1, 1000}, request.divide, "divide");
  const bool second_order = request.second_order != solver::SecondOrder::none;
  if (request.losses.any() && second_order && !motion.asked)
    throw InputError(building.file +
                     ": losses of members are found by first order; accepted: no --p-delta, or --dynamic beside it");
  if ((motion.asked || request.time_history) && request.second_order == solver::SecondOrder::frame3dd)
    throw InputError(building.file + ": Frame3DD's own second order does not move; accepted: --p-delta");
}

/// The exact functions of a member under axial force take work with its slenderness: a rod of a kilometre and a
/// millimetre would keep the search for buckling loads at work for hours.
void require_stocky(const Building& building, const AnalysisRequest& request) {
  if (request.buckling == 0 && request.second_order == solver::SecondOrder::none) return;
  constexpr double most = 1e5;  // a cable of 100 m and 10 mm has 4e4
  for (const Member& member : building.members) {
    const Section& section = building[member.section];
    const double slenderness = member.length / std::sqrt(std::min(section.Iy, section.Iz) / section.area);
    if (!(slenderness <= most))
      throw InputError(building.file + ", members." + member.name +
                       ": a slenderness (length / radius of gyration) of " + short_number(slenderness, 3) +
                       " with second order or buckling; accepted: at most " + short_number(most, 3));
  }
}

}  // namespace topple::structure
