#include "simulation/debris/local_capacity.h"

#include <algorithm>

#include "model/index_of.h"

namespace topple::structure {

double local_capacity(const Building& building, Part part, std::span<const double> strength) {
  double least = unlimited;
  const auto value = [&](JointId id, Sense sense) {
    return building[id].capacity.value[static_cast<std::size_t>(sense)] * strength[index_of(id)];
  };
  if (part.member.valid()) {
    const double length = building[part.member].length;
    for (int end = 0; end < 2; ++end) {
      const JointId id = building.joint(part.member, end);
      for (const Sense sense : {Sense::shear_y, Sense::shear_z}) least = std::min(least, value(id, sense));
      for (const Sense sense : {Sense::moment_y, Sense::moment_z})
        least = std::min(least, 8 * value(id, sense) / length);
    }
    return least;
  }
  const Panel& panel = building[part.panel];
  for (int edge = 0; edge < 4; ++edge) {
    const Vec3 along = building[panel.nodes[static_cast<std::size_t>((edge + 1) % 4)]].position -
                       building[panel.nodes[static_cast<std::size_t>(edge)]].position;
    least = std::min(least, value(building.joint(part.panel, edge), Sense::shear_z) * along.norm());
  }
  return least;
}

}  // namespace topple::structure
