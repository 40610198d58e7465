// Segments of a damaged building: against union-find from scratch, and how little a break looks at.
#include "failure/segmentation.h"

#include <catch2/catch.hpp>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "structure/frame_builder.h"

namespace {

using namespace topple::test;

/// Connected components from scratch over nodes and members, the independent answer.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::size_t find(std::size_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parent_;
};

struct Damage {
  std::vector<char> joint_holds, member_left, supported;
};

/// Node and member vertices that hang on a support, each with the least vertex of its segment.
std::vector<int> standing_from_scratch(const Building& building, const Damage& damage) {
  const std::size_t nodes = building.nodes.size(), vertices = nodes + building.members.size();
  UnionFind sets(vertices);
  for (std::size_t m = 0; m < building.members.size(); ++m)
    for (std::size_t end = 0; end < 2; ++end)
      if (damage.joint_holds[2 * m + end])
        sets.join(nodes + m, static_cast<std::size_t>(building.members[m].nodes[end].index));
  std::vector<char> anchored(vertices, 0);
  for (std::size_t n = 0; n < nodes; ++n)
    if (damage.supported[n]) anchored[sets.find(n)] = 1;
  std::vector<int> least(vertices, -1), answer(vertices, -1);
  for (std::size_t v = 0; v < vertices; ++v) {
    const std::size_t root = sets.find(v);
    if (least[root] < 0) least[root] = static_cast<int>(v);
    const bool removed = v >= nodes && damage.member_left[v - nodes];
    if (anchored[root] && !removed) answer[v] = least[root];
  }
  return answer;
}

void require_equal(const Segmentation& segments, const std::vector<int>& expected, const Building& building) {
  // Labels differ, the partition must not: each label belongs to one least vertex and the other way round.
  std::map<int, int> least_of_label, label_of_least;
  for (std::size_t v = 0; v < expected.size(); ++v) {
    const bool is_node = v < building.nodes.size();
    const int label = is_node ? segments.label(NodeId(v)) : segments.label(MemberId(v - building.nodes.size()));
    REQUIRE((label >= 0) == (expected[v] >= 0));
    if (label < 0) continue;
    REQUIRE(segments.anchored(label));
    REQUIRE(least_of_label.emplace(label, expected[v]).first->second == expected[v]);
    REQUIRE(label_of_least.emplace(expected[v], label).first->second == label);
  }
}

}  // namespace

TEST_CASE("random damage leaves the segments that union-find finds") {
  std::mt19937 random(20);
  for (int trial = 0; trial < 60; ++trial) {
    const FrameBuilder frame = grid_building(3, 2 + trial % 2, 3, 5, 3, same_capacity(1), same_capacity(1));
    const Building& building = frame.building;
    Segmentation segments(building);
    Damage damage{std::vector<char>(building.joints.size(), 1), std::vector<char>(building.members.size(), 0),
                  std::vector<char>(building.nodes.size(), 0)};
    for (const NodeSupport& support : building.supports)
      damage.supported[static_cast<std::size_t>(support.node.index)] = 1;
    std::set<int> left;
    for (int round = 0; round < 40; ++round) {
      for (int k = 0; k < 1 + trial % 3; ++k) {
        const auto pick = random() % 10;
        if (pick < 7) {
          const std::size_t j = random() % building.joints.size();
          damage.joint_holds[j] = 0;
          segments.break_joint(JointId(j));
        } else if (pick < 9) {
          const std::size_t m = random() % building.members.size();
          damage.member_left[m] = 1;
          damage.joint_holds[2 * m] = damage.joint_holds[2 * m + 1] = 0;
          segments.remove(MemberId(m));
        } else {
          const std::size_t n = random() % building.nodes.size();
          damage.supported[n] = 0;
          segments.remove_support(NodeId(n));
        }
      }
      for (const Segmentation::Part& part : segments.extract_unanchored()) {
        REQUIRE(part.nodes.size() + part.members.size() > 0);
        for (MemberId member : part.members) REQUIRE(left.insert(member.index).second);
      }
      require_equal(segments, standing_from_scratch(building, damage), building);
    }
  }
}

TEST_CASE("a break inside a large building looks only at its neighbourhood") {
  const FrameBuilder frame = grid_building(6, 6, 10, 5, 3, same_capacity(1), same_capacity(1));
  const Building& building = frame.building;
  Segmentation segments(building);
  const std::uint64_t before = segments.vertices_searched();
  const MemberId beam(building.members.size() / 2);
  segments.break_joint(building.joint(beam, 0));
  CHECK(segments.searches() == 1);
  // The two sides of one beam end meet round the nearest panel of four beams: far fewer than the 1,400 vertices.
  CHECK(segments.vertices_searched() - before < 150);
  segments.break_joint(building.joint(beam, 0));
  CHECK(segments.searches() == 1);
}

TEST_CASE("a beam that lost both joints leaves alone, a post with its top fixed to the node does not") {
  const FrameBuilder frame = grid_building(2, 2, 1, 5, 3, same_capacity(1), same_capacity(1));
  const Building& building = frame.building;
  const NameIndex names(building);
  Segmentation segments(building);
  const MemberId beam = *names.member("BX-1-1-1"), post = *names.member("P-1-1-1");
  segments.break_joint(building.joint(beam, 0));
  segments.break_joint(building.joint(post, 0));
  CHECK(segments.extract_unanchored().empty());
  CHECK(segments.label(post) == segments.label(*names.node("N-1-1-1")));
  segments.break_joint(building.joint(beam, 1));
  const auto parts = segments.extract_unanchored();
  REQUIRE(parts.size() == 1);
  CHECK(parts[0].members == std::vector<MemberId>{beam});
  CHECK(parts[0].nodes.empty());
}

TEST_CASE("a segment whose last support is taken away leaves as a whole") {
  const FrameBuilder frame = grid_building(2, 1, 2, 5, 3, same_capacity(1), same_capacity(1));
  const Building& building = frame.building;
  Segmentation segments(building);
  segments.remove_support(building.supports[0].node);
  CHECK(segments.extract_unanchored().empty());
  segments.remove_support(building.supports[1].node);
  const auto parts = segments.extract_unanchored();
  REQUIRE(parts.size() == 1);
  CHECK(parts[0].nodes.size() == building.nodes.size());
  CHECK(parts[0].members.size() == building.members.size());
}

TEST_CASE("a membrane panel joins nothing, a shell panel does") {
  for (const PanelModel model : {PanelModel::membrane, PanelModel::shell}) {
    FrameBuilder frame;
    const NodeId a0 = frame.node("A0", 0, 0, 0), b0 = frame.node("B0", 5, 0, 0);
    const NodeId a1 = frame.node("A1", 0, 0, 3), b1 = frame.node("B1", 5, 0, 3);
    frame.member("PA", MemberKind::post, a0, a1, same_capacity(1));
    const MemberId pb = frame.member("PB", MemberKind::post, b0, b1, same_capacity(1));
    frame.panel("W", model, {a0, b0, b1, a1});
    frame.support(a0);
    frame.support(b0);
    Segmentation segments(frame.building);
    segments.break_joint(frame.building.joint(pb, 0));
    const auto parts = segments.extract_unanchored();
    if (model == PanelModel::shell) {
      CHECK(parts.empty());
    } else {
      REQUIRE(parts.size() == 1);
      CHECK(parts[0].members == std::vector<MemberId>{pb});
    }
  }
}
