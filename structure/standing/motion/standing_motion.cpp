#include "standing/motion/standing_motion.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "model/index_of.h"
#include "standing/motion/moving_component.h"

namespace topple::structure {
namespace {

std::vector<solver::FrameDynamics::Impulse> numbered(const FrameStatics& statics,
                                                     const StandingMotion::NodalForces& forces) {
  std::vector<solver::FrameDynamics::Impulse> impulses;
  for (const auto& [node, force] : forces) impulses.push_back({statics.number(node), force});
  return impulses;
}

std::vector<std::vector<solver::FrameDynamics::Impulse>> numbered(const FrameStatics& statics,
                                                                  std::span<const StandingMotion::NodalForces> forces) {
  std::vector<std::vector<solver::FrameDynamics::Impulse>> pushes;
  for (const StandingMotion::NodalForces& one : forces) pushes.push_back(numbered(statics, one));
  return pushes;
}

}  // namespace

StandingMotion::StandingMotion(const MotionSources& sources, const MotionSettings& settings)
    : from_(sources),
      settings_(settings),
      masses_(sources.building, sources.loads, sources.parts.bearings),
      model_(sources, masses_),
      damping_(sources, model_, settings),
      momentum_(sources, masses_, *this) {}
StandingMotion::~StandingMotion() { forget_all(); }

void StandingMotion::forget_all() {
  for (const auto& [c, moving] : moving_) from_.statics.follow(c, nullptr);
  moving_.clear();
}

std::vector<int> StandingMotion::moving() const {
  std::vector<int> components;
  for (const auto& [c, moving] : moving_) components.push_back(c);
  return components;
}

int StandingMotion::set_step(double dt) {
  constexpr double rounding = 1e-9;
  const int count = std::max(1, static_cast<int>(std::ceil(dt / settings_.longest_substep - rounding)));
  const double substep = dt / count;
  if (substep != substep_ && any()) throw std::logic_error("the length of substeps changes while something moves");
  substep_ = substep;
  return count;
}

const solver::FrameDynamics* StandingMotion::frame(int component) const {
  const auto found = moving_.find(component);
  return found == moving_.end() ? nullptr : found->second->frame.get();
}

void StandingMotion::remember_motion(PanelId id) {
  const auto found = moving_.find(from_.components.of(id));
  if (found == moving_.end() || from_.building[id].model != PanelModel::shell ||
      found->second->changed_shells.contains(id))
    return;
  std::vector<Vec6> at_nodes;
  for (const NodeId node : from_.building[id].all_nodes()) at_nodes.push_back(velocity(node));
  Moving::ChangedShell& changed = found->second->changed_shells[id];
  changed.motion = from_.shells.of(id)->motion(at_nodes);
  changed.had = momentum_.of(id).head<3>();
}

void StandingMotion::give_to_chunks(PanelId id, const Vec3& momentum) {
  const auto found = moving_.find(from_.components.of(id));
  if (found == moving_.end()) return;
  if (from_.building[id].model != PanelModel::shell) {
    to_chunks_.try_emplace(id, Vec3::Zero()).first->second += momentum;
    return;
  }
  remember_motion(id);
  Moving::ChangedShell& changed = found->second->changed_shells.at(id);
  changed.gave = changed.gave.value_or(Vec3::Zero()) + momentum;
}

void StandingMotion::update_mass(PanelId id) {
  const auto found = moving_.find(from_.components.of(id));
  if (found == moving_.end() || from_.building[id].model != PanelModel::shell) return;
  solver::FrameDynamics& frame = *found->second->frame;
  const int number = from_.statics.number(id);
  if (!from_.statics.stiff(id)) {  // it takes along what it has
    const Eigen::Index size = from_.statics.shell_stiffness(id).rows();
    frame.set_patch_mass(number, Eigen::MatrixXd::Zero(size, size));
    found->second->changed_shells.erase(id);
    return;
  }
  const Eigen::MatrixXd mass = model_.mass(id);
  if (const auto changed = found->second->changed_shells.find(id); changed != found->second->changed_shells.end()) {
    const std::vector<NodeId> nodes = from_.building[id].all_nodes();
    Eigen::VectorXd now(mass.rows());
    for (std::size_t n = 0; n < nodes.size(); ++n)
      now.segment<6>(static_cast<Eigen::Index>(6 * n)) = velocity(nodes[n]);
    Moving::ChangedShell& own = changed->second;
    own.impulses = from_.shells.of(id)->momentum(model_.kilograms(id), own.motion);
    if (own.gave) {  // it moves on by as much more as evens out what chunks took
      Vec3 more = own.had - *own.gave;
      for (std::size_t n = 0; n < nodes.size(); ++n) more -= own.impulses.segment<3>(static_cast<Eigen::Index>(6 * n));
      Eigen::VectorXd even = Eigen::VectorXd::Zero(mass.rows());
      for (std::size_t n = 0; n < nodes.size(); ++n)
        even.segment<3>(static_cast<Eigen::Index>(6 * n)) = more / model_.kilograms(id);
      own.impulses += mass * even;
    }
    own.impulses -= mass * now;
  }
  frame.set_patch_mass(number, mass);
}

void StandingMotion::pass_on_motion(int c) {
  Moving& moving = *moving_.at(c);
  if (moving.changed_shells.empty()) return;
  NodalForces impulses;
  for (const auto& [id, changed] : std::exchange(moving.changed_shells, {})) {
    if (changed.impulses.size() == 0) continue;
    const std::vector<NodeId> nodes = from_.building[id].all_nodes();
    for (std::size_t n = 0; n < nodes.size(); ++n)
      impulses.emplace_back(nodes[n], changed.impulses.segment<6>(static_cast<Eigen::Index>(6 * n)));
  }
  moving.frame->add_impulses(numbered(from_.statics, impulses));
}

void StandingMotion::store_plastic_rotations(int c, const Moving& moving) const {
  const std::vector<PlasticHinge>& hinges = from_.yielding.hinges(c);
  for (std::size_t h = 0; h < hinges.size(); ++h) {
    const Joint& own = from_.building[hinges[h].joint];
    if (!from_.parts.standing(hinges[h].joint)) continue;
    const double turned =
        moving.frame->plastic_rotations(from_.statics.number(own.member))(6 * own.end + hinges[h].axis);
    if (turned == hinges[h].plastic_rotation) continue;
    const double held = std::copysign(from_.yielding.capacity(hinges[h]), turned - hinges[h].plastic_rotation);
    from_.yielding.turned_in_motion(c, h, turned, held);
  }
}

void StandingMotion::make_frame(int c, Moving& moving) const {
  const auto& [model, masses, damping] = moving.beginning;
  solver::DynamicOptions options;
  options.substep = substep_;
  options.spectral_radius = settings_.spectral_radius;
  options.shortest_impulse = settings_.shortest_impulse;
  options.largest_error = settings_.substep_error;
  options.most_parts = settings_.substep_parts;
  options.beams_vibrate = true;
  options.analysis.threads = from_.threads;
  options.damping = damping;
  options.second_order = from_.second_order;
  moving.frame = std::make_unique<solver::FrameDynamics>(model, masses, options);
  moving.law = std::make_unique<MovingLaw>(from_, c);
}

void StandingMotion::start(int c) {
  if (moves(c)) return;
  const std::vector<Vec6> rest = model_.at_rest(c);

  auto made = std::make_unique<Moving>();
  Moving& moving = *made;
  auto& [model, masses, damping] = moving.beginning;
  model = model_.frame(c);
  masses = model_.node_masses(c);
  damping = damping_.start(c, model, masses, rest);
  make_frame(c, moving);
  model_.lay_on(c, *moving.frame);
  moving.frame->set_state(rest, std::vector<Vec6>(rest.size(), Vec6::Zero()));
  moving.elastic_at_start = moving.frame->energy().elastic;
  moving.between_nodes = from_.account.elastic_at_rest(c) - moving.elastic_at_start;
  for (const MemberId member : from_.statics.members(c)) moving.mass.push_back(masses_.of(member));
  from_.statics.follow(c, moving.frame.get());
  moving_.emplace(c, std::move(made));
  ++starts_;
}

void StandingMotion::stop(int c) {
  const auto found = moving_.find(c);
  if (found == moving_.end()) return;
  const Moving& moving = *found->second;
  const solver::DynamicEnergy& own = moving.frame->energy();
  const std::vector<NodeId>& nodes = from_.statics.nodes(c);
  const bool stands =
      std::any_of(nodes.begin(), nodes.end(), [&](NodeId node) { return from_.node_solved[index_of(node)] != 0; });
  // All that it had went with what left.
  if (!stands) past_.freed += own.kinetic + own.elastic + moving.between_nodes;
  past_.damped += own.damped;
  past_.numerical += own.numerical;
  // Where it comes to rest the account of rest has the works of its loads, but those of what left. Where nothing of it
  // stands any more nobody else has them.
  past_.external_work += stands ? moving.left_work : own.external_work;
  past_.struck += own.struck;
  past_.freed += own.freed;
  past_.dissipated += own.dissipated;
  past_changes_ += moving.frame->counters().changes + moving.yield_changes + 1;
  from_.statics.follow(c, nullptr);
  moving_.erase(found);
}

std::uint64_t StandingMotion::changes() const {
  std::uint64_t sum = starts_ + past_changes_;
  for (const auto& [c, moving] : moving_) sum += moving->frame->counters().changes + moving->yield_changes;
  return sum;
}

void StandingMotion::update_masses() {
  const auto bring = [&](const std::vector<std::pair<MemberId, Vec6>>& to_members) {
    Vec3 sum = Vec3::Zero();
    for (const auto& [member, momentum] : to_members) {
      moving_.at(from_.statics.component(member))->frame->add_momentum(from_.statics.number(member), momentum);
      sum += momentum.head<3>();
    }
    return sum;
  };
  for (const MotionMasses::Rehung& panel : masses_.update()) {
    const bool stands = from_.parts.stands(panel.panel);
    const Vec3 brought = stands ? bring(momentum_.brought(panel)) : Vec3(Vec3::Zero());
    const auto gave = to_chunks_.find(panel.panel);
    if (gave == to_chunks_.end()) continue;
    (void)bring(momentum_.shared(panel, momentum_.given_up(panel) - brought - gave->second));
  }
  to_chunks_.clear();
  for (auto& [c, one] : moving_) {
    Moving& moving = *one;
    const std::vector<MemberId>& members = from_.statics.members(c);
    for (std::size_t b = 0; b < members.size(); ++b) {
      const double mass = masses_.of(members[b]);
      if (mass == moving.mass[b] || !from_.parts.stands(members[b])) continue;
      moving.mass[b] = mass;
      const solver::Beam& beam = moving.frame->model().beams[b];
      moving.frame->set_beam_density(static_cast<int>(b), std::max(0.0, mass) / (beam.area * beam.length));
    }
  }
}

std::vector<StandingMotion::Break> StandingMotion::advance(int c) {
  pass_on_motion(c);
  Moving& moving = *moving_.at(c);
  const double freed = moving.frame->energy().freed;
  std::vector<solver::PlasticHinge> hinges;
  for (const PlasticHinge& hinge : from_.yielding.hinges(c)) {
    const Joint& own = from_.building[hinge.joint];
    if (from_.parts.standing(hinge.joint))
      hinges.push_back(
          {from_.statics.number(own.member), own.end, hinge.axis, from_.yielding.capacity(hinge), hinge.limit});
  }
  moving.law->set_hinges(std::move(hinges));
  const std::uint64_t yielded = moving.frame->counters().yielding;
  const std::vector<solver::JointBreak>& broken = moving.frame->advance(moving.law.get());
  const bool yields = moving.frame->counters().yielding != yielded;
  if (std::exchange(moving.yields, yields) != yields) ++moving.yield_changes;
  store_plastic_rotations(c, moving);
  std::vector<Break> breaks;
  for (const solver::JointBreak& one : broken) {
    const MemberId member = from_.statics.members(c)[static_cast<std::size_t>(one.beam)];
    breaks.push_back({from_.building.joint(member, one.end), member_joint_demand(one.forces, one.end), one.time, 0});
  }
  for (Break& one : breaks) one.freed = (moving.frame->energy().freed - freed) / static_cast<double>(breaks.size());
  return breaks;
}

const Vec6& StandingMotion::displacement(NodeId node) const {
  const Moving& moving = *moving_.at(from_.statics.component(node));
  return moving.frame->displacements()[static_cast<std::size_t>(from_.statics.number(node))];
}

Vec6 StandingMotion::velocity(NodeId node) const {
  const solver::FrameDynamics* own = frame(from_.statics.component(node));
  if (own == nullptr) return Vec6::Zero();
  return own->velocities()[static_cast<std::size_t>(from_.statics.number(node))];
}

solver::Vec12 StandingMotion::end_forces(MemberId member) const {
  return moving_.at(from_.statics.component(member))->frame->beam_end_forces(from_.statics.number(member));
}

solver::Vec12 StandingMotion::ends(MemberId member) const {
  return moving_.at(from_.statics.component(member))->frame->beam_ends(from_.statics.number(member));
}

Vec6 StandingMotion::reaction(NodeId node, std::size_t support) const {
  return moving_.at(from_.statics.component(node))->frame->reaction(from_.statics.support_number(support));
}

std::array<Vec6, 4> StandingMotion::corner_forces(PanelId membrane) const {
  return moving_.at(from_.components.of(membrane))->frame->shell_corner_forces(from_.statics.number(membrane));
}

Eigen::MatrixXd StandingMotion::mobility(int c, std::span<const NodalForces> forces) const {
  return moving_.at(c)->frame->mobility(numbered(from_.statics, forces));
}

Eigen::MatrixXd StandingMotion::substep_mobility(int c, std::span<const NodalForces> forces) const {
  if (moving_.at(c)->yields) return mobility(c, forces);
  return moving_.at(c)->frame->substep_mobility(numbered(from_.statics, forces));
}

const Vec6& StandingMotion::foreseen_acceleration(NodeId node) {
  const int c = from_.statics.component(node);
  pass_on_motion(c);
  return moving_.at(c)->frame->foresee()[static_cast<std::size_t>(from_.statics.number(node))];
}

StandingMotion::LocalMotion StandingMotion::local_motion(int c, std::span<const NodalForces> forces) const {
  std::vector<int> nodes;
  std::vector<std::vector<solver::FrameDynamics::Impulse>> pushes;
  const auto pushed = [&](int node) { return std::find(nodes.begin(), nodes.end(), node) != nodes.end(); };
  for (const NodalForces& one : forces) {
    pushes.push_back(numbered(from_.statics, one));
    for (const solver::FrameDynamics::Impulse& force : pushes.back())
      if (!pushed(force.node)) nodes.push_back(force.node);
  }
  LocalMotion local{moving_.at(c)->frame->local_modes(nodes, pushes), {}};
  for (const auto& [beam, end_forces] : local.modes.end_forces) {
    const MemberId member = from_.statics.members(c)[static_cast<std::size_t>(beam)];
    for (int end = 0; end < 2; ++end) {
      const JointId joint = from_.building.joint(member, end);
      if (!from_.building[joint].capacity.breakable || !from_.parts.standing(joint) ||
          !pushed(from_.statics.number(from_.building[member].nodes[static_cast<std::size_t>(end)])))
        continue;
      Eigen::Matrix<double, 6, Eigen::Dynamic> columns(6, end_forces.cols());
      for (Eigen::Index k = 0; k < end_forces.cols(); ++k) columns.col(k) = member_joint_demand(end_forces.col(k), end);
      local.demands.emplace_back(joint, std::move(columns));
    }
  }
  return local;
}

double StandingMotion::strike(int c, const NodalForces& impulses) {
  pass_on_motion(c);
  solver::FrameDynamics& frame = *moving_.at(c)->frame;
  const double before = frame.energy().struck;
  frame.strike(numbered(from_.statics, impulses));
  return frame.energy().struck - before;
}

double StandingMotion::turn_at_once(int c, std::size_t number, double turn, double dissipated) {
  const Moving& moving = *moving_.at(c);
  const PlasticHinge& hinge = from_.yielding.hinges(c)[number];
  const Joint& own = from_.building[hinge.joint];
  const double before = moving.frame->energy().struck;
  moving.frame->turn_at_once(from_.statics.number(own.member), own.end, hinge.axis, turn, dissipated);
  store_plastic_rotations(c, moving);
  return moving.frame->energy().struck - before;
}

double StandingMotion::largest_turn(int c) const {
  const std::vector<Vec6>& u = moving_.at(c)->frame->displacements();
  double largest = 0;
  for (const MemberId id : from_.statics.members(c)) {
    if (!from_.parts.stands(id)) continue;
    const Member& member = from_.building[id];
    // A rigid end that holds the member no more says nothing of where its end is.
    const bool first = from_.parts.holds(from_.building.joint(id, 0)),
               second = from_.parts.holds(from_.building.joint(id, 1));
    const auto at = [&](std::size_t end) -> const Vec6& {
      return u[static_cast<std::size_t>(from_.statics.number(member.nodes[end]))];
    };
    if (first && second) {
      const Vec3 apart = member.axes * Vec3(at(1).head<3>() - at(0).head<3>());
      largest = std::max(largest, apart.tail<2>().norm() / member.length);
    } else if (first || second) {
      largest = std::max(largest, at(first ? 0 : 1).tail<3>().norm());
    }
  }
  return largest;
}

void StandingMotion::update_damping(int c) {
  if (const solver::RayleighDamping* const anew = damping_.update(c)) moving_.at(c)->frame->set_damping(*anew);
}

double StandingMotion::last_turn(int c) const { return moving_.at(c)->turned; }

void StandingMotion::damp_by_mass(int c, double turn) {
  Moving& moving = *moving_.at(c);
  const bool falls = turn > settings_.falling_turn && turn > moving.turned;
  moving.turned = turn;
  moving.frame->set_mass_damping(falls ? 0 : damping_.of(c).mass);
}

}  // namespace topple::structure
