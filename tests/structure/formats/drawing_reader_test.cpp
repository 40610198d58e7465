// glTF files of drawings: read as they are laid out, refused by what is wrong in them.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/scratch_folder.h"
#include "topple/fracture/gltf_reader.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/visual_mesh.h"

namespace fracture = topple::fracture;
using topple::test::ScratchFolder;
using Json = nlohmann::json;

namespace {

template <class T>
void add(std::string& bytes, std::initializer_list<T> numbers) {
  for (const T number : numbers) bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// A tetrahedron: four points of floats, then twelve indices of two bytes, then texture coordinates of one byte each.
std::string tetrahedron() {
  std::string bytes;
  add<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  add<std::uint16_t>(bytes, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
  add<std::uint8_t>(bytes, {0, 0, 255, 0, 0, 255, 255, 255});
  return bytes;
}

Json document() {
  return Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0, "name": "a"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"},
                  {"bufferView": 2, "componentType": 5121, "count": 4, "type": "VEC2", "normalized": true}],
    "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24},
                    {"buffer": 0, "byteOffset": 72, "byteLength": 8}],
    "buffers": [{"byteLength": 80}]})");
}

std::string glb(const Json& json, std::string binary = tetrahedron()) {
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4);
  std::string bytes;
  const auto length = [](const std::string& of) { return static_cast<std::uint32_t>(of.size()); };
  add<std::uint32_t>(bytes, {0x46546C67, 2, 28 + length(text) + length(binary), length(text), 0x4E4F534A});
  bytes += text;
  add<std::uint32_t>(bytes, {length(binary), 0x004E4942});
  return bytes + binary;
}

std::vector<fracture::NamedMesh> read(const std::string& bytes, const char* name = "d.glb") {
  const ScratchFolder folder;
  std::ofstream(folder / name, std::ios::binary) << bytes;
  return fracture::read_gltf((folder / name).string());
}

std::string refusal(const std::string& bytes, const char* name = "d.glb") {
  try {
    (void)read(bytes, name);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

Json with(const char* pointer, const Json& value) {
  Json changed = document();
  changed[Json::json_pointer(pointer)] = value;
  return changed;
}

}  // namespace

TEST_CASE("a drawing has its points turned upright, flat normals and texture coordinates") {
  const auto meshes = read(glb(document()));
  REQUIRE(meshes.size() == 1);
  CHECK(meshes[0].name == "a");
  const fracture::Mesh& mesh = meshes[0].mesh;
  REQUIRE(mesh.triangles.size() == 4);
  REQUIRE(mesh.positions.size() == 12);
  CHECK(mesh.positions[1] == fracture::Vec3(0, 0, 1));  // y up becomes z up
  CHECK(mesh.normals[0] == fracture::Vec3(0, 1, 0));    // of 0, 2, 1: -z of the file
  CHECK(mesh.texture[2].x() == 1);                      // vertex 1: (255, 0), and v from below
  CHECK(mesh.texture[2].y() == 1);
  CHECK(fracture::audit(mesh, 1e-9, true).volume == Approx(1. / 6));
}

TEST_CASE("nodes move what is below them: by a matrix, by parts, mirrored, without a name") {
  Json moved = document();
  moved["nodes"] = Json::parse(R"([
    {"children": [1, 2], "translation": [10, 0, 0], "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476], "scale": [2, 2, 2]},
    {"mesh": 0}, {"mesh": 0, "name": "m", "matrix": [-1, 0, 0, 0,  0, 1, 0, 0,  0, 0, 1, 0,  0, 5, 0, 1]}])");
  const auto meshes = read(glb(moved));
  REQUIRE(meshes.size() == 2);
  CHECK(meshes[0].name == "node 1");
  // A quarter about the file's y takes x to -z; twice as large, and 10 along x. Upright: (x, -z, y).
  CHECK((meshes[0].mesh.positions[2] - fracture::Vec3(10, 2, 0)).norm() < 1e-12);
  for (const auto& one : meshes)
    CHECK(fracture::audit(one.mesh, 1e-9, true).volume == Approx(8. / 6));  // none inside out
  double highest = 0;
  for (const fracture::Vec3& p : meshes[1].mesh.positions) highest = std::max(highest, p.z());
  CHECK(highest == Approx(2 * (5 + 1)));
}

TEST_CASE("triangles come without indices, and with indices of each size, and flat ones are nothing") {
  Json loose = document();
  loose["meshes"][0]["primitives"][0].erase("indices");
  loose["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  const auto single = read(glb(loose));  // four points: one triangle, and one left over
  REQUIRE(single.size() == 1);
  CHECK(single[0].mesh.triangles.size() == 1);
  CHECK(single[0].mesh.texture[0].isZero());
  std::string wide = tetrahedron().substr(0, 48);
  add<std::uint32_t>(wide, {0, 2, 1, 0, 0, 3});  // the second has two corners in one place
  Json large = document();
  large["accessors"][1] = {{"bufferView", 1}, {"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}};
  large["accessors"].erase(2);
  large["bufferViews"].erase(2);
  large["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  large["buffers"][0]["byteLength"] = 72;
  CHECK(read(glb(large, wide)).at(0).mesh.triangles.size() == 1);
  std::string small = tetrahedron().substr(0, 48);
  add<std::uint8_t>(small, {0, 2, 1, 0, 1, 3});
  Json narrow = large;
  narrow["accessors"][1]["componentType"] = 5121;
  narrow["bufferViews"][1]["byteLength"] = 6;
  narrow["buffers"][0]["byteLength"] = 54;
  CHECK(read(glb(narrow, small)).at(0).mesh.triangles.size() == 2);
}

TEST_CASE("a text with a buffer beside it is read as well, from its own folder alone") {
  const ScratchFolder folder;
  Json text = document();
  text["buffers"][0]["uri"] = "points.bin";
  std::filesystem::create_directory(folder / "inner");
  std::ofstream(folder / "points.bin", std::ios::binary) << tetrahedron();
  std::ofstream(folder / "d.gltf") << text.dump();
  std::ofstream(folder / "inner/d.gltf") << with("/buffers/0/uri", "../points.bin").dump();
  CHECK(fracture::read_gltf((folder / "d.gltf").string()).size() == 1);
  CHECK_THROWS_AS(fracture::read_gltf((folder / "inner/d.gltf").string()), std::runtime_error);
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  CHECK(fracture::read_gltf("d.gltf").size() == 1);
  std::filesystem::current_path(before);
}

TEST_CASE("what is wrong in a drawing is told by what it is") {
  struct Wrong {
    const char* pointer;
    Json value;
    const char* said;
  };
  for (const Wrong& wrong : {
           Wrong{"/scene", 5, "it has no scene"},
           Wrong{"/nodes/0/mesh", 3, "a missing mesh"},
           Wrong{"/nodes/0/children", {7}, "a missing node"},
           Wrong{"/nodes/0/children", {0}, "more than 64 deep"},
           Wrong{"/meshes/0/primitives/0/mode", 1, "something else than triangles"},
           Wrong{"/meshes/0/primitives/0/attributes", Json{{"NORMAL", 0}}, "a mesh without POSITION"},
           Wrong{"/meshes/0/primitives/0/attributes/POSITION", 9, "a missing accessor"},
           Wrong{"/meshes/0/primitives/0/attributes/POSITION", 1, "another kind than its use needs"},
           Wrong{"/meshes/0/primitives/0/indices", 2, "another kind than its use needs"},
           Wrong{"/accessors/0/componentType", 5125, "positions that are no floating-point numbers"},
           Wrong{"/accessors/0/componentType", 5122, "another component type than positions"},
           Wrong{"/accessors/1",
                 Json::parse(R"({"bufferView": 1, "componentType": 5126, "count": 6, "type": "SCALAR"})"),
                 "indices that are no whole numbers"},
           Wrong{"/accessors/0/bufferView", 8, "a missing buffer view"},
           Wrong{"/accessors/0/count", 3, "a triangle of vertices that do not exist"},
           Wrong{"/accessors/0/count", 9, "an accessor beyond its buffer"},
           Wrong{"/accessors/0/byteOffset", 1000, "an accessor beyond its buffer"},
           Wrong{"/bufferViews/0/byteStride", 4, "an accessor without a layout"},
           Wrong{"/bufferViews/0/buffer", 1, ""},
           Wrong{"/buffers/0/byteLength", 0, ""},
           Wrong{"/buffers/0/byteLength", -1, ""},
           Wrong{"/buffers", Json::array(), ""},
           Wrong{"/nodes/0/scale", {1e200, 1e200, 1e200}, "no error"},
           Wrong{"/nodes/0/matrix", std::vector<double>(16, 1e308), "a position that is not finite"},
       }) {
    INFO(wrong.pointer << " is " << wrong.value);
    const std::string told = refusal(glb(with(wrong.pointer, wrong.value)));
    CHECK_THAT(told, Catch::Contains(wrong.said));
    if (std::string(wrong.said) != "no error") CHECK_THAT(told, Catch::Contains("d.glb: "));
  }
}

TEST_CASE("bytes that are no glTF, and files that cannot be read, are told as such") {
  CHECK_THAT(refusal("no glTF at all"), Catch::Contains("d.glb: no glTF 2.0 file"));
  CHECK_THAT(refusal("{}", "d.gltf"), Catch::Contains("d.gltf: no glTF 2.0 file"));
  CHECK_THAT(refusal(""), Catch::Contains("d.glb: no glTF 2.0 file"));
  const std::string whole = glb(document());
  for (std::size_t size = 0; size < whole.size(); size += 3)  // cut anywhere
    CHECK_THAT(refusal(whole.substr(0, size)), Catch::Contains("d.glb: "));
  const ScratchFolder folder;
  const auto told = [](const std::filesystem::path& file) -> std::string {
    try {
      (void)fracture::read_gltf(file.string());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  };
  REQUIRE(::mkfifo((folder / "pipe.glb").c_str(), 0600) == 0);
  CHECK_THAT(told(folder / "pipe.glb"), Catch::Contains("it is a folder, a pipe or a device"));
  std::ofstream(folder / "large.glb") << "x";
  std::filesystem::resize_file(folder / "large.glb", (std::uintmax_t{1} << 30) + 1);  // of holes: no room on the disk
  CHECK_THAT(told(folder / "large.glb"), Catch::Contains("1073741825 bytes; accepted: at most 1073741824"));
  CHECK_THAT(told(folder.path()), Catch::Contains("it is a folder, a pipe or a device"));
  CHECK_THAT(told(folder / "missing.glb"), Catch::Contains("No such file or directory"));
}

TEST_CASE("a short file that places very many nodes, or draws very many triangles, is refused") {
  Json tree = document();
  tree["nodes"] = Json::array();
  for (int i = 0; i < 40; ++i) tree["nodes"].push_back({{"children", {i + 1, i + 1}}});
  tree["nodes"].push_back({{"mesh", 0}});
  CHECK_THAT(refusal(glb(tree)), Catch::Contains("more than 100000 nodes are placed"));
  Json many = document();  // 100 nodes of 100 meshes' worth of 3 * 20,000 indices
  std::string bytes = tetrahedron().substr(0, 48);
  constexpr int corners = 3 * 60'000;
  for (int i = 0; i < corners / 3; ++i) add<std::uint16_t>(bytes, {0, 2, 1});
  many["accessors"][1]["count"] = corners;
  many["accessors"].erase(2);
  many["bufferViews"].erase(2);
  many["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  many["bufferViews"][1]["byteLength"] = 2 * corners;
  many["buffers"][0]["byteLength"] = bytes.size();
  many["scenes"][0]["nodes"] = std::vector<int>(100, 0);
  CHECK_THAT(refusal(glb(many, bytes)), Catch::Contains("more than 5000000 triangles"));
}

TEST_CASE("a model's drawings are refused by the key that names them") {
  using namespace topple::structure;
  const ScratchFolder folder;
  std::ofstream(folder / "d.glb", std::ios::binary) << glb(document());
  std::ofstream(folder / "bad.glb", std::ios::binary) << "bad";
  const auto meshes = [&](const std::string& bind, const std::string& file = "d.glb") {
    const std::string text = R"({"topple": 1, "materials": {"S": {"youngs_modulus": 210e9, "poisson_ratio": 0.3}},
      "sections": {"s": {"area": 0.01, "Iy": 1e-4, "Iz": 2e-5, "J": 1e-6}}, "nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 3, 0], "D": [0, 3, 0]},
      "members": {"AB": {"nodes": ["A", "B"], "section": "s", "material": "S"}},
      "panels": {"W": {"nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "S"}},
      "supports": {"A": "fixed"}, "meshes": {"facade": {"file": ")" +
                             file + R"(", "bind": )" + bind + "}}}";
    std::ofstream(folder / "m.json") << text;
    return read_drawn_meshes(parse_model(text, "m.json", Purpose::inspect), folder / "m.json");
  };
  const auto told = [&](const std::string& bind, const std::string& file = "d.glb") -> std::string {
    try {
      (void)meshes(bind, file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  CHECK(meshes(R"({"a": "AB"})").at(0).member.index == 0);
  CHECK(meshes(R"({"a": "W"})").at(0).panel.index == 0);
  const auto nearest = meshes("\"nearest\"");
  REQUIRE(nearest.size() == 1);
  CHECK_FALSE(nearest[0].member.valid());
  CHECK_FALSE(nearest[0].panel.valid());
  CHECK_THAT(told(R"({"a": "X"})"),
             Catch::Contains("m.json, meshes.facade.bind.a: found \"X\"; accepted: the name of a"));
  CHECK_THAT(told(R"({"b": "AB"})"), Catch::Contains("m.json, meshes.facade.bind.b: no node of ") &&
                                         Catch::Contains("d.glb has that name and a mesh"));
  CHECK_THAT(told("\"nearest\"", "bad.glb"),
             Catch::Contains("m.json, meshes.facade.file: ") && Catch::Contains("bad.glb: no glTF 2.0 file"));
  CHECK(read_drawn_meshes(read_model(folder / "m.json", Purpose::inspect), folder / "m.3dd").empty());
}
