#include "assembly/frame_elements.h"

#include <algorithm>
#include <utility>

namespace topple::solver {

FrameElements::FrameElements(FrameModel given)
    : model(checked_model(std::move(given))),
      beam_factor(model.beams.size(), 1.0),
      beam_stands(model.beams.size(), 1),
      shell_stands(model.shells.size(), 1),
      node_stands(model.nodes.size(), 1),
      dofs_(model),
      elements_of_node_(model.nodes.size()) {
  int element = 0;
  const auto belongs = [&](std::span<const int> nodes) {
    for (int node : nodes) elements_of_node_[static_cast<std::size_t>(node)].push_back(element);
    ++element;
  };
  for (const Beam& beam : model.beams) belongs(beam.node);
  for (const Shell& shell : model.shells) belongs(shell.node);
  for (const Patch& patch : model.patches) belongs(patch.node);
  for (const Diaphragm& diaphragm : model.diaphragms) {
    for (int node : diaphragm.nodes) belongs(std::span(&node, 1));
  }
}

std::span<const int> FrameElements::beams_of_node(int node) const {
  const auto& elements = elements_of_node_[static_cast<std::size_t>(node)];  // in order: beams first
  const auto end = std::lower_bound(elements.begin(), elements.end(), static_cast<int>(model.beams.size()));
  return {elements.begin(), end};
}

void FrameElements::elements_of_vertex(int vertex, std::vector<int>& elements) const {
  const auto v = static_cast<std::size_t>(vertex);
  const auto append = [&](std::size_t node) {
    elements.insert(elements.end(), elements_of_node_[node].begin(), elements_of_node_[node].end());
  };
  if (v < model.nodes.size()) return append(v);
  for (const int node : model.diaphragms[v - model.nodes.size()].nodes) append(static_cast<std::size_t>(node));
}

/// Of the node's elements those from `first` on, `count` of that kind, counted from 0.
std::vector<int> FrameElements::numbers_of_node(int node, std::size_t first, std::size_t count) const {
  std::vector<int> numbers;
  for (int element : elements_of_node_[static_cast<std::size_t>(node)]) {
    const auto e = static_cast<std::size_t>(element);
    if (e >= first && e < first + count) numbers.push_back(static_cast<int>(e - first));
  }
  return numbers;
}

std::vector<int> FrameElements::shells_of_node(int node) const {
  return numbers_of_node(node, element_of_shell(0), model.shells.size());
}

std::vector<int> FrameElements::patches_of_node(int node) const {
  return numbers_of_node(node, element_of_patch(0), model.patches.size());
}

}  // namespace topple::solver
