#include "app/output/html_replay.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "app/part_motion.h"
#include "renderer/instances/scene_instances.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/formats/plain_text.h"

#ifdef TOPPLE_REPLAY
extern "C" const char topple_replay_page_begin[];
extern "C" const char topple_replay_page_end[];
#endif

namespace topple::viewer {
namespace {

using Json = nlohmann::ordered_json;

std::string_view page() {
#ifdef TOPPLE_REPLAY
  return {topple_replay_page_begin, static_cast<std::size_t>(topple_replay_page_end - topple_replay_page_begin)};
#else
  throw std::runtime_error("this program was built without the replay page: build it where npm is installed");
#endif
}

/// Bytes of an array (little-endian, as in every browser) as base64.
template <class T>
std::string base64(const std::vector<T>& values) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes(values.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  std::string text;
  text.reserve(4 * ((bytes.size() + 2) / 3));
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned three = static_cast<unsigned>(bytes[i]) << 16U;
    if (i + 1 < bytes.size()) three |= static_cast<unsigned>(bytes[i + 1]) << 8U;
    if (i + 2 < bytes.size()) three |= bytes[i + 2];
    text += digits[three >> 18U & 63U];
    text += digits[three >> 12U & 63U];
    text += i + 1 < bytes.size() ? digits[three >> 6U & 63U] : '=';
    text += i + 2 < bytes.size() ? digits[three & 63U] : '=';
  }
  return text;
}

Json mesh_json(const Mesh& mesh) {
  std::vector<float> positions, normals;
  for (const Vertex& v : mesh.vertices)
    for (int c = 0; c < 3; ++c) positions.push_back(v.position[c]), normals.push_back(v.normal[c]);
  return {{"positions", base64(positions)}, {"normals", base64(normals)}, {"indices", base64(mesh.indices)}};
}

std::array<float, 3> floats(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

class ReplayData {
 public:
  ReplayData(const structure::Building& building, const Recording& recording)
      : building_(building), recording_(recording) {
    const glm::dvec3 centre = bounds_of(building).centre();
    origin_ = {centre.x, centre.y, centre.z};
  }

  [[nodiscard]] Json write() {
    read_shapes();
    const Bounds bounds = bounds_of(building_);
    Json data;
    data["title"] = building_.title.empty() ? "Topple" : building_.title;
    data["radius"] = bounds.radius();
    data["ground"] = bounds.low.z - bounds.centre().z;
    std::vector<float> times;
    for (const auto& frame : recording_.frames()) times.push_back(static_cast<float>(frame.time));
    data["times"] = base64(times);
    data["sections"] = Json::array();
    for (const auto& section : building_.sections) data["sections"].push_back(mesh_json(section_mesh(section, 1)));
    data["members"] = members();
    data["bent"] = std::move(bent_);
    data["panels"] = panels();
    data["shapes"] = shapes();
    data["places"] = positions();
    data["tracks"] = tracks();
    data["drawn"] = drawn();
    data["failed"] = failed();
    data["events"] = Json::array();
    for (const auto& event : recording_.events())
      data["events"].push_back({{"time", event.time}, {"kind", static_cast<int>(event.kind)}, {"text", event.text}});
    return data;
  }

 private:
  void read_shapes() {
    for (std::size_t part = 0; part < building_.members.size() + building_.panels.size(); ++part)
      shapes_.push_back(part_shapes(building_, recording_, part));
  }

  /// A mesh, the ways in which it bends, one after the other, and how its normals turn with them.
  static Json bending_json(const Mesh& mesh, const PartMesh& part) {
    Json json = mesh_json(mesh);
    if (part.bends.empty()) return json;
    const auto text = [](const std::vector<std::vector<structure::Vec3>>& ways) {
      std::vector<float> numbers;
      for (const auto& way : ways)
        for (const structure::Vec3& of : way)
          for (const float x : floats(of)) numbers.push_back(x);
      return base64(numbers);
    };
    json["bends"] = text(part.bends);
    if (!part.bend_normals.empty()) json["turns"] = text(part.bend_normals);
    return json;
  }

  /// The mesh of members like this one that bend: about their middle, in their axes.
  int bent_mesh(structure::MemberId id) {
    const structure::Member& member = building_[id];
    const auto [known, made] = bent_meshes_.try_emplace({member.section.index, member.length}, bent_.size());
    if (made) {
      const PartMesh part = member_mesh(building_, id, true);
      bent_.push_back(bending_json(part.mesh, part));
    }
    return static_cast<int>(known->second);
  }

  /// Of parts that were ever drawn elsewhere than undeformed: number, frames; their motions since then in building
  /// axes (shift, turn), and weights of bends where there are any, at each.
  [[nodiscard]] Json shapes() const {
    Json list = Json::array();
    for (std::size_t part = 0; part < shapes_.size(); ++part) {
      const structure::AnimatedPose rest =
          part < building_.members.size() ? rest_pose(building_, structure::MemberId(part))
                                          : rest_pose(building_, structure::PanelId(part - building_.members.size()));
      const bool bent = ways_of_bending(shapes_[part]) > 0;
      if (shapes_[part].size() == 1 && !bent && shapes_[part][0].shape.pose == rest) continue;
      std::vector<std::int32_t> frames;
      std::vector<float> motions, weights;
      for (const ShapeChange& change : shapes_[part]) {
        frames.push_back(change.frame);
        const PartMotion motion = motion_of(rest, change.shape.pose, origin_);
        for (const float x : floats(motion.shift)) motions.push_back(x);
        for (int c = 0; c < 4; ++c) motions.push_back(static_cast<float>(motion.turn.coeffs()[c]));
        weights.insert(weights.end(), change.shape.bend.begin(), change.shape.bend.end());
      }
      Json one{{"part", part}, {"frames", base64(frames)}, {"motions", base64(motions)}};
      if (bent) one["weights"] = base64(weights);
      list.push_back(std::move(one));
    }
    return list;
  }

  /// Name, section, kind; first end, length and axes (rows) as numbers; the mesh of one that bends.
  [[nodiscard]] Json members() {
    Json list = Json::array();
    for (std::size_t m = 0; m < building_.members.size(); ++m) {
      const structure::Member& member = building_.members[m];
      const Eigen::Vector3d first = building_[member.nodes[0]].position + member.offsets[0] - origin_;
      std::vector<float> numbers;
      for (const float x : floats(first)) numbers.push_back(x);
      numbers.push_back(static_cast<float>(member.length));
      for (int row = 0; row < 3; ++row)
        for (const float x : floats(member.axes.row(row).transpose())) numbers.push_back(x);
      list.push_back({{"name", member.name},
                      {"section", member.section.index},
                      {"kind", static_cast<int>(member.kind)},
                      {"numbers", base64(numbers)}});
      if (ways_of_bending(shapes_[m]) > 0) list.back()["bent"] = bent_mesh(structure::MemberId(m));
    }
    return list;
  }

  [[nodiscard]] Json panels() const {
    Json list = Json::array();
    const auto all = panel_states(building_, recording_);
    for (std::size_t p = 0; p < building_.panels.size(); ++p) {
      const structure::Panel& panel = building_.panels[p];
      const std::size_t ways = ways_of_bending(shapes_[building_.members.size() + p]);
      Json states = Json::array();
      for (const PanelState& state : all[p]) {
        PartMesh part = panel_part_mesh(building_, structure::PanelId(p), state, ways);
        if (!normals_turn(part, shapes_[building_.members.size() + p])) part.bend_normals.clear();
        states.push_back({{"frame", state.frame}, {"mesh", bending_json(placed(part, {}, origin_), part)}});
      }
      list.push_back({{"name", panel.name}, {"kind", static_cast<int>(panel.kind)}, {"states", std::move(states)}});
    }
    return list;
  }

  /// [part, frame, track] for each change of place after the first frame.
  [[nodiscard]] Json positions() const {
    const auto all = part_places(building_, recording_);
    std::vector<std::int32_t> changes;
    for (std::size_t part = 0; part < all.size(); ++part)
      for (const PlaceChange& change : all[part])
        if (change.frame > 0 || change.track != part_stands)
          changes.insert(changes.end(), {static_cast<std::int32_t>(part), change.frame, change.track});
    return base64(changes);
  }

  [[nodiscard]] Json tracks() const {
    Json list = Json::array();
    for (const BodyTrack& track : recording_.tracks()) {
      std::vector<std::int32_t> frames;
      std::vector<float> poses;
      for (const PoseKey& key : track.keys) {
        frames.push_back(key.frame);
        poses.insert(poses.end(), key.offset.begin(), key.offset.end());
        poses.insert(poses.end(), key.turn.begin(), key.turn.end());
      }
      Json one{{"centre", floats(track.rest_centre - origin_)},
               {"first", track.first},
               {"end", track.end},
               {"frames", base64(frames)},
               {"poses", base64(poses)}};
      if (track.radius > 0) one["radius"] = track.radius;
      if (track.chunk) {
        one["chunk"] = mesh_json(chunk_mesh(*track.chunk));
        one["kind"] = static_cast<int>(track.chunk_of);
      }
      list.push_back(std::move(one));
    }
    return list;
  }

  /// Pieces of a model around the building: [frame, track] for each change of place.
  [[nodiscard]] Json drawn() const {
    Json list = Json::array();
    for (const DrawnTrack& piece : drawn_tracks(building_, recording_)) {
      std::vector<std::int32_t> places;
      for (const PlaceChange& change : piece.places) places.insert(places.end(), {change.frame, change.track});
      list.push_back({{"mesh", mesh_json(placed_mesh(*piece.mesh, origin_))}, {"places", base64(places)}});
    }
    return list;
  }

  /// [member, end, frame] of each member's joint that fails.
  [[nodiscard]] Json failed() const {
    std::vector<std::int32_t> list;
    std::vector<char> told(2 * building_.members.size(), 0);
    std::shared_ptr<const FrameAnswer> seen;
    for (std::size_t f = 0; f < recording_.frames().size(); ++f) {
      const auto& answer = recording_.frames()[f].answer;
      if (answer == seen) continue;
      seen = answer;
      for (std::size_t j = 0; j < told.size(); ++j) {
        if (told[j] != 0 || answer->joints[j].intact) continue;
        told[j] = 1;
        list.insert(list.end(),
                    {static_cast<std::int32_t>(j / 2), static_cast<std::int32_t>(j % 2), static_cast<std::int32_t>(f)});
      }
    }
    return base64(list);
  }

  const structure::Building& building_;
  const Recording& recording_;
  Eigen::Vector3d origin_;
  std::vector<std::vector<ShapeChange>> shapes_;  ///< by part
  Json bent_ = Json::array();                     ///< meshes of members that bend
  std::map<std::pair<std::int64_t, double>, std::size_t> bent_meshes_;
};

/// "<" would end or open elements within the page's script.
std::string in_script(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) c == '<' ? out += "\\u003c" : out += c;
  return out;
}

}  // namespace

bool can_write_replay() {
#ifdef TOPPLE_REPLAY
  return true;
#else
  return false;
#endif
}

void write_html_replay(const structure::Building& building, const Recording& recording, const std::string& file) {
  constexpr std::string_view mark = "\"TOPPLE_DATA\"";
  const std::string_view whole = page();
  const std::size_t at = whole.find(mark);
  if (at == std::string_view::npos) throw std::runtime_error("the replay page has no place for its data");
  structure::OutputFile out(file);
  out.write(whole.substr(0, at));
  out.write(in_script(ReplayData(building, recording).write().dump()));
  out.write(whole.substr(at + mark.size()));
  out.commit();
  std::printf("%s: replay\n", structure::one_line(file).c_str());
}

}  // namespace topple::viewer
