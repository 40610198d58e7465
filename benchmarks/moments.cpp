// A collapse beside the same moments held up and moved by a rigid body engine alone: writes what stands and what lies
// or flies at such moments as boxes and the joints that are left (baseline/scene.h), and what a step took us there.
//   bench_moments SCENARIO EVERY FOLDER
// EVERY: simulated seconds from moment to moment. Prints a line for each: seconds, awake bodies, milliseconds of a step
// (median of those around it) with and without the collision engine, the file.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <map>
#include <numeric>

#include "support/rigid_bodies.h"
#include "topple/solver/blas_kernel.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

namespace {

using namespace topple;
using namespace topple::bench;

constexpr std::size_t steps_around = 5;  ///< on each side of a moment

/// How a part has moved from where it stood, and how it moves now.
struct Motion {
  Mat3 turn = Mat3::Identity();
  Vec3 from = Vec3::Zero(), to = Vec3::Zero(), velocity = Vec3::Zero(), spin = Vec3::Zero();
  bool asleep = true;
};

/// Poses of all bodies by handle: two in succession tell velocities.
using Poses = std::map<std::int64_t, collision::Pose>;

Poses poses_of(const Simulation& simulation) {
  Poses poses;
  for (const BodyView& body : simulation.bodies()) poses[body.id.value] = body.pose;
  return poses;
}

Motion motion_of(const BodyView& body, const Poses& before, double step) {
  Motion motion;
  motion.turn = body.pose.orientation.toRotationMatrix();
  motion.from = body.rest_centre;
  motion.to = body.pose.position;
  motion.asleep = body.asleep;
  const auto was = before.find(body.id.value);
  if (was == before.end() || body.asleep) return motion;
  const Eigen::AngleAxisd turned(body.pose.orientation * was->second.orientation.conjugate());
  motion.velocity = (body.pose.position - was->second.position) / step;
  motion.spin = turned.axis() * (turned.angle() / step);
  return motion;
}

class MomentWriter {
 public:
  MomentWriter(const Simulation& simulation, const Poses& before, std::ostream& out)
      : simulation_(simulation), building_(simulation.building()), out_(out) {
    for (const BodyView& body : simulation.bodies())
      motions_[body.id.value] = motion_of(body, before, simulation.scenario().step);
  }

  void run() {
    out_ << std::setprecision(17) << "gravity " << building_.gravity << "\nground " << ground() << '\n';
    const PartLoads loads = part_loads(building_, simulation_.scenario().combination.value());
    for (const std::size_t i : members_in_order(building_)) {
      const Member& member = building_.members[i];
      place(simulation_.body_of(MemberId(i)), member_body(building_, member, total(loads.members[i], member.axes)));
    }
    for (std::size_t i = 0; i < building_.panels.size(); ++i) {
      place(simulation_.body_of(PanelId(i)), panel_body(building_, building_.panels[i], loads.panels[i]));
    }
    pieces();
    joints();
  }

 private:
  [[nodiscard]] double ground() const {
    double lowest = 1e300;
    for (const NodeSupport& support : building_.supports)
      lowest = std::min(lowest, position(building_, support.node).z());
    return simulation_.scenario().ground.value_or(lowest);
  }

  /// `body` stands in its place, or goes with `carrier`; nothing for what is gone.
  void place(collision::BodyId carrier, Body body) {
    constexpr std::int64_t stands = -1;
    numbers_[body.name] = -1;
    if (carrier.value < stands) return;
    Motion motion;
    if (carrier.value >= 0) motion = motions_.at(carrier.value);
    numbers_[body.name] = count_++;
    const Vec3 arm = motion.turn * (body.centre - motion.from);
    body.centre = motion.to + arm;
    body.axes = body.axes * motion.turn.transpose();
    write(body, out_);
    state(motion, motion.velocity + motion.spin.cross(arm));
  }

  void state(const Motion& motion, const Vec3& velocity) {
    out_ << "state " << count_ - 1 << ' ' << velocity.transpose() << ' ' << motion.spin.transpose() << ' '
         << (motion.asleep ? 1 : 0) << '\n';
  }

  /// Balls, and chunks as the boxes around them.
  void pieces() {
    for (const BodyView& view : simulation_.bodies()) {
      if (!view.members.empty() || !view.panels.empty()) continue;
      const Motion& motion = motions_.at(view.id.value);
      Body body;
      body.name = "piece_" + std::to_string(view.id.value);  // names may have spaces
      body.mass = view.mass;
      body.centre = view.pose.position;
      body.axes = motion.turn.transpose();
      body.half_extents = Vec3::Constant(view.radius);
      if (view.chunk) {
        Eigen::AlignedBox3d box;
        for (const auto& at : view.chunk->positions) box.extend(Vec3(at[0], at[1], at[2]));
        body.half_extents = box.sizes() / 2;
        body.centre += motion.turn * box.center();
      }
      ++count_;
      write(body, out_);
      if (view.radius > 0) out_ << "ball " << count_ - 1 << '\n';
      state(motion, motion.velocity);
    }
  }

  void joint(const std::string& name, const std::string& part, const std::string& other, const Vec3& point) {
    const int a = numbers_.at(part), b = other.empty() ? -1 : numbers_.at(other);
    if (a >= 0 && (other.empty() || b >= 0))
      out_ << "joint " << name << ' ' << a << ' ' << b << ' ' << point.transpose() << " 0\n";
  }

  [[nodiscard]] Vec3 moved(collision::BodyId carrier, const Vec3& point) const {
    if (carrier.value < 0) return point;
    const Motion& motion = motions_.at(carrier.value);
    return motion.to + motion.turn * (point - motion.from);
  }

  /// As bench_scene joins them, where both sides still go together and the joint has not broken.
  void joints() {
    visit_member_joints(building_, [&](MemberId id, int end, MemberId below, const Vec3& point) {
      const collision::BodyId carrier = simulation_.body_of(id);
      const collision::BodyId other = below.valid() ? simulation_.body_of(below) : collision::BodyId{-1};
      if (other != carrier || !simulation_.frame().intact(building_.joint(id, end))) return;
      const std::string& name = building_[id].name;
      joint(joint_name(name, end), name, below.valid() ? building_[below].name : "", moved(carrier, point));
    });
    visit_panel_joints(building_, [&](PanelId id, int edge, MemberId along, const Vec3& middle) {
      const collision::BodyId carrier = simulation_.body_of(id);
      if (simulation_.body_of(along) != carrier || !simulation_.frame().intact(building_.joint(id, edge))) return;
      const std::string& name = building_[id].name;
      joint(joint_name(name, edge), name, building_[along].name, moved(carrier, middle));
    });
  }

  const Simulation& simulation_;
  const Building& building_;
  std::ostream& out_;
  std::map<std::int64_t, Motion> motions_;
  std::map<std::string, int> numbers_;  ///< of bodies in the scene; -1: gone
  int count_ = 0;
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Seconds of the steps, of which the middle one is the moment.
struct Around {
  std::vector<double> whole, own;
  void take(const Simulation& simulation) {
    const auto& stages = simulation.stage_seconds();
    whole.push_back(std::accumulate(stages.begin(), stages.end(), 0.0));
    own.push_back(whole.back() - simulation.collision_engine_seconds());
  }
};

void follow(const std::string& name, double every, const std::string& folder) {
  auto [building, scenario] = read_scenario(find_scenario(name));
  Simulation simulation(std::move(building), std::move(scenario));
  for (int number = 1; !simulation.finished(); ++number) {
    const double moment = number * every;
    Around around;
    const double step = simulation.scenario().step;
    while (!simulation.finished() && simulation.time() < moment - (steps_around + 0.5) * step) simulation.step();
    Poses before;
    for (std::size_t i = 0; i < steps_around && !simulation.finished(); ++i) {
      before = poses_of(simulation);
      simulation.step();
      around.take(simulation);
    }
    if (simulation.finished()) return;
    const std::string path = folder + "/moment_" + std::to_string(number) + ".txt";
    std::ofstream file(path);
    MomentWriter(simulation, before, file).run();
    if (!file.flush()) throw std::runtime_error(path + ": cannot be written");
    const double time = simulation.time();
    std::size_t awake = 0;
    for (const BodyView& body : simulation.bodies()) awake += body.asleep ? 0 : 1;
    for (std::size_t i = 0; i < steps_around && !simulation.finished(); ++i) {
      simulation.step();
      around.take(simulation);
    }
    std::printf("%g %zu %g %g %s\n", time, awake, 1e3 * median(around.whole), 1e3 * median(around.own), path.c_str());
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  solver::prepare_blas(argv);
  try {
    if (argc != 4 || !(std::atof(argv[2]) > 0)) {
      std::fprintf(stderr, "usage: bench_moments SCENARIO EVERY FOLDER, EVERY in seconds, above zero\n");
      return 2;
    }
    follow(argv[1], std::atof(argv[2]), argv[3]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
