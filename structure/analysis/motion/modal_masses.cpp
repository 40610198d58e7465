#include "analysis/motion/modal_masses.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "loads/on_pieces.h"
#include "model/index_of.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

/// Vertical loads gathered at nodes, downwards positive.
class Downward {
 public:
  Downward(const Building& building, const Frame& frame, bool to_pieces)
      : building_(building), frame_(frame), to_pieces_(to_pieces), at_(frame.model.nodes.size(), 0) {}

  void add(const std::vector<solver::NodeLoad>& loads) {
    for (const solver::NodeLoad& load : loads) add(static_cast<std::size_t>(load.node), -load.load.z());
  }

  void add(const std::vector<solver::BeamLoad>& loads) {
    std::vector<solver::BeamLoad> parts;
    for (const solver::BeamLoad& load : loads) {
      const auto m = static_cast<std::size_t>(load.beam);
      const Member& member = building_.members[m];
      if (!to_pieces_ || frame_.pieces[m].empty()) {
        add(member, {member.nodes[0].index, member.nodes[1].index}, member.length, load);
        continue;
      }
      parts.clear();
      lay_on_pieces(frame_.model, frame_.pieces[m], load, parts);
      for (const solver::BeamLoad& part : parts) {
        const solver::Beam& beam = frame_.model.beams[static_cast<std::size_t>(part.beam)];
        add(member, beam.node, beam.length, part);
      }
    }
  }

  void add(const std::vector<solver::ShellLoad>& loads) {
    for (const solver::ShellLoad& load : loads) {
      const auto& corners = frame_.model.shells[static_cast<std::size_t>(load.shell)].node;
      const auto at = [&](std::size_t k) { return frame_.model.nodes[static_cast<std::size_t>(corners[k])]; };
      const double area = 0.5 * (at(2) - at(0)).cross(at(3) - at(1)).norm();
      for (const int corner : corners) add(static_cast<std::size_t>(corner), -load.traction.z() * area / 4);
    }
  }

  [[nodiscard]] const std::vector<double>& at() const { return at_; }

 private:
  void add(std::size_t node, double force) { at_[node] += force; }
  /// By the lever rule to two nodes that are `length` apart.
  void add(const Member& member, const std::array<int, 2>& nodes, double length, const solver::BeamLoad& load) {
    const auto down = [&](const Vec6& local) { return -(member.axes.transpose() * local.head<3>()).z(); };
    const auto along = [&](double place, double force) {
      const double second = force * place / length;
      add(static_cast<std::size_t>(nodes[0]), force - second);
      add(static_cast<std::size_t>(nodes[1]), second);
    };
    if (load.kind == solver::BeamLoad::Kind::point) along(load.from, down(load.first));
    if (load.kind != solver::BeamLoad::Kind::distributed) return;
    // Two triangles of a trapezoid, each at its own centroid.
    const double width = load.to - load.from;
    along(load.from + width / 3, down(load.first) * width / 2);
    along(load.to - width / 3, down(load.last) * width / 2);
  }

  const Building& building_;
  const Frame& frame_;
  bool to_pieces_;
  std::vector<double> at_;
};

/// The cases that become mass, as one combination of loads without self weight.
std::vector<double> mass_of_loads(const Building& building, const Frame& frame, bool to_pieces) {
  Building loads = building;
  for (LoadCase& load_case : loads.cases) load_case.self_weight = Vec3::Zero();
  loads.combinations = {{"masses.loads", building.masses.loads}};
  if (!(building.gravity > 0))
    throw InputError(building.file + ", masses.loads: loads become mass by gravity, which must be above 0");
  PartLoads parts = part_loads(loads, CombinationId(0));
  parts.settlements.clear();  // the push of a moved spring has no mass
  const solver::LoadSet set = load_set(loads, parts);
  Downward down(building, frame, to_pieces);
  down.add(set.nodes);
  down.add(set.beams);
  down.add(on_frame(loads, frame, parts, set).shells);
  std::vector<double> mass = down.at();
  double largest = 0;
  for (const double force : mass) largest = std::max(largest, force);
  constexpr double rounding = 1e-9;
  for (std::size_t n = 0; n < mass.size(); ++n) {
    if (mass[n] < -rounding * largest || (mass[n] < 0 && largest == 0))
      throw InputError(building.file + ", masses.loads: the loads push node " +
                       (n < building.nodes.size() ? building.nodes[n].name : "of a mesh") +
                       " upwards; accepted are load cases that act downwards");
    mass[n] = std::max(mass[n], 0.0) / building.gravity;
  }
  return mass;
}

/// Panels that are load alone: their mass goes where their weight does.
std::vector<double> mass_of_claddings(const Building& building, const Frame& frame, const EdgeMembers& edges,
                                      bool to_pieces) {
  Downward down(building, frame, to_pieces);
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    const Panel& panel = building.panels[p];
    if (panel.model != PanelModel::cladding) continue;
    PanelAction weight;
    weight.body_force = Vec3(0, 0, -building[panel.material].density * panel.thickness);
    const TributaryLoads handed = tributary_loads(building, edges, PanelId(p), weight, {true, true, true, true});
    down.add(handed.nodes);
    down.add(handed.beams);
  }
  return down.at();
}

}  // namespace

std::vector<double> mass_lengths(const Building& building, const Frame& frame) {
  std::vector<double> lengths;
  constexpr double rounding = 1e-9;
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    const Member& member = building.members[m];
    const double apart = (building[member.nodes[1]].position + member.offsets[1] - building[member.nodes[0]].position -
                          member.offsets[0])
                             .norm();
    if (apart <= (1 + rounding) * member.length) continue;
    lengths.resize(frame.model.beams.size(), 0);
    lengths[m] = apart;
    for (const MemberPiece& piece : frame.pieces[m]) {
      const auto beam = static_cast<std::size_t>(piece.beam);
      lengths[beam] = apart * frame.model.beams[beam].length / member.length;
    }
  }
  return lengths;
}

std::vector<solver::NodeMass> modal_masses(const Building& building, const Frame& frame, const EdgeMembers& edges,
                                           bool to_pieces) {
  std::vector<double> point = mass_of_claddings(building, frame, edges, to_pieces);
  if (!building.masses.loads.empty()) {
    const std::vector<double> loads = mass_of_loads(building, frame, to_pieces);
    for (std::size_t n = 0; n < point.size(); ++n) point[n] += loads[n];
  }
  for (const auto& [id, mass] : building.masses.members) {
    const Member& member = building[id];
    const auto& pieces = frame.pieces[index_of(id)];
    for (const NodeId node : member.nodes)
      if (!to_pieces || pieces.empty()) point[index_of(node)] += mass / 2;
    for (const MemberPiece& piece : pieces) {
      const solver::Beam& beam = frame.model.beams[static_cast<std::size_t>(piece.beam)];
      for (const int node : beam.node)
        if (to_pieces) point[static_cast<std::size_t>(node)] += mass / 2 * beam.length / member.length;
    }
  }
  std::vector<solver::NodeMass> masses;
  for (const NodeMass& given : building.masses.nodes) masses.push_back({given.node.index, given.mass, given.inertia});
  for (std::size_t n = 0; n < point.size(); ++n)
    if (point[n] != 0) masses.push_back({static_cast<int>(n), point[n], Vec3::Zero()});
  return masses;
}

}  // namespace topple::structure
