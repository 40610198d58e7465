#pragma once
// From a building and a snapshot to the arrays that the graphics card draws: one array for each section and one for
// each shape of panel, standing parts first, moving ones after them. Standing parts are worked out again only when the
// structure's answer or the options change; moving ones for each picture.
#include <algorithm>
#include <array>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/camera.h"
#include "renderer/shapes/dust.h"
#include "renderer/shapes/mesh.h"
#include "renderer/shapes/overlay.h"
#include "renderer/shapes/palette.h"
#include "renderer/shapes/piers.h"
#include "renderer/snapshot.h"
#include "renderer/view_options.h"

namespace topple::viewer {

/// Positions are relative to SceneInstances::origin().
struct MemberInstance {
  glm::vec3 first_end;
  glm::vec4 rotation;  ///< quaternion x, y, z, w: member axes to global
  float length;
  glm::vec3 displacement1, rotation1, displacement2, rotation2;  ///< of the two ends, global, scaled
  glm::vec3 bulge;        ///< of the middle beside that, global, scaled; the ends keep their turns
  Rgba base, end1, end2;  ///< base: with its material as alpha (looks.h), or 255
};
struct PanelInstance {
  glm::vec3 corner[4];
  float thickness;
  Rgba base, edge[4];  ///< of edges in the view of materials: cracks, by their alpha
  glm::vec3 rest[3];   ///< corners 1, 2 and 4 in the undeformed building
};
struct RigidInstance {
  glm::vec3 position;
  glm::vec4 rotation;
  glm::vec3 scale;
  Rgba colour;
  glm::vec3 rest{0};  ///< where the mesh's origin was in the undeformed building
};

/// Instances that share a mesh. The first `standing` of them change rarely.
template <class Instance>
struct InstanceBatch {
  Mesh mesh;
  std::vector<Mesh> coarse;  ///< simpler ones of the same, each coarser than the one before; none: too few to need any
  std::vector<Instance> instances;
  std::size_t standing = 0;
  std::uint64_t revision = 0;       ///< counts changes of the standing ones
  std::uint64_t mesh_revision = 0;  ///< counts changes of the mesh's vertices, whose number stays
};

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
  [[nodiscard]] const std::vector<InstanceBatch<RigidInstance>>& chunks() const { return chunks_; }
  /// The same of a model that is drawn around the building: a batch for each piece, bent while it stands.
  [[nodiscard]] const std::vector<InstanceBatch<RigidInstance>>& drawn() const { return drawn_; }

  /// Below supports, in the view of materials.
  [[nodiscard]] const InstanceBatch<RigidInstance>& piers() const { return piers_; }
  /// Torn ends of members of concrete.
  [[nodiscard]] const std::vector<InstanceBatch<RigidInstance>>& torn_ends() const { return torn_ends_; }

  /// Loads and contacts; reactions, which come from below the ground.
  [[nodiscard]] const InstanceBatch<RigidInstance>& arrows() const { return arrows_; }
  [[nodiscard]] const InstanceBatch<RigidInstance>& buried_arrows() const { return buried_arrows_; }
  [[nodiscard]] const std::vector<DustInstance>& dust() const { return dust_; }
  /// Diagrams along members.
  [[nodiscard]] const Overlay& diagrams() const { return diagrams_; }
  /// Around what is hovered over and selected, where it now is.
  [[nodiscard]] const Overlay& marks() const { return marks_; }

  /// The centre of the undeformed building; single precision counts from here.
  [[nodiscard]] const glm::dvec3& origin() const { return origin_; }
  [[nodiscard]] const Bounds& bounds() const { return bounds_; }
  /// Members are bent so that it is seen: by what the run has done to them, because displacements are enlarged, or
  /// because a mode is drawn.
  [[nodiscard]] bool bent() const {
    return built_shape_ != nullptr || seen_bent_ ||
           std::max(built_options_.deflection_scale, built_options_.motion_scale_now()) > 1;
  }
  /// Some panel is of glass.
  [[nodiscard]] bool has_glass() const { return has_glass_; }
  /// m: of the thinner side of most members.
  [[nodiscard]] float member_width() const { return member_width_; }
  /// The largest of the values that Scale::largest_in_view refers to.
  [[nodiscard]] double largest() const { return largest_; }
  /// The least and greatest value of the diagram that is drawn (N, N m).
  [[nodiscard]] const std::array<double, 2>& diagram_range() const { return diagram_range_; }

 private:
  struct Motion;
  struct BrokenPanel;
  struct Part {
    std::size_t batch = 0;
    MemberInstance rest;
  };
  struct PanelPart {
    std::size_t batch = 0;
    PanelInstance rest;
  };
  void place_members();
  void place_panels();
  void rebuild_standing(const Snapshot& snapshot, const ViewOptions& options);
  void draw_diagrams(const Snapshot& snapshot, const ViewOptions& options);
  void draw_arrows(const Snapshot& snapshot, const ViewOptions& options);
  void append_moving(const Snapshot& snapshot);
  void draw_marks(const Snapshot& snapshot, const ViewOptions& options);
  void draw_cables(const Snapshot& snapshot);
  [[nodiscard]] MemberInstance standing_member(std::size_t index, const Snapshot& snapshot,
                                               const ViewOptions& options) const;
  [[nodiscard]] PanelInstance standing_panel(std::size_t index, const Snapshot& snapshot,
                                             const ViewOptions& options) const;
  void place_chunks(const Snapshot& snapshot);
  void find_torn_ends();
  void place_torn_ends(const Snapshot& snapshot);
  [[nodiscard]] bool is_seen_bent(const Snapshot& snapshot) const;
  void place_piers(const Snapshot& snapshot, const ViewOptions& options);
  void add_torn_end(std::size_t index, int end, const MemberInstance& instance);
  [[nodiscard]] std::size_t bars_of_chunk(structure::MaterialId material) const;
  void place_broken_panels(const Snapshot& snapshot, bool bend);
  void bend_broken_panel(std::size_t panel, const Snapshot& snapshot, BrokenPanel& drawn);
  [[nodiscard]] Rgba broken_colour(std::size_t panel) const;
  void place_drawn(const Snapshot& snapshot, bool bend);
  void bend_drawn(const DrawnPiece& piece, const Snapshot& snapshot, InstanceBatch<RigidInstance>& batch) const;
  void colour_member(std::size_t index, const Snapshot& snapshot, const ViewOptions& options);
  void colour_panel(std::size_t index, const Snapshot& snapshot, const ViewOptions& options);
  [[nodiscard]] MemberInstance moved_member(std::size_t index, const Motion& motion, const Snapshot& snapshot) const;
  [[nodiscard]] PanelInstance moved_panel(std::size_t index, const Motion& motion, const Snapshot& snapshot) const;
  [[nodiscard]] bool shown(const structure::Member& member, const PartSwitches& switches) const;
  [[nodiscard]] std::vector<InstanceBatch<PanelInstance>>& batches(const structure::Panel& panel) {
    return panel.kind == structure::PanelKind::slab ? slabs_ : walls_;
  }

  const structure::Building& building_;
  Bounds bounds_;
  glm::dvec3 origin_{0};
  std::vector<Part> member_parts_;  ///< with their colours of now
  std::vector<PanelPart> panel_parts_;
  std::vector<InstanceBatch<MemberInstance>> members_;
  std::vector<InstanceBatch<PanelInstance>> slabs_, walls_;
  InstanceBatch<RigidInstance> projectiles_, piers_;
  std::vector<Pier> pier_places_;
  std::vector<InstanceBatch<RigidInstance>> chunks_;
  std::map<std::int64_t, std::size_t> chunk_of_body_;
  std::vector<InstanceBatch<RigidInstance>> torn_ends_;  ///< variants of each section, in their order
  InstanceBatch<RigidInstance> arrows_, buried_arrows_;
  std::vector<DustInstance> dust_;
  Overlay diagrams_, marks_;
  std::array<double, 2> diagram_range_{};
  /// Of a panel that is broken in part: the mesh that it draws, where its vertices are while nothing bends it, and how
  /// its corners have moved as it is drawn.
  struct BrokenPanel {
    std::shared_ptr<const fracture::Mesh> mesh;
    std::size_t batch = 0;
    std::vector<glm::vec3> rest;
    std::array<Eigen::Vector3f, 4> moved{};
  };
  std::map<std::size_t, BrokenPanel> broken_panels_;
  std::vector<InstanceBatch<RigidInstance>> drawn_;
  struct DrawnBatch {
    std::size_t batch = 0;
    bool bent = false;
  };
  std::map<std::shared_ptr<const fracture::Mesh>, DrawnBatch> batch_of_drawn_;
  double largest_ = 0;
  float member_width_ = 0;
  bool seen_bent_ = false, has_glass_ = false;
  // What the standing instances were built for.
  std::shared_ptr<const FrameAnswer> built_answer_;
  std::shared_ptr<const Membership> built_membership_;
  ViewOptions built_options_;
  std::shared_ptr<const std::vector<Eigen::Matrix<float, 6, 1>>> built_shape_;
  float built_scale_ = 0;
  std::shared_ptr<const TunedJoints> built_tuned_;
  std::shared_ptr<const std::vector<float>> built_path_;
  struct MovingPart {
    std::size_t index;
    int body;
  };
  std::vector<MovingPart> moving_members_, moving_panels_;
  /// Of moving members, by their place in moving_members_: ends at which nothing of the same body holds.
  std::vector<std::array<bool, 2>> torn_;
};

/// Box around all nodes.
[[nodiscard]] Bounds bounds_of(const structure::Building& building);

}  // namespace topple::viewer
