#include "dynamics/recent_loads.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "elements/beam.h"

namespace topple::solver {
Vec6 times_to_feel(const Beam& beam) {
  constexpr double bending = 22.3733;  // the square of the first root of cos x cosh x = 1
  Vec6 times = Vec6::Zero();
  const auto set = [&](std::initializer_list<int> components, double squared) {
    if (!(squared > 0) || !std::isfinite(squared)) return;
    for (const int component : components) times(component) = 1 / std::sqrt(squared);
  };
  const double L = beam.length, by_length = beam.density * beam.area;
  set({0}, M_PI * M_PI / (L * L) * beam.youngs_modulus / beam.density);
  set({1, 5}, bending * bending / std::pow(L, 4) * beam.youngs_modulus * beam.Iz / by_length);
  set({2, 4}, bending * bending / std::pow(L, 4) * beam.youngs_modulus * beam.Iy / by_length);
  set({3}, M_PI * M_PI / (L * L) * beam.shear_modulus * beam.J / (beam.density * (beam.Iy + beam.Iz)));
  return times;
}

void RecentLoads::change(int beam, const Held& held, const std::vector<BeamLoad>& from, const std::vector<BeamLoad>& to,
                         double h) {
  if (times_.empty()) return;
  const double longest = times_[static_cast<std::size_t>(beam)].maxCoeff();
  auto found = histories_.find(beam);
  if (found == histories_.end() && !(h < longest)) return;
  const CondensedBeam condensed(held.beam, held.factor);
  const auto stretch = [&](double duration, std::vector<BeamLoad> loads) {
    std::erase_if(loads, [](const BeamLoad& one) { return one.kind == BeamLoad::Kind::temperature; });
    Stretch made{duration, std::move(loads), Vec12::Zero()};
    made.fixed_end = condensed.fixed_end_forces(made.pushes).force;
    return made;
  };
  if (found == histories_.end()) found = histories_.emplace(beam, History{stretch(longest + h, from)}).first;
  History& history = found->second;
  if (history.front().duration > 0)
    history.insert(history.begin(), stretch(0, to));
  else
    history.front() = stretch(0, to);
}

void RecentLoads::hold_otherwise(int beam, const Held& held) {
  const auto found = histories_.find(beam);
  if (found == histories_.end()) return;
  const CondensedBeam condensed(held.beam, held.factor);
  if (condensed.loose()) {
    histories_.erase(found);
    return;
  }
  for (Stretch& one : found->second) one.fixed_end = condensed.fixed_end_forces(one.pushes).force;
}

void RecentLoads::accept(double h) {
  for (auto entry = histories_.begin(); entry != histories_.end();) {
    History& history = entry->second;
    history.front().duration += h;
    // No longer than it is looked back to from the start of this substep.
    double kept = times_[static_cast<std::size_t>(entry->first)].maxCoeff() + h;
    for (auto one = history.begin(); one != history.end(); ++one) {
      if (kept > one->duration) {
        kept -= one->duration;
        continue;
      }
      one->duration = kept;
      history.erase(std::next(one), history.end());
      break;
    }
    const auto alike = [&](const Stretch& one) { return one.fixed_end == history.front().fixed_end; };
    entry = std::all_of(history.begin(), history.end(), alike) ? histories_.erase(entry) : std::next(entry);
  }
}

double RecentLoads::mean_of(const History& history, Eigen::Index component, double under_way, double ago,
                            double length) {
  double sum = 0, left = length;
  for (const Stretch& one : history) {
    const double duration = one.duration + (&one == &history.front() ? under_way : 0);
    const double passed = std::min(ago, duration), taken = std::min(left, duration - passed);
    ago -= passed;
    left -= taken;
    sum += taken * one.fixed_end(component);
  }
  return sum / (length - left);
}

Vec12 RecentLoads::felt(int beam, const Vec12& acting, double h, bool at_end, bool accepted) const {
  const auto found = histories_.find(beam);
  if (found == histories_.end()) return acting;
  const History& history = found->second;
  const double under_way = accepted ? 0 : h, ago = at_end ? 0 : h;
  const Vec6& times = times_[static_cast<std::size_t>(beam)];
  Vec12 result = acting;
  for (Eigen::Index component = 0; component < 6; ++component) {
    if (!(times(component) > h)) continue;
    for (const Eigen::Index place : {component, component + 6})
      result(place) += mean_of(history, place, under_way, ago, times(component)) - history.front().fixed_end(place);
  }
  return result;
}

}  // namespace topple::solver
