#include "simulation/fracture/panel_chunks.h"

#include <iterator>

namespace topple::structure {

std::vector<PanelChunk> break_panel(const Building& building, PanelId id, double mass, const std::vector<Vec3>& space,
                                    const Vec3& at, std::optional<double> radius,
                                    const fracture::PanelSettings& settings) {
  return break_up(BrokenPanel(building, id, mass, space, settings), at, radius);
}

std::vector<PanelChunk> break_up(BrokenPanel panel, const Vec3& at, std::optional<double> radius) {
  std::vector<PanelChunk> chunks = panel.hit(at, radius);
  if (chunks.empty()) return chunks;
  std::vector<PanelChunk> rest = panel.leave();
  for (PanelChunk& chunk : rest) chunk.hit = false;
  chunks.insert(chunks.end(), std::make_move_iterator(rest.begin()), std::make_move_iterator(rest.end()));
  return chunks;
}

}  // namespace topple::structure
