#include "visual/drawn_weight.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "model/index_of.h"
#include "model/panel_area.h"
#include "topple/structure/error.h"
#include "topple/structure/visual_mesh.h"
#include "visual/part_places.h"

namespace topple::structure {

namespace {

/// A triangle is shared out in pieces whose sides are no longer than this, m.
constexpr double finest = 0.25;

/// Pieces of the triangles of all meshes: a drawing of a building has far fewer.
constexpr double most_pieces = 2e7;

/// How many times finer than a triangle its pieces are.
double fineness(const Vec3& u, const Vec3& v) {
  return std::max(1.0, std::ceil(std::max({u.norm(), v.norm(), (v - u).norm()}) / finest));
}

/// A drawing in millimetres, taken for metres, would be cut into a million times as many pieces.
void require_in_metres(const Building& building, const DrawnMesh& drawn) {
  double pieces = 0;
  for (const auto& [a, b, c] : drawn.mesh.triangles) {
    const auto at = [&](int k) -> const Vec3& { return drawn.mesh.positions[static_cast<std::size_t>(k)]; };
    pieces += std::pow(fineness(at(b) - at(a), at(c) - at(a)), 2);
  }
  if (!(pieces <= most_pieces))
    throw InputError(building.file + ", meshes: \"" + drawn.name +
                     "\" has a density and a surface too large to share out over the building's parts; accepted: a "
                     "mesh in metres, as glTF is");
}

/// Surface of a mesh that lies nearest to each part, m2.
std::map<Part, double> nearest_surface(const fracture::Mesh& mesh, const PartPlaces& places) {
  std::map<Part, double> areas;
  for (const auto& triangle : mesh.triangles) {
    const auto at = [&](std::size_t k) -> const Vec3& { return mesh.positions[static_cast<std::size_t>(triangle[k])]; };
    const Vec3 u = at(1) - at(0), v = at(2) - at(0);
    const int n = static_cast<int>(fineness(u, v));
    const double area = u.cross(v).norm() / 2 / (n * n);
    // n^2 triangles alike, those that stand on their base before those that hang between them.
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        const auto add = [&](double third) {
          areas[places.nearest(at(0) + (i + third) / n * u + (j + third) / n * v, places.all())] += area;
        };
        add(1.0 / 3);
        if (i + j + 1 < n) add(2.0 / 3);
      }
  }
  return areas;
}

/// kg that each part carries.
void share_out(const Building& building, const DrawnMesh& drawn, const PartPlaces& places,
               std::map<Part, double>& carried) {
  const fracture::MeshAudit audit = fracture::audit(drawn.mesh, 1e-9, true);
  if (audit.open_edges > 0 || !(audit.volume > 0))
    throw InputError(building.file + ", meshes: \"" + drawn.name + "\" has a density and is not closed (" +
                     audit.text() + "); accepted: closed triangle meshes");
  const double mass = drawn.density * audit.volume;
  if (drawn.member.valid()) {
    carried[Part(drawn.member)] += mass;
  } else if (drawn.panel.valid()) {
    carried[Part(drawn.panel)] += mass;
  } else {
    require_in_metres(building, drawn);
    const std::map<Part, double> areas = nearest_surface(drawn.mesh, places);
    double sum = 0;
    for (const auto& [part, area] : areas) sum += area;
    for (const auto& [part, area] : areas) carried[part] += area / sum * mass;
  }
}

void make_denser(Building& building, Part part, double mass) {
  MaterialId& own = part.member.valid() ? building.members[index_of(part.member)].material
                                        : building.panels[index_of(part.panel)].material;
  const std::string& name = part.member.valid() ? building[part.member].name : building[part.panel].name;
  const double volume = part.member.valid()
                            ? building[building[part.member].section].area * building[part.member].length
                            : building[part.panel].thickness * panel_area(building, building[part.panel], true);
  Material denser = building[own];
  denser.name += " of " + name;
  denser.density += mass / volume;
  own = MaterialId(building.materials.size());
  building.materials.push_back(std::move(denser));
}

}  // namespace

void add_drawn_weight(Building& building, const std::filesystem::path& file) {
  const PartPlaces places(building);
  std::map<Part, double> carried;
  for (const DrawnMesh& drawn : read_drawn_meshes(building, file))
    if (drawn.density > 0) share_out(building, drawn, places, carried);
  for (const auto& [part, mass] : carried) make_denser(building, part, mass);
}

}  // namespace topple::structure
