#include "analysis/undivided_members.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace topple::structure {

std::optional<double> own_frequency(const Building& building, const Member& member) {
  const Section& section = building[member.section];
  const Material& material = building[member.material];
  const double mass = material.density * section.area, weaker = std::min(section.Iy, section.Iz);
  if (!(mass > 0)) return std::nullopt;
  return std::numbers::pi / 2 * std::sqrt(material.youngs_modulus * weaker / mass) / (member.length * member.length);
}

std::string told_undivided(const Building& building, const Frame& frame,
                           const std::vector<solver::VibrationMode>& modes) {
  if (modes.empty()) return {};
  double highest = 0;
  for (const solver::VibrationMode& mode : modes) highest = std::max(highest, mode.angular_frequency);
  highest /= 2 * std::numbers::pi;
  std::size_t count = 0, slowest = 0;
  double lowest = highest;
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    if (!frame.pieces[m].empty()) continue;
    const std::optional<double> own = own_frequency(building, building.members[m]);
    if (!own || *own > highest) continue;
    ++count;
    if (*own > lowest) continue;
    lowest = *own;
    slowest = m;
  }
  if (count == 0) return {};
  char text[400];
  std::snprintf(
      text, sizeof text,
      "modes: member %s%s of one element would swing by %s at %.4g Hz between pinned ends, which is within the "
      "frequencies told; one element makes that up to 11 %% too quick, and leaves it out between held ends; "
      "accepted: --divide 2 (0.4 %%) or more, or nodes that divide it",
      building.members[slowest].name.c_str(), count > 1 ? (" and " + std::to_string(count - 1) + " more").c_str() : "",
      count > 1 ? "themselves" : "itself", lowest);
  return text;
}

}  // namespace topple::structure
