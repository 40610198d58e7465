// topple fracture PANEL -o DIR: breaks a panel without a building and writes what remains and every chunk.
#include <cmath>
#include <cstdio>
#include <memory>

#include "command.h"
#include "fracture_drawing.h"
#include "topple/fracture/mesh_files.h"
#include "topple/structure/formats/json_tree.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/formats/panel_file.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::app {

namespace {

using fracture::BreakablePanel;
using fracture::Chunk;
using structure::JsonTree;
using structure::PanelFile;

struct FractureOptions {
  std::string panel, folder;
  bool obj = false;
};

/// All that one run has broken, in order.
struct Broken {
  std::vector<Chunk> chunks;
  std::vector<std::size_t> hit;  ///< of each chunk, from 1
  std::size_t cells = 0;
};

std::string mesh_text(const fracture::Mesh& mesh, const fracture::MeshFileInfo& info, bool obj) {
  return obj ? fracture::obj_text(mesh, info.name) : fracture::glb_text(mesh, info);
}

JsonTree row(const auto& values) {
  auto list = JsonTree::array();
  for (const double value : values) list.push_back(value);
  return list;
}

std::string summary(const PanelFile& file, const BreakablePanel& panel, const Broken& broken, const char* ending) {
  JsonTree chunks = JsonTree::array(), areas = chunks, volumes = chunks;
  const double thickness = file.shape.thickness;
  double sum = panel.area();
  std::size_t loose = 0;
  for (std::size_t i = 0; i < broken.chunks.size(); ++i) {
    const auto properties = properties_of(broken.chunks[i], thickness, file.density);
    const double area = fracture::area(broken.chunks[i].outline);
    sum += area;
    loose += broken.chunks[i].hit ? 0 : 1;
    areas.push_back(area);
    volumes.push_back(properties.volume);
    chunks.push_back(
        {{"file", "chunk-" + std::to_string(i + 1) + ending},
         {"hit", broken.hit[i]},
         {"loose", !broken.chunks[i].hit},
         {"mass", properties.mass},
         {"centre", row(properties.centre)},
         {"inertia",
          {row(properties.inertia.row(0)), row(properties.inertia.row(1)), row(properties.inertia.row(2))}}});
  }
  const double whole = panel.intact_area();
  const JsonTree result{
      {"topple", TOPPLE_VERSION},
      {"panel", file.file},
      {"seed", file.settings.seed},
      {"counts",
       {{"hits", file.hits.size()},
        {"cells", broken.cells},
        {"chunks", broken.chunks.size()},
        {"loose_chunks", loose},
        {"panel_triangles", panel.mesh().triangles.size()}}},
      {"areas", {{"panel", whole}, {"remaining", panel.area()}, {"chunks", areas}}},
      {"volumes", {{"panel", whole * thickness}, {"remaining", panel.area() * thickness}, {"chunks", volumes}}},
      {"area_error", std::abs(sum - whole) / whole},
      {"chunks", chunks}};
  return result.dump(1) + "\n";
}

/// Chunks of an earlier run would look as if they were this one's.
void remove_earlier(const structure::OutputFolder& folder, const structure::NamedFiles& files) {
  std::vector<std::string> written;
  for (const auto& [name, text] : files) written.push_back(name);
  for (const char* ending : {".glb", ".obj"}) {
    folder.remove_numbered("chunk-", ending, written);
    const std::string panel = std::string("panel") + ending;
    std::error_code ignored;
    if (written.front() != panel) std::filesystem::remove(folder.path() / panel, ignored);
  }
}

int run(const FractureOptions& options) {
  const std::filesystem::path input = structure::find_panel(options.panel);
  const structure::OutputFolder folder(options.folder, {input}, {"panel.*", "chunk-*", "pattern.svg", "summary.json"});
  const PanelFile file = structure::read_panel(input);
  BreakablePanel panel(file.shape, file.settings);
  Broken broken;
  for (std::size_t i = 0; i < file.hits.size(); ++i) {
    const fracture::Fracture result = panel.hit(file.hits[i].at, file.hits[i].radius);
    broken.cells += result.cells;
    for (const Chunk& chunk : result.chunks) {
      broken.chunks.push_back(chunk);
      broken.hit.push_back(i + 1);
    }
  }
  const char* ending = options.obj ? ".obj" : ".glb";
  const double thickness = file.shape.thickness;
  std::vector<std::pair<std::string, std::string>> files;
  files.emplace_back(std::string("panel") + ending,
                     mesh_text(compact(panel.mesh()),
                               {"panel", fracture::Vec3::Zero(), {{"volume", panel.area() * thickness}}}, options.obj));
  for (std::size_t i = 0; i < broken.chunks.size(); ++i) {
    const auto properties = properties_of(broken.chunks[i], thickness, file.density);
    const std::string name = "chunk-" + std::to_string(i + 1);
    files.emplace_back(
        name + ending,
        mesh_text(mesh_of(broken.chunks[i], thickness),
                  {name, properties.centre, {{"mass", properties.mass}, {"volume", properties.volume}}}, options.obj));
  }
  files.emplace_back("pattern.svg", pattern_svg(file, panel, broken.chunks));
  files.emplace_back("summary.json", summary(file, panel, broken, ending));
  structure::write_files(options.folder, files);
  remove_earlier(folder, files);
  std::printf("%s: %zu hits, %zu chunks, %.4g of %.4g m2 remain; written to %s\n", file.file.c_str(), file.hits.size(),
              broken.chunks.size(), panel.area(), panel.intact_area(), structure::one_line(options.folder).c_str());
  return success;
}

const Registration registration(
    {"fracture", "Break a panel by itself and write the pieces", [](CLI::App& app) -> std::function<int()> {
       auto options = std::make_shared<FractureOptions>();
       app.add_option("PANEL", options->panel, "A shipped panel's name, or a file")->required();
       app.add_option("-o,--output", options->folder, "Folder for the meshes, drawing and summary")->required();
       app.add_flag("--obj", options->obj, "Wavefront OBJ instead of glTF");
       return [options] { return run(*options); };
     }});

}  // namespace

}  // namespace topple::app
