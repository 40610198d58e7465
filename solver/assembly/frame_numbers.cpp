// The numbers of a frame: what is refused in them, and others in their place.
#include <algorithm>
#include <stdexcept>

#include "assembly/frame_system.h"

namespace topple::solver {
namespace {

void check_patch(const Patch& patch, std::size_t index, int nodes) {
  const std::string name = "patch " + std::to_string(index);
  const auto size = static_cast<Eigen::Index>(6 * patch.node.size());
  for (const int node : patch.node)
    if (node < 0 || node >= nodes)
      throw std::invalid_argument(name + ": node " + std::to_string(node) + " does not exist");
  if (patch.stiffness.rows() != size || patch.stiffness.cols() != size || !patch.stiffness.allFinite())
    throw std::invalid_argument(name + ": its stiffness is not a finite matrix of six freedoms for each node");
  if (patch.mass.size() > 0 && (patch.mass.rows() != size || patch.mass.cols() != size || !patch.mass.allFinite()))
    throw std::invalid_argument(name + ": its mass is not a finite matrix of six freedoms for each node");
}

}  // namespace

FrameModel checked_model(FrameModel model) {
  const int nodes = static_cast<int>(model.nodes.size());
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (!model.nodes[i].allFinite()) throw std::invalid_argument("node " + std::to_string(i) + " is not finite");
  }
  for (std::size_t i = 0; i < model.beams.size(); ++i) check_beam(model.beams[i], static_cast<int>(i), nodes);
  for (std::size_t i = 0; i < model.shells.size(); ++i) {
    check_shell(model.shells[i], static_cast<int>(i), model.nodes);
  }
  for (std::size_t i = 0; i < model.patches.size(); ++i) check_patch(model.patches[i], i, nodes);
  return model;
}

namespace {

template <class Elements>
bool same_nodes(const Elements& some, const Elements& others) {
  return std::equal(some.begin(), some.end(), others.begin(), others.end(),
                    [](const auto& a, const auto& b) { return a.node == b.node; });
}

bool same_elements(const FrameModel& some, const FrameModel& others) {
  return some.nodes.size() == others.nodes.size() && same_nodes(some.beams, others.beams) &&
         same_nodes(some.shells, others.shells) && same_nodes(some.patches, others.patches) &&
         std::equal(some.diaphragms.begin(), some.diaphragms.end(), others.diaphragms.begin(), others.diaphragms.end(),
                    [](const Diaphragm& a, const Diaphragm& b) { return a.nodes == b.nodes; });
}

bool same_numbering(const DofMap& some, const DofMap& others) {
  return some.equations == others.equations && some.held == others.held && some.number == others.number &&
         some.diaphragm_of_node == others.diaphragm_of_node && some.first_equation == others.first_equation &&
         some.vertex_of_equation == others.vertex_of_equation && some.diaphragm_number == others.diaphragm_number;
}

}  // namespace

bool FrameElements::replace_model(FrameModel& given) {
  if (!same_elements(model, given)) return false;
  given = checked_model(std::move(given));
  DofMap dofs(given);
  if (!same_numbering(dofs_, dofs)) return false;
  model = std::move(given);
  dofs_ = std::move(dofs);  // the arms of diaphragms
  std::fill(beam_factor.begin(), beam_factor.end(), 1.0);
  std::fill(beam_stands.begin(), beam_stands.end(), char{1});
  std::fill(shell_stands.begin(), shell_stands.end(), char{1});
  std::fill(node_stands.begin(), node_stands.end(), char{1});
  if (kept_shells_.size() < model.shells.size()) kept_shells_.resize(model.shells.size());
  return true;
}

bool FrameSystem::replace_numbers(FrameModel& given) {
  if (!replace_model(given)) return false;
  support_ = support_stiffness(model);
  return true;
}

}  // namespace topple::solver
