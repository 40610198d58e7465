#pragma once
// A panel that breaks piece by piece, standing or lying: its chunks' mass, shapes and meshes, and those of what
// remains. All in global axes of the undeformed building.
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "archive/nested_state.h"
#include "simulation/debris/mass_properties.h"
#include "topple/fracture/panel.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

/// One convex chunk.
struct PanelChunk {
  MassProperties rest;
  double volume = 0;       ///< m3
  std::vector<Vec3> hull;  ///< corners of its collision shape, a prism: each with its opposite, about the centre
  std::shared_ptr<const fracture::Mesh> mesh;  ///< about the centre of mass
  bool hit = false;                            ///< the hit broke it out; else it is of the rest
};

class BrokenPanel {
 public:
  /// `mass`: of the whole panel. `space`: the eight corners of the panel's own collision shape, within which all shapes
  /// stay, a little apart, so that nothing starts inside a neighbour or what the panel was joined to. `held`: the edges
  /// that hold it.
  BrokenPanel(const Building& building, PanelId id, double mass, const std::vector<Vec3>& space,
              const fracture::PanelSettings& settings, const std::array<bool, 4>& held = {true, true, true, true});

  /// Throws InputError that names the panel where its cells or ring cracks are too small for it: what would else come
  /// out when it is hit.
  static void expect_fit(const Building& building, const Panel& panel, const fracture::PanelSettings& settings);

  /// What a hit at a point breaks out and what then hangs on nothing. Empty when nothing can break there.
  [[nodiscard]] std::vector<PanelChunk> hit(const Vec3& at, std::optional<double> radius);
  /// The same for a body of this radius that goes through: the hit is as much larger as it takes for nothing of the
  /// panel to be left within the radius, for cells break by where their sites lie. `first`: as without the body.
  [[nodiscard]] std::vector<PanelChunk> hit_through(const Vec3& at, std::optional<double> first, double radius);
  /// Other edges hold it from now on: what hangs on nothing leaves.
  [[nodiscard]] std::vector<PanelChunk> hold(const std::array<bool, 4>& held);
  /// All that remains, as chunks.
  [[nodiscard]] std::vector<PanelChunk> leave();

  /// Whether the material at (the foot of) a point is still there.
  [[nodiscard]] bool holds(const Vec3& at) const;
  [[nodiscard]] const std::array<bool, 4>& held() const { return held_; }
  /// Along which an edge of the panel is still there, m.
  [[nodiscard]] double edge_length(std::size_t edge) const { return panel_.intact_length(edge); }
  /// Chunks that left so far: they are numbered from 1.
  [[nodiscard]] int chunks_out() const { return chunks_out_; }

  // What remains: described when it is first asked for after a change.
  [[nodiscard]] double volume() const { return described().volume; }
  [[nodiscard]] const MassProperties& rest() const { return described().rest; }
  [[nodiscard]] const std::vector<std::vector<Vec3>>& hulls() const { return described().hulls; }
  [[nodiscard]] const std::shared_ptr<const fracture::Mesh>& mesh() const;
  [[nodiscard]] PanelRemains remains() const;
  /// Distance along a ray (unit direction) to its surface.
  [[nodiscard]] std::optional<double> ray(const Vec3& from, const Vec3& direction) const;

  /// Its place, thickness and space are the building's.
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [plane, thickness, panel, density, space, held, holes, chunks_out, description, mesh] = *this;
    archive(NestedState<fracture::BreakablePanel>{panel}, density, held, holes, chunks_out, description, mesh);
  }

 private:
  struct Plane {
    Vec3 origin;
    Mat3 axes;
    [[nodiscard]] Vec2 flat(const Vec3& point) const { return (axes * (point - origin)).head<2>(); }
    [[nodiscard]] Vec3 lift(const Vec3& local) const { return origin + axes.transpose() * local; }
  };
  static fracture::PanelShape shape_of(const Building& building, const Panel& panel, const Plane& plane,
                                       const std::array<bool, 4>& held);
  [[nodiscard]] std::vector<PanelChunk> chunks_of(const fracture::Fracture& fracture);
  [[nodiscard]] PanelChunk lift(const fracture::Chunk& chunk) const;
  struct Description {
    Description() {}  // clang makes none as long as the class around it is not whole
    double volume = 0;
    MassProperties rest;
    std::vector<std::vector<Vec3>> hulls;
  };
  template <class Archive>
  friend void serialize(Archive& archive, Description& of) {
    auto& [volume, rest, hulls] = of;
    archive(volume, rest, hulls);
  }
  [[nodiscard]] const Description& described() const;

  Plane plane_;
  double thickness_;
  fracture::BreakablePanel panel_;
  double density_;
  fracture::Polygon space_;
  std::array<bool, 4> held_;
  std::vector<std::vector<Vec2>> holes_;
  int chunks_out_ = 0;
  mutable std::optional<Description> description_;
  mutable std::shared_ptr<const fracture::Mesh> mesh_;
};

}  // namespace topple::structure
