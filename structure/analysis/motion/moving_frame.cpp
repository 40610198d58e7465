#include "analysis/motion/moving_frame.h"

#include <algorithm>

#include "loads/frame_loads.h"
#include "model/index_of.h"
#include "topple/structure/error.h"

namespace topple::structure {
namespace {

/// Vertical load cases turned into mass at nodes by the lever rule.
class CaseMasses {
 public:
  CaseMasses(const Building& building, std::vector<double>& at) : building_(building), at_(at) {}

  void add(const solver::NodeLoad& load) { at_[static_cast<std::size_t>(load.node)] -= load.load.z(); }
  void add(const solver::BeamLoad& load) {
    const Member& member = building_.members[static_cast<std::size_t>(load.beam)];
    const auto down = [&](const Vec6& local) { return -(member.axes.transpose() * local.head<3>()).z(); };
    const auto along = [&](double place, double force) {
      at_[index_of(member.nodes[0])] += force * (1 - place / member.length);
      at_[index_of(member.nodes[1])] += force * place / member.length;
    };
    if (load.kind == solver::BeamLoad::Kind::point) along(load.from, down(load.first));
    if (load.kind != solver::BeamLoad::Kind::distributed) return;
    const double width = load.to - load.from;
    along(load.from + width / 3, down(load.first) * width / 2);
    along(load.to - width / 3, down(load.last) * width / 2);
  }

 private:
  const Building& building_;
  std::vector<double>& at_;
};

std::vector<double> masses_of_cases(const Building& building, CombinationId combination) {
  std::vector<double> at(building.nodes.size(), 0);
  Building cases = building;
  std::vector<std::pair<LoadCaseId, double>> factors = building.masses.loads;
  std::erase_if(factors, [&](const auto& given) {
    const auto& own = building[combination].factors;
    return std::any_of(own.begin(), own.end(), [&](const auto& f) { return f.first == given.first && f.second != 0; });
  });
  if (factors.empty()) return at;
  for (LoadCase& load_case : cases.cases) load_case.self_weight = Vec3::Zero();
  cases.combinations = {{"masses.loads", factors}};
  const PartLoads parts = part_loads(cases, CombinationId(0));
  for (std::size_t p = 0; p < cases.panels.size(); ++p)
    if (cases.panels[p].model == PanelModel::shell && parts.panels[p].pressure != 0)
      throw InputError(building.file + ", masses.loads: pressure on a shell panel (" + cases.panels[p].name +
                       ") is no mass of a frame that moves; accepted: the case in the combination");
  const solver::LoadSet set = load_set(cases, parts);
  CaseMasses masses(cases, at);
  for (const solver::NodeLoad& load : set.nodes) masses.add(load);
  for (const solver::BeamLoad& load : set.beams) masses.add(load);
  for (double& mass : at) mass = std::max(mass, 0.0) / building.gravity;
  return at;
}

}  // namespace

double moving_mass(const Building& building, const Member& member, const std::vector<solver::BeamLoad>& loads) {
  double down = 0;
  for (const solver::BeamLoad& load : loads) {
    const auto downward = [&](const Vec6& local) { return -(member.axes.transpose() * local.head<3>()).z(); };
    if (load.kind == solver::BeamLoad::Kind::point) down += downward(load.first);
    if (load.kind == solver::BeamLoad::Kind::distributed)
      down += (downward(load.first) + downward(load.last)) / 2 * (load.to - load.from);
  }
  if (down > 0) return down / building.gravity;
  return building[member.material].density * building[member.section].area * member.length;
}

std::vector<solver::NodeMass> given_masses(const Building& building, CombinationId combination) {
  std::vector<double> at = masses_of_cases(building, combination);
  for (const auto& [member, mass] : building.masses.members)
    for (const NodeId node : building[member].nodes) at[index_of(node)] += mass / 2;
  std::vector<solver::NodeMass> masses;
  for (const NodeMass& given : building.masses.nodes) masses.push_back({given.node.index, given.mass, given.inertia});
  for (std::size_t n = 0; n < at.size(); ++n)
    if (at[n] > 0) masses.push_back({static_cast<int>(n), at[n], Vec3::Zero()});
  return masses;
}

}  // namespace topple::structure
