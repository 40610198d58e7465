#include "topple/fracture/gltf_reader.h"

#include <tiny_gltf.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <new>
#include <optional>
#include <stdexcept>

namespace topple::fracture {

namespace {

using Matrix = Eigen::Matrix4d;

/// Pictures are of no use here.
bool skip_image(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
  return true;
}

Matrix transform_of(const tinygltf::Node& node) {
  Matrix m = Matrix::Identity();
  if (node.matrix.size() == 16) {
    for (int i = 0; i < 16; ++i) m(i % 4, i / 4) = node.matrix[static_cast<std::size_t>(i)];
    return m;
  }
  Eigen::Affine3d t = Eigen::Affine3d::Identity();
  if (node.translation.size() == 3) t.translate(Vec3(node.translation[0], node.translation[1], node.translation[2]));
  if (node.rotation.size() == 4)
    t.rotate(Eigen::Quaterniond(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]).normalized());
  if (node.scale.size() == 3) t.scale(Vec3(node.scale[0], node.scale[1], node.scale[2]));
  return t.matrix();
}

class Reader {
 public:
  Reader(const tinygltf::Model& model, std::string file) : model_(model), file_(std::move(file)) {}

  std::vector<NamedMesh> read() {
    Matrix upright;  // y up to z up
    upright << 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1;
    const std::size_t scene = model_.defaultScene >= 0 ? static_cast<std::size_t>(model_.defaultScene) : 0;
    if (scene >= model_.scenes.size()) fail("it has no scene");
    for (const int node : model_.scenes[scene].nodes) visit(node, upright, 0);
    return std::move(meshes_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw std::runtime_error(file_ + ": " + what); }

  template <class Thing>
  const Thing& at(const std::vector<Thing>& things, int index, const char* what) const {
    if (index < 0 || static_cast<std::size_t>(index) >= things.size()) fail(std::string("a missing ") + what);
    return things[static_cast<std::size_t>(index)];
  }

  void visit(int index, const Matrix& above, int depth) {
    constexpr int deepest = 64;
    // One node may stand below several others: a short file can place 2^64 of them.
    constexpr std::size_t most_placed = 100'000;
    if (depth > deepest) fail("nodes lie more than 64 deep in each other");
    if (++placed_ > most_placed) fail("more than 100000 nodes are placed; accepted: fewer");
    const tinygltf::Node& node = at(model_.nodes, index, "node");
    const Matrix here = above * transform_of(node);
    if (node.mesh >= 0) {
      NamedMesh named{node.name.empty() ? "node " + std::to_string(index) : node.name, {}};
      for (const tinygltf::Primitive& primitive : at(model_.meshes, node.mesh, "mesh").primitives)
        add(primitive, here, named.mesh);
      if (!named.mesh.triangles.empty()) meshes_.push_back(std::move(named));
    }
    for (const int child : node.children) visit(child, here, depth + 1);
  }

  /// Component c of element i of an accessor of numbers.
  class Numbers {
   public:
    Numbers(const Reader& reader, int index, int components) {
      const tinygltf::Accessor& accessor = reader.at(reader.model_.accessors, index, "accessor");
      const tinygltf::BufferView& view = reader.at(reader.model_.bufferViews, accessor.bufferView, "buffer view");
      const tinygltf::Buffer& buffer = reader.at(reader.model_.buffers, view.buffer, "buffer");
      type_ = accessor.componentType;
      count = accessor.count;
      if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) != components)
        reader.fail("an accessor of another kind than its use needs");
      size_ = size_of(reader, type_);
      const int stride = accessor.ByteStride(view);
      const std::size_t element = size_ * static_cast<std::size_t>(components), all = buffer.data.size();
      if (stride <= 0 || static_cast<std::size_t>(stride) < element) reader.fail("an accessor without a layout");
      stride_ = static_cast<std::size_t>(stride);
      // Nothing is added or multiplied before it is known to be small: the file may hold any number.
      const bool begins = view.byteOffset <= all && accessor.byteOffset <= all - view.byteOffset;
      const std::size_t left = begins ? all - view.byteOffset - accessor.byteOffset : 0;
      if (!begins || (count > 0 && (left < element || count - 1 > (left - element) / stride_)))
        reader.fail("an accessor beyond its buffer");
      data_ = buffer.data.data() + (all - left);
    }
    [[nodiscard]] bool real() const { return type_ == TINYGLTF_COMPONENT_TYPE_FLOAT; }
    [[nodiscard]] double real(std::size_t i, std::size_t c) const {
      const unsigned char* from = data_ + i * stride_ + c * size_;
      if (type_ == TINYGLTF_COMPONENT_TYPE_FLOAT) return read<float>(from);
      return static_cast<double>(whole(i, c)) / (size_ == 1 ? 255.0 : 65535.0);  // normalised texture coordinates
    }
    [[nodiscard]] std::uint32_t whole(std::size_t i, std::size_t c) const {
      const unsigned char* from = data_ + i * stride_ + c * size_;
      return size_ == 1 ? *from : size_ == 2 ? read<std::uint16_t>(from) : read<std::uint32_t>(from);
    }
    std::size_t count = 0;

   private:
    static std::size_t size_of(const Reader& reader, int type) {
      switch (type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
          return 1;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
          return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
          return 4;
        default:
          reader.fail("an accessor of another component type than positions, indices and texture coordinates have");
      }
    }
    template <class T>
    static T read(const unsigned char* from) {
      T value;
      std::memcpy(&value, from, sizeof value);
      return value;
    }
    const unsigned char* data_ = nullptr;
    std::size_t stride_ = 0, size_ = 0;
    int type_ = 0;
  };

  void add(const tinygltf::Primitive& primitive, const Matrix& place, Mesh& mesh) {
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != -1)
      fail("a mesh of something else than triangles; accepted: triangles");
    const auto attribute = [&](const char* name) {
      const auto found = primitive.attributes.find(name);
      return found == primitive.attributes.end() ? -1 : found->second;
    };
    if (attribute("POSITION") < 0) fail("a mesh without POSITION");
    const Numbers positions(*this, attribute("POSITION"), 3);
    if (!positions.real()) fail("positions that are no floating-point numbers");
    std::vector<Vec3> places(positions.count);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Vec3 own(positions.real(i, 0), positions.real(i, 1), positions.real(i, 2));
      places[i] = (place * own.homogeneous()).head<3>();
      if (!places[i].allFinite()) fail("a position that is not finite");
    }
    std::vector<std::array<std::size_t, 3>> triangles;
    if (primitive.indices >= 0) {
      const Numbers indices(*this, primitive.indices, 1);
      if (indices.real()) fail("indices that are no whole numbers");
      for (std::size_t i = 0; i + 2 < indices.count; i += 3)
        triangles.push_back({indices.whole(i, 0), indices.whole(i + 1, 0), indices.whole(i + 2, 0)});
    } else {
      for (std::size_t i = 0; i + 2 < places.size(); i += 3) triangles.push_back({i, i + 1, i + 2});
    }
    const bool mirrored = place.topLeftCorner<3, 3>().determinant() < 0;
    std::optional<Numbers> texture;
    if (const int accessor = attribute("TEXCOORD_0"); accessor >= 0) texture.emplace(*this, accessor, 2);
    constexpr std::size_t most_triangles = 5'000'000;
    triangles_ += triangles.size();
    if (triangles_ > most_triangles) fail("more than 5000000 triangles; accepted: fewer");
    for (auto [a, b, c] : triangles) {
      if (std::max({a, b, c}) >= places.size()) fail("a triangle of vertices that do not exist");
      if (mirrored) std::swap(b, c);
      // Flat: what is cut keeps the directions that it had.
      const Vec3 across = (places[b] - places[a]).cross(places[c] - places[a]);
      if (across.norm() == 0) continue;
      const int first = static_cast<int>(mesh.positions.size());
      for (const std::size_t v : {a, b, c}) {
        mesh.positions.push_back(places[v]);
        mesh.normals.push_back(across.normalized());
        mesh.texture.push_back(texture ? Vec2(texture->real(v, 0), 1 - texture->real(v, 1)) : Vec2::Zero());
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  }

  const tinygltf::Model& model_;
  std::string file_;
  std::vector<NamedMesh> meshes_;
  std::size_t placed_ = 0, triangles_ = 0;
};

/// The files that a glTF file may name: regular ones in its own folder or below. (tinygltf's own way expands names by
/// the shell's rules, commands included, and looks wherever they point.)
class Folder {
 public:
  explicit Folder(const std::string& file) {
    std::error_code ignored;
    root_ = std::filesystem::weakly_canonical(std::filesystem::path(file).parent_path() / ".", ignored);
  }
  [[nodiscard]] bool has(const std::string& file) const {
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::weakly_canonical(file, error);
    if (error || !std::filesystem::is_regular_file(whole, error)) return false;
    const auto root = root_.has_filename() ? root_ : root_.parent_path();
    return std::mismatch(root.begin(), root.end(), whole.begin(), whole.end()).first == root.end();
  }
  /// Of this and no other size: nothing is allocated for what is not there.
  static bool read(const std::string& file, std::vector<unsigned char>& bytes, std::string& why) {
    constexpr std::uintmax_t most = std::uintmax_t{1} << 30;
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
      return why = error ? error.message() : std::string("it is a folder, a pipe or a device"), false;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error) return why = error.message(), false;
    if (size > most) return why = std::to_string(size) + " bytes; accepted: at most " + std::to_string(most), false;
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return why = std::strerror(errno), false;
    bytes.resize(static_cast<std::size_t>(size));
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(stream.gcount()) != size) return why = "it became shorter while it was read", false;
    return true;
  }
  [[nodiscard]] tinygltf::FsCallbacks callbacks() {
    tinygltf::FsCallbacks calls{};
    calls.FileExists = [](const std::string& file, void* self) { return static_cast<Folder*>(self)->has(file); };
    calls.ExpandFilePath = [](const std::string& file, void*) { return file; };
    calls.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string* why, const std::string& file, void* self) {
      if (!static_cast<Folder*>(self)->has(file)) return *why += "not in the file's own folder", false;
      return read(file, *bytes, *why);
    };
    calls.user_data = this;
    return calls;
  }

 private:
  std::filesystem::path root_;
};

}  // namespace

std::vector<NamedMesh> read_gltf(const std::string& file) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(&skip_image, nullptr);
  tinygltf::Model model;
  std::string error, warning;
  Folder folder(file);
  loader.SetFsCallbacks(folder.callbacks());
  std::vector<unsigned char> bytes;
  if (!Folder::read(file, bytes, error)) throw std::runtime_error(file + ": cannot be read: " + error);
  const std::string base = std::filesystem::path(file).parent_path().string();
  const auto size = static_cast<unsigned int>(bytes.size());
  const bool binary = file.size() > 4 && file.compare(file.size() - 4, 4, ".glb") == 0;
  bool read = false;
  try {
    read = binary ? loader.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(), size, base)
                  : loader.LoadASCIIFromString(&model, &error, &warning, reinterpret_cast<const char*>(bytes.data()),
                                               size, base.empty() ? "." : base);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& parser) {  // what the parser itself does not turn into a text
    error = parser.what();
  }
  if (!read) throw std::runtime_error(file + ": no glTF 2.0 file: " + (error.empty() ? warning : error));
  return Reader(model, file).read();
}

}  // namespace topple::fracture
