#pragma once
// What stands of a building under random changes, impacts and steps; what it tells of itself, to the bit; and its
// state, saved and loaded at random.
#include <bit>
#include <cstring>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "random_collapse.h"
#include "topple/structure/standing_frame.h"

namespace topple::test {

/// Numbers by what they are, compared to the bit.
class ToldBits {
 public:
  void add(const char* what, double value) { told_.emplace_back(what, std::bit_cast<std::uint64_t>(value)); }
  template <class Number>
  requires std::is_integral_v<Number> || std::is_enum_v<Number>
  void add(const char* what, Number value) { told_.emplace_back(what, static_cast<std::uint64_t>(value)); }
  template <class Tag>
  void add(const char* what, Id<Tag> id) {
    add(what, id.index);
  }
  template <class Derived>
  void add(const char* what, const Eigen::MatrixBase<Derived>& all) {
    add(what, all.rows());
    for (Eigen::Index j = 0; j < all.cols(); ++j)
      for (Eigen::Index i = 0; i < all.rows(); ++i) add(what, all(i, j));
  }
  template <class T>
  void add(const char* what, const std::vector<T>& all) {
    add(what, all.size());
    for (const T& one : all) add(what, one);
  }
  template <class T, std::size_t n>
  void add(const char* what, const std::array<T, n>& all) {
    for (const T& one : all) add(what, one);
  }
  template <class A, class B>
  void add(const char* what, const std::pair<A, B>& both) {
    add(what, both.first);
    add(what, both.second);
  }
  template <class T>
  void add(const char* what, const std::optional<T>& one) {
    add(what, one.has_value());
    if (one) add(what, *one);
  }
  void add(const char* what, const JointBreak& line) {
    add(what, line.joint);
    add(what, line.cause);
    add(what, line.sense);
    add(what, Eigen::Vector3d(line.demand, line.capacity, line.energy));
    add(what, line.generation);
    add(what, line.position);
    add(what, line.inside);
  }
  void add(const char* what, const Detached& part) {
    add(what, part.members);
    add(what, part.panels);
    add(what, part.nodes);
    add(what, part.mechanism);
    add(what, part.hinges);
    add(what, part.cut);
    add(what, part.motion.has_value());
    if (!part.motion) return;
    add(what, part.motion->momentum);
    add(what, part.motion->angular);
    add(what, part.motion->displacement);
  }
  void add(const char* what, const solver::BeamLoad& load) {
    add(what, load.kind);
    add(what, load.first);
    add(what, load.last);
    add(what, Eigen::Vector2d(load.from, load.to));
  }
  /// Empty: the same. Else what is told otherwise first, and which number of all that is.
  [[nodiscard]] std::string difference(const ToldBits& other) const {
    for (std::size_t i = 0; i < std::min(told_.size(), other.told_.size()); ++i)
      if (told_[i] != other.told_[i])
        return std::string(told_[i].first) + ", number " + std::to_string(i) + ": " + number(told_[i].second) +
               ", not " + number(other.told_[i].second);
    return told_.size() == other.told_.size() ? "" : "it tells more";
  }

 private:
  static std::string number(std::uint64_t bits) {
    std::ostringstream text;
    text.precision(17);
    text << bits << " (" << std::bit_cast<double>(bits) << ")";
    return text.str();
  }
  std::vector<std::pair<const char*, std::uint64_t>> told_;
};

/// As it is made.
struct StandingStart {
  Building building;
  FailureRules rules;
  std::optional<MotionRules> motion;  ///< none: from rest to rest
  int selective_from = StandingFrame::default_selective_from;
};

class RandomStanding {
 public:
  explicit RandomStanding(const StandingStart& start)
      : building_(start.building), moves_(start.motion.has_value()), frame_(building_, CombinationId(0u), start.rules) {
    frame_.restrict_answers_from(start.selective_from);
    if (moves_) frame_.let_move(1.0 / 60, *start.motion);
  }

  [[nodiscard]] StandingFrame& frame() { return frame_; }
  [[nodiscard]] std::string saved() const {
    std::ostringstream to;
    frame_.save_state(to);
    return std::move(to).str();
  }
  /// What the other one's frame saved; its building and what its owner knows are taken over.
  void load(const RandomStanding& other, const std::string& bytes) {
    building_ = other.building_;
    remains_ = other.remains_;
    open_step_ = other.open_step_;
    std::istringstream from(bytes);
    frame_.load_state(from);
  }

  /// One change, impact or step, and what it answers.
  void act(RandomNumbers& random, ToldBits& told) {
    switch (random.below(open_step_ ? 12 : 24)) {
      case 0:
        return impact(random, told);
      case 1:
        return hurt_panel(random);
      case 2:
        return lay(random);
      case 3:
        return lay(random);
      case 4: {
        told.add("detached", frame_.extract_detached());
        return told.add("yielded", frame_.extract_yielded());
      }
      case 5:
        return open_step_ ? step(random, told) : weaken(random);
      case 6:
        return open_step_ ? step(random, told) : cut(random);
      case 7:
        return open_step_ ? step(random, told) : push(random);
      default:
        return step(random, told);
    }
  }

  void tell(ToldBits& told) {
    tell_nodes(told);
    tell_members(told);
    tell_panels(told);
    for (std::size_t j = 0; j < building_.joints.size(); ++j) {
      const JointId joint(j);
      told.add("joint holds", frame_.intact(joint));
      if (!frame_.intact(joint)) continue;
      told.add("demand", frame_.demand(joint));
      told.add("utilisation", frame_.utilisation(joint).value);
      told.add("largest utilisation", frame_.largest_utilisation_so_far(joint));
    }
    const FrameEnergy e = frame_.energy();
    const double energies[] = {e.elastic,      e.elastic_at_start, e.gravity_work, e.other_work,
                               e.contact_work, e.dissipated,       e.freed,        e.kinetic,
                               e.damped,       e.numerical,        e.struck};
    for (const double energy : energies) told.add("energy", energy);
    for (const PlasticRotation& turned : frame_.plastic_rotations()) {
      told.add("turned joint", turned.joint);
      told.add("plastic rotation", turned.turned);
    }
    for (const ContactLoad& load : frame_.contact_loads()) {
      told.add("contact load", load.key);
      told.add("contact load", load.force);
    }
    const FrameCounters c = frame_.counters();
    const std::uint64_t counts[] = {c.solves,    c.low_rank,  c.refactorisations,   c.segmentations,
                                    c.unchanged, c.selective, c.background_factors, c.vertices_searched};
    for (const std::uint64_t count : counts) told.add("counter", count);
    told.add("segments", frame_.standing_segments());
    told.add("pending", frame_.pending());
    told.add("in motion", frame_.in_motion());
    told.add("has detached", frame_.has_detached());
  }

 private:
  void tell_nodes(ToldBits& told) {
    for (std::size_t n = 0; n < building_.nodes.size(); ++n) {
      const NodeId node(n);
      told.add("node stands", frame_.stands(node));
      told.add("displacement", frame_.displacement(node));
      told.add("velocity", frame_.velocity(node));
      told.add("node mass", frame_.node_mass(node));
      told.add("node load", frame_.node_load(node));
      told.add("reaction", frame_.reaction(node));
    }
  }
  void tell_members(ToldBits& told) {
    for (std::size_t m = 0; m < building_.members.size(); ++m) {
      const MemberId member(m);
      told.add("segment", frame_.segment(member));
      told.add("end forces", frame_.end_forces(member));
      told.add("member loads", frame_.member_loads(member));
      told.add("internal forces", frame_.internal_forces(member, 2));
    }
  }
  void tell_panels(ToldBits& told) {
    for (std::size_t p = 0; p < building_.panels.size(); ++p) {
      const PanelId panel(p);
      told.add("panel stands", frame_.stands(panel));
      told.add("panel mass", frame_.mass(panel));
      told.add("panel velocity", frame_.motion(panel).velocity);
      told.add("panel spin", frame_.motion(panel).spin);
      if (const auto stress = frame_.stress(panel))
        told.add("stress", Eigen::Vector2d(stress->tension, stress->compression));
      if (frame_.stands(panel) && building_.panels[p].model == PanelModel::shell)
        told.add("shell stiffness", frame_.shell_stiffness(panel));
    }
  }

  /// On a member or panel that stands; none may be found.
  std::optional<ContactPlace> place(RandomNumbers& random) {
    for (int trial = 0; trial < 5; ++trial) {
      const auto member = random.one_of<MemberId>(building_.members.size());
      if (!building_.panels.empty() && random.below(2) == 0) {
        const auto panel = random.one_of<PanelId>(building_.panels.size());
        const auto& nodes = building_[panel].nodes;
        const double s = random.from(0.1, 0.9), t = random.from(0.1, 0.9);
        const auto at = [&](std::size_t n) { return building_[nodes[n]].position; };
        if (frame_.stands(panel))
          return ContactPlace{{}, panel, (1 - t) * ((1 - s) * at(0) + s * at(1)) + t * (s * at(2) + (1 - s) * at(3))};
      } else if (const double s = random.from(0, 1); frame_.stands(member)) {
        const auto& nodes = building_[member].nodes;
        return ContactPlace{member, {}, (1 - s) * building_[nodes[0]].position + s * building_[nodes[1]].position};
      }
    }
    return std::nullopt;
  }
  static Vec3 direction(RandomNumbers& random) {
    return Vec3(random.from(-1, 1), random.from(-1, 1), random.from(-1, 0.2)).normalized();
  }

  void step(RandomNumbers& random, ToldBits& told) {
    if (!moves_) return told.add("breaks", frame_.settle(random.below(3) == 0 ? 1000 : 1 + random.below(3)));
    if (open_step_) {
      if (frame_.in_motion() && random.below(3) != 0) return frame_.move_on();
      open_step_ = false;
      return told.add("breaks", frame_.end_move());
    }
    if (random.below(3) != 0) {
      for (int n = random.below(8); n >= 0; --n) told.add("breaks", frame_.move());
      return;
    }
    open_step_ = true;
    told.add("breaks", frame_.begin_move());
  }
  void weaken(RandomNumbers& random) {
    const auto joint = random.one_of<JointId>(building_.joints.size());
    switch (random.below(4)) {
      case 0:
        return frame_.set_strength_factor(joint, random.from(0.2, 1));
      case 1:
        return frame_.set_stiffness_factor(random.one_of<MemberId>(building_.members.size()), random.from(0.1, 1));
      default:
        if (!building_.joints[static_cast<std::size_t>(joint.index)].capacity.breakable && random.below(2) == 0) return;
        JointCapacity& capacity = building_.joints[static_cast<std::size_t>(joint.index)].capacity;
        if (!capacity.breakable) capacity.value.fill(2e5);
        capacity.breakable = true;
        for (double& value : capacity.value) value *= random.from(0.5, 1.2);
        return frame_.capacity_changed(joint);
    }
  }
  void cut(RandomNumbers& random) {
    const auto joint = random.one_of<JointId>(building_.joints.size());
    switch (random.below(6)) {
      case 0:
        return frame_.remove(random.one_of<MemberId>(building_.members.size()));
      case 1:
        if (!building_.panels.empty()) frame_.remove(random.one_of<PanelId>(building_.panels.size()));
        return;
      case 2:
        return frame_.remove_support(
            building_.supports[static_cast<std::size_t>(random.below(static_cast<int>(building_.supports.size())))]
                .node);
      default:
        if (frame_.intact(joint)) frame_.break_joint(joint, BreakCause::tool);
    }
  }
  void push(RandomNumbers& random) {
    if (random.below(8) == 0) return frame_.set_gravity(building_.gravity * Vec3(random.from(-0.1, 0.1), 0, -1));
    Vec6 load = Vec6::Zero();
    load(random.below(3)) = random.from(-5e4, 5e4);
    frame_.add_load(random.one_of<NodeId>(building_.nodes.size()), load);
  }
  void lay(RandomNumbers& random) {
    ContactLoad load;
    load.key = random.below(4);
    if (random.below(4) == 0) return frame_.remove_contact_load(load.key);
    const std::optional<ContactPlace> at = place(random);
    if (!at) return;
    load.place = *at;
    load.force = Vec3(0, 0, random.from(-3e4, 0));
    frame_.set_contact_load(load);
  }
  /// A rectangle more of it is gone, in the axes of the panel.
  void hurt_panel(RandomNumbers& random) {
    if (building_.panels.empty()) return;
    const auto panel = random.one_of<PanelId>(building_.panels.size());
    const Panel& own = building_[panel];
    const Vec3 across = own.axes * (building_[own.nodes[2]].position - building_[own.nodes[0]].position);
    PanelRemains& remains = remains_[panel];
    const int column = static_cast<int>(remains.holes.size());
    if (random.below(3) == 0) return frame_.expect_fracture(panel);
    if (!frame_.stands(panel) || column > 4) return;
    const double x = across.x() * (0.02 + 0.2 * column), y = across.y() * random.from(0.1, 0.5);
    const double width = 0.15 * across.x(), height = 0.35 * across.y();
    remains.holes.push_back({{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}});
    remains.share -= 0.15 * 0.35;
    for (std::size_t edge = 0; edge < 4; ++edge)
      remains.edge_length[edge] =
          (building_[own.nodes[(edge + 1) % 4]].position - building_[own.nodes[edge]].position).norm();
    std::optional<Vec3> taken;
    if (random.below(2) == 0) taken = 10 * direction(random);
    frame_.fracture(panel, remains, taken);
  }
  void impact(RandomNumbers& random, ToldBits& told) {
    const std::optional<ContactPlace> at = place(random);
    const Vec3 along = direction(random);
    const double impulse = random.from(10, 3000);
    const int more = random.below(4);
    if (!at) return;
    if (moves_) return impact_in_motion(*at, along, impulse, more, told);
    if (frame_.pending()) return;
    const StandingFrame::UnitResponse response =
        more == 0 ? frame_.respond_near(*at, along) : frame_.respond(*at, along);
    told.add("compliance", response.compliance);
    told.add("Rayleigh mass", response.rayleigh_mass);
    told.add("demands of a push", response.demands);
    told.add("critical energy", frame_.critical_energy(*at));
    if (more != 1 || response.demands.empty()) return;
    JointBreak broken;
    broken.joint = response.demands.front().first;
    if (frame_.intact(broken.joint)) told.add("shift", frame_.break_in_impact({&broken, 1}, *at, along));
  }
  void impact_in_motion(const ContactPlace& at, const Vec3& along, double impulse, int more, ToldBits& told) {
    const StandingFrame::HeldResponse pushed = frame_.respond_held({&at, 1}, {&along, 1});
    told.add("mobility", pushed.mobility);
    told.add("held compliance", pushed.compliance);
    told.add("speed", pushed.speed);
    told.add("local modes", pushed.squared);
    told.add("work", frame_.strike(pushed, Eigen::VectorXd::Constant(1, impulse)));
    if (more == 0 && !pushed.hinges.empty()) {
      const StandingFrame::HeldResponse::Hinge& hinge = pushed.hinges.front();
      const StandingFrame::ImpactTurn turn{hinge.joint, hinge.axis, 0.05 * hinge.limit,
                                           0.05 * hinge.limit * hinge.capacity};
      told.add("work of a turn", frame_.turn_in_impact({&turn, 1}));
    }
    if (more == 1 && !pushed.demands.empty()) {
      JointBreak broken;
      broken.joint = pushed.demands.front().first;
      frame_.break_in_impact({&broken, 1});
    }
  }

  Building building_;
  bool moves_;
  StandingFrame frame_;
  std::map<PanelId, PanelRemains> remains_;
  bool open_step_ = false;
};

}  // namespace topple::test
