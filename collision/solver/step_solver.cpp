#include "solver/step_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

namespace topple::collision {

void StepSolver::clear() {
  ordered_ = 0;
  bodies_.clear();
  bodies_.emplace_back();  // what stands
  contacts_.clear();
  hinges_.clear();
  cables_.clear();
}

int StepSolver::add(const SolverBody& body) {
  bodies_.push_back(body);
  return static_cast<int>(bodies_.size()) - 1;
}

StepSolver::Softness StepSolver::softness(double frequency, double damping, double h) {
  const double w = 2 * M_PI * frequency, a1 = 2 * damping + h * w, a2 = h * w * a1;
  return {w / a1, a2 / (1 + a2), 1 / (1 + a2)};
}

namespace {
void accumulate(const Motion6& more, Motion6& to) {
  for (int i = 0; i < 3; ++i) {
    to.linear[i] += more.linear[i];
    to.angular[i] += more.angular[i];
  }
}
/// Bodies, and packs of contacts, for which a piece of a loop is worth being handed on: a microsecond or two.
constexpr std::size_t kBodies = 128, kPacks = 8;
Vec3 get(const Wide* of, int lane) { return {of[0][lane], of[1][lane], of[2][lane]}; }
}  // namespace

template <class Work>
void StepSolver::each_body(const Work& work) {
  region_.each(bodies_.size() - 1, kBodies, [&](std::size_t i) { work(i + 1); });
}

/// Those of a pack by one thread, which begins with the pack.
template <class Begin, class Work>
void StepSolver::each_contact(const Begin& begin, const Work& work) {
  constexpr std::uint32_t none = ContactPacking::kNone;
  const std::vector<std::uint32_t>& packed = packing_.packed();
  region_.each(packing_.packs().size(), kPacks, [&](std::size_t pack) {
    // Contacts of a pack are far from each other in memory, and so are their pairs.
    for (std::size_t k = kLanes * (pack + 1); k < std::min(kLanes * (pack + 2), packed.size()); ++k)
      if (packed[k] != none) prefetch_lines(*contacts_[packed[k]].pair);
    for (std::size_t k = kLanes * (pack + 2); k < std::min(kLanes * (pack + 3), packed.size()); ++k)
      if (packed[k] != none) prefetch_lines(contacts_[packed[k]]);
    begin(pack);
    for (std::size_t k = kLanes * pack; k < kLanes * (pack + 1); ++k)
      if (packed[k] != none) work(contacts_[packed[k]]);
  });
}

void StepSolver::scale_bodies(double dt) {
  const std::size_t count = bodies_.size();
  velocity_.assign(count, {});
  displacement_.assign(count, {});
  kick_.assign(count, {});
  pushed_.assign(count, {});
  begun_.assign(count, {});
  moving_.assign(count, {});
  each_body([&](std::size_t i) {
    const SolverBody& body = bodies_[i];
    // From the middle of the step to that of a sub-step before the first.
    body.set(body.velocity + body.acceleration * ((dt - h_) / 2),
             body.spin + body.angular_acceleration * ((dt - h_) / 2), velocity_[i]);
    body.set(body.acceleration * h_, body.angular_acceleration * h_, kick_[i]);
  });
}

void StepSolver::unscale_bodies(double dt) {
  each_body([&](std::size_t i) {
    SolverBody& body = bodies_[i];
    body.velocity = body.linear(velocity_[i]) - body.acceleration * ((dt - h_) / 2);
    body.spin = body.angular(velocity_[i]) - body.angular_acceleration * ((dt - h_) / 2);
    body.moved = body.linear(displacement_[i]);
    body.turned = body.angular(displacement_[i]);
  });
}

/// True where a point has changed by more than `settled`.
bool StepSolver::each_pack(ContactKernels::Pass pass, const SubStep& step, std::vector<Motion6>& velocity) {
  std::atomic<bool> unsettled{false};
  const std::vector<std::size_t>&sets = packing_.sets(), &stages = packing_.stages();
  ContactPack* const packs = packing_.packs().data();
  PackPoint* const points = packing_.points().data();
  for (std::size_t stage = 0; stage + 1 < stages.size(); ++stage)
    region_.loop(stages[stage + 1] - stages[stage], 1, [&](std::size_t begin, std::size_t end) {
      const std::size_t first = sets[stages[stage] + begin], past = sets[stages[stage] + end];
      if (pass(packs, points, first, past, velocity.data(), displacement_.data(), step))
        unsettled.store(true, std::memory_order_relaxed);
    });
  return unsettled;
}

/// Gravity, and what contacts did in the sub-step before: Jacobians stay through a step, so that the sum over a body's
/// contacts is known from its velocities.
void StepSolver::begin_sub_step(int number) {
  each_body([&](std::size_t i) {
    begun_[i] = velocity_[i];
    accumulate(kick_[i], begun_[i]);
    accumulate(kick_[i], velocity_[i]);
    if (number > 0) accumulate(pushed_[i], velocity_[i]);
  });
}

/// Of the last pass, J: in the order of points, colour by colour.
double StepSolver::energy_of_changes() {
  const std::vector<std::size_t>& colours = packing_.colours();
  colour_energies_.assign(colours.size() - 1, 0);
  region_.each(colour_energies_.size(), 1, [&](std::size_t c) {
    Wide sum{};
    for (std::size_t i = packing_.packs()[colours[c]].first_point; i < packing_.end_of_points(colours[c + 1]); ++i)
      sum += energies_[i].value;
    colour_energies_[c] = sum[0] + sum[1] + sum[2] + sum[3];
  });
  return std::accumulate(colour_energies_.begin(), colour_energies_.end(), 0.0);
}

/// One pass over the contacts serves what rests or goes on evenly: impulses of the sub-step before are near. An impact
/// comes through one contact in a pass; as long as it is on its way passes are repeated.
void StepSolver::stop_closing(SubStep step) {
  const ContactKernels& kernels = contact_kernels();
  Again again;
  again.settled = settings_.settled;
  step.again = &again;
  step.first = true;
  bool unsettled = each_pack(kernels.solve, step);
  step.first = false;
  if (!unsettled) return;
  const std::size_t points = packing_.points().size();
  changes_.assign(points, PackWide{});
  ways_.assign(points, PackWide{});
  energies_.resize(points);
  again.change = &changes_.data()->value;
  again.way = &ways_.data()->value;
  again.energy = &energies_.data()->value;
  double before = 0;
  for (int pass = 1; pass < settings_.most_passes && unsettled; ++pass) {
    unsettled = each_pack(kernels.solve, step);
    if (!unsettled) break;
    const double energy = energy_of_changes();
    again.share = energy < before ? energy / before : 0;
    before = energy;
    each_pack(kernels.go_on, step);
  }
}

/// Normal impulses and friction together. What is squeezed between two that slide gets nearly opposite pushes from
/// both: passes are repeated as in `stop_closing`, or what one has too much sets it flying.
void StepSolver::relax(SubStep step) { repeat(contact_kernels().relax, step, velocity_, 1); }

/// At least `fewest` passes; then, as long as one changes a contact by much, over those of the bodies that it moved.
void StepSolver::repeat(ContactKernels::Pass pass, SubStep step, std::vector<Motion6>& velocity, int fewest) {
  Again again;
  again.settled = settings_.settled;
  step.again = &again;
  for (int done = 0; done < settings_.most_passes;) {
    step.first = done == 0;
    moves_.assign(bodies_.size(), 0);
    again.moves = moves_.data();
    const bool unsettled = each_pack(pass, step, velocity);
    if (++done < fewest) continue;
    if (!unsettled) break;
    moved_.swap(moves_);
    again.moved = moved_.data();
  }
}

void StepSolver::sub_step(int number) {
  const SubStep step{h_, settings_.pushed_apart, settings_.restitution_from};
  const ContactKernels& kernels = contact_kernels();
  begin_sub_step(number);
  if (number == 0) each_pack(kernels.warm_start, step);
  const auto of = [&](int body) -> const SolverBody& { return bodies_[static_cast<std::size_t>(body)]; };
  const auto displacement = [&](int body) -> const Motion6& { return displacement_[static_cast<std::size_t>(body)]; };
  // What joints do is told apart from what contacts do (`begun_`): their rows turn with the bodies.
  for (HingeRows* hinge : hinges_) {
    hinge->prepare(of(hinge->body), of(hinge->holder), displacement(hinge->body), displacement(hinge->holder));
    hinge->warm_start(velocity_.data(), begun_.data());
  }
  const auto hold_cables = [&] {
    for (CableRow* cable : cables_) {
      const auto i = static_cast<std::size_t>(cable->body);
      cable->hold(bodies_[i], h_, displacement_[i], velocity_[i], begun_[i]);
    }
  };
  const auto hold_hinges = [&] {
    for (HingeRows* hinge : hinges_) hinge->solve(0, 0, h_, velocity_.data(), begun_.data());
  };
  hold_cables();
  hold_hinges();
  stop_closing(step);
  hold_cables();
  hold_hinges();
  relax(step);
  for (HingeRows* hinge : hinges_) hinge->add_up();
  each_body([&](std::size_t i) {
    for (int k = 0; k < 3; ++k) {
      pushed_[i].linear[k] = velocity_[i].linear[k] - begun_[i].linear[k];
      pushed_[i].angular[k] = velocity_[i].angular[k] - begun_[i].angular[k];
    }
    moving_[i] = velocity_[i];
  });
  move(step);
}

/// Bodies move by their velocities, and by what pushes overlaps apart: that is no speed and no force, or what is jammed
/// between two parts would press them by the stiffness of springs that nothing has.
void StepSolver::move(SubStep step) {
  if (!hinges_.empty()) ignored_.assign(bodies_.size(), {});
  const double frequency = std::min(settings_.joint_frequency, 0.25 / h_);
  for (const HingeRows* hinge : hinges_)
    HingeRows(*hinge).solve(frequency, settings_.joint_damping, h_, moving_.data(), ignored_.data());
  // What lies between two much heavier ones takes about as many passes as it is lighter.
  repeat(contact_kernels().separate, step, moving_, settings_.moving_passes);
  each_body([&](std::size_t i) {
    for (int k = 0; k < 3; ++k) {
      displacement_[i].linear[k] += h_ * moving_[i].linear[k];
      displacement_[i].angular[k] += h_ * moving_[i].angular[k];
    }
  });
}

void StepSolver::store_contact(SolverContact& contact, double dt) {
  const ContactPack& pack = pack_of(contact);
  const int lane = contact.lane;
  Manifold& manifold = contact.pair->manifold;
  double total = 0;
  contact.centre.setZero();
  for (int i = 0; i < manifold.count; ++i) {
    ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
    const PackPoint& row = packing_.points()[pack.first_point + static_cast<std::size_t>(i)];
    point.impulse = row.impulse[lane] / h_;
    point.force = row.total[lane] / dt;
    total += row.total[lane];
    contact.load = std::max(contact.load, row.total[lane] / dt / row.mass[lane]);
    contact.centre += row.total[lane] * contact.places[static_cast<std::size_t>(i)];
  }
  if (total > 0)
    contact.centre /= total;
  else
    contact.centre = contact.anchor;
  Vec3 slide = Vec3::Zero(), slide_total = Vec3::Zero();
  for (int i = 0; i < 2; ++i) {
    slide += pack.slide[i][lane] * get(pack.along[i], lane);
    slide_total += pack.slide_total[i][lane] * get(pack.along[i], lane);
  }
  manifold.friction = slide / h_;
  manifold.twist = pack.twist[lane] / h_;
  manifold.friction_force = slide_total / dt;
  manifold.twist_force = pack.twist_total[lane] / dt;
  contact.impulse = total * manifold.normal + slide_total;
  Vec3 carried = pack.carried[lane] * manifold.normal;
  for (int i = 0; i < 2; ++i) carried += pack.slide_carried[i][lane] * get(pack.along[i], lane);
  contact.late = dt * contact.impulse - h_ * carried;
  contact.moment = pack.twist_total[lane] * manifold.normal + (contact.anchor - contact.centre).cross(slide_total);
}

void StepSolver::run(double dt, int substeps) {
  h_ = dt / substeps;
  scale_bodies(dt);
  packing_.pack(contacts_, bodies_.size(), ordered_, domains_of(contacts_.size()));
  each_contact([&](std::size_t pack) { packing_.begin(pack); }, [&](SolverContact& contact) { prepare(contact, dt); });
  for (HingeRows* hinge : hinges_) hinge->begin_step(h_);
  for (int i = 0; i < substeps; ++i) sub_step(i);
  each_pack(contact_kernels().restitute, {h_, settings_.pushed_apart, settings_.restitution_from});
  each_contact([](std::size_t) {}, [&](SolverContact& contact) { store_contact(contact, dt); });
  for (HingeRows* hinge : hinges_) hinge->end_step(h_);
  unscale_bodies(dt);
  keep_angular_momentum();
}

/// How fast the place of a contact moves: with the corners of the one that has none of its faces there; with the middle
/// of a ball.
Vec3 StepSolver::place_moves(const SolverContact& contact) const {
  const SolverBody &first = bodies_[static_cast<std::size_t>(contact.first)],
                   &second = bodies_[static_cast<std::size_t>(contact.second)];
  if (contact.first_ball && contact.second_ball) return (first.velocity + second.velocity) / 2;
  if (contact.first_ball || contact.second_ball) return contact.first_ball ? first.velocity : second.velocity;
  const SolverBody& corners = contact.corners_on_second ? second : first;
  return corners.velocity + corners.spin.cross(contact.centre - corners.at.position);
}

/// The arms of impulses are those of the step's beginning, and the bodies have moved since. With Q the sum of impulses
/// on the second times the time left, u the speed of the place where they act and v that of a body's centre, the second
/// lacks Q x (v - u) of its angular momentum, and the first -Q x (v - u): together what the two have to keep. Without
/// it what swings is turned back by where it was half a step ago, and swings farther each time (by w^2 dt/4 in a
/// second). About a fixed point an impulse has moved on by u x Q. What that would set spinning too fast is turned with
/// the other body alike: that costs the least energy, and sets no slender body spinning about its length beside a heavy
/// one.
void StepSolver::keep_angular_momentum() {
  const auto turned = [](const SolverBody& of, const Vec3& moment) {
    return Vec3(of.at.turn * of.inverse_root_moments.cwiseProduct(of.scaled_moment(moment)));
  };
  for (SolverContact& contact : contacts_) {
    if (contact.late.isZero(0)) continue;
    SolverBody &first = bodies_[static_cast<std::size_t>(contact.first)],
               &second = bodies_[static_cast<std::size_t>(contact.second)];
    const Vec3 moves = place_moves(contact);
    Vec3 of_first = turned(first, (first.velocity - moves).cross(contact.late)),
         of_second = turned(second, contact.late.cross(second.velocity - moves));
    contact.carried = moves.cross(contact.late);
    if (std::max(of_first.norm(), of_second.norm()) > settings_.spins_by) {
      const bool first_free = contact.first != 0 && !first.root_mobility,
                 second_free = contact.second != 0 && !second.root_mobility;
      contact.carried = (second_free ? second : first).velocity.cross(contact.late);
      if (!first_free || !second_free) continue;
      const Mat3 inertia = second.inertia();
      of_first = of_second =
          Mat3(first.inertia() + inertia).ldlt().solve(contact.late.cross(second.velocity - first.velocity));
      contact.carried += inertia * of_second;
    }
    first.spin += of_first;
    second.spin += of_second;
  }
}

}  // namespace topple::collision
