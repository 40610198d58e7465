// Whether what the solver holds can rest as it lies, and with which forces.
#include <algorithm>

#include "solver/equilibrium.h"
#include "solver/step_solver.h"

namespace topple::collision {

namespace {

/// Along the normal and two directions across it.
std::array<Vec3, 3> directions(const Vec3& normal) {
  const Vec3 aside = std::abs(normal.z()) < 0.7 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 across = aside.cross(normal).normalized();
  return {normal, across, normal.cross(across)};
}

Eigen::Matrix<double, 1, 6> row(const SolverBody& body, const Vec3& place, const Vec3& along) {
  Eigen::Matrix<double, 1, 6> made;
  made.head<3>() = body.inverse_root_mass * along;
  made.tail<3>() = body.scaled_moment((place - body.at.position).cross(along));
  return made;
}

}  // namespace

/// Where normal forces may act. A ball does not roll while its force is no farther from its middle than soil gives way
/// before it: corners of a square that far out.
std::vector<StepSolver::RestPoint> StepSolver::rest_points(const SolverContact& contact) const {
  const Manifold& manifold = contact.pair->manifold;
  std::vector<RestPoint> made;
  for (int i = 0; i < manifold.count; ++i) {
    const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
    if (bears_at_rest(point)) made.push_back({contact.places[static_cast<std::size_t>(i)], point.force, i});
  }
  if (!(contact.rolling > 0) || made.size() != 1) return made;
  const RestPoint middle = made.front();
  const std::array<Vec3, 3> along = directions(manifold.normal);
  made.clear();
  for (const Vec3& out : {along[1], along[2]})
    for (const double way : {contact.rolling, -contact.rolling})
      made.push_back({middle.place + way * out, middle.start / 4, middle.point});
  return made;
}

void StepSolver::add_to(Equilibrium& equilibrium, const SolverContact& contact) const {
  const SolverBody &first = bodies_[static_cast<std::size_t>(contact.first)],
                   &second = bodies_[static_cast<std::size_t>(contact.second)];
  const Manifold& manifold = contact.pair->manifold;
  const std::array<Vec3, 3> along = directions(manifold.normal);
  RestContact& made = equilibrium.contacts.emplace_back();
  made.first = contact.first;
  made.second = contact.second;
  made.friction = contact.friction;
  for (const RestPoint& point : rest_points(contact)) {
    made.on_first.row(made.count) = row(first, point.place, along[0]);
    made.on_second.row(made.count) = row(second, point.place, along[0]);
    made.stiffness[made.count] =
        1 / (made.on_first.row(made.count).squaredNorm() + made.on_second.row(made.count).squaredNorm());
    made.start[made.count] = point.start;
    ++made.count;
  }
  for (int i = 0; i < 2; ++i) {
    made.on_first.row(4 + i) = row(first, contact.anchor, along[static_cast<std::size_t>(1 + i)]);
    made.on_second.row(4 + i) = row(second, contact.anchor, along[static_cast<std::size_t>(1 + i)]);
    made.start[4 + i] = manifold.friction_force.dot(along[static_cast<std::size_t>(1 + i)]);
  }
  made.on_first.row(6).tail<3>() = contact.lever * first.scaled_moment(along[0]);
  made.on_second.row(6).tail<3>() = contact.lever * second.scaled_moment(along[0]);
  made.start[6] = manifold.twist_force / contact.lever;
  const double masses = made.on_first.bottomRows<3>().squaredNorm() + made.on_second.bottomRows<3>().squaredNorm();
  made.stiffness.tail<3>().setConstant(3 / masses);
}

bool StepSolver::rest(double dt, const Vec3& gravity, std::span<const double> sizes, std::vector<char>& moves) {
  Equilibrium equilibrium;
  equilibrium.bodies.resize(bodies_.size());
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    const SolverBody& one = bodies_[i];
    Equilibrium::Body& made = equilibrium.bodies[i];
    made.weight.head<3>() = gravity / one.inverse_root_mass;
    const double weight = std::max(1e-9, gravity.norm()) / (one.inverse_root_mass * one.inverse_root_mass);
    made.scale.head<3>().setConstant(1 / (one.inverse_root_mass * weight));
    made.scale.tail<3>() = one.inverse_root_moments.cwiseInverse() / (weight * sizes[i]);
    made.moves = moves[i] != 0;
  }
  equilibrium.contacts.reserve(contacts_.size());
  for (SolverContact& contact : contacts_) {
    contact.find_places();
    find_friction_centre(contact);
    add_to(equilibrium, contact);
  }
  for (HingeRows* hinge : hinges_) {
    hinge->prepare(bodies_[static_cast<std::size_t>(hinge->body)], bodies_[static_cast<std::size_t>(hinge->holder)], {},
                   {});
    equilibrium.joints.push_back(hinge->at_rest());
  }
  for (const CableRow* cable : cables_)
    equilibrium.joints.push_back(cable->at_rest(bodies_[static_cast<std::size_t>(cable->body)], dt));
  int searches = 1;
  while (!equilibrium.solve(settings_.equilibrium, settings_.equilibrium_passes))
    if (++searches > settings_.rest_searches || !equilibrium.leave_out_what_gives(settings_.left_out)) return false;
  for (std::size_t i = 1; i < bodies_.size(); ++i) moves[i] = equilibrium.bodies[i].moves ? 1 : 0;
  for (std::size_t k = 0; k < contacts_.size(); ++k) store_rest(equilibrium.contacts[k], contacts_[k], dt);
  std::size_t k = 0;
  for (HingeRows* hinge : hinges_) hinge->store_rest(equilibrium.joints[k++].force, dt);
  for (CableRow* cable : cables_) cable->store_rest(equilibrium.joints[k++].force[0], dt);
  return true;
}

void StepSolver::store_rest(const RestContact& found, SolverContact& contact, double dt) const {
  Manifold& manifold = contact.pair->manifold;
  const std::array<Vec3, 3> along = directions(manifold.normal);
  double pressed = 0;
  Vec3 middle = Vec3::Zero();
  const std::vector<RestPoint> points = rest_points(contact);
  for (int i = 0; i < manifold.count; ++i) manifold.points[static_cast<std::size_t>(i)].force = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double force = found.force[static_cast<Eigen::Index>(k)];
    manifold.points[static_cast<std::size_t>(points[k].point)].force += force;
    pressed += force;
    middle += force * points[k].place;
  }
  for (int i = 0; i < manifold.count; ++i) {
    ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
    point.impulse = point.force;
  }
  manifold.friction = manifold.friction_force = found.force[4] * along[1] + found.force[5] * along[2];
  manifold.twist = manifold.twist_force = found.force[6] * contact.lever;
  contact.centre = pressed > 0 ? Vec3(middle / pressed) : contact.anchor;
  contact.impulse = (pressed * manifold.normal + manifold.friction) * dt;
  contact.moment = (manifold.twist * manifold.normal + (contact.anchor - contact.centre).cross(manifold.friction)) * dt;
}

}  // namespace topple::collision
