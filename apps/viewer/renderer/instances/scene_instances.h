#pragma once
// From a building and a snapshot to the arrays that the graphics card draws: one array for each section and one for
// each shape of panel, standing parts first, moving ones after them. Standing parts are worked out again only when the
// structure's answer or the options change; moving ones for each picture.
#include <algorithm>
#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/camera.h"
#include "renderer/instances/chunk_instances.h"
#include "renderer/instances/drawn_instances.h"
#include "renderer/instances/overlay_instances.h"
#include "renderer/instances/torn_end_instances.h"
#include "renderer/shapes/dust.h"
#include "renderer/shapes/piers.h"
#include "renderer/snapshot.h"
#include "renderer/view_options.h"

namespace topple::viewer {

class SceneInstances {
 public:
  /// `ground`: its height, m, on which piers stand below supports that lie above it; none: no piers are drawn.
  explicit SceneInstances(const structure::Building& building, std::optional<double> ground = std::nullopt);
  void update(const Snapshot& snapshot, const ViewOptions& options);

  [[nodiscard]] const std::vector<InstanceBatch<MemberInstance>>& members() const { return members_; }
  /// Slabs and walls apart, for their opacities: [kind][shape].
  [[nodiscard]] const std::vector<InstanceBatch<PanelInstance>>& panels(structure::PanelKind kind) const {
    return kind == structure::PanelKind::slab ? slabs_ : walls_;
  }
  [[nodiscard]] const InstanceBatch<RigidInstance>& projectiles() const { return projectiles_; }
  /// Each chunk of a broken panel, and each state of what remains of it, has a mesh of its own; batches are only ever
  /// added. One that is gone has no instance.
  [[nodiscard]] const std::vector<InstanceBatch<RigidInstance>>& chunks() const { return chunks_.batches(); }
  /// The same of a model that is drawn around the building: a batch for each piece, bent while it stands.
  [[nodiscard]] const std::vector<InstanceBatch<RigidInstance>>& drawn() const { return drawn_.batches(); }

  /// Below supports, in the view of materials.
  [[nodiscard]] const InstanceBatch<RigidInstance>& piers() const { return piers_; }
  /// Torn ends of members of concrete.
  [[nodiscard]] const std::vector<InstanceBatch<RigidInstance>>& torn_ends() const { return torn_ends_.batches(); }

  /// Loads and contacts; reactions, which come from below the ground.
  [[nodiscard]] const InstanceBatch<RigidInstance>& arrows() const { return overlays_.arrows(); }
  [[nodiscard]] const InstanceBatch<RigidInstance>& buried_arrows() const { return overlays_.buried_arrows(); }
  /// At joints that have yielded.
  [[nodiscard]] const InstanceBatch<RigidInstance>& hinges() const { return overlays_.hinges(); }
  [[nodiscard]] const std::vector<DustInstance>& dust() const { return dust_; }
  /// Diagrams along members.
  [[nodiscard]] const Overlay& diagrams() const { return overlays_.diagrams(); }
  /// Around what is hovered over and selected, where it now is.
  [[nodiscard]] const Overlay& marks() const { return overlays_.marks(); }

  /// The centre of the undeformed building; single precision counts from here.
  [[nodiscard]] const glm::dvec3& origin() const { return origin_; }
  [[nodiscard]] const Bounds& bounds() const { return bounds_; }
  /// Members are bent so that it is seen: by what the run has done to them, because displacements are enlarged, or
  /// because a mode is drawn.
  [[nodiscard]] bool bent() const {
    return built_.shape != nullptr || seen_bent_ ||
           std::max(built_.options.deflection_scale, built_.options.motion_scale_now()) > 1;
  }
  /// Some panel is of glass.
  [[nodiscard]] bool has_glass() const { return has_glass_; }
  /// m: of the thinner side of most members.
  [[nodiscard]] float member_width() const { return member_width_; }
  /// The largest of the values that Scale::largest_in_view refers to.
  [[nodiscard]] double largest() const { return parts_.largest(); }
  /// The least and greatest value of the diagram that is drawn (N, N m).
  [[nodiscard]] const std::array<double, 2>& diagram_range() const { return overlays_.diagram_range(); }

 private:
  /// What the standing instances were built for.
  struct Built {
    std::shared_ptr<const FrameAnswer> answer;
    std::shared_ptr<const Membership> membership;
    ViewOptions options;
    std::shared_ptr<const std::vector<Eigen::Matrix<float, 6, 1>>> shape;
    float scale = 0;
    std::shared_ptr<const TunedJoints> tuned;
    std::shared_ptr<const std::vector<float>> path;
    [[nodiscard]] bool same(const Snapshot& snapshot, const ViewOptions& now) const;
  };
  void build_members();
  void build_panels();
  void rebuild_standing(const Snapshot& snapshot, const ViewOptions& options);
  void build_piers(const Snapshot& snapshot, const ViewOptions& options);
  void append_moving(const Snapshot& snapshot);
  [[nodiscard]] bool is_seen_bent(const Snapshot& snapshot) const;
  [[nodiscard]] std::size_t section_of(std::size_t member) const {
    return static_cast<std::size_t>(building_.members[member].section.index);
  }
  [[nodiscard]] std::vector<InstanceBatch<PanelInstance>>& batches(const structure::Panel& panel) {
    return panel.kind == structure::PanelKind::slab ? slabs_ : walls_;
  }

  const structure::Building& building_;
  Bounds bounds_;
  glm::dvec3 origin_{0};
  PartInstances parts_;
  ChunkInstances chunks_;
  DrawnInstances drawn_;
  TornEndInstances torn_ends_;
  OverlayInstances overlays_;
  std::vector<InstanceBatch<MemberInstance>> members_;  ///< by section
  std::vector<InstanceBatch<PanelInstance>> slabs_, walls_;
  std::vector<std::size_t> panel_batch_;  ///< of each panel, in slabs_ or walls_
  InstanceBatch<RigidInstance> projectiles_, piers_;
  std::vector<Pier> pier_places_;
  std::vector<DustInstance> dust_;
  float member_width_ = 0;
  bool seen_bent_ = false, has_glass_ = false;
  Built built_;
  std::vector<MovingPart> moving_members_, moving_panels_;
};

/// Box around all nodes.
[[nodiscard]] Bounds bounds_of(const structure::Building& building);

}  // namespace topple::viewer
