#include "app/output/usd_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "app/part_motion.h"
#include "renderer/shapes/palette.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::viewer {
namespace {

__attribute__((format(printf, 1, 2))) std::string print(const char* format, ...) {
  char text[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

/// Names of prims hold letters, digits and underscores, and are unique among their siblings.
class PrimNames {
 public:
  std::string operator()(const std::string& name) {
    std::string prim;
    for (const char c : name) prim += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    if (prim.empty() || std::isdigit(static_cast<unsigned char>(prim[0])) != 0) prim = "_" + prim;
    std::string unique = prim;
    for (int i = 2; !used_.insert(unique).second; ++i) unique = prim + "_" + std::to_string(i);
    return unique;
  }

 private:
  std::set<std::string> used_;
};

class UsdWriter {
 public:
  UsdWriter(const structure::Building& building, const Recording& recording, std::ostream& out, double rate)
      : building_(building), recording_(recording), out_(out), rate_(rate), samples_(export_samples(recording, rate)) {}

  void write() {
    out_ << "#usda 1.0\n(\n    defaultPrim = \"Building\"\n    upAxis = \"Z\"\n    metersPerUnit = 1\n"
         << print(
                "    timeCodesPerSecond = %.9g\n    framesPerSecond = %.9g\n    startTimeCode = 0\n    endTimeCode = "
                "%d\n",
                rate_, rate_, samples_.back().code)
         << ")\n\ndef Xform \"Building\"\n{\n";
    const auto places = part_places(building_, recording_);
    out_ << "    def Scope \"Members\"\n    {\n";
    PrimNames members;
    for (std::size_t m = 0; m < building_.members.size(); ++m)
      member(members(building_.members[m].name), structure::MemberId(m), places[m]);
    out_ << "    }\n    def Scope \"Panels\"\n    {\n";
    PrimNames panels;
    const auto states = panel_states(building_, recording_);
    for (std::size_t p = 0; p < building_.panels.size(); ++p)
      for (std::size_t k = 0; k < states[p].size(); ++k) {
        // What remains after each break is a prim of its own, seen while it lasts.
        const std::string& name = building_.panels[p].name;
        panel(panels(k == 0 ? name : name + "_rest"), structure::PanelId(p), states[p][k],
              places[building_.members.size() + p],
              {states[p][k].frame, k + 1 < states[p].size() ? states[p][k + 1].frame : never});
      }
    out_ << "    }\n    def Scope \"Bodies\"\n    {\n";
    for (const BodyTrack& track : recording_.tracks()) body(track);
    // Pieces of a model around the building, each while it is one; those that stand as they were drawn.
    out_ << "    }\n    def Scope \"Drawn\"\n    {\n";
    int number = 0;
    for (const DrawnTrack& piece : drawn_tracks(building_, recording_))
      part("drawn_" + std::to_string(++number), {placed_mesh(*piece.mesh, origin_), {}, {}, {}}, {ShapeChange()},
           piece.places, drawn_colour);
    out_ << "    }\n}\n";
  }

 private:
  /// Vertices at one place are one point, which is written once; normals go with the corners of faces.
  class Points {
   public:
    explicit Points(const Mesh& mesh) {
      std::map<std::array<float, 3>, std::size_t> known;
      for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const glm::vec3 p = mesh.vertices[v].position;
        const auto [one, made] = known.try_emplace({p.x, p.y, p.z}, vertex_.size());
        if (made) vertex_.push_back(v);
        of_.push_back(one->second);
      }
    }
    [[nodiscard]] std::size_t of(std::uint32_t vertex) const { return of_[vertex]; }
    /// Of this mesh or the same one bent.
    [[nodiscard]] std::string text(const Mesh& mesh) const {
      std::string text;
      for (const std::size_t v : vertex_) add(text, mesh.vertices[v].position);
      return text;
    }

   private:
    std::vector<std::size_t> of_, vertex_;  // of each vertex its point, of each point a vertex
  };
  static void add(std::string& text, const glm::vec3& p) {
    text += print("%s(%.7g, %.7g, %.7g)", text.empty() ? "" : ", ", static_cast<double>(p.x), static_cast<double>(p.y),
                  static_cast<double>(p.z));
  }

  /// Of each corner of its faces.
  static std::string normals_text(const Mesh& mesh) {
    std::string text;
    for (const std::uint32_t vertex : mesh.indices) add(text, mesh.vertices[vertex].normal);
    return text;
  }

  void mesh(const std::string& name, const Mesh& mesh, Rgba colour, const std::string& more) {
    const Points points(mesh);
    out_ << "        def Mesh \"" << name << "\"\n        {\n            int[] faceVertexCounts = [";
    for (std::size_t i = 0; i < mesh.indices.size() / 3; ++i) out_ << (i > 0 ? ", 3" : "3");
    out_ << "]\n            int[] faceVertexIndices = [";
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) out_ << (i > 0 ? ", " : "") << points.of(mesh.indices[i]);
    out_ << "]\n            point3f[] points = [" << points.text(mesh) << "]\n            normal3f[] normals = ["
         << normals_text(mesh) << "] (\n                interpolation = \"faceVarying\"\n            )\n"
         << "            uniform token subdivisionScheme = \"none\"\n";
    colour_and(colour, more);
  }
  void colour_and(Rgba colour, const std::string& more) {
    const glm::vec4 c = unpack(colour);
    const auto linear = [](float x) { return std::pow(static_cast<double>(x), 2.2); };
    out_ << print("            color3f[] primvars:displayColor = [(%.4g, %.4g, %.4g)]\n", linear(c.r), linear(c.g),
                  linear(c.b))
         << more << "        }\n";
  }

  /// Collects time samples, leaving out those that repeat what comes before and after.
  struct Motion {
    std::string translate, orient;
    std::string last_translate, last_orient;
    int held = -1;
    bool moved = false;
    void add(int code, const PartMotion& motion) {
      const std::string t =
          print("(%.7g, %.7g, %.7g)", motion.shift.x() + 0.0, motion.shift.y() + 0.0, motion.shift.z() + 0.0);
      const std::string q =
          print("(%.7g, %.7g, %.7g, %.7g)", motion.turn.w(), motion.turn.x(), motion.turn.y(), motion.turn.z());
      if (t == last_translate && q == last_orient) {
        held = code;
        return;
      }
      moved = moved || !last_translate.empty() || !motion.shift.isZero(0) || motion.turn.w() != 1;
      if (held >= 0) put(held, last_translate, last_orient);
      held = -1;
      put(code, t, q);
      last_translate = t, last_orient = q;
    }
    void put(int code, const std::string& t, const std::string& q) {
      const std::string number = "                " + std::to_string(code) + ": ";
      translate += number + t + ",\n";
      orient += number + q + ",\n";
    }
    [[nodiscard]] std::string text() const {
      return "            double3 xformOp:translate.timeSamples = {\n" + translate +
             "            }\n            quatf xformOp:orient.timeSamples = {\n" + orient +
             "            }\n            uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]\n";
    }
  };

  /// From which frame of the file on it is seen, and from which no more.
  static std::string seen(const std::vector<std::pair<int, bool>>& changes) {
    if (changes.size() == 1 && changes[0].second) return {};
    std::string text = "            token visibility.timeSamples = {\n";
    for (const auto& [code, visible] : changes)
      text += "                " + std::to_string(code) + ": \"" + (visible ? "inherited" : "invisible") + "\",\n";
    return text + "            }\n";
  }

  static constexpr std::int32_t never = std::numeric_limits<std::int32_t>::max();
  /// Frames of the recording: from the first to before the second.
  using Span = std::pair<std::int32_t, std::int32_t>;
  void member(const std::string& name, structure::MemberId id, const std::vector<PlaceChange>& places) {
    const auto shapes = part_shapes(building_, recording_, static_cast<std::size_t>(id.index));
    part(name, member_mesh(building_, id, ways_of_bending(shapes) > 0), shapes, places,
         member_colour(building_[id].kind));
  }
  void panel(const std::string& name, structure::PanelId id, const PanelState& state,
             const std::vector<PlaceChange>& places, Span lasts) {
    const auto shapes =
        part_shapes(building_, recording_, building_.members.size() + static_cast<std::size_t>(id.index));
    part(name, panel_part_mesh(building_, id, state, ways_of_bending(shapes)), shapes, places,
         panel_colour(building_[id].kind), lasts);
  }

  /// Points of a mesh that is bent, where they change: held until the code before, so that none lies between two.
  class Bends {
   public:
    Bends(const PartMesh& part, const Eigen::Vector3d& origin)
        : part_(part), origin_(origin), points_(placed(part, {}, origin)) {
      for (const Vertex& v : part.mesh.vertices) normals_.emplace_back(v.normal.x, v.normal.y, v.normal.z);
    }
    void add(int code, const structure::BendWeights& now) {
      if (part_.bends.empty()) return;
      turn(code, now);
      if (!samples_.empty() && now == last_) {
        held_ = code;
        return;
      }
      if (held_ >= 0) put(held_, last_);
      put(code, now);
      last_ = now, held_ = -1;
    }
    [[nodiscard]] std::string text() const {
      std::string text;
      if (!samples_.empty()) text += "            point3f[] points.timeSamples = {\n" + samples_ + "            }\n";
      if (!turns_.empty()) text += "            normal3f[] normals.timeSamples = {\n" + turns_ + "            }\n";
      return text;
    }

   private:
    void put(int code, const structure::BendWeights& bend) {
      samples_ +=
          "                " + std::to_string(code) + ": [" + points_.text(placed(part_, bend, origin_)) + "],\n";
    }
    /// Normals, by steps that are not seen, each held until the code before the next: straight until the first.
    void turn(int code, const structure::BendWeights& now) {
      if (!structure::normals_turn(normals_, part_.bend_normals, turned_, now)) return;
      if (code > 0 && turned_at_ < code - 1) put_normals(code - 1);
      turned_ = now, turned_at_ = code;
      put_normals(code);
    }
    void put_normals(int code) {
      turns_ +=
          "                " + std::to_string(code) + ": [" + normals_text(placed(part_, turned_, origin_)) + "],\n";
    }
    const PartMesh& part_;
    Eigen::Vector3d origin_;
    Points points_;
    std::vector<structure::Vec3> normals_;
    std::string turns_;
    structure::BendWeights turned_{};
    int turned_at_ = -1;
    std::string samples_;
    structure::BendWeights last_{};
    int held_ = -1;
  };

  void part(const std::string& name, const PartMesh& drawn, const std::vector<ShapeChange>& shapes,
            const std::vector<PlaceChange>& places, Rgba colour, Span lasts = {0, never}) {
    Motion motion;
    Bends points(drawn, origin_);
    std::vector<std::pair<int, bool>> visible;
    std::size_t next = 0;
    for (const ExportSample& sample : samples_) {
      while (next + 1 < places.size() && places[next + 1].frame <= sample.frame) ++next;
      const bool there = lasts.first <= sample.frame && sample.frame < lasts.second;
      const int track = there ? places[next].track : part_gone;
      if (visible.empty() || visible.back().second != (track != part_gone))
        visible.emplace_back(sample.code, track != part_gone);
      if (track == part_gone) continue;
      const structure::BentPart& shape = shape_at(shapes, sample.frame);
      const PartMotion own = motion_of(drawn.rest, shape.pose, origin_);
      motion.add(sample.code,
                 track >= 0
                     ? motion_of(recording_.tracks()[static_cast<std::size_t>(track)], sample.frame, origin_) * own
                     : own);
      points.add(sample.code, shape.bend);
    }
    mesh(name, placed(drawn, {}, origin_), colour, points.text() + (motion.moved ? motion.text() : "") + seen(visible));
  }

  void body(const BodyTrack& track) {
    if (!track.chunk && !(track.radius > 0)) return;
    Motion motion;
    std::vector<std::pair<int, bool>> visible;
    for (const ExportSample& sample : samples_) {
      const bool here = track.first <= sample.frame && (track.end < 0 || sample.frame < track.end);
      if (visible.empty() || visible.back().second != here) visible.emplace_back(sample.code, here);
      if (!here) continue;
      const BodyPose pose = track.pose(sample.frame);
      motion.add(sample.code, {pose.orientation, pose.position - origin_});
    }
    if (motion.last_translate.empty()) return;  // it came and went between two frames of the file
    const std::string more = motion.text() + seen(visible);
    if (track.chunk)
      return mesh("chunk_" + std::to_string(track.id), chunk_mesh(*track.chunk), piece_colour(track.chunk_of), more);
    out_ << "        def Sphere \"projectile_" << track.id << "\"\n        {\n"
         << print("            double radius = %.6g\n", track.radius);
    colour_and(projectile_colour, more);
  }

  const structure::Building& building_;
  const Recording& recording_;
  std::ostream& out_;
  double rate_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<ExportSample> samples_;
};

}  // namespace

void write_usd(const structure::Building& building, const Recording& recording, const std::string& file, double rate) {
  structure::OutputFile out(file);
  UsdWriter(building, recording, out.stream(), rate).write();
  out.commit();
  std::printf("%s: animation\n", structure::one_line(file).c_str());
}

}  // namespace topple::viewer
