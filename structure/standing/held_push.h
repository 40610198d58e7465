#pragma once
// The response to a push that is over before nodes move. The struck part bends between its nodes, which are held; its
// joints bear the push, and its nodes get the impulse.
#include <span>

#include "standing/frame_response.h"
#include "standing/motion/standing_motion.h"

namespace topple::structure {

class HeldPush {
 public:
  struct Sources {
    const StandingParts& parts;
    const PanelSuperelements& shells;
    const FrameStatics& statics;
    const FrameResponse& response;
  };
  explicit HeldPush(const Sources& sources) : from_(sources) {}

  /// Unit pushes at standing places, each along its direction; without mobility and speeds.
  [[nodiscard]] StandingFrame::HeldResponse respond(std::span<const ContactPlace> places,
                                                    std::span<const Vec3> directions) const;

 private:
  /// A place's push by the members that bear it.
  struct Pushed {
    PlacedLoad placed;
    std::vector<std::pair<MemberId, std::vector<solver::BeamLoad>>> members;
  };
  [[nodiscard]] Pushed push(const ContactPlace& place, const Vec3& direction) const;
  [[nodiscard]] solver::Beam beam(MemberId member) const;
  [[nodiscard]] double work(const Pushed& by, const Pushed& through) const;
  void add_demands(const Pushed& pushed, Eigen::Index place, StandingFrame::HeldResponse& answer) const;

  Sources from_;
};

}  // namespace topple::structure
