#include "standing/unstable_model.h"

#include <algorithm>
#include <cmath>

#include "model/index_of.h"

namespace topple::structure {

namespace {

constexpr std::size_t named_at_most = 8;

/// "along z", "about x and z": components within reach of the largest one of that kind.
std::string directions(const Vec6& motion) {
  static constexpr std::array<const char*, 6> words{"along x", "along y", "along z", "about x", "about y", "about z"};
  const double largest = motion.cwiseAbs().maxCoeff();
  std::string text;
  for (int c = 0; c < 6; ++c) {
    if (std::abs(motion(c)) < 0.5 * largest) continue;
    if (!text.empty()) text += " and ";
    text += words[static_cast<std::size_t>(c)];
  }
  return text;
}

}  // namespace

std::string describe_mechanism(const Building& building, const FrameMechanism& mechanism) {
  return "the model is unstable: " + describe_motion(building, mechanism);
}

std::string describe_motion(const Building& building, const FrameMechanism& mechanism) {
  std::string text;
  const std::size_t named = std::min(named_at_most, mechanism.nodes.size());
  for (std::size_t i = 0; i < named; ++i) {
    const NodeId node = mechanism.nodes[i];
    text += (i ? ", node " : "node ") + building[node].name + " moves " + directions(mechanism.motion[index_of(node)]);
  }
  if (mechanism.nodes.size() > named) text += " and " + std::to_string(mechanism.nodes.size() - named) + " more";
  std::string members;
  std::size_t count = 0;
  for (const Member& member : building.members) {
    const bool moves = std::any_of(member.nodes.begin(), member.nodes.end(), [&](NodeId node) {
      return std::find(mechanism.nodes.begin(), mechanism.nodes.end(), node) != mechanism.nodes.end();
    });
    if (!moves || count == named_at_most) continue;
    members += (count++ ? ", " : "") + member.name;
  }
  return members.empty() ? text : text + "; members " + members;
}

}  // namespace topple::structure
