#pragma once
// What a push at several places did to the body that pushed, as impulses at these places.
#include <Eigen/Core>
#include <span>
#include <vector>

#include "simulation/impact/coupled_push.h"

namespace topple::structure {

struct PushImpulses {
  Eigen::VectorXd along;     ///< N s, one for each place, along its normal
  CoupledPush::Vec6 change;  ///< of velocity and spin: what these impulses do to the body
};

/// The impulses along the normals that come nearest to giving the body `rates_out` (velocity, spin), measured by the
/// energy of what is left over: the least ones where places depend on each other. What lies across all normals (what
/// the body's weight did meanwhile) is left out. However nearly the normals depend on each other, the change is no
/// longer, in energy, than the way from the body's own motion to `rates_out`. A place that is `through` has given way:
/// where all that would push the body on, along its normal, it gets no faster.
[[nodiscard]] PushImpulses impulses_of_push(const PushingBody& body, std::span<const PushedPlace> places,
                                            const CoupledPush::Vec6& rates_out, const std::vector<char>& through);

}  // namespace topple::structure
