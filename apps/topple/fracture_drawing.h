#pragma once
#include <string>
#include <vector>

#include "topple/fracture/panel.h"
#include "topple/structure/formats/panel_file.h"

namespace topple::app {

/// The panel as a drawing (SVG): what remains, every chunk in a colour of its own, the hits as crosses. Chunks that
/// left because nothing held them are paler.
[[nodiscard]] std::string pattern_svg(const structure::PanelFile& file, const fracture::BreakablePanel& panel,
                                      const std::vector<fracture::Chunk>& chunks);

}  // namespace topple::app
