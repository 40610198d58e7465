#pragma once
// A building as the small editor describes it: a grid of posts, storeys, sections, floors and walls.
#include <array>
#include <string>

namespace topple::viewer {

enum class FrameKind { concrete, steel };
inline constexpr std::array<const char*, 2> frame_names{"reinforced concrete", "steel"};

/// Lengths in m. What make_model_text accepts: 2 to 20 posts each way, 1 to 60 storeys, bays from 1 to 15, storeys from
/// 2 to 8 high, posts from 0.1 to 2 wide, beams from 0.1 to 2 deep, floors from 0.05 to 1 and walls from 0.05 to 1
/// thick.
struct BuildingPlan {
  std::string title = "My building";
  std::array<int, 2> posts{4, 3};
  int storeys = 3;
  std::array<double, 2> bay{5, 5};
  double storey_height = 3.2;
  FrameKind frame = FrameKind::concrete;
  double post_width = 0.35, beam_depth = 0.45;
  bool floors = true;
  double floor_thickness = 0.18;
  std::array<bool, 4> walls{true, true, true, true};  ///< outer ones on the sides x-, x+, y-, y+
  double wall_thickness = 0.24;
};

/// The model file: a building generator with materials, sections and joints. Concrete posts are square, beams half as
/// wide as deep, with 1 % of B500 steel; steel posts are square tubes, beams welded I-sections of S355. Walls are of
/// brick. Capacities are those of the sections (concrete: EN 1992-1-1 with characteristic strengths, axial force and
/// bending apart). Throws structure::InputError for what is out of bounds.
[[nodiscard]] std::string make_model_text(const BuildingPlan& plan);

}  // namespace topple::viewer
