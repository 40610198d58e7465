#pragma once
// The beam that tests of impacts strike.
#include "frame_builder.h"

namespace topple::test {

/// Of this length along x between two fixed ends, 5 m up, with a load per length.
[[nodiscard]] inline FrameBuilder beam_between_walls(double length, double load,
                                                     const structure::JointCapacity& joint = {}) {
  FrameBuilder f;
  const structure::NodeId a = f.node("A", 0, 0, 5), b = f.node("B", length, 0, 5);
  f.member("AB", structure::MemberKind::beam, a, b, joint, joint);
  f.support(a);
  f.support(b);
  f.load(structure::MemberId(0u), load);
  return f;
}

}  // namespace topple::test
