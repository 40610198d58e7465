#pragma once
// Panels that break where they stand: a hit that is harder than the panel can bear there punches a hole, what hangs on
// nothing leaves as well, and the frame goes on with what remains.
#include <vector>

#include "simulation/accounts/event_log.h"
#include "simulation/accounts/running_sums.h"
#include "simulation/fracture/breakable_panels.h"
#include "simulation/impact/strike.h"

namespace topple::structure {

class StandingFracture {
 public:
  /// All of it must outlive this.
  StandingFracture(Scene& scene, EventLog& log, RunningSums& sums, Debris& debris, BreakablePanels& panels)
      : scene_(scene), log_(log), sums_(sums), debris_(debris), panels_(panels) {}

  /// N; unlimited where nothing can be punched.
  [[nodiscard]] double punching_force(const Strike& hit) const;
  /// Speed that the punch leaves an impact that is fast enough to feel the panel alone, m/s; 0 for one that is not.
  [[nodiscard]] double speed_through(const Strike& hit, double force) const;
  /// With the speed that is left. True when it went through.
  bool punch_at_once(Strike& hit, double force, double left);
  /// Returns the mass that the hit broke out, kg; 0 when nothing can break there.
  double break_out(Strike& hit);
  /// What a hit broke out leaves with the speed of the body, which flies on through the hole.
  void push_chunks(const Strike& hit);
  /// Where edges of broken panels have failed since, pieces that only they held leave.
  void drop_loose_pieces();
  /// Where the stress (of rest, or of the motion now) passes what the material bears, a panel cracks at its largest;
  /// what that leaves is looked at again when the frame has settled, or after its next substep.
  void crack();

  /// It has nothing of its own.
  template <class Archive>
  void serialize(Archive&) {
    [[maybe_unused]] auto& [scene, log, sums, debris, panels] = *this;
  }

 private:
  /// How the material of a panel moves, as a rigid body.
  struct RigidMotion {
    Vec3 centre, velocity, spin;
    [[nodiscard]] Vec3 at(const Vec3& point) const { return velocity + spin.cross(point - centre); }
  };
  [[nodiscard]] RigidMotion motion_of(PanelId panel) const;
  std::vector<collision::BodyId> break_standing(PanelId panel, std::vector<PanelChunk> chunks);

  Scene& scene_;
  EventLog& log_;
  RunningSums& sums_;
  Debris& debris_;
  BreakablePanels& panels_;
};

}  // namespace topple::structure
