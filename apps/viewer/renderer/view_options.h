#pragma once
// What a person chooses to see.
#include "topple/structure/ids.h"

namespace topple::viewer {

enum class Colouring {
  plain,        ///< by kind of part
  joints,       ///< at each end: force red, torque green, both yellow
  utilisation,  ///< along each member between its ends' utilisations, by the legend's map
  component,    ///< one of the six components of the joints' demand, signed
};
/// What full colour stands for in `joints` and `component`.
enum class Scale { capacity, largest_in_view };

struct PartSwitches {
  bool posts = true, beams = true, braces = true, slabs = true, walls = true;
  bool operator==(const PartSwitches&) const = default;
};

struct ViewOptions {
  Colouring colouring = Colouring::joints;
  Scale scale = Scale::capacity;
  int component = 4;             ///< Colouring::component: 0 to 5 (x, y, z, rx, ry, rz in joint axes)
  PartSwitches shown, coloured;  ///< what is drawn at all; whose joints are coloured
  bool failed_joints = true;     ///< show failed joints in their colour
  bool colour_blind_safe = false;
  float deflection_scale = 1;  ///< standing parts are drawn at this multiple of their displacement
  float slab_opacity = 1, wall_opacity = 0.4F;  ///< below 1, what is behind shows through
  bool shadows = true, ambient_occlusion = true, grid = true, debris = true;
  structure::JointId selected_joint;
  structure::MemberId hovered_member, selected_member;
  structure::PanelId hovered_panel, selected_panel;
  bool operator==(const ViewOptions&) const = default;
};

}  // namespace topple::viewer
