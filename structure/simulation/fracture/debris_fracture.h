#pragma once
// Panels that break in flight and where they land: those that came off whole break into chunks (shatter.cpp), those of
// bodies with other parts break out of them (crumble.cpp).
#include <array>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "simulation/debris/break_up.h"
#include "simulation/debris/release_impulses.h"
#include "simulation/fracture/landing_impulses.h"

namespace topple::structure {

class DebrisFracture {
 public:
  /// What it looks at and changes; all of it must outlive it.
  struct Sources {
    Scene& scene;
    EventLog& log;
    RunningSums& sums;
    Debris& debris;
    Hinges& hinges;
    BreakablePanels& panels;
    PieceViews& views;
    BreakUp& break_up;
    const ReleaseImpulses& release_impulses;
  };
  explicit DebrisFracture(const Sources& sources);

  /// A panel that an impact broke off the frame: what hit it pushes the chunks that it broke out, each by its share of
  /// the mass, and flies on through the gap.
  void shatter_struck(collision::BodyId id);
  /// Of the contacts of the last step, what the following ask for: how panels that break have landed.
  [[nodiscard]] std::vector<ContactRecord> landings(std::span<const ContactRecord> contacts);
  /// Panels that came down hard, by landings(). False: none.
  bool shatter_landed(std::span<const ContactRecord> landings);

  /// An impact on a panel of a body that has other parts.
  struct PanelImpact {
    double energy = 0;       ///< of the approach, J
    Vec3 at = Vec3::Zero();  ///< in the undeformed building
    double radius = 0;       ///< of the ball that hit it, m
  };
  /// Of landings(): the hardest on each panel. Taken before bodies break up, so that each is felt by the body that had
  /// it.
  [[nodiscard]] std::map<PanelId, PanelImpact> impacts_on_panels(std::span<const ContactRecord> landings) const;
  /// They break out of the bodies that they are in now.
  void crumble(const std::map<PanelId, PanelImpact>& impacts);

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [scene, log, sums, debris, hinges, panels, views, break_up, release_impulses, landing] = *this;
    archive(landing);
  }

 private:
  /// The hardest impact on a panel that came down: change of speed, m/s, and where, in the body's axes from its centre.
  struct Landing {
    double speed = 0;
    Vec3 at = Vec3::Zero();
  };
  std::vector<collision::BodyId> shatter(collision::BodyId id, const Vec3& point, std::optional<double> radius,
                                         std::size_t& out);
  void push_whole(collision::BodyId id);
  [[nodiscard]] double inverse_effective_mass(const Body& one, const ContactRecord& contact) const;
  std::vector<Body> break_out_in_flight(PanelId panel, const PanelImpact& impact);
  [[nodiscard]] std::array<bool, 4> held_in_flight(PanelId panel, const Body& one) const;

  Scene& scene_;
  EventLog& log_;
  RunningSums& sums_;
  Debris& debris_;
  Hinges& hinges_;
  BreakablePanels& panels_;
  PieceViews& views_;
  BreakUp& break_up_;
  const ReleaseImpulses& release_impulses_;
  LandingImpulses landing_;
};

}  // namespace topple::structure
