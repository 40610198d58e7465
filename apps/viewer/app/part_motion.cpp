#include "app/part_motion.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "topple/structure/visual_mesh.h"

namespace topple::viewer {

std::vector<ExportSample> export_samples(const Recording& recording, double rate) {
  constexpr double rounding = 1e-9;  // s
  const auto& frames = recording.frames();
  std::vector<ExportSample> samples;
  std::size_t frame = 0;
  const double begin = frames.front().time;
  for (int code = 0; begin + code / rate <= frames.back().time + rounding; ++code) {
    while (frame + 1 < frames.size() && frames[frame + 1].time <= begin + code / rate + rounding) ++frame;
    samples.push_back({code, static_cast<std::int32_t>(frame)});
  }
  return samples;
}

std::vector<std::vector<PlaceChange>> part_places(const structure::Building& building, const Recording& recording) {
  const auto& frames = recording.frames();
  const auto& tracks = recording.tracks();
  std::vector<std::vector<PlaceChange>> places(building.members.size() + building.panels.size());
  std::shared_ptr<const Membership> seen;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (frames[f].membership == seen) continue;
    seen = frames[f].membership;
    const auto frame = static_cast<std::int32_t>(f);
    std::vector<int> alive;  // tracks in the order of the snapshot's bodies
    for (std::size_t t = 0; t < tracks.size(); ++t)
      if (tracks[t].first <= frame && (tracks[t].end < 0 || frame < tracks[t].end))
        alive.push_back(static_cast<int>(t));
    const auto note = [&](std::size_t part, int place) {
      const int track = place >= 0 ? alive[static_cast<std::size_t>(place)] : place;
      if (places[part].empty() || places[part].back().track != track) places[part].push_back({frame, track});
    };
    for (std::size_t m = 0; m < building.members.size(); ++m) note(m, seen->member[m]);
    for (std::size_t p = 0; p < building.panels.size(); ++p) note(building.members.size() + p, seen->panel[p]);
  }
  return places;
}

std::vector<std::vector<PanelState>> panel_states(const structure::Building& building, const Recording& recording) {
  std::vector<std::vector<PanelState>> states(building.panels.size());
  for (std::size_t f = 0; f < recording.frames().size(); ++f) {
    const Membership& membership = *recording.frames()[f].membership;
    if (f > 0 && recording.frames()[f - 1].membership.get() == &membership) continue;
    for (std::size_t p = 0; p < states.size(); ++p)
      if (states[p].empty() || states[p].back().remains != membership.broken[p])
        states[p].push_back({static_cast<std::int32_t>(f), membership.broken[p]});
  }
  return states;
}

namespace {

/// A standing piece as pictures bend it: its vertices go with the parts that they hang on, its normals as its faces do.
std::shared_ptr<const fracture::Mesh> bent_piece(const structure::Building& building, const DrawnPiece& piece,
                                                 const FrameAnswer& answer) {
  const structure::BentBuilding bent{
      [&](structure::NodeId node) -> structure::Vec6 {
        return answer.displacements[static_cast<std::size_t>(node.index)].cast<double>();
      },
      [&](structure::JointId joint) { return answer.joints[static_cast<std::size_t>(joint.index)].intact; }};
  auto mesh = std::make_shared<fracture::Mesh>(*piece.mesh);
  const auto across = [&] {
    std::vector<structure::Vec3> sum(mesh->positions.size(), structure::Vec3::Zero());
    for (const auto& triangle : mesh->triangles) {
      const auto at = [&](std::size_t corner) { return mesh->positions[static_cast<std::size_t>(triangle[corner])]; };
      for (const int v : triangle) sum[static_cast<std::size_t>(v)] += (at(1) - at(0)).cross(at(2) - at(0));
    }
    return sum;
  };
  const auto straight = across();
  for (std::size_t v = 0; v < mesh->positions.size(); ++v)
    mesh->positions[v] += displacement_with(building, (*piece.bones)[v], piece.mesh->positions[v], bent);
  const auto now = across();
  for (std::size_t v = 0; v < mesh->normals.size(); ++v)
    if (!straight[v].isZero(0) && !now[v].isZero(0))
      mesh->normals[v] = Eigen::Quaterniond::FromTwoVectors(straight[v], now[v]) * mesh->normals[v];
  return mesh;
}

/// Somewhere farther from where it was drawn last than is seen.
bool is_elsewhere(const fracture::Mesh& now, const fracture::Mesh& last) {
  for (std::size_t v = 0; v < now.positions.size(); ++v)
    if ((now.positions[v] - last.positions[v]).norm() > structure::drawn_tolerance) return true;
  return false;
}

}  // namespace

std::vector<DrawnTrack> drawn_tracks(const structure::Building& building, const Recording& recording) {
  const auto& tracks = recording.tracks();
  const auto track_of = [&](std::int64_t body) {
    const auto found = std::lower_bound(tracks.begin(), tracks.end(), body,
                                        [](const BodyTrack& one, std::int64_t id) { return one.id < id; });
    return found == tracks.end() || found->id != body ? part_gone : static_cast<int>(found - tracks.begin());
  };
  std::vector<DrawnTrack> all;
  std::map<const fracture::Mesh*, std::size_t> number;
  std::map<const fracture::Mesh*, std::shared_ptr<const fracture::Mesh>> drawn_as;  // of pieces that stand
  std::shared_ptr<const std::vector<DrawnPiece>> seen;
  std::shared_ptr<const FrameAnswer> answer;
  for (std::size_t f = 0; f < recording.frames().size(); ++f) {
    if (recording.frames()[f].drawn == seen && recording.frames()[f].answer == answer) continue;
    seen = recording.frames()[f].drawn;
    answer = recording.frames()[f].answer;
    const auto frame = static_cast<std::int32_t>(f);
    std::vector<char> here(all.size(), 0);
    const auto note = [&](DrawnTrack& one, int track) {
      if (one.places.empty() && frame > 0) one.places.push_back({0, part_gone});
      if (one.places.empty() || one.places.back().track != track) one.places.push_back({frame, track});
    };
    if (seen)
      for (const DrawnPiece& piece : *seen) {
        auto mesh = piece.mesh;
        if (piece.body == part_stands && piece.bones) {
          auto& last = drawn_as.try_emplace(piece.mesh.get(), piece.mesh).first->second;
          if (auto now = bent_piece(building, piece, *answer); is_elsewhere(*now, *last)) last = std::move(now);
          mesh = last;
        }
        const auto [known, made] = number.try_emplace(mesh.get(), all.size());
        if (made) {
          all.push_back({mesh, {}});
          here.push_back(0);
        }
        here[known->second] = 1;
        note(all[known->second], piece.body == part_stands ? part_stands : track_of(piece.body));
      }
    for (std::size_t i = 0; i < here.size(); ++i)
      if (here[i] == 0) note(all[i], part_gone);
  }
  return all;
}

std::vector<ShapeChange> part_shapes(const structure::Building& building, const Recording& recording,
                                     std::size_t part) {
  const bool is_member = part < building.members.size();
  const structure::MemberId member(is_member ? part : 0);
  const structure::PanelId panel(is_member ? 0 : part - building.members.size());
  structure::SteadyPart drawn_as = is_member ? steady(building, member) : steady(building, panel);
  std::vector<ShapeChange> changes;
  const auto note = [&](std::size_t frame, const structure::BentPart& shape) {
    if (changes.empty() || !(changes.back().shape == shape))
      changes.push_back({static_cast<std::int32_t>(frame), shape});
  };
  const Recording::Frame* seen = nullptr;
  for (std::size_t f = 0; f < recording.frames().size(); ++f) {
    const Recording::Frame& frame = recording.frames()[f];
    if (seen != nullptr && seen->answer == frame.answer && seen->membership == frame.membership) continue;
    seen = &frame;
    const auto& [answer, membership] = std::tie(*frame.answer, *frame.membership);
    note(f, drawn_as.at(is_member ? bent_member(building, member, drawn_shape(building, member, answer, membership))
                                  : bent_panel(building, panel, moved_corners(building, panel, answer, membership))));
  }
  return changes;
}

std::size_t ways_of_bending(const std::vector<ShapeChange>& shapes) {
  std::size_t ways = 0;
  for (const ShapeChange& one : shapes)
    for (std::size_t k = 0; k < one.shape.bend.size(); ++k)
      if (one.shape.bend[k] != 0) ways = std::max(ways, k + 1);
  return ways;
}

const structure::BentPart& shape_at(const std::vector<ShapeChange>& shapes, std::int32_t frame) {
  const auto next = std::upper_bound(shapes.begin(), shapes.end(), frame,
                                     [](std::int32_t f, const ShapeChange& one) { return f < one.frame; });
  return next == shapes.begin() ? shapes.front().shape : (next - 1)->shape;
}

namespace {

std::vector<structure::Vec3> positions(const Mesh& mesh) {
  std::vector<structure::Vec3> places;
  for (const Vertex& v : mesh.vertices)
    places.push_back(Eigen::Vector3f(v.position.x, v.position.y, v.position.z).cast<double>());
  return places;
}

std::vector<structure::Vec3> normals(const Mesh& mesh) {
  std::vector<structure::Vec3> normals;
  for (const Vertex& v : mesh.vertices)
    normals.push_back(Eigen::Vector3f(v.normal.x, v.normal.y, v.normal.z).cast<double>());
  return normals;
}

glm::vec3 vector(const Eigen::Vector3d& v) { return glm::vec3(v.x(), v.y(), v.z()); }

}  // namespace

PartMesh member_mesh(const structure::Building& building, structure::MemberId id, bool bent) {
  const structure::Member& member = building[id];
  PartMesh part;
  part.rest = rest_pose(building, id);
  part.mesh = section_mesh(building[member.section], bent ? structure::bent_segments : 1);
  for (Vertex& v : part.mesh.vertices) v.position.x = (v.position.x - 0.5F) * static_cast<float>(member.length);
  if (!bent) return part;
  part.bends = structure::member_bends(member.length, positions(part.mesh));
  part.bend_normals = structure::member_bend_normals(member.length, positions(part.mesh), normals(part.mesh));
  return part;
}

PartMesh panel_part_mesh(const structure::Building& building, structure::PanelId id, const PanelState& state,
                         std::size_t ways) {
  PartMesh part;
  part.rest = rest_pose(building, id);
  part.mesh = placed_panel_mesh(building, building[id], state, part.rest.position);
  if (ways == 0) return part;
  part.bends = structure::panel_bends(building, id, positions(part.mesh));
  part.bend_normals = structure::panel_bend_normals(building, id, positions(part.mesh), normals(part.mesh));
  part.bends.resize(std::min(ways, part.bends.size()));
  part.bend_normals.resize(part.bends.size());
  return part;
}

bool normals_turn(const PartMesh& part, const std::vector<ShapeChange>& shapes) {
  const auto straight = normals(part.mesh);
  return std::any_of(shapes.begin(), shapes.end(), [&](const ShapeChange& change) {
    return structure::normals_turn(straight, part.bend_normals, {}, change.shape.bend);
  });
}

Mesh placed(const PartMesh& part, const structure::BendWeights& bend, const Eigen::Vector3d& origin) {
  Mesh mesh = part.mesh;
  const auto local = positions(mesh), local_normals = normals(mesh);
  for (std::size_t v = 0; v < local.size(); ++v) {
    Eigen::Vector3d at = local[v];
    for (std::size_t k = 0; k < part.bends.size(); ++k) at += static_cast<double>(bend[k]) * part.bends[k][v];
    const Eigen::Vector3d normal = structure::bent_normal(local_normals[v], part.bend_normals, bend, v);
    mesh.vertices[v].position = vector(part.rest.position + part.rest.orientation * at - origin);
    mesh.vertices[v].normal = vector(part.rest.orientation * normal);
  }
  return mesh;
}

Mesh placed_panel_mesh(const structure::Building& building, const structure::Panel& panel,
                       const Eigen::Vector3d& origin) {
  Mesh mesh = panel_mesh(building, panel);
  glm::vec3 corner[4];
  for (std::size_t c = 0; c < 4; ++c) {
    const Eigen::Vector3d p = building[panel.nodes[c]].position - origin;
    corner[c] = glm::vec3(p.x(), p.y(), p.z());
  }
  for (Vertex& v : mesh.vertices) {
    const float s = v.position.x, t = v.position.y;
    const glm::vec3 along_s = glm::mix(corner[1] - corner[0], corner[2] - corner[3], t);
    const glm::vec3 along_t = glm::mix(corner[3] - corner[0], corner[2] - corner[1], s);
    const glm::vec3 across = glm::normalize(glm::cross(along_s, along_t));
    const float z = v.position.z * static_cast<float>(panel.thickness);
    v.position = glm::mix(glm::mix(corner[0], corner[1], s), glm::mix(corner[3], corner[2], s), t) + across * z;
    v.normal = glm::normalize(v.normal.x * along_s / glm::dot(along_s, along_s) +
                              v.normal.y * along_t / glm::dot(along_t, along_t) + v.normal.z * across);
  }
  return mesh;
}

Mesh placed_panel_mesh(const structure::Building& building, const structure::Panel& panel, const PanelState& state,
                       const Eigen::Vector3d& origin) {
  return state.remains ? placed_mesh(*state.remains, origin) : placed_panel_mesh(building, panel, origin);
}

Mesh placed_mesh(const fracture::Mesh& placed, const Eigen::Vector3d& origin) {
  Mesh mesh = chunk_mesh(placed);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d p = placed.positions[i] - origin;
    mesh.vertices[i].position = glm::vec3(p.x(), p.y(), p.z());
  }
  return mesh;
}

PartMotion motion_of(const BodyTrack& track, std::int32_t frame, const Eigen::Vector3d& origin) {
  const BodyPose pose = track.pose(frame);
  PartMotion motion;
  motion.turn = pose.orientation;
  motion.shift = pose.position - origin - pose.orientation * (pose.rest_centre - origin);
  return motion;
}

PartMotion motion_of(const structure::AnimatedPose& rest, const structure::AnimatedPose& now,
                     const Eigen::Vector3d& origin) {
  PartMotion motion;
  if (now == rest) return motion;
  motion.turn = (now.orientation * rest.orientation.conjugate()).normalized();
  motion.shift = now.position - origin - motion.turn * (rest.position - origin);
  return motion;
}

PartMotion operator*(const PartMotion& outer, const PartMotion& inner) {
  return {outer.turn * inner.turn, outer.turn * inner.shift + outer.shift};
}

}  // namespace topple::viewer
