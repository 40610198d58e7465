#include "standing/frame_statics.h"

#include <numeric>

namespace topple::structure {

namespace {

/// Component number of each node: connected by members, panels and diaphragms, numbered in order of the least node.
std::vector<int> components_of(const Building& building, const Frame& frame) {
  std::vector<std::size_t> parent(building.nodes.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto find = [&](std::size_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  const auto join = [&](int a, int b) {
    parent[find(static_cast<std::size_t>(a))] = find(static_cast<std::size_t>(b));
  };
  for (const solver::Beam& beam : frame.model.beams) join(beam.node[0], beam.node[1]);
  // Any panel: what lies on it goes to all of its edges.
  for (const Panel& panel : building.panels)
    for (const NodeId node : panel.all_nodes()) join(panel.nodes[0].index, node.index);
  for (const solver::Diaphragm& diaphragm : frame.model.diaphragms)
    for (int node : diaphragm.nodes) join(diaphragm.nodes.front(), node);
  std::vector<int> number(parent.size(), -1), answer(parent.size());
  int count = 0;
  for (std::size_t n = 0; n < parent.size(); ++n) {
    int& component = number[find(n)];
    if (component < 0) component = count++;
    answer[n] = component;
  }
  return answer;
}

}  // namespace

FrameStatics::FrameStatics(const Building& building, const PanelSuperelements& shells, int threads)
    : stiff_(building.panels.size(), 0), patch_(building.panels.size(), 0) {
  const Frame frame = make_frame(building);
  std::vector<solver::FrameModel> models = split(building, frame);
  end_forces_.assign(building.members.size(), solver::Vec12::Zero());
  member_loads_.resize(building.members.size());
  node_loads_.assign(building.nodes.size(), Vec6::Zero());
  geometric_.assign(building.nodes.size(), Vec6::Zero());
  member_stiffness_.assign(building.members.size(), 1.0);
  solver::AnalysisOptions options;
  options.threads = threads;
  for (std::size_t c = 0; c < models.size(); ++c)
    components_[c].analysis = std::make_unique<solver::Reanalysis>(std::move(models[c]), options);
  for (const Place& place : member_place_)
    stiffness_diagonal_.push_back(at(place).beam_stiffness_diagonal(place.local));
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    if (const PanelSuperelement* shell = shells.of(PanelId(p))) set_stiffness(PanelId(p), shell->stiffness());
}

std::vector<solver::FrameModel> FrameStatics::split(const Building& building, const Frame& frame) {
  const std::vector<int> number = components_of(building, frame);
  std::vector<solver::FrameModel> models;
  const auto local = [&](int node) { return node_place_[static_cast<std::size_t>(node)].local; };
  const auto component = [&](int node) { return static_cast<std::size_t>(number[static_cast<std::size_t>(node)]); };
  for (std::size_t n = 0; n < building.nodes.size(); ++n) {
    const auto c = component(static_cast<int>(n));
    if (c == models.size()) {
      models.emplace_back();
      components_.emplace_back();
    }
    node_place_.push_back({static_cast<int>(c), static_cast<int>(models[c].nodes.size())});
    models[c].nodes.push_back(frame.model.nodes[n]);
    components_[c].nodes.push_back(NodeId(n));
  }
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    solver::Beam beam = frame.model.beams[m];
    const auto c = component(beam.node[0]);
    beam.node = {local(beam.node[0]), local(beam.node[1])};
    member_place_.push_back({static_cast<int>(c), static_cast<int>(models[c].beams.size())});
    models[c].beams.push_back(beam);
    components_[c].members.push_back(MemberId(m));
  }
  place_panels(building, frame, models);
  place_supports(building, frame, models);
  for (solver::Diaphragm diaphragm : frame.model.diaphragms) {
    const auto c = component(diaphragm.nodes.front());
    for (int& node : diaphragm.nodes) node = local(node);
    models[c].diaphragms.push_back(std::move(diaphragm));
  }
  return models;
}

/// Membranes as the frame has them; a shell panel as one element between its nodes, with the stiffness that its
/// superelement will give it.
void FrameStatics::place_panels(const Building& building, const Frame& frame, std::vector<solver::FrameModel>& models) {
  const auto local = [&](int node) { return node_place_[static_cast<std::size_t>(node)].local; };
  const auto component = [&](int node) {
    return static_cast<std::size_t>(node_place_[static_cast<std::size_t>(node)].component);
  };
  membrane_place_.resize(building.panels.size());
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    if (building.panels[p].model == PanelModel::shell) {
      solver::Patch patch;
      for (const NodeId node : building.panels[p].all_nodes()) patch.node.push_back(local(node.index));
      const auto size = static_cast<Eigen::Index>(6 * patch.node.size());
      patch.stiffness = Eigen::MatrixXd::Zero(size, size);
      stiff_[p] = patch_[p] = 1;
      const auto c = component(building.panels[p].nodes[0].index);
      membrane_place_[p] = {static_cast<int>(c), static_cast<int>(models[c].patches.size())};
      models[c].patches.push_back(std::move(patch));
      components_[c].shells.push_back(PanelId(p));
      continue;
    }
    if (frame.shell_of_panel[p] < 0) continue;
    solver::Shell shell = frame.model.shells[static_cast<std::size_t>(frame.shell_of_panel[p])];
    stiff_[p] = 1;
    const auto c = component(shell.node[0]);
    for (int& node : shell.node) node = local(node);
    membrane_place_[p] = {static_cast<int>(c), static_cast<int>(models[c].shells.size())};
    models[c].shells.push_back(shell);
    components_[c].membranes.push_back(PanelId(p));
  }
}

void FrameStatics::place_supports(const Building& building, const Frame& frame,
                                  std::vector<solver::FrameModel>& models) {
  const auto local = [&](int node) { return node_place_[static_cast<std::size_t>(node)].local; };
  const auto component = [&](int node) {
    return static_cast<std::size_t>(node_place_[static_cast<std::size_t>(node)].component);
  };
  std::vector<int> edge_of(frame.model.supports.size(), -1);
  for (std::size_t e = 0; e < frame.edge_supports.size(); ++e)
    for (const int s : frame.edge_supports[e]) edge_of[static_cast<std::size_t>(s)] = static_cast<int>(e);
  for (std::size_t s = 0; s < frame.model.supports.size(); ++s) {
    solver::Support support = frame.model.supports[s];
    if (static_cast<std::size_t>(support.node) >= building.nodes.size()) continue;  // inside a superelement
    support_edge_.push_back(edge_of[s]);
    const auto c = component(support.node);
    support_node_.push_back(NodeId(static_cast<std::size_t>(support.node)));
    support.node = local(support.node);
    support_place_.push_back({static_cast<int>(c), static_cast<int>(models[c].supports.size())});
    models[c].supports.push_back(support);
  }
}

const solver::Reanalysis& FrameStatics::at(const Place& place) const { return *parts(place.component).analysis; }

void FrameStatics::break_joint(MemberId member, int end) {
  const Place& place = member_place_[index(member)];
  change(place, [&](auto& frame) { frame.set_end_stiffness(place.local, end, Vec6::Zero()); });
  const auto found = hinges_.find(member);
  if (found == hinges_.end()) return;
  found->second.held.segment<6>(6 * end).setZero();
  found->second.plastic_rotation.segment<6>(6 * end).setZero();
  found->second.stiffness[static_cast<std::size_t>(end)].setZero();
  write_loads(member);
}

void FrameStatics::remove(MemberId member) {
  const Place& place = member_place_[index(member)];
  change(place, [&](auto& frame) { frame.remove_beam(place.local); });
  if (hinges_.erase(member) == 0) return;
  const solver::Beam& beam = at(place).model().beams[static_cast<std::size_t>(place.local)];
  for (const int local : beam.node) write_load(parts(place.component).nodes[static_cast<std::size_t>(local)]);
}

void FrameStatics::remove_membrane(PanelId panel) {
  const Place& place = membrane_place_[index(panel)];
  stiff_[index(panel)] = 0;
  if (place.component < 0) return;
  if (patch_[index(panel)] == 0) return change(place, [&](auto& frame) { frame.remove_shell(place.local); });
  const Eigen::Index size = at(place).patch_stiffness(place.local).rows();
  change(place, [&](auto& frame) { frame.set_patch_stiffness(place.local, Eigen::MatrixXd::Zero(size, size)); });
}

Mat24 FrameStatics::membrane_stiffness(PanelId panel) const {
  const Place& place = membrane_place_[index(panel)];
  return at(place).shell_stiffness(place.local);
}

void FrameStatics::set_stiffness(PanelId panel, const Eigen::MatrixXd& stiffness) {
  const Place& place = membrane_place_[index(panel)];
  if (patch_[index(panel)] != 0)
    change(place, [&](auto& frame) { frame.set_patch_stiffness(place.local, stiffness); });
  else
    change(place, [&](auto& frame) { frame.set_shell_stiffness(place.local, stiffness); });
}

const Eigen::MatrixXd& FrameStatics::shell_stiffness(PanelId shell) const {
  const Place& place = membrane_place_[index(shell)];
  return at(place).patch_stiffness(place.local);
}

void FrameStatics::lose_support(std::size_t support) {
  const Place& place = support_place_[support];
  change(place, [&](auto& frame) { frame.set_support_stiffness(place.local, Vec6::Zero()); });
}

void FrameStatics::remove_support(NodeId node) {
  for (std::size_t s = 0; s < support_node_.size(); ++s)
    if (support_node_[s] == node) lose_support(s);
}

void FrameStatics::remove_support(NodeId node, std::size_t edge_support) {
  for (std::size_t s = 0; s < support_node_.size(); ++s)
    if (support_node_[s] == node && support_edge_[s] == static_cast<int>(edge_support)) lose_support(s);
}

void FrameStatics::set_stiffness(MemberId member, double factor) {
  const Place& place = member_place_[index(member)];
  change(place, [&](auto& frame) { frame.set_beam_stiffness_factor(place.local, factor); });
  member_stiffness_[index(member)] = factor;
}

void FrameStatics::drop(const std::vector<NodeId>& nodes) {
  for (NodeId node : nodes) {
    const Place& place = node_place_[index(node)];
    const int local[] = {place.local};
    change(place, [&](auto& frame) { frame.drop_nodes(local); });
  }
}

void FrameStatics::set_loads(MemberId member, std::vector<solver::BeamLoad> loads) {
  member_loads_[index(member)] = std::move(loads);
  write_loads(member);
}

void FrameStatics::set_load(NodeId node, const Vec6& load) {
  node_loads_[index(node)] = load;
  write_load(node);
}

void FrameStatics::forget(int number) {
  Component& component = components_[static_cast<std::size_t>(number)];
  component.changed = false;
  component.gone = true;
}

const solver::Shell& FrameStatics::shell(PanelId membrane) const {
  const Place& place = membrane_place_[index(membrane)];
  return at(place).model().shells[static_cast<std::size_t>(place.local)];
}

const Mat24* FrameStatics::given_stiffness(PanelId panel) const {
  const Place& place = membrane_place_[index(panel)];
  const auto& given = at(place).model().shell_stiffness;
  const auto found = given.find(place.local);
  return found == given.end() ? nullptr : &found->second;
}

/// A component's beams and shells as members and membranes.
class FrameStatics::Adapter : public solver::UseWatch {
 public:
  Adapter(FrameStatics& statics, const Component& component, MemberWatch& watch)
      : statics_(statics), component_(component), watch_(watch) {}
  double beam_use(int beam) override {
    const MemberId member = component_.members[static_cast<std::size_t>(beam)];
    statics_.read_end_forces(component_, member);
    return watch_.member_use(member, statics_.end_forces_[index(member)]);
  }
  double shell_use(int shell) override {
    return watch_.membrane_use(component_.membranes[static_cast<std::size_t>(shell)],
                               component_.analysis->shell_corner_forces(shell));
  }
  double beam_growth(int beam, const double (&root)[12]) override {
    return watch_.member_growth(component_.members[static_cast<std::size_t>(beam)],
                                Eigen::Map<const solver::Vec12>(root));
  }
  double shell_growth(int shell, const double (&root)[24]) override {
    std::array<Vec6, 4> corners;
    for (std::size_t corner = 0; corner < 4; ++corner) corners[corner] = Eigen::Map<const Vec6>(root + 6 * corner);
    return watch_.membrane_growth(component_.membranes[static_cast<std::size_t>(shell)], corners);
  }

 private:
  FrameStatics& statics_;
  const Component& component_;
  MemberWatch& watch_;
};

std::optional<FrameMechanism> FrameStatics::solve(int number) {
  Component& component = components_[static_cast<std::size_t>(number)];
  const solver::ReanalysisAnswer& answer = component.analysis->solve();
  if (answer.stable) {
    component.unwatched = false;
    read_end_forces(component);
    if (second_order_) component.diverged = !displace(number);
    component.changed = false;
    return std::nullopt;
  }
  return told(number, answer);
}

std::optional<FrameMechanism> FrameStatics::solve(int number, MemberWatch& watch) {
  Component& component = components_[static_cast<std::size_t>(number)];
  Adapter adapter(*this, component, watch);
  const solver::ReanalysisAnswer& answer = component.analysis->solve(adapter);
  if (answer.stable) {
    component.partial = component.unwatched = component.analysis->selective_effort().selective;
    // A factor in the warning band serves no selective answers, and nothing was read.
    if (!component.partial && !component.analysis->uses_known()) {
      for (std::size_t beam = 0; beam < component.members.size(); ++beam)
        (void)adapter.beam_use(static_cast<int>(beam));
      for (std::size_t shell = 0; shell < component.membranes.size(); ++shell)
        (void)adapter.shell_use(static_cast<int>(shell));
    }
  }
  return told(number, answer);
}

void FrameStatics::complete(int number, MemberWatch& watch) {
  Component& component = components_[static_cast<std::size_t>(number)];
  if (!component.unwatched) return;
  Adapter adapter(*this, component, watch);
  component.analysis->complete(&adapter);
  component.partial = component.unwatched = false;
}

void FrameStatics::read_end_forces(const Component& component, MemberId member) const {
  end_forces_[index(member)] = answered_end_forces(component, member);
}

solver::Vec12 FrameStatics::answered_end_forces(const Component& component, MemberId member) const {
  solver::Vec12 forces = component.analysis->beam_end_forces(member_place_[index(member)].local);
  if (const auto found = hinges_.find(member); found != hinges_.end()) forces += found->second.held;
  return forces;
}

void FrameStatics::read_end_forces(int number) { read_end_forces(parts(number)); }

void FrameStatics::read_end_forces(const Component& component) const {
  for (MemberId member : component.members) read_end_forces(component, member);
  component.partial = false;
}

const solver::Vec12& FrameStatics::end_forces(MemberId member) const {
  const Component& component = parts(member_place_[index(member)].component);
  if (component.partial) read_end_forces(component);
  return end_forces_[index(member)];
}

solver::Vec12 FrameStatics::elastic_end_forces(MemberId member) const {
  if (!second_order_) return end_forces(member);
  return answered_end_forces(parts(member_place_[index(member)].component), member);
}

std::optional<FrameMechanism> FrameStatics::told(int number, const solver::ReanalysisAnswer& answer) {
  Component& component = components_[static_cast<std::size_t>(number)];
  component.changed = false;
  if (answer.stable) return std::nullopt;
  component.changed = true;
  FrameMechanism mechanism;
  mechanism.motion.assign(node_place_.size(), Vec6::Zero());
  for (int local : answer.mechanism.nodes) mechanism.nodes.push_back(component.nodes[static_cast<std::size_t>(local)]);
  for (std::size_t i = 0; i < answer.mechanism.motion.size(); ++i)
    mechanism.motion[index(component.nodes[i])] = answer.mechanism.motion[i];
  return mechanism;
}

const Vec6& FrameStatics::displacement(NodeId node) const {
  const Place& place = node_place_[index(node)];
  return at(place).displacements_at({&place.local, 1})[static_cast<std::size_t>(place.local)];
}

solver::Beam FrameStatics::beam(MemberId member) const {
  const Place& place = member_place_[index(member)];
  solver::Beam beam = at(place).model().beams[static_cast<std::size_t>(place.local)];
  beam.youngs_modulus *= stiffness(member);
  beam.shear_modulus *= stiffness(member);
  return beam;
}

double FrameStatics::strain_energy(int component) const {
  return parts(component).gone ? 0 : parts(component).analysis->strain_energy();
}

solver::ReanalysisCounters FrameStatics::counters() const {
  solver::ReanalysisCounters sum;
  for (const Component& component : components_) {
    const solver::ReanalysisCounters& one = component.analysis->counters();
    sum.solves += one.solves;
    sum.unchanged += one.unchanged;
    sum.load_solves += one.load_solves;
    sum.low_rank += one.low_rank;
    sum.refactorisations += one.refactorisations;
    sum.orderings += one.orderings;
    sum.background_factors += one.background_factors;
    sum.late_factors += one.late_factors;
    sum.selective += one.selective;
    sum.beams_visited += one.beams_visited;
    sum.beams_left += one.beams_left;
  }
  return sum;
}

}  // namespace topple::structure
