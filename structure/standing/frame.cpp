#include "topple/structure/frame.h"

#include <algorithm>

#include "mesh/frame_mesh.h"
#include "mesh/semi_rigid_edges.h"
#include "model/panel_area.h"
#include "standing/member_beam.h"
#include "standing/panel_superelement.h"

namespace topple::structure {

namespace {

solver::AxialAction axial_action(AxialAction action) {
  switch (action) {
    case AxialAction::tension:
      return solver::AxialAction::tension_only;
    case AxialAction::compression:
      return solver::AxialAction::compression_only;
    default:
      return solver::AxialAction::both;
  }
}

solver::Beam make_beam(const Building& building, MemberId id) {
  const Member& member = building[id];
  solver::Beam beam = elastic_beam(building, id);
  beam.node = {member.nodes[0].index, member.nodes[1].index};
  beam.density = building[member.material].density;
  for (int end = 0; end < 2; ++end)
    beam.end_stiffness[static_cast<std::size_t>(end)] = building[building.joint(id, end)].stiffness;
  beam.axial = axial_action(member.axial);
  return beam;
}

solver::Shell make_membrane(const Building& building, const Panel& panel) {
  const Material& material = building[panel.material];
  solver::Shell shell;
  for (std::size_t i = 0; i < 4; ++i) shell.node[i] = panel.nodes[i].index;
  shell.youngs_modulus = material.youngs_modulus;
  shell.poisson_ratio = material.poisson_ratio;
  shell.thickness = panel.thickness;
  shell.density = material.density;
  if (!panel.openings.empty())  // of the one element that it stays for its mass
    shell.density *= panel_area(building, panel, true) / panel_area(building, panel, false);
  return shell;
}

}  // namespace

Frame make_frame(const Building& building) {
  Frame frame;
  solver::FrameModel& model = frame.model;
  model.nodes.reserve(building.nodes.size());
  for (const Node& node : building.nodes) model.nodes.push_back(node.position);
  model.beams.reserve(building.members.size());
  for (std::size_t i = 0; i < building.members.size(); ++i) model.beams.push_back(make_beam(building, MemberId(i)));
  frame.shell_of_panel.assign(building.panels.size(), -1);
  const auto operators = std::make_shared<ShellOperators>();
  for (std::size_t i = 0; i < building.panels.size(); ++i)
    if (building.panels[i].model == PanelModel::membrane) {
      frame.shell_of_panel[i] = static_cast<int>(model.shells.size());
      model.shells.push_back(make_membrane(building, building.panels[i]));
      if (!building.panels[i].openings.empty())
        model.shell_stiffness.emplace(frame.shell_of_panel[i],
                                      PanelSuperelement(building, PanelId(i), operators).stiffness());
    }
  for (const NodeSupport& support : building.supports)
    model.supports.push_back({support.node.index, support.stiffness});
  for (const Diaphragm& diaphragm : building.diaphragms) {
    model.diaphragms.emplace_back();
    for (const NodeId node : diaphragm.nodes) model.diaphragms.back().nodes.push_back(node.index);
  }
  add_shell_panels(building, frame);
  divide_members(building, frame);
  add_edge_supports(building, frame);
  add_semi_rigid_edges(building, frame);
  return frame;
}

}  // namespace topple::structure
