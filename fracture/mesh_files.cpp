#include "topple/fracture/mesh_files.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

namespace topple::fracture {

namespace {

template <class Number>
std::string number_text(Number number) {
  char buffer[40];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr};
}

template <class Vector>
std::string list_text(const Vector& values) {
  std::string text = "[";
  for (const auto value : values) text += (text.size() > 1 ? "," : "") + number_text(value);
  return text + "]";
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) >= 0x20) result += c;
  }
  return result + "\"";
}

void put_word(std::string& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>((word >> shift) & 0xffu);
}
void put_float(std::string& bytes, double value) {
  put_word(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

void put_chunk(std::string& file, std::uint32_t kind, std::string data, char padding) {
  while (data.size() % 4 != 0) data += padding;
  put_word(file, static_cast<std::uint32_t>(data.size()));
  put_word(file, kind);
  file += data;
}

constexpr int kFloat = 5126, kUnsigned = 5125, kVertices = 34962, kIndices = 34963;

struct Accessor {
  int component;
  const char* type;
  std::size_t count, offset, length;
  int target;
  std::string bounds;
};

std::string accessors_text(const std::vector<Accessor>& accessors) {
  std::string views, list;
  for (std::size_t i = 0; i < accessors.size(); ++i) {
    const Accessor& a = accessors[i];
    const char* comma = i == 0 ? "" : ",";
    views += comma + std::string("{\"buffer\":0,\"byteOffset\":") + number_text(a.offset) +
             ",\"byteLength\":" + number_text(a.length) + ",\"target\":" + number_text(a.target) + "}";
    list += comma + std::string("{\"bufferView\":") + number_text(i) +
            ",\"componentType\":" + number_text(a.component) + ",\"count\":" + number_text(a.count) + ",\"type\":\"" +
            a.type + "\"" + a.bounds + "}";
  }
  return "\"bufferViews\":[" + views + "],\"accessors\":[" + list + "]";
}

}  // namespace

namespace {

/// Buffer and accessors of one mesh after another.
struct MeshData {
  std::string bytes;
  std::vector<Accessor> accessors;

  void add(int component, const char* type, std::size_t count, std::size_t begin, int target) {
    accessors.push_back({component, type, count, begin, bytes.size() - begin, target, {}});
  }

  /// Four accessors: positions about `origin`, normals, texture coordinates, indices.
  void add(const Mesh& mesh, const Vec3& origin) {
    std::vector<double> lower(3, std::numeric_limits<double>::max()), upper(3, std::numeric_limits<double>::lowest());
    std::size_t begin = bytes.size();
    for (const Vec3& position : mesh.positions)
      for (int i = 0; i < 3; ++i) {
        const double value = position[i] - origin[i];
        const auto axis = static_cast<std::size_t>(i);
        const double written = static_cast<float>(value);
        lower[axis] = std::min(lower[axis], written);
        upper[axis] = std::max(upper[axis], written);
        put_float(bytes, value);
      }
    add(kFloat, "VEC3", mesh.positions.size(), begin, kVertices);
    accessors.back().bounds = ",\"min\":" + list_text(lower) + ",\"max\":" + list_text(upper);
    begin = bytes.size();
    for (const Vec3& normal : mesh.normals)
      for (const double value : normal) put_float(bytes, value);
    add(kFloat, "VEC3", mesh.normals.size(), begin, kVertices);
    begin = bytes.size();
    for (const Vec2& texture : mesh.texture) {
      put_float(bytes, texture.x());
      put_float(bytes, 1 - texture.y());
    }
    add(kFloat, "VEC2", mesh.texture.size(), begin, kVertices);
    begin = bytes.size();
    for (const auto& triangle : mesh.triangles)
      for (const int vertex : triangle) put_word(bytes, static_cast<std::uint32_t>(vertex));
    add(kUnsigned, "SCALAR", 3 * mesh.triangles.size(), begin, kIndices);
  }
};

std::string extras_text(const MeshFileInfo& info) {
  std::string extras;
  for (const auto& [name, value] : info.extras)
    extras += (extras.empty() ? "" : ",") + quoted(name) + ":" + number_text(value);
  return "\"extras\":{" + extras + "}";
}

std::string mesh_text(const std::string& name, std::size_t number) {
  const auto at = [&](std::size_t i) { return number_text(4 * number + i); };
  return "{\"name\":" + name + ",\"primitives\":[{\"attributes\":{\"POSITION\":" + at(0) + ",\"NORMAL\":" + at(1) +
         ",\"TEXCOORD_0\":" + at(2) + "},\"indices\":" + at(3) + "}]}";
}

constexpr const char* kHead = "{\"asset\":{\"version\":\"2.0\",\"generator\":\"topple\"},\"scene\":0,";

std::string glb_of(std::string json, const std::string& meshes, const MeshData& data) {
  const bool empty = meshes.empty();
  if (!empty)
    json += ",\"meshes\":[" + meshes + "],\"buffers\":[{\"byteLength\":" + number_text(data.bytes.size()) + "}]," +
            accessors_text(data.accessors);
  json += "}";
  std::string chunks;
  put_chunk(chunks, 0x4e4f534au, json, ' ');
  if (!empty) put_chunk(chunks, 0x004e4942u, data.bytes, '\0');
  std::string file = "glTF";
  put_word(file, 2);
  put_word(file, static_cast<std::uint32_t>(12 + chunks.size()));
  return file + chunks;
}

}  // namespace

std::string glb_text(const Mesh& mesh, const MeshFileInfo& info) {
  const std::string name = quoted(info.name);
  // A mesh of nothing is not allowed: the node then stands alone.
  const bool empty = mesh.triangles.empty();
  MeshData data;
  if (!empty) data.add(mesh, info.origin);
  const std::string json = kHead + std::string("\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"name\":") + name +
                           ",\"translation\":" + list_text(info.origin) + (empty ? "" : ",\"mesh\":0") + "," +
                           extras_text(info) + "}]";
  return glb_of(json, empty ? "" : mesh_text(name, 0), data);
}

std::string glb_text(const std::vector<PlacedMesh>& placed) {
  MeshData data;
  std::string nodes, meshes, children;
  std::size_t count = 0;
  for (const PlacedMesh& one : placed) {
    if (one.mesh->triangles.empty()) continue;
    const std::string name = quoted(one.info.name);
    data.add(*one.mesh, Vec3::Zero());
    meshes += (count == 0 ? "" : ",") + mesh_text(name, count);
    nodes += ",{\"name\":" + name + ",\"translation\":" + list_text(one.info.origin) +
             ",\"rotation\":" + list_text(one.rotation) + ",\"mesh\":" + number_text(count) + "," +
             extras_text(one.info) + "}";
    ++count;
    children += (children.empty() ? "" : ",") + number_text(count);
  }
  const double half = std::sqrt(0.5);
  std::string root = "{\"rotation\":" + list_text(Eigen::Vector4d(-half, 0, 0, half));
  if (!children.empty()) root += ",\"children\":[" + children + "]";
  return glb_of(kHead + std::string("\"scenes\":[{\"nodes\":[0]}],\"nodes\":[") + root + "}" + nodes + "]", meshes,
                data);
}

std::string obj_text(const Mesh& mesh, const std::string& name) {
  std::string text = "o " + name + "\n";
  const auto line = [&](const char* kind, const auto& values) {
    text += kind;
    for (const double value : values) text += " " + number_text(value);
    text += "\n";
  };
  for (const Vec3& position : mesh.positions) line("v", position);
  for (const Vec2& texture : mesh.texture) line("vt", texture);
  for (const Vec3& normal : mesh.normals) line("vn", normal);
  for (const auto& triangle : mesh.triangles) {
    text += "f";
    for (const int vertex : triangle) {
      const std::string number = number_text(vertex + 1);
      text += " " + number + "/" + number + "/" + number;
    }
    text += "\n";
  }
  return text;
}

}  // namespace topple::fracture
