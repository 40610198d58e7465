#include "standing/statics/frame_answers.h"

namespace topple::structure {

FrameAnswers::FrameAnswers(const Building& building, const Frame& frame, std::vector<solver::FrameModel> models,
                           int threads)
    : FrameNumbers(building, frame, models),
      stiff_(building.panels.size(), 0),
      end_forces_(building.members.size(), solver::Vec12::Zero()),
      member_stiffness_(building.members.size(), 1.0),
      components_(models.size()),
      member_loads_(building.members.size()),
      node_loads_(building.nodes.size(), Vec6::Zero()) {
  solver::AnalysisOptions options;
  options.threads = threads;
  for (std::size_t c = 0; c < models.size(); ++c)
    components_[c].analysis = std::make_unique<solver::Reanalysis>(std::move(models[c]), options);
  for (const Place& place : member_place_)
    stiffness_diagonal_.push_back(at(place).beam_stiffness_diagonal(place.local));
  for (std::size_t p = 0; p < building.panels.size(); ++p) stiff_[p] = panel_place_[p].component >= 0 ? 1 : 0;
}

Mat24 FrameAnswers::membrane_stiffness(PanelId panel) const {
  const Place& place = panel_place_[index(panel)];
  return at(place).shell_stiffness(place.local);
}

const Eigen::MatrixXd& FrameAnswers::shell_stiffness(PanelId shell) const {
  const Place& place = panel_place_[index(shell)];
  return at(place).patch_stiffness(place.local);
}

const solver::Shell& FrameAnswers::shell(PanelId membrane) const {
  const Place& place = panel_place_[index(membrane)];
  return at(place).model().shells[static_cast<std::size_t>(place.local)];
}

const Mat24* FrameAnswers::given_stiffness(PanelId panel) const {
  const Place& place = panel_place_[index(panel)];
  const auto& given = at(place).model().shell_stiffness;
  const auto found = given.find(place.local);
  return found == given.end() ? nullptr : &found->second;
}

/// What a hinge holds is a load on the member's end, one that has slipped an angle in it.
std::vector<solver::BeamLoad> FrameAnswers::with_hinges(MemberId member, std::vector<solver::BeamLoad> loads) const {
  const auto found = hinges_.find(member);
  if (found == hinges_.end()) return loads;
  for (int end = 0; end < 2; ++end) {
    solver::BeamLoad held;
    held.kind = solver::BeamLoad::Kind::point;
    held.from = end == 0 ? 0 : beam(member).length;
    held.first = found->second.held.segment<6>(6 * end);
    if (!held.first.isZero(0)) loads.push_back(held);
  }
  solver::BeamLoad plastic_rotation;
  plastic_rotation.kind = solver::BeamLoad::Kind::temperature;
  plastic_rotation.first = found->second.plastic_rotation.head<6>();
  plastic_rotation.last = found->second.plastic_rotation.tail<6>();
  if (!plastic_rotation.first.isZero(0) || !plastic_rotation.last.isZero(0)) loads.push_back(plastic_rotation);
  return loads;
}

solver::Vec12 FrameAnswers::plastic_rotations(MemberId member) const {
  const auto found = hinges_.find(member);
  return found == hinges_.end() ? solver::Vec12::Zero() : found->second.plastic_rotation;
}

void FrameAnswers::read_end_forces(MemberId member) const { end_forces_[index(member)] = answered_end_forces(member); }

solver::Vec12 FrameAnswers::answered_end_forces(MemberId member) const {
  const Place& place = member_place_[index(member)];
  solver::Vec12 forces = at(place).beam_end_forces(place.local);
  if (const auto found = hinges_.find(member); found != hinges_.end()) forces += found->second.held;
  return forces;
}

void FrameAnswers::read_end_forces(int component) const {
  for (MemberId member : members(component)) read_end_forces(member);
  state(component).partial = false;
}

const solver::Vec12& FrameAnswers::end_forces(MemberId member) const {
  if (state(component(member)).partial) read_end_forces(component(member));
  return end_forces_[index(member)];
}

solver::Vec12 FrameAnswers::elastic_end_forces(MemberId member) const {
  return second_order_ ? answered_end_forces(member) : end_forces(member);
}

const Vec6& FrameAnswers::displacement(NodeId node) const {
  const Place& place = node_place_[index(node)];
  return at(place).displacements_at({&place.local, 1})[static_cast<std::size_t>(place.local)];
}

solver::Beam FrameAnswers::beam(MemberId member) const {
  const Place& place = member_place_[index(member)];
  solver::Beam beam = at(place).model().beams[static_cast<std::size_t>(place.local)];
  beam.youngs_modulus *= stiffness(member);
  beam.shear_modulus *= stiffness(member);
  return beam;
}

double FrameAnswers::strain_energy(int component) const {
  return state(component).gone ? 0 : state(component).analysis->strain_energy();
}

solver::ReanalysisCounters FrameAnswers::counters() const {
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

std::array<Vec6, 4> FrameAnswers::corner_forces(PanelId membrane) const {
  const Place& place = panel_place_[index(membrane)];
  return at(place).shell_corner_forces(place.local);
}

std::vector<Vec6> FrameAnswers::node_forces(PanelId panel) const {
  const Place& place = panel_place_[index(panel)];
  if (is_patch(panel)) return at(place).patch_forces(place.local);
  const std::array<Vec6, 4> corners = at(place).shell_corner_forces(place.local);
  return {corners.begin(), corners.end()};
}

std::vector<Vec6> FrameAnswers::node_forces(PanelId panel, const std::vector<Vec6>& displacements) const {
  const bool patch = is_patch(panel);
  // From the first node's place, where the ground has no hold: a rigid translation of the whole costs no digits.
  const bool free = !patch && given_stiffness(panel) == nullptr;
  const Vec3 origin = free ? Vec3(displacements.front().head<3>()) : Vec3(Vec3::Zero());
  Eigen::VectorXd u(static_cast<Eigen::Index>(6 * displacements.size()));
  for (std::size_t n = 0; n < displacements.size(); ++n) {
    u.segment<6>(static_cast<Eigen::Index>(6 * n)) = displacements[n];
    u.segment<3>(static_cast<Eigen::Index>(6 * n)) -= origin;
  }
  const Eigen::VectorXd force = patch ? Eigen::VectorXd(shell_stiffness(panel) * u) : membrane_stiffness(panel) * u;
  std::vector<Vec6> forces(displacements.size());
  for (std::size_t n = 0; n < forces.size(); ++n) forces[n] = force.segment<6>(static_cast<Eigen::Index>(6 * n));
  return forces;
}

Vec6 FrameAnswers::reaction(std::size_t support) const {
  return at(support_place_[support]).reaction(support_place_[support].local);
}

Vec6 FrameAnswers::reaction(NodeId node) const {
  Vec6 sum = Vec6::Zero();
  for (std::size_t s = 0; s < support_node_.size(); ++s)
    if (support_node_[s] == node) sum += reaction(s);
  return sum;
}

Vec6 FrameAnswers::reaction(NodeId node, std::size_t edge_support) const {
  Vec6 sum = Vec6::Zero();
  for (std::size_t s = 0; s < support_node_.size(); ++s)
    if (support_node_[s] == node && support_edge_[s] == static_cast<int>(edge_support)) sum += reaction(s);
  return sum;
}

Vec3 FrameAnswers::point_displacement(MemberId member, double distance,
                                      const std::vector<solver::BeamLoad>& loads) const {
  const Place& place = member_place_[index(member)];
  const solver::Reanalysis& analysis = at(place);
  const auto& nodes = analysis.model().beams[static_cast<std::size_t>(place.local)].node;
  return analysis.point_displacement(place.local, distance, analysis.displacements_at(nodes),
                                     with_hinges(member, loads));
}

FrameAnswers::Response FrameAnswers::respond(int component, const ResponseLoads& loads) const {
  return std::move(respond(component, {&loads, 1}).front());
}

FrameAnswers::Response FrameAnswers::respond_near(int component, const ResponseLoads& loads) const {
  return std::move(respond_near(component, {&loads, 1}).front());
}

std::vector<FrameAnswers::Response> FrameAnswers::told(int component, std::vector<solver::Reanalysis::Response> answers,
                                                       const std::vector<char>& known) const {
  std::vector<Response> responses(answers.size());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    responses[i].statics_ = this;
    responses[i].component_ = component;
    responses[i].answer_ = std::move(answers[i]);
    responses[i].known_ = known;
  }
  return responses;
}

std::vector<FrameAnswers::Response> FrameAnswers::respond(int component, std::span<const ResponseLoads> loads) const {
  std::vector<solver::LoadSet> sets;
  for (const ResponseLoads& one : loads) sets.push_back(local(one));
  return told(component, state(component).analysis->respond(sets), {});
}

std::vector<FrameAnswers::Response> FrameAnswers::respond_near(int component,
                                                               std::span<const ResponseLoads> loads) const {
  std::vector<solver::LoadSet> sets;
  for (const ResponseLoads& one : loads) sets.push_back(local(one));
  std::vector<char> known;
  std::vector<solver::Reanalysis::Response> answers = state(component).analysis->respond_near(sets, known);
  return told(component, std::move(answers), known);
}

bool FrameAnswers::Response::known(NodeId node) const {
  return known_.empty() || known_[static_cast<std::size_t>(statics_->node_place_[index(node)].local)] != 0;
}

const Vec6& FrameAnswers::Response::displacement(NodeId node) const {
  return answer_.displacements[static_cast<std::size_t>(statics_->node_place_[index(node)].local)];
}

solver::Vec12 FrameAnswers::Response::end_forces(MemberId member) const {
  const Place& place = statics_->member_place_[index(member)];
  return statics_->at(place).beam_end_forces(place.local, answer_);
}

Vec3 FrameAnswers::Response::point_displacement(MemberId member, double distance,
                                                const std::vector<solver::BeamLoad>& loads) const {
  const Place& place = statics_->member_place_[index(member)];
  return statics_->at(place).point_displacement(place.local, distance, answer_.displacements, loads);
}

}  // namespace topple::structure
