#include "formats/read_meshes.h"

namespace topple::structure::formats {

std::vector<MeshEntry> read_meshes(const JsonValue& root) {
  std::vector<MeshEntry> entries;
  const auto meshes = root.find("meshes");
  if (!meshes) return entries;
  meshes->expect_object();
  for (const JsonValue item : *meshes) {
    item.only({"file", "bind", "density", "material"});
    MeshEntry& entry = entries.emplace_back();
    entry.name = item.key();
    entry.file = item.require("file").text("the path of a glTF file, from the model's folder");
    if (const auto density = item.find("density")) entry.density = density->not_negative();
    if (const auto material = item.find("material")) {
      entry.material = material->text();
      const auto materials = root.find("materials");
      if (!materials || !materials->find(entry.material)) material->refuse("the name of a material");
    }
    const auto bind = item.find("bind");
    if (!bind) continue;
    if (bind->is_text()) {
      if (bind->text() != "nearest") bind->refuse("\"nearest\", or an object of glTF node names");
      continue;
    }
    bind->expect_object();
    for (const JsonValue part : *bind)
      entry.bind.emplace(std::string(part.key()), part.text("the name of a member or panel"));
  }
  return entries;
}

}  // namespace topple::structure::formats
