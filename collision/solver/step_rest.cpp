// Whether what the solver holds can rest as it lies, and with which forces.
#include <algorithm>

#include "solver/equilibrium.h"
#include "solver/step_solver.h"

namespace topple::collision {

namespace {

Eigen::Matrix<double, 1, 6> row(const Wide* along, const Wide& root, const Wide* angular, int lane) {
  Eigen::Matrix<double, 1, 6> made;
  for (int i = 0; i < 3; ++i) {
    made[i] = along[i][lane] * root[lane];
    made[3 + i] = angular[i][lane];
  }
  return made;
}

RestContact rest_contact(const SolverContact& contact, const ContactPack& pack, const PackPoint* points, int count) {
  RestContact made;
  const int lane = contact.lane;
  made.first = contact.first;
  made.second = contact.second;
  made.points = count;
  made.friction = contact.friction;
  for (int i = 0; i < count; ++i) {
    made.on_first.row(i) = row(pack.normal, pack.first_root, points[i].first, lane);
    made.on_second.row(i) = row(pack.normal, pack.second_root, points[i].second, lane);
    made.stiffness[i] = points[i].mass[lane];
    made.lever[static_cast<std::size_t>(i)] = points[i].lever[lane];
    made.start[i] = points[i].impulse[lane];
  }
  for (int i = 0; i < 2; ++i) {
    made.on_first.row(4 + i) = row(pack.along[i], pack.first_root, pack.along_first[i], lane);
    made.on_second.row(4 + i) = row(pack.along[i], pack.second_root, pack.along_second[i], lane);
    made.start[4 + i] = pack.slide[i][lane];
  }
  made.stiffness[4] = pack.inverse[0][lane];
  made.coupling = pack.inverse[1][lane];
  made.stiffness[5] = pack.inverse[2][lane];
  for (int i = 0; i < 3; ++i) {
    made.on_first(6, 3 + i) = pack.twist_first[i][lane];
    made.on_second(6, 3 + i) = pack.twist_second[i][lane];
  }
  made.stiffness[6] = pack.twist_mass[lane];
  made.start[6] = pack.twist[lane];
  return made;
}

}  // namespace

bool StepSolver::rest(double dt, const Vec3& gravity, std::span<const double> sizes) {
  h_ = 1;  // impulses are forces
  scale_bodies(h_, Vec3::Zero());
  for (Motion6& motion : velocity_) motion = {};
  colour();
  fill_packs();
  for (SolverContact& contact : contacts_) prepare(contact);
  Equilibrium equilibrium;
  equilibrium.bodies.resize(bodies_.size());
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    const SolverBody& one = bodies_[i];
    Equilibrium::Body& made = equilibrium.bodies[i];
    made.weight.head<3>() = gravity / one.inverse_root_mass;
    const double weight = std::max(1e-9, gravity.norm()) / (one.inverse_root_mass * one.inverse_root_mass);
    made.scale.head<3>().setConstant(1 / (one.inverse_root_mass * weight));
    made.scale.tail<3>() = one.inverse_root_moments.cwiseInverse() / (weight * sizes[i]);
  }
  for (const SolverContact& contact : contacts_) {
    const ContactPack& pack = packs_[static_cast<std::size_t>(contact.pack)];
    equilibrium.contacts.push_back(
        rest_contact(contact, pack, &points_[pack.first_point], contact.pair->manifold.count));
  }
  for (HingeRows* hinge : hinges_) {
    hinge->prepare(bodies_[static_cast<std::size_t>(hinge->body)], bodies_[static_cast<std::size_t>(hinge->holder)], {},
                   {});
    equilibrium.joints.push_back(hinge->at_rest());
  }
  for (const CableRow* cable : cables_)
    equilibrium.joints.push_back(cable->at_rest(bodies_[static_cast<std::size_t>(cable->body)], dt));
  if (!equilibrium.solve(settings_.equilibrium, settings_.equilibrium_passes)) return false;
  take_forces(equilibrium, dt);
  return true;
}

void StepSolver::take_forces(const Equilibrium& equilibrium, double dt) {
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    SolverContact& contact = contacts_[k];
    const RestContact& found = equilibrium.contacts[k];
    ContactPack& pack = packs_[static_cast<std::size_t>(contact.pack)];
    for (int i = 0; i < found.points; ++i) {
      PackPoint& point = points_[pack.first_point + static_cast<std::size_t>(i)];
      point.impulse[contact.lane] = found.force[i];
      point.total[contact.lane] = found.force[i] * dt;
    }
    for (int i = 0; i < 2; ++i) {
      pack.slide[i][contact.lane] = found.force[4 + i];
      pack.slide_total[i][contact.lane] = found.force[4 + i] * dt;
    }
    pack.twist[contact.lane] = found.force[6];
    pack.twist_total[contact.lane] = found.force[6] * dt;
    store_contact(contact, dt);
  }
  std::size_t k = 0;
  for (HingeRows* hinge : hinges_) hinge->take_rest(equilibrium.joints[k++].force, dt);
  for (CableRow* cable : cables_) cable->take_rest(equilibrium.joints[k++].force[0], dt);
}

}  // namespace topple::collision
