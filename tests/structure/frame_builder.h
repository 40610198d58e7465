#pragma once
// Small buildings made in code for tests of what stands: a plain rectangular steel section, joints that hold or break.
#include <Eigen/Geometry>
#include <string>

#include "topple/structure/building.h"

namespace topple::test {

using namespace topple::structure;

/// Capacity with the same limit in all seven senses.
inline JointCapacity same_capacity(double limit) {
  JointCapacity capacity;
  capacity.value.fill(limit);
  capacity.breakable = true;
  return capacity;
}

class FrameBuilder {
 public:
  FrameBuilder() {
    building.gravity = 10;
    Material steel;
    steel.name = "steel";
    steel.youngs_modulus = 200e9;
    steel.shear_modulus = 80e9;
    steel.poisson_ratio = 0.25;
    steel.density = 0;
    building.materials = {steel};
    Section section;
    section.name = "bar";
    section.depth = section.width = 0.2;
    section.area = 0.04;
    section.Iy = 2e-4;
    section.Iz = 1e-4;
    section.J = 1.5e-4;
    building.sections = {section};
  }

  NodeId node(const std::string& name, double x, double y, double z) {
    building.nodes.push_back({name, Vec3(x, y, z)});
    return NodeId(building.nodes.size() - 1);
  }

  MemberId member(const std::string& name, MemberKind kind, NodeId first, NodeId second,
                  const JointCapacity& first_joint = {}, const JointCapacity& second_joint = {}) {
    Member member;
    member.name = name;
    member.kind = kind;
    member.nodes = {first, second};
    member.section = SectionId(0u);
    member.material = MaterialId(0u);
    const Vec3 along = building[second].position - building[first].position;
    member.length = along.norm();
    const Vec3 x = along / member.length;
    const Vec3 up = x.head<2>().norm() < 1e-6 ? Vec3::UnitX() : Vec3::UnitZ();
    const Vec3 y = up.cross(x).normalized();
    member.axes.row(0) = x;
    member.axes.row(1) = y;
    member.axes.row(2) = x.cross(y);
    const MemberId id(building.members.size());
    building.members.push_back(member);
    const JointCapacity* capacity[] = {&first_joint, &second_joint};
    for (int end = 0; end < 2; ++end) {
      Joint joint;
      joint.name = name + ":" + std::to_string(end + 1);
      joint.member = id;
      joint.end = end;
      joint.capacity = *capacity[end];
      building.joints.push_back(joint);
    }
    return id;
  }

  /// Panels come after the last member: their joints follow those of the members.
  PanelId panel(const std::string& name, PanelModel model, std::array<NodeId, 4> nodes,
                const JointCapacity& edge = {}) {
    Panel panel;
    panel.name = name;
    panel.model = model;
    panel.nodes = nodes;
    panel.thickness = 0.2;
    panel.material = MaterialId(0u);
    const Vec3 x = (building[nodes[1]].position - building[nodes[0]].position).normalized();
    const Vec3 diagonal = building[nodes[2]].position - building[nodes[0]].position;
    const Vec3 z = x.cross(diagonal).normalized();
    panel.axes.row(0) = x;
    panel.axes.row(1) = z.cross(x);
    panel.axes.row(2) = z;
    panel.kind = std::abs(z.z()) > 0.5 ? PanelKind::slab : PanelKind::wall;
    const PanelId id(building.panels.size());
    building.panels.push_back(panel);
    for (int end = 0; end < 4; ++end) {
      Joint joint;
      joint.name = name + ":" + std::to_string(end + 1);
      joint.panel = id;
      joint.end = end;
      joint.capacity = edge;
      building.joints.push_back(joint);
    }
    return id;
  }

  void support(NodeId node) { building.supports.push_back({node, Vec6::Constant(unlimited)}); }

  void load(NodeId node, const Vec6& value) { load_case().nodes.push_back({node, value}); }
  /// Uniform global vertical load on a member, positive up.
  void load(MemberId member, double vertical) {
    MemberLoad load;
    load.member = member;
    load.to = building[member].length;
    load.first(2) = load.last(2) = vertical;
    load_case().members.push_back(load);
  }
  void load(PanelId panel, double pressure) { load_case().panels.push_back({panel, pressure, 0}); }
  void self_weight(double density) {
    building.materials[0].density = density;
    load_case().self_weight = Vec3(0, 0, -1);
  }
  LoadCase& load_case() {
    if (building.cases.empty()) {
      building.cases.emplace_back().name = "dead";
      building.combinations.push_back({"dead", {{LoadCaseId(0u), 1.0}}});
    }
    return building.cases.front();
  }

  Building building;
};

/// Posts on a grid of nx by ny lines and as many storeys, beams between their tops; every post foot and beam end takes
/// the given capacities. Names as the generator has them: P-i-j-k, BX-i-j-k, BY-i-j-k, N-i-j-k.
inline FrameBuilder grid_building(int nx, int ny, int storeys, double bay, double height, const JointCapacity& post,
                                  const JointCapacity& beam) {
  FrameBuilder frame;
  const auto name = [](const char* kind, int i, int j, int k) {
    return kind + std::to_string(i + 1) + "-" + std::to_string(j + 1) + "-" + std::to_string(k);
  };
  const auto at = [&](int i, int j, int k) { return NodeId(static_cast<std::size_t>((k * ny + j) * nx + i)); };
  for (int k = 0; k <= storeys; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) frame.node(name("N-", i, j, k), i * bay, j * bay, k * height);
  for (int k = 1; k <= storeys; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        frame.member(name("P-", i, j, k), MemberKind::post, at(i, j, k - 1), at(i, j, k), post);
        if (i + 1 < nx) frame.member(name("BX-", i, j, k), MemberKind::beam, at(i, j, k), at(i + 1, j, k), beam, beam);
        if (j + 1 < ny) frame.member(name("BY-", i, j, k), MemberKind::beam, at(i, j, k), at(i, j + 1, k), beam, beam);
      }
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) frame.support(at(i, j, 0));
  return frame;
}

}  // namespace topple::test
