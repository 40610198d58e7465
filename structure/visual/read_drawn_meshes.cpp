// The `meshes` of a model: what the key holds, and the glTF files that it names.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "formats/json/json_document.h"
#include "formats/read_meshes.h"
#include "topple/fracture/gltf_reader.h"
#include "topple/structure/error.h"
#include "topple/structure/visual_mesh.h"

namespace topple::structure {

std::vector<DrawnMesh> read_drawn_meshes(const Building& building, const std::filesystem::path& file) {
  if (file.extension() != ".json") return {};
  const formats::JsonDocument document = formats::JsonDocument::from_file(file);
  const NameIndex names(building);
  std::vector<DrawnMesh> meshes;
  for (const formats::MeshEntry& entry : formats::read_meshes(document.root())) {
    const std::filesystem::path drawing = file.parent_path() / entry.file;
    std::vector<fracture::NamedMesh> drawn;
    try {
      drawn = fracture::read_gltf(drawing.string());
    } catch (const std::runtime_error& error) {
      throw InputError(building.file + ", meshes." + entry.name + ".file: " + error.what());
    }
    for (fracture::NamedMesh& one : drawn) {
      const double unit = building.units.mass / std::pow(building.units.length, 3);
      DrawnMesh mesh{one.name, std::move(one.mesh), {}, {}, entry.density * unit};
      if (const auto bound = entry.bind.find(mesh.name); bound != entry.bind.end()) {
        mesh.member = names.member(bound->second).value_or(MemberId());
        mesh.panel = names.panel(bound->second).value_or(PanelId());
        if (!mesh.member.valid() && !mesh.panel.valid())
          throw InputError(building.file + ", meshes." + entry.name + ".bind." + mesh.name + ": found \"" +
                           bound->second + "\"; accepted: the name of a member or panel");
      }
      meshes.push_back(std::move(mesh));
    }
    for (const auto& [node, part] : entry.bind)
      if (std::none_of(meshes.begin(), meshes.end(), [&](const DrawnMesh& mesh) { return mesh.name == node; }))
        throw InputError(building.file + ", meshes." + entry.name + ".bind." + node + ": no node of " +
                         drawing.string() + " has that name and a mesh");
  }
  return meshes;
}

}  // namespace topple::structure
