#pragma once
// What a person chooses to see.
#include "topple/structure/ids.h"

namespace topple::viewer {

enum class Colouring {
  materials,    ///< as they are: no colour means anything
  plain,        ///< by kind of part
  joints,       ///< at each end: force red, torque green, both yellow
  utilisation,  ///< along each member between its ends' utilisations, by the legend's map
  component,    ///< one of the six components of the joints' demand, signed
  segments,     ///< each connected part in a colour of its own, standing or fallen
  path,         ///< which way a chosen force goes: its share at each joint
};
/// What full colour stands for in `joints` and `component`.
enum class Scale { capacity, largest_in_view };

struct PartSwitches {
  bool posts = true, beams = true, braces = true, slabs = true, walls = true;
  bool operator==(const PartSwitches&) const = default;
};

struct ViewOptions {
  static constexpr float usual_opacity = -1;
  Colouring colouring = Colouring::materials;
  Scale scale = Scale::capacity;
  int component = 4;             ///< Colouring::component: 0 to 5 (x, y, z, rx, ry, rz in joint axes)
  PartSwitches shown, coloured;  ///< what is drawn at all; whose joints are coloured
  bool failed_joints = true;     ///< show failed joints in their colour
  bool yielded_joints = true;    ///< where colours have a meaning, mark joints that have turned beyond what is elastic
  bool colour_blind_safe = false;
  static constexpr float as_deflection = -1;
  float deflection_scale = 1;          ///< standing parts are drawn at this multiple of their displacement
  float motion_scale = as_deflection;  ///< another multiple of what has come to it since the run began
  /// Below 1, what is behind shows through; `usual_opacity`: slabs not, walls only in views that colours give a
  /// meaning.
  float slab_opacity = usual_opacity, wall_opacity = usual_opacity;
  int diagram = -1;         ///< 0 to 5: that internal force drawn along each member; -1: none
  float diagram_scale = 1;  ///< 1: the largest is drawn as a tenth of the building's radius
  bool loads = false, reactions = false, contacts = false;  ///< as arrows
  float arrow_scale = 1;
  bool shadows = true, ambient_occlusion = true, grid = true, debris = true, dust = true;
  bool drawn = true;  ///< a model that is drawn around the building
  structure::JointId selected_joint;
  structure::MemberId hovered_member, selected_member;
  structure::PanelId hovered_panel, selected_panel;
  /// True where colours carry a meaning.
  [[nodiscard]] bool analysis() const { return colouring != Colouring::materials && colouring != Colouring::plain; }
  [[nodiscard]] float motion_scale_now() const { return motion_scale < 0 ? deflection_scale : motion_scale; }
  [[nodiscard]] float slab_opacity_now() const { return slab_opacity < 0 ? 1 : slab_opacity; }
  [[nodiscard]] float wall_opacity_now() const { return wall_opacity < 0 ? (analysis() ? 0.4F : 1.0F) : wall_opacity; }
  bool operator==(const ViewOptions&) const = default;
  /// Equal but for what is hovered over and selected, which are marks over the scene.
  [[nodiscard]] bool same_but_marks(ViewOptions other) const {
    other.selected_joint = selected_joint;
    other.hovered_member = hovered_member, other.selected_member = selected_member;
    other.hovered_panel = hovered_panel, other.selected_panel = selected_panel;
    return *this == other;
  }
};

}  // namespace topple::viewer
