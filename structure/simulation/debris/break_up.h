#pragma once
// Bodies of several parts that are hit hard fall apart: as free segments (free_segment.h) their joints are asked what
// they bear, those most over capacity break, and the parts that are left move on as the whole did, so that momentum,
// linear and angular, and kinetic energy go over exactly.
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "model/index_of.h"
#include "simulation/accounts/event_log.h"
#include "simulation/accounts/piece_views.h"
#include "simulation/accounts/running_sums.h"
#include "simulation/debris/debris.h"
#include "simulation/debris/hinges.h"
#include "simulation/fracture/breakable_panels.h"
#include "simulation/impact/contact_record.h"
#include "simulation/impact/free_segment.h"
#include "simulation/impact/pressing_forces.h"

namespace topple::structure {

class BreakUp {
 public:
  /// What it looks at and changes; all of it must outlive it.
  struct Sources {
    Scene& scene;
    EventLog& log;
    RunningSums& sums;
    Debris& debris;
    Hinges& hinges;
    const BreakablePanels& panels;
    PieceViews& views;
  };
  explicit BreakUp(const Sources& sources);

  /// Bodies that the contacts of the last step press hard, or that spin fast, fall apart until nothing more breaks.
  void break_landed(std::span<const ContactRecord> contacts);

  /// Its joints are asked what they bear when it is hit hard.
  [[nodiscard]] bool may_fall_apart(const Body& one) const;
  [[nodiscard]] bool may_fall_apart(collision::BodyId id) const;
  /// The joint holds, in the frame or in what left it.
  [[nodiscard]] bool holds(JointId joint) const;
  /// The joint of a body broke.
  void lose(JointId joint) { broken_[index_of(joint)] = 1; }
  /// Lengths, m, of the edges by which a panel that can break is still joined; nothing for one that cannot: it comes
  /// down whole, with what most of its corners are joined to.
  [[nodiscard]] std::optional<std::array<double, 4>> free_panel_edges(PanelId panel) const;

  /// What left the frame, or a body, as a body at rest where it was in the undeformed building.
  [[nodiscard]] Body describe(const Detached& part) const;
  /// With what lies frozen on them.
  [[nodiscard]] FreeSegmentParts parts_of(const Body& one) const;
  [[nodiscard]] FreeSegment& free_segment_of(const Body& one);
  /// The body goes, or is about to be another.
  void forget(collision::BodyId id) { free_segments_.erase(id.value); }

  /// After joints of it broke: the bodies that it is now, itself when it still hangs together.
  std::vector<collision::BodyId> come_apart(collision::BodyId id);
  /// Replaces the body by its parts, each with the velocity of its centre in the whole; `chunks`: of panels that broke
  /// out of it, which move on with it.
  std::vector<collision::BodyId> split(collision::BodyId id, const std::vector<FreeSegmentParts>& parts,
                                       std::vector<Body> chunks = {});

  template <class Archive>
  void save(Archive& archive) const {
    auto& [scene, log, sums, debris, hinges, panels, views, pressing, broken, free_segments] = *this;
    archive(pressing, broken, free_segments.size());
    for (const auto& [body, segment] : free_segments) archive(body, *segment);
  }
  template <class Archive>
  void load(Archive& archive) {
    std::size_t segments = 0;
    archive(pressing_, broken_, segments);
    for (; segments > 0; --segments) {
      std::int64_t body = -1;
      archive(body);
      std::unique_ptr<FreeSegment>& segment = free_segments_[body];
      segment = std::make_unique<FreeSegment>(scene_.building);
      archive(*segment);
    }
  }

 private:
  /// What presses on a body, its spin and gravity do to it, in the axes of the undeformed building.
  struct BodyActions {
    collision::BodyId on;
    std::vector<FreePush> pushes;
    Vec3 spin, gravity;
    int generation = 0;  ///< of its breaks, so far
  };
  [[nodiscard]] std::vector<BodyActions> pressed_hard(std::span<const ContactRecord> contacts);
  [[nodiscard]] bool spins_hard(const Body& one, const Vec3& spin) const;
  [[nodiscard]] std::vector<BodyActions> handed_on(const BodyActions& loading,
                                                   const std::vector<collision::BodyId>& pieces) const;
  bool break_joints_of(const BodyActions& loading);
  void record_breaks(const Body& one, const std::vector<std::pair<JointId, Utilisation>>& broken, int generation);

  Scene& scene_;
  EventLog& log_;
  RunningSums& sums_;
  Debris& debris_;
  Hinges& hinges_;
  const BreakablePanels& panels_;
  PieceViews& views_;
  PressingForces pressing_;
  std::vector<char> broken_;                                            ///< per joint: after it had left the frame
  std::map<std::int64_t, std::unique_ptr<FreeSegment>> free_segments_;  ///< by body, made when it is first hit hard
};

}  // namespace topple::structure
