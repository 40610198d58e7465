#include "topple/fracture/mesh_files.h"
#include "topple/structure/visual_mesh.h"

namespace topple::structure {

std::string visual_mesh_glb(const VisualMesh& model, const Simulation& simulation) {
  std::map<std::int64_t, const BodyView*> bodies;
  for (const BodyView& body : simulation.bodies()) bodies.emplace(body.id.value, &body);
  std::vector<fracture::Mesh> meshes;
  meshes.reserve(model.pieces().size());  // the list below points into it
  std::vector<fracture::PlacedMesh> placed;
  const BentBuilding bent = bent_as(simulation.frame());
  for (const VisualMesh::Piece& piece : model.pieces()) {
    const auto body = bodies.find(piece.body.value);
    if (piece.body.value != -1 && body == bodies.end()) continue;
    fracture::PlacedMesh one;
    fracture::Mesh mesh = *piece.mesh;
    if (piece.body.value == -1) {
      for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        mesh.positions[v] += displacement_with(simulation.building(), (*piece.bones)[v], mesh.positions[v], bent);
    } else {
      const BodyView& view = *body->second;
      for (Vec3& position : mesh.positions) position -= view.rest_centre;
      one.info.origin = view.pose.position;
      one.rotation = view.pose.orientation.coeffs();
    }
    meshes.push_back(std::move(mesh));
    one.mesh = &meshes.back();
    one.info.name = piece.name;
    one.info.extras = {{"volume", piece.volume}};
    placed.push_back(std::move(one));
  }
  return fracture::glb_text(placed);
}

}  // namespace topple::structure
