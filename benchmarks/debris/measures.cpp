#include "measures.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>

namespace topple::bench {

namespace {

using collision::BodyState, collision::World;
using Eigen::Vector3d;

constexpr int kLook = 6;                // steps from look to look at overlaps
constexpr double kSlow = 0.02;          // m/s
constexpr double kWorthTelling = 0.01;  // m that everything falls: less is no fall, and its share says nothing

/// ms; the processor's: of all threads of this program.
double time_by(StepTime by) {
  timespec time{};
  clock_gettime(by == StepTime::clock ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// FNV-1a.
class Bits {
 public:
  void add(const BodyState& state) {
    add(state.pose.position.data(), 3);
    add(state.pose.orientation.coeffs().data(), 4);
    add(state.velocity.data(), 3);
    add(state.angular_velocity.data(), 3);
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  void add(const double* numbers, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      std::uint64_t word = 0;
      std::memcpy(&word, numbers + i, sizeof word);
      for (int byte = 0; byte < 8; ++byte) value_ = (value_ ^ (word >> (8 * byte) & 255)) * 1099511628211U;
    }
  }
  std::uint64_t value_ = 14695981039346656037U;
};

/// Times and bits of a run; `before` and `after` are called around each step.
template <class Before, class After>
DebrisMeasures run_scene(DebrisRun& run, const DebrisScene& scene, StepTime by, const Before& before,
                         const After& after) {
  const int steps = static_cast<int>(std::lround(scene.seconds / kDebrisStep));
  std::vector<double> times;
  Bits bits;
  DebrisMeasures measured;
  for (int k = 0; k < steps; ++k) {
    const bool added = run.begin_step(k);
    before(added);
    const bool awake = run.world().awake_count() > 0;
    const double begun = time_by(by);
    run.step();
    if (awake) times.push_back(time_by(by) - begun);
    for (const collision::BodyId id : run.bodies()) bits.add(run.world().state(id));
    after(k);
  }
  measured.bodies = run.bodies().size();
  measured.bits = bits.value();
  measured.awake_steps = times.size();
  if (times.empty()) return measured;
  std::sort(times.begin(), times.end());
  measured.milliseconds = times[times.size() / 2];
  measured.worst_milliseconds = times.back();
  return measured;
}

std::vector<PlacedSolid> placed(const DebrisScene& scene, DebrisRun& run) {
  std::vector<PlacedSolid> bodies;
  for (std::size_t i = 0; i < run.bodies().size(); ++i) {
    const BodyState state = run.world().state(run.bodies()[i]);
    bodies.emplace_back(scene.shapes[scene.falling[i].shape], state.pose.position, state.pose.orientation);
  }
  return bodies;
}

std::vector<PlacedSolid> placed_standing(const DebrisScene& scene) {
  std::vector<PlacedSolid> standing;
  for (const StandingSolid& one : scene.standing)
    standing.emplace_back(scene.shapes[one.shape], one.position, Eigen::Quaterniond::Identity());
  return standing;
}

/// Energy of motion and height of all that is there, J, and how fast it goes.
class Energies {
 public:
  explicit Energies(const DebrisScene& scene) : scene_(scene) {}
  /// Before a step: what came with new bodies is no gain.
  void begin(DebrisRun& run, bool added) {
    if (!added) return;
    const double now = of(run);
    put_in_ += now - last_;
    last_ = now;
  }
  void end(DebrisRun& run) {
    const double now = of(run);
    created_ += std::max(0.0, now - last_);
    last_ = now;
  }
  [[nodiscard]] double mean_speed() const { return speed_; }
  [[nodiscard]] double mean_height() const { return height_; }
  [[nodiscard]] std::optional<double> created() const {
    const double taken_out = put_in_ - last_;
    if (taken_out < kWorthTelling * mass_ * kDebrisGravity) return std::nullopt;
    return created_ / taken_out;
  }

 private:
  double of(DebrisRun& run) {
    double sum = 0;
    speed_ = height_ = mass_ = 0;
    for (std::size_t i = 0; i < run.bodies().size(); ++i) {
      const FallingSolid& falls = scene_.falling[i];
      const ConvexSolid& shape = scene_.shapes[falls.shape];
      const BodyState state = run.world().state(run.bodies()[i]);
      // Stored velocities read at mid-step (collision::BodyState): now is half a step of gravity farther.
      const double down = scene_.gravity && !state.asleep ? kDebrisGravity * kDebrisStep / 2 : 0;
      const Vector3d velocity = state.velocity - Vector3d(0, 0, down),
                     spin = state.pose.orientation.conjugate() * state.angular_velocity;
      const double mass = falls.density * shape.volume;
      sum += mass * velocity.squaredNorm() / 2 + falls.density * spin.dot(shape.inertia * spin) / 2;
      if (scene_.gravity) sum += mass * kDebrisGravity * state.pose.position.z();
      mass_ += mass;
      speed_ += velocity.norm() / static_cast<double>(run.bodies().size());
      height_ += state.pose.position.z() / static_cast<double>(run.bodies().size());
    }
    return sum;
  }
  const DebrisScene& scene_;
  double last_ = 0, put_in_ = 0, created_ = 0, mass_ = 0, speed_ = 0, height_ = 0;
};

}  // namespace

DebrisMeasures time_debris(const DebrisScene& scene, const MakeWorld& make_world, StepTime by) {
  DebrisRun run(scene, make_world());
  return run_scene(
      run, scene, by, [](bool) {}, [](int) {});
}

DebrisMeasures measure_debris(const DebrisScene& scene, const MakeWorld& make_world) {
  DebrisRun run(scene, make_world());
  BodyBalances balances(scene);
  Energies energies(scene);
  const std::vector<PlacedSolid> standing = placed_standing(scene);
  std::optional<double> rest, settled;
  double deepest = 0;
  Overlaps overlaps;
  const auto look = [&] {
    overlaps = find_overlaps(placed(scene, run), standing, scene.ground);
    deepest = std::max(deepest, overlaps.deepest);
  };
  DebrisMeasures measured = run_scene(
      run, scene, StepTime::processor,
      [&](bool added) {
        energies.begin(run, added);
        balances.begin_step(run, run.world());
      },
      [&](int k) {
        balances.end_step(run, run.world());
        energies.end(run);
        const double time = (k + 1) * kDebrisStep;
        const auto since = [&](bool holds, std::optional<double>& from) {
          if (!holds || !run.all_there())
            from.reset();
          else if (!from)
            from = time;
        };
        since(run.world().awake_count() == 0, rest);
        since(energies.mean_speed() < kSlow, settled);
        if (k % kLook == kLook - 1 && run.world().awake_count() > 0) look();
      });
  look();
  measured.at_end = overlaps;
  measured.deepest = deepest;
  measured.rest = rest;
  measured.settled_at = settled;
  measured.height = energies.mean_height();
  measured.awake = balances.awake();
  measured.asleep = balances.asleep(run, run.world());
  measured.created = energies.created();
  measured.momentum = balances.most_motion() > 0 ? balances.lost_momentum() / balances.most_motion() : 0;
  if (!scene.gravity && !scene.ground && scene.standing.empty()) measured.angular = balances.lost_angular_momentum();
  return measured;
}

}  // namespace topple::bench
