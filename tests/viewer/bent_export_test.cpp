// Members and panels are bent alike in the viewer's pictures and in what leaves it: glTF, USD, the replay page. Vertex
// by vertex, against the formula of the viewer's shaders.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/open_scene.h"
#include "app/output/gltf_scene.h"
#include "app/output/html_replay.h"
#include "app/output/usd_scene.h"
#include "app/part_motion.h"
#include "app/session.h"
#include "renderer/instances/scene_instances.h"
#include "support/scratch_folder.h"
#include "topple/structure/bent_part.h"

namespace {

using namespace topple::viewer;
using Eigen::Vector3d;
using topple::test::ScratchFolder;
using Places = std::vector<Vector3d>;

constexpr double rate = 60;  // as often as was recorded
/// Beside structure::drawn_tolerance: sections turn with the axis to first order there, by up to 0.1 rad in pictures.
constexpr double allowed = topple::structure::drawn_tolerance + 0.003;

/// A column is taken away at 0.5 s: beams hang by plastic hinges. Another at 4 s: they fall.
struct Collapse {
  Scene scene = open_scene("steel_frame_hinges");
  Session session{scene.building, scene.scenario};
  Collapse() {
    (void)session.snapshot();
    for (int i = 0; i < 300; ++i) {
      session.step();
      (void)session.snapshot();
    }
  }
  [[nodiscard]] const topple::structure::Building& building() const { return *scene.building; }
  [[nodiscard]] const Recording& recording() { return *session.recording(); }
};

/// Frames of files: it stands, swings down, hangs, falls.
constexpr std::array<int, 6> moments{0, 40, 55, 200, 265, 290};

glm::vec3 turned(const glm::vec4& q, const glm::vec3& v) {
  const glm::vec3 u(q.x, q.y, q.z);
  return v + 2.0F * glm::cross(u, glm::cross(u, v) + q.w * v);
}

/// member_vertex of renderer/shaders.cpp.
Vector3d drawn(const MemberInstance& m, const glm::vec3& position, const glm::dvec3& origin) {
  const float s = position.x, s2 = s * s, s3 = s2 * s, rest = 1 - s, span = m.length;
  const glm::vec3 x = turned(m.rotation, {1, 0, 0});
  const glm::vec3 slope1 = glm::cross(m.rotation1, x), slope2 = glm::cross(m.rotation2, x);
  const glm::vec3 chord = m.displacement2 - m.displacement1, across = chord - x * glm::dot(chord, x);
  glm::vec3 moves = m.displacement1 + x * glm::dot(chord, x) * s + (3 * s2 - 2 * s3) * across +
                    span * ((s - 2 * s2 + s3) * slope1 + (s3 - s2) * slope2);
  glm::vec3 slope = (6 * s - 6 * s2) * across / span + (1 - 4 * s + 3 * s2) * slope1 + (3 * s2 - 2 * s) * slope2;
  moves += 16 * s2 * rest * rest * m.bulge;
  slope += 32 * s * rest * (1 - 2 * s) * m.bulge / span;
  const glm::vec3 turns = glm::cross(x, slope) + x * (glm::dot(m.rotation1, x) * rest + glm::dot(m.rotation2, x) * s);
  glm::vec3 arm = turned(m.rotation, {0, position.y, position.z});
  if (const float angle = glm::length(turns); angle > 1e-9F)
    arm = turned({turns / angle * std::sin(angle / 2), std::cos(angle / 2)}, arm);
  const glm::dvec3 at = origin + glm::dvec3(m.first_end + x * s * span + moves + arm);
  return {at.x, at.y, at.z};
}

/// What a file draws of a part at a moment: triangles, each with its corners' places and normals.
struct Surface {
  Places places, normals;  ///< by threes
};
/// The largest angle between a triangle and the mean of its corners' normals, rad.
double largest_slant(const Surface& surface) {
  double most = 0;
  for (std::size_t i = 0; i + 2 < surface.places.size(); i += 3) {
    const Vector3d* p = &surface.places[i];
    const Vector3d across = (p[1] - p[0]).cross(p[2] - p[0]);
    if (across.norm() < 1e-6) continue;
    const Vector3d mean = surface.normals[i] + surface.normals[i + 1] + surface.normals[i + 2];
    most = std::max(most, std::acos(std::clamp(mean.normalized().dot(across.normalized()), -1.0, 1.0)));
  }
  return most;
}

/// Every vertex of every member that is there, and the corners of panels, as pictures have them.
struct Picture {
  std::map<std::size_t, Places> members, panels;
  Picture(Collapse& collapse, int moment) {
    const auto& building = collapse.building();
    const Snapshot snapshot = collapse.recording().at(moment / rate);
    SceneInstances instances(building);
    instances.update(snapshot, ViewOptions());
    const auto take = [&](const std::vector<int>& place, auto&& batch_of, auto&& add) {
      // Instances of what stands come first, then those of what moves, both in the order of the building.
      std::map<std::size_t, std::size_t> next;
      for (const bool stands : {true, false})
        for (std::size_t i = 0; i < place.size(); ++i)
          if (place[i] != part_gone && (place[i] == part_stands) == stands) add(i, next[batch_of(i)]++);
    };
    const auto section = [&](std::size_t m) { return static_cast<std::size_t>(building.members[m].section.index); };
    take(snapshot.membership->member, section, [&](std::size_t m, std::size_t at) {
      const auto& batch = instances.members()[section(m)];
      for (const Vertex& v : batch.mesh.vertices)
        members[m].push_back(drawn(batch.instances[at], v.position, instances.origin()));
    });
    take(
        snapshot.membership->panel, [](std::size_t) { return 0U; },
        [&](std::size_t p, std::size_t at) {
          if (snapshot.membership->broken[p]) return;
          for (const glm::vec3& c : instances.panels(topple::structure::PanelKind::slab)[0].instances[at].corner) {
            const glm::dvec3 corner = instances.origin() + glm::dvec3(c);
            panels[p].emplace_back(corner.x, corner.y, corner.z);
          }
        });
  }
};

/// The largest angle between the normals of a panel's faces at its corners and panel_vertex of renderer/shaders.cpp.
double largest_slant(const Surface& surface, const Places& corners, double half) {
  double most = 0;
  int met = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    const bool far_along = c == 1 || c == 2, far_up = c == 2 || c == 3;
    const Vector3d along = far_up ? corners[2] - corners[3] : corners[1] - corners[0];
    const Vector3d up = far_along ? corners[2] - corners[1] : corners[3] - corners[0];
    const Vector3d across = along.cross(up).normalized();
    for (std::size_t i = 0; i < surface.places.size(); ++i) {
      const double share = std::abs(surface.normals[i].dot(across));
      if (std::abs((surface.places[i] - corners[c]).norm() - half) > allowed || share < 0.7) continue;
      most = std::max(most, std::acos(std::min(share, 1.0)));
      ++met;
    }
  }
  REQUIRE(met >= 8);  // a vertex on either face at each corner
  return most;
}

/// Normals lie across what is drawn, whatever it is bent to: members' triangles in the file itself tell; a panel is
/// drawn by too few of them.
template <class Export>
void check_normals(Collapse& collapse, const Export& file) {
  double unturned = 0, unturned_member = 0;
  for (const int moment : moments) {
    const Picture picture(collapse, moment);
    for (const auto& [m, vertices] : picture.members) {
      INFO(collapse.building().members[m].name << " at frame " << moment);
      // Turns of up to 0.15 rad about two axes at once, to first order.
      CHECK(largest_slant(file.member_surface(m, moment, true)) < 0.03);
      unturned_member = std::max(unturned_member, largest_slant(file.member_surface(m, moment, false)));
    }
    for (const auto& [p, corners] : picture.panels) {
      INFO(collapse.building().panels[p].name << " at frame " << moment);
      const double half = collapse.building().panels[p].thickness / 2;
      CHECK(largest_slant(file.panel_surface(p, moment, true), corners, half) < 0.015);
      unturned = std::max(unturned, largest_slant(file.panel_surface(p, moment, false), corners, half));
    }
  }
  // What normals would be off by if they did not turn.
  CHECK(unturned > 0.06);
  CHECK(unturned_member > 0.06);
}

/// What an exported file draws of a part at a moment: its vertices, in the order of its mesh.
template <class Export>
void compare(Collapse& collapse, const Export& file) {
  const auto& building = collapse.building();
  for (const int moment : moments) {
    const Picture picture(collapse, moment);
    REQUIRE(picture.members.size() >= 20);
    for (const auto& [m, vertices] : picture.members) {
      INFO(building.members[m].name << " at frame " << moment);
      const Places is = file.member(m, moment);
      // One that is never bent has no vertices between its ends: then its straight lines are compared.
      if (is.size() == vertices.size())
        for (std::size_t v = 0; v < is.size(); ++v) REQUIRE((is[v] - vertices[v]).norm() < allowed);
      else
        for (const Vector3d& end : is)
          REQUIRE(std::any_of(vertices.begin(), vertices.end(),
                              [&](const Vector3d& v) { return (v - end).norm() < allowed; }));
    }
    for (const auto& [p, corners] : picture.panels) {
      INFO(building.panels[p].name << " at frame " << moment);
      const Places is = file.panel(p, moment);
      const double half = building.panels[p].thickness / 2;
      for (const Vector3d& corner : corners)
        REQUIRE(std::any_of(is.begin(), is.end(),
                            [&](const Vector3d& v) { return std::abs((v - corner).norm() - half) < allowed; }));
    }
  }
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

template <class T>
std::vector<T> numbers(const std::string& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

class Gltf {
 public:
  Gltf(const topple::structure::Building& building, const std::filesystem::path& file) : building_(building) {
    const std::string bytes = text_of(file);
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    json_ = nlohmann::json::parse(bytes.substr(20, length));
    binary_ = bytes.substr(28 + length);
    for (std::size_t n = 0; n < json_["nodes"].size(); ++n) nodes_[json_["nodes"][n]["name"]] = n;
    for (const auto& channel : json_["animations"][0]["channels"])
      samplers_[{channel["target"]["node"], channel["target"]["path"]}] =
          json_["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
  }
  [[nodiscard]] const nlohmann::json& json() const { return json_; }
  [[nodiscard]] const nlohmann::json& node(const std::string& name) const { return json_["nodes"][nodes_.at(name)]; }
  [[nodiscard]] Places member(std::size_t m, int frame) const { return places(building_.members[m].name, frame); }
  [[nodiscard]] Places panel(std::size_t p, int frame) const { return places(building_.panels[p].name, frame); }
  [[nodiscard]] Surface member_surface(std::size_t m, int frame, bool turned) const {
    return surface(building_.members[m].name, frame, turned);
  }
  [[nodiscard]] Surface panel_surface(std::size_t p, int frame, bool turned) const {
    return surface(building_.panels[p].name, frame, turned);
  }

 private:
  [[nodiscard]] std::vector<float> floats(std::size_t accessor) const {
    const auto& view = json_["bufferViews"][json_["accessors"][accessor]["bufferView"].get<std::size_t>()];
    return numbers<float>(binary_.substr(view["byteOffset"], view["byteLength"]));
  }
  /// Straight between keys, as the file asks.
  [[nodiscard]] std::vector<double> at(const std::string& name, const std::string& path, int frame,
                                       const std::vector<double>& still) const {
    const auto found = samplers_.find({nodes_.at(name), path});
    if (found == samplers_.end()) return still;
    const auto times = floats(found->second["input"]), values = floats(found->second["output"]);
    const std::size_t width = values.size() / times.size();
    const double time = frame / rate;
    std::size_t k = 0;
    while (k + 1 < times.size() && static_cast<double>(times[k + 1]) <= time + 1e-4) ++k;
    const std::size_t next = std::min(k + 1, times.size() - 1);
    const double t0 = static_cast<double>(times[k]), t1 = static_cast<double>(times[next]);
    const double share = next > k ? std::clamp((time - t0) / (t1 - t0), 0.0, 1.0) : 0;
    std::vector<double> value;
    for (std::size_t c = 0; c < width; ++c)
      value.push_back((1 - share) * static_cast<double>(values[k * width + c]) +
                      share * static_cast<double>(values[next * width + c]));
    return value;
  }
  [[nodiscard]] Places places(const std::string& name, int frame) const {
    return values(name, "POSITION", frame, true);
  }
  [[nodiscard]] Surface surface(const std::string& name, int frame, bool turned) const {
    const auto& primitive = json_["meshes"][node(name)["mesh"].get<std::size_t>()]["primitives"][0];
    const auto& accessor = json_["accessors"][primitive["indices"].get<std::size_t>()];
    const auto& view = json_["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const Places at = places(name, frame), normals = values(name, "NORMAL", frame, turned);
    Surface surface;
    for (const auto v : numbers<std::uint32_t>(binary_.substr(view["byteOffset"], view["byteLength"]))) {
      surface.places.push_back(at[v]);
      surface.normals.push_back(normals[v].normalized());
    }
    return surface;
  }
  /// Places, or normals: of each vertex.
  [[nodiscard]] Places values(const std::string& name, const char* what, int frame, bool turned) const {
    const auto& part = node(name);
    const auto& mesh = json_["meshes"][part["mesh"].get<std::size_t>()];
    const auto& primitive = mesh["primitives"][0];
    const bool is_place = what == std::string("POSITION");
    std::vector<float> sum = floats(primitive["attributes"][what]);
    const auto weights =
        at(name, "weights", frame, part.value("weights", mesh.value("weights", std::vector<double>())));
    REQUIRE(weights.size() == primitive.value("targets", nlohmann::json::array()).size());
    for (std::size_t k = 0; k < weights.size() && turned; ++k) {
      if (!primitive["targets"][k].contains(what)) continue;
      const auto way = floats(primitive["targets"][k][what]);
      REQUIRE(way.size() == sum.size());
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<float>(weights[k]) * way[i];
    }
    const auto t = at(name, "translation", frame, part["translation"]),
               r = at(name, "rotation", frame, part["rotation"]);
    const Eigen::Quaterniond turn = Eigen::Quaterniond(r[3], r[0], r[1], r[2]).normalized();
    Places list;
    for (std::size_t i = 0; i < sum.size(); i += 3) {
      const Vector3d p = turn * Eigen::Vector3f(sum[i], sum[i + 1], sum[i + 2]).cast<double>() +
                         (is_place ? Vector3d(t[0], t[1], t[2]) : Vector3d(Vector3d::Zero()));
      list.emplace_back(p.x(), -p.z(), p.y());  // y up to z up
    }
    return list;
  }

  const topple::structure::Building& building_;
  nlohmann::json json_;
  std::string binary_;
  std::map<std::string, std::size_t> nodes_;
  std::map<std::pair<std::size_t, std::string>, nlohmann::json> samplers_;
};

class Usd {
 public:
  Usd(const topple::structure::Building& building, const std::filesystem::path& file)
      : building_(building), text_(text_of(file)) {}
  [[nodiscard]] std::string prim(std::string name) const {
    std::replace(name.begin(), name.end(), '-', '_');
    const std::size_t begin = text_.find("def Mesh \"" + name + "\"");
    REQUIRE(begin != std::string::npos);
    return text_.substr(begin, text_.find("\n        }\n", begin) - begin);
  }
  /// In the order of the vertices of section_mesh(): points that lie at one place are one.
  [[nodiscard]] Places member(std::size_t m, int frame) const {
    const topple::structure::Member& member = building_.members[m];
    Places points = placed(prim(member.name), frame);
    for (const int segments : {1, topple::structure::bent_segments}) {
      const Mesh mesh = section_mesh(building_[member.section], segments);
      std::map<std::array<float, 3>, std::size_t> known;
      Places all;
      for (const Vertex& v : mesh.vertices) {
        const std::size_t k = known.try_emplace({v.position.x, v.position.y, v.position.z}, known.size()).first->second;
        if (k < points.size()) all.push_back(points[k]);
      }
      if (known.size() == points.size()) return all;
    }
    FAIL("as many points as no mesh of this section has");
    return {};
  }
  [[nodiscard]] Places panel(std::size_t p, int frame) const { return placed(prim(building_.panels[p].name), frame); }
  [[nodiscard]] Surface member_surface(std::size_t m, int frame, bool turned) const {
    return surface(prim(building_.members[m].name), frame, turned);
  }
  [[nodiscard]] Surface panel_surface(std::size_t p, int frame, bool turned) const {
    return surface(prim(building_.panels[p].name), frame, turned);
  }

 private:
  static std::vector<double> still(const std::string& prim, const std::string& attribute) {
    const std::size_t begin = prim.find(attribute + " = [") + attribute.size() + 4;
    return values(prim.substr(begin, prim.find(']', begin) - begin));
  }
  static Surface surface(const std::string& prim, int frame, bool turned) {
    const Places at = placed(prim, frame);
    std::vector<double> normals = turned ? sample(prim, "normal3f[] normals", frame) : std::vector<double>();
    if (normals.empty()) normals = still(prim, "normal3f[] normals");
    const auto r = sample(prim, "xformOp:orient", frame);
    Surface surface;
    for (const double v : still(prim, "int[] faceVertexIndices")) {
      const std::size_t n = 3 * surface.normals.size();
      surface.places.push_back(at[static_cast<std::size_t>(v)]);
      surface.normals.emplace_back(normals[n], normals[n + 1], normals[n + 2]);
      if (!r.empty())
        surface.normals.back() = Eigen::Quaterniond(r[0], r[1], r[2], r[3]).normalized() * surface.normals.back();
    }
    return surface;
  }
  static std::vector<double> values(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return std::strchr("()[],", c) != nullptr; }, ' ');
    std::istringstream in(text);
    std::vector<double> list;
    for (double x = 0; in >> x;) list.push_back(x);
    return list;
  }
  static std::vector<double> sample(const std::string& prim, const std::string& attribute, int frame) {
    const std::size_t begin = prim.find(attribute + ".timeSamples = {\n");
    if (begin == std::string::npos) return {};
    std::istringstream in(prim.substr(begin, prim.find("\n            }", begin) - begin));
    std::string line, last;
    std::getline(in, line);
    while (std::getline(in, line) && (last.empty() || std::stoi(line) <= frame)) last = line;
    return values(last.substr(last.find(':') + 1));
  }
  static Places placed(const std::string& prim, int frame) {
    std::vector<double> points = sample(prim, "point3f[] points", frame);
    if (points.empty()) points = still(prim, "point3f[] points");
    const auto t = sample(prim, "xformOp:translate", frame), r = sample(prim, "xformOp:orient", frame);
    Places list;
    for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
      list.emplace_back(points[i], points[i + 1], points[i + 2]);
      if (!t.empty())
        list.back() =
            Eigen::Quaterniond(r[0], r[1], r[2], r[3]).normalized() * list.back() + Vector3d(t[0], t[1], t[2]);
    }
    return list;
  }
  const topple::structure::Building& building_;
  std::string text_;
};

std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned held = 0, bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    held = held << 6U | static_cast<unsigned>(digits.find(c));
    if ((bits += 6) >= 8) bytes += static_cast<char>(held >> (bits -= 8) & 255U);
  }
  return bytes;
}

/// As replay/main.js puts it together; motions of bodies are the recording's.
class Page {
 public:
  Page(Collapse& collapse, const std::filesystem::path& file)
      : building_(collapse.building()), recording_(collapse.recording()), places_(part_places(building_, recording_)) {
    const std::string html = text_of(file), mark = "type=\"application/json\">";
    const std::size_t begin = html.find(mark) + mark.size();
    REQUIRE(begin > mark.size());
    data_ = nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
    const glm::dvec3 centre = bounds_of(building_).centre();
    origin_ = {centre.x, centre.y, centre.z};
    for (const auto& shape : data_["shapes"]) shapes_[shape["part"]] = shape;
  }
  [[nodiscard]] const nlohmann::json& data() const { return data_; }
  [[nodiscard]] Places member(std::size_t m, int moment) const {
    const int frame = recorded(moment);
    const auto& member = data_["members"][m];
    const auto n = floats(member["numbers"]);
    const bool bent = member.contains("bent");
    const auto& mesh = bent ? data_["bent"][member["bent"].get<std::size_t>()]
                            : data_["sections"][member["section"].get<std::size_t>()];
    Places list = this->bent(mesh, "positions", "bends", m, frame);
    for (Vector3d& p : list) {
      const Vector3d x(n[4], n[5], n[6]), y(n[7], n[8], n[9]), z(n[10], n[11], n[12]);
      const double along = bent ? p.x() + n[3] / 2 : p.x() * n[3];
      p = Vector3d(n[0], n[1], n[2]) + along * x + p.y() * y + p.z() * z;
    }
    return moved(std::move(list), m, frame);
  }
  [[nodiscard]] Places panel(std::size_t p, int moment) const {
    const int frame = recorded(moment);
    const std::size_t part = building_.members.size() + p;
    return moved(bent(data_["panels"][p]["states"][0]["mesh"], "positions", "bends", part, frame), part, frame);
  }
  [[nodiscard]] Surface member_surface(std::size_t m, int moment, bool turned) const {
    const auto& member = data_["members"][m];
    const auto& mesh = member.contains("bent") ? data_["bent"][member["bent"].get<std::size_t>()]
                                               : data_["sections"][member["section"].get<std::size_t>()];
    const auto n = floats(member["numbers"]);
    Eigen::Matrix3d axes;
    axes << n[4], n[7], n[10], n[5], n[8], n[11], n[6], n[9], n[12];
    return surface(mesh, this->member(m, moment), axes, m, moment, turned);
  }
  [[nodiscard]] Surface panel_surface(std::size_t p, int moment, bool turned) const {
    return surface(data_["panels"][p]["states"][0]["mesh"], panel(p, moment), Eigen::Matrix3d::Identity(),
                   building_.members.size() + p, moment, turned);
  }

 private:
  [[nodiscard]] Surface surface(const nlohmann::json& mesh, const Places& at, const Eigen::Matrix3d& axes,
                                std::size_t part, int moment, bool turned) const {
    const int frame = recorded(moment);
    const Places normals = bent(mesh, "normals", turned ? "turns" : "none", part, frame);
    const Vector3d here = moved({Vector3d::Zero()}, part, frame)[0];
    Surface surface;
    for (const auto v : numbers<std::uint32_t>(from_base64(mesh["indices"]))) {
      surface.places.push_back(at[v]);
      surface.normals.push_back((moved({axes * normals[v]}, part, frame)[0] - here).normalized());
    }
    return surface;
  }
  /// What rests is recorded at its beginning and its end.
  [[nodiscard]] int recorded(int moment) const {
    const auto& frames = recording_.frames();
    std::size_t frame = 0;
    while (frame + 1 < frames.size() && frames[frame + 1].time <= moment / rate + 1e-9) ++frame;
    return static_cast<int>(frame);
  }
  static std::vector<double> floats(const nlohmann::json& text) {
    const auto values = numbers<float>(from_base64(text));
    return {values.begin(), values.end()};
  }
  [[nodiscard]] std::size_t key(const nlohmann::json& shape, int frame) const {
    const auto frames = numbers<std::int32_t>(from_base64(shape["frames"]));
    const auto after = std::upper_bound(frames.begin(), frames.end(), frame);
    return after == frames.begin() ? 0 : static_cast<std::size_t>(after - frames.begin()) - 1;
  }
  /// Places, or normals, and how they go with its ways of bending.
  [[nodiscard]] Places bent(const nlohmann::json& mesh, const char* what, const char* by, std::size_t part,
                            int frame) const {
    auto sum = floats(mesh[what]);
    if (mesh.contains(by)) {
      const auto& shape = shapes_.at(part);
      const auto ways = floats(mesh[by]), weights = floats(shape["weights"]);
      const std::size_t k = key(shape, frame);
      for (std::size_t w = 0; w < ways.size() / sum.size(); ++w)
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weights[8 * k + w] * ways[w * sum.size() + i];
    }
    Places list;
    for (std::size_t i = 0; i < sum.size(); i += 3) list.emplace_back(sum[i], sum[i + 1], sum[i + 2]);
    return list;
  }
  [[nodiscard]] Places moved(Places list, std::size_t part, int frame) const {
    if (const auto shape = shapes_.find(part); shape != shapes_.end()) {
      const auto m = floats(shape->second["motions"]);
      const std::size_t k = 7 * key(shape->second, frame);
      for (Vector3d& p : list)
        p = Eigen::Quaterniond(m[k + 6], m[k + 3], m[k + 4], m[k + 5]) * p + Vector3d(m[k], m[k + 1], m[k + 2]);
    }
    int track = part_stands;
    for (const PlaceChange& change : places_[part])
      if (change.frame <= frame) track = change.track;
    for (Vector3d& p : list) {
      if (track >= 0) {
        const PartMotion motion = motion_of(recording_.tracks()[static_cast<std::size_t>(track)], frame, origin_);
        p = motion.turn * p + motion.shift;
      }
      p += origin_;
    }
    return list;
  }
  const topple::structure::Building& building_;
  const Recording& recording_;
  std::vector<std::vector<PlaceChange>> places_;
  nlohmann::json data_;
  Eigen::Vector3d origin_;
  std::map<std::size_t, nlohmann::json> shapes_;
};

}  // namespace

TEST_CASE("plastic hinges, what hangs by them and what falls from them are bent alike in pictures, glTF and USD") {
  const ScratchFolder folder;
  Collapse collapse;
  // The scene shows what it is there for: at both ends a beam is turned against its posts, which no elastic joint does.
  const auto& building = collapse.building();
  const topple::structure::NameIndex names(building);
  const auto beam = *names.member("BX-1-1-1");
  const Snapshot hangs = collapse.recording().at(200 / rate);
  const MemberShape* shape = hangs.answer->shapes->find(static_cast<std::size_t>(beam.index));
  REQUIRE(shape != nullptr);
  for (const std::size_t end : {0U, 1U}) {
    const auto node = static_cast<std::size_t>(building[beam].nodes[end].index);
    CHECK((shape->ends[end] - hangs.answer->displacements[node]).tail<3>().norm() > 0.05F);
  }

  write_gltf(building, collapse.recording(), (folder / "bent.glb").string(), rate);
  const Gltf gltf(building, folder / "bent.glb");
  compare(collapse, gltf);
  check_normals(collapse, gltf);
  // What is bent shares meshes too: one for each kind, section and length, beside that of the straight ones.
  std::size_t bent = 0, bending = 0;
  for (const auto& member : building.members) bent += gltf.node(member.name).contains("weights") ? 1 : 0;
  for (const auto& mesh : gltf.json()["meshes"]) bending += mesh.contains("weights") ? 1 : 0;
  CHECK(bent > 8);
  CHECK(bending <= 2 + building.panels.size());
  CHECK(gltf.json()["meshes"].size() <= 4 + building.panels.size() + collapse.recording().tracks().size());

  write_usd(building, collapse.recording(), (folder / "bent.usda").string(), rate);
  const Usd usd(building, folder / "bent.usda");
  compare(collapse, usd);
  check_normals(collapse, usd);
  CHECK(usd.prim("BX-1-1-1").find("points.timeSamples") != std::string::npos);
}

TEST_CASE("the replay page bends members and panels as pictures do") {
  if (!can_write_replay()) {
    std::cout << "SKIPPED: built without the replay page\n";
    return;
  }
  const ScratchFolder folder;
  Collapse collapse;
  write_html_replay(collapse.building(), collapse.recording(), (folder / "bent.html").string());
  const Page page(collapse, folder / "bent.html");
  compare(collapse, page);
  check_normals(collapse, page);
  CHECK(page.data()["bent"].size() <= 2);
}
