#include "model/solved_member.h"

#include <algorithm>
#include <cmath>

namespace topple::structure {

namespace {

/// Gauss-Legendre with four points on 0 ... 1: exact to degree seven, enough for the square of a cubic moment and for a
/// linear load on the quintic that it bends.
constexpr std::array<std::pair<double, double>, 4> gauss{{{0.069431844202973713, 0.17392742256872693},
                                                          {0.33000947820757187, 0.32607257743127307},
                                                          {0.66999052179242813, 0.32607257743127307},
                                                          {0.93056815579702629, 0.17392742256872693}}};

/// Force and moment dotted with translation and rotation, forces apart along gravity and across it.
LoadWork split_work(const Vec6& load, const Vec6& displacement, const Vec3& gravity) {
  LoadWork work;
  work.gravity = load.head<3>().dot(gravity) * displacement.head<3>().dot(gravity);
  work.other = load.dot(displacement) - work.gravity;
  return work;
}

}  // namespace

LoadWork work(const Vec6& load, const Vec6& displacement, const Vec3& gravity) {
  return split_work(load, displacement, gravity);
}

SolvedMember::SolvedMember(const solver::Beam& beam, const solver::Vec12& end_forces, const solver::Vec12& rigid_ends,
                           std::vector<solver::BeamLoad> loads)
    : beam_(beam),
      end_forces_(end_forces),
      rigid_ends_(rigid_ends),
      loads_(std::move(loads)),
      diagram_(beam_, end_forces_, loads_) {}

Vec6 SolvedMember::end(int end) const { return at(end == 0 ? 0 : beam_.length); }

std::vector<double> SolvedMember::cuts(std::span<const solver::BeamLoad> loads) const {
  std::vector<double> places{0, beam_.length};
  for (const std::span<const solver::BeamLoad> some : {std::span<const solver::BeamLoad>(loads_), loads})
    for (const solver::BeamLoad& load : some) {
      if (load.kind == solver::BeamLoad::Kind::temperature) continue;
      places.push_back(load.from);
      if (load.kind == solver::BeamLoad::Kind::distributed) places.push_back(load.to);
    }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

LoadWork SolvedMember::work(std::span<const solver::BeamLoad> loads, const Vec3& gravity) const {
  LoadWork sum;
  for (const solver::BeamLoad& load : loads)
    if (load.kind == solver::BeamLoad::Kind::point) sum += split_work(load.first, at(load.from), gravity);
  const std::vector<double> places = cuts(loads);
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const double length = places[i + 1] - places[i], middle = 0.5 * (places[i] + places[i + 1]);
    const auto acts = [&](const solver::BeamLoad& load) {
      return load.kind == solver::BeamLoad::Kind::distributed && load.from < middle && middle < load.to;
    };
    if (std::none_of(loads.begin(), loads.end(), acts)) continue;
    for (const auto& [place, weight] : gauss) {
      const double x = places[i] + place * length;
      Vec6 intensity = Vec6::Zero();
      for (const solver::BeamLoad& load : loads)
        if (acts(load)) intensity += load.first + (x - load.from) / (load.to - load.from) * (load.last - load.first);
      sum += split_work(weight * length * intensity, at(x), gravity);
    }
  }
  return sum;
}

Vec6 SolvedMember::stiffness() const {
  const double E = beam_.youngs_modulus, G = beam_.shear_modulus;
  Vec6 stiffness;
  stiffness << E * beam_.area, G * beam_.shear_area_y, G * beam_.shear_area_z, G * beam_.J, E * beam_.Iy, E * beam_.Iz;
  return stiffness;
}

double SolvedMember::mutual_energy(const SolvedMember& other) const {
  using Quantity = solver::BeamDiagram::Quantity;
  const Vec6 stiff = stiffness();
  double energy = 0;
  const std::vector<double> places = cuts(other.loads_);
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const double length = places[i + 1] - places[i];
    for (const auto& [place, weight] : gauss)
      for (int k = 0; k < 6; ++k) {
        if (!(stiff(k) > 0)) continue;
        const double x = places[i] + place * length;
        energy += weight * length * diagram_.value(static_cast<Quantity>(k), x) *
                  other.diagram_.value(static_cast<Quantity>(k), x) / (2 * stiff(k));
      }
  }
  return energy;
}

double SolvedMember::strain_energy() const {
  double energy = mutual_energy(*this);
  for (int f = 0; f < 12; ++f) {
    const double spring = beam_.end_stiffness[static_cast<std::size_t>(f / 6)](f % 6);
    if (spring > 0 && std::isfinite(spring)) energy += end_forces_(f) * end_forces_(f) / (2 * spring);
  }
  return energy;
}

}  // namespace topple::structure
