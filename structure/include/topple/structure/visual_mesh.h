#pragma once
// A visual mesh bound to a building: closed triangle meshes that follow the parts they are bound to, and are cut where
// those part from each other.
//
// Each place of a mesh belongs to the member or panel nearest to it (or to the one that its glTF node is bound to by
// name). While the parts of a piece stand or move together, the piece is whole; standing, its vertices follow the
// members as bones. When they part, it is cut by planes: through the joints that broke between them, across the member;
// else half way between the parts. What is drawn over a chunk of a broken panel is cut out along the chunk's sides and
// goes with it. Cuts are capped, so pieces stay closed and their volumes add up.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "topple/fracture/mesh.h"
#include "topple/structure/simulation.h"

namespace topple::structure {

/// One closed mesh of a model, global axes (z up), m.
struct DrawnMesh {
  std::string name;     ///< of its glTF node
  fracture::Mesh mesh;  ///< m, global axes
  MemberId member;      ///< what it is bound to by name, if it is
  PanelId panel;        ///< or this
  double density = 0;   ///< kg/m3; 0: it weighs nothing
};

/// The `meshes` of the file that the building was read from, from their glTF files; empty when it has none. Throws
/// InputError.
[[nodiscard]] std::vector<DrawnMesh> read_drawn_meshes(const Building& building, const std::filesystem::path& file);

/// Drawn meshes that follow a simulation.
class VisualMesh {
 public:
  /// Throws InputError, naming the mesh, for one that is not closed.
  VisualMesh(const Building& building, std::vector<DrawnMesh> meshes);
  ~VisualMesh();

  /// Cuts what has parted since the last call.
  void update(const Simulation& simulation);

  /// One closed piece of a mesh, and what it follows.
  struct Piece {
    std::string name;                            ///< of the mesh, numbered when it is in pieces
    std::shared_ptr<const fracture::Mesh> mesh;  ///< where it was in the undeformed building
    double volume = 0;                           ///< m3
    collision::BodyId body;                      ///< that it follows; -1: it stands, -2: it is gone
    /// Of a standing piece: the part that each vertex hangs on, members first, then panels; null: it does not stand.
    std::shared_ptr<const std::vector<std::int32_t>> bones;
  };
  /// As of the last update().
  [[nodiscard]] const std::vector<Piece>& pieces() const;
  /// Changes whenever pieces() may have.
  [[nodiscard]] std::uint64_t revision() const;
  /// Volume of all meshes as they were read, m3.
  [[nodiscard]] double volume() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A building as it is bent.
struct BentBuilding {
  std::function<Vec6(NodeId)> displacement;  ///< of a node, global
  std::function<bool(JointId)> holds;        ///< whether a joint still connects its two sides
};
/// How far a point of the undeformed building moves with the part that it hangs on (numbered as in Piece::bones): its
/// foot on the part moves and turns with the part, a member as it bends.
[[nodiscard]] Vec3 displacement_with(const Building& building, std::int32_t part, const Vec3& point,
                                     const BentBuilding& bent);
/// As a frame is bent at rest now; it has to outlive what is returned.
[[nodiscard]] BentBuilding bent_as(const StandingFrame& frame);

/// All pieces that are there, as a binary glTF file (y up): those that stand bent with their members, the others as
/// they lie. Each node tells its volume.
[[nodiscard]] std::string visual_mesh_glb(const VisualMesh& model, const Simulation& simulation);

}  // namespace topple::structure
