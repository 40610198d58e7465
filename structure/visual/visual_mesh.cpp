#include "topple/structure/visual_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>

#include "topple/fracture/solid_cut.h"
#include "topple/structure/error.h"
#include "visual/chunk_prism.h"
#include "visual/part_places.h"

namespace topple::structure {

namespace {

/// A mesh is looked at along its edges in steps of this, m: a long face has no vertices in its middle.
constexpr double sample_step = 0.75;
/// A part with less than this share of a piece's samples does not cut it.
constexpr double least_share = 0.02;
/// Cuts of one piece in a row; what is still shared then goes with most of it.
constexpr int most_cuts = 12;
/// Pairs of parts between which a cut is tried.
constexpr std::size_t most_pairs = 8;

constexpr std::int64_t stands = -1;

/// What holds a part now: a body, the frame, or nothing any more.
std::int64_t owner_of(const Simulation& simulation, Part part) {
  const bool standing =
      part.member.valid() ? simulation.frame().stands(part.member) : simulation.frame().stands(part.panel);
  if (standing) return stands;
  const collision::BodyId body = part.member.valid() ? simulation.body_of(part.member) : simulation.body_of(part.panel);
  return body.value == stands ? -2 : body.value;
}

}  // namespace

struct VisualMesh::State {
  struct Source {
    Piece piece;
    std::vector<Part> parts;  ///< that it follows; one when it is bound by name
    int cuts = 0;             ///< so far
    std::int64_t chunk = -1;  ///< of a broken panel, or piece of a cut member, by its body: followed instead
  };

  explicit State(const Building& given) : building(given), places(given) {}

  void follow(Source source, const Simulation& simulation, std::vector<Source>& result);
  [[nodiscard]] fracture::Plane between(Part first, Part second, const Simulation& simulation) const;
  [[nodiscard]] std::map<Part, std::size_t> samples(const fracture::Mesh& mesh, const std::vector<Part>& among) const;
  [[nodiscard]] std::vector<Part> pieces_of(MemberId member) const;
  [[nodiscard]] std::vector<Source> pieces_in(const Source& whole, const fracture::Mesh& solid) const;
  void follow_chunks(const Simulation& simulation);
  void follow_cut_members(const Simulation& simulation);
  [[nodiscard]] bool cut_out_chunk(const Source& source, const ChunkPrism& chunk, std::vector<Source>& result) const;
  void list();
  void find_bones(Source& source) const;

  const Building& building;
  PartPlaces places;
  std::vector<Source> sources;
  std::vector<Piece> pieces;
  std::set<std::int64_t> chunks_followed;
  std::set<MemberId> members_cut;
  double volume = 0;
  std::size_t events_seen = static_cast<std::size_t>(-1);
  std::vector<std::int64_t> bodies_seen;  ///< in order of id
  std::uint64_t revision = 0;
};

/// A member with its later pieces, where it is divided (divide_member.h).
std::vector<Part> VisualMesh::State::pieces_of(MemberId member) const {
  std::vector<Part> parts{Part(member)};
  const NameIndex names(building);
  const std::string& name = building[member].name;
  for (int n = 2; names.node(name + "/cut-1"); ++n) {
    const auto piece = names.member(name + "/" + std::to_string(n));
    if (!piece) break;
    parts.emplace_back(*piece);
  }
  return parts;
}

/// How many places of a mesh lie nearest to each part.
std::map<Part, std::size_t> VisualMesh::State::samples(const fracture::Mesh& mesh,
                                                       const std::vector<Part>& among) const {
  std::map<Part, std::size_t> counts;
  for (const auto& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& a = mesh.positions[static_cast<std::size_t>(triangle[k])];
      const Vec3& b = mesh.positions[static_cast<std::size_t>(triangle[(k + 1) % 3])];
      const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() / sample_step)));
      for (int i = 0; i < steps; ++i) ++counts[places.nearest(a + (b - a) * (i + 0.5) / steps, among)];
    }
  return counts;
}

/// Through the joint that broke between two parts, across its member; else half way between the parts.
fracture::Plane VisualMesh::State::between(Part first, Part second, const Simulation& simulation) const {
  const auto broken_end = [&](Part of, Part other) -> std::optional<fracture::Plane> {
    if (!of.member.valid()) return std::nullopt;
    const Member& member = building[of.member];
    for (int end = 0; end < 2; ++end) {
      const NodeId node = member.nodes[static_cast<std::size_t>(end)];
      if (simulation.frame().intact(building.joint(of.member, end)) || !places.touches(other, node)) continue;
      return fracture::Plane{building[node].position + member.offsets[static_cast<std::size_t>(end)],
                             member.axes.row(0).transpose()};
    }
    return std::nullopt;
  };
  if (const auto plane = broken_end(first, second)) return *plane;
  if (const auto plane = broken_end(second, first)) return *plane;
  const auto [a, b] = places.closest(first, second);
  Vec3 direction = b - a;
  if (direction.norm() < 1e-6) direction = places.centre(second) - places.centre(first);
  if (direction.norm() < 1e-6) direction = Vec3::UnitZ();
  return {(a + b) / 2, direction.normalized()};
}

void VisualMesh::State::follow(Source source, const Simulation& simulation, std::vector<Source>& result) {
  if (source.chunk >= 0) {
    const bool there = std::binary_search(bodies_seen.begin(), bodies_seen.end(), source.chunk);
    source.piece.body = {there ? source.chunk : -2};
    result.push_back(std::move(source));
    return;
  }
  std::map<std::int64_t, std::vector<Part>> owners;
  for (const Part part : source.parts) owners[owner_of(simulation, part)].push_back(part);
  source.piece.body = {owners.begin()->first};
  if (owners.size() == 1) {
    result.push_back(std::move(source));
    return;
  }
  // Most places first; of equals the first owner.
  const std::map<Part, std::size_t> counts = samples(*source.piece.mesh, source.parts);
  std::vector<std::pair<std::size_t, std::int64_t>> order;
  std::size_t total = 0;
  for (const auto& [owner, parts] : owners) {
    std::size_t sum = 0;
    for (const Part part : parts)
      if (const auto found = counts.find(part); found != counts.end()) sum += found->second;
    order.emplace_back(sum, owner);
    total += sum;
  }
  std::stable_sort(order.begin(), order.end(), [](const auto& x, const auto& y) { return x.first > y.first; });
  const auto settle = [&] {
    source.parts = owners[order[0].second];
    source.piece.body = {order[0].second};
    source.piece.bones = nullptr;
    result.push_back(std::move(source));
  };
  if (source.cuts >= most_cuts || static_cast<double>(order[1].first) < least_share * static_cast<double>(total))
    return settle();

  // Between parts of the two owners, those that lie closest to each other first, until a cut parts something.
  std::vector<std::tuple<double, Part, Part>> pairs;
  for (const Part a : owners[order[0].second])
    for (const Part b : owners[order[1].second]) {
      if (!counts.contains(a) || !counts.contains(b)) continue;
      const auto [at_a, at_b] = places.closest(a, b);
      pairs.emplace_back((at_a - at_b).norm(), a, b);
    }
  std::sort(pairs.begin(), pairs.end());
  if (pairs.size() > most_pairs) pairs.resize(most_pairs);
  fracture::CutSolid halves;
  for (const auto& [distance, first, second] : pairs) {
    halves = fracture::cut(*source.piece.mesh, between(first, second, simulation));
    if (!halves.below.triangles.empty() && !halves.above.triangles.empty()) break;
  }
  if (halves.below.triangles.empty() || halves.above.triangles.empty()) return settle();
  for (const fracture::Mesh* half : {&halves.below, &halves.above})
    for (Source& part : pieces_in(source, *half)) {
      ++part.cuts;
      follow(std::move(part), simulation, result);
    }
}

/// The connected parts of what was cut off a piece, each with those of its parts that it lies nearest to.
std::vector<VisualMesh::State::Source> VisualMesh::State::pieces_in(const Source& whole,
                                                                    const fracture::Mesh& solid) const {
  std::vector<Source> found;
  for (fracture::Mesh& one : fracture::connected_parts(solid)) {
    Source& piece = found.emplace_back();
    piece.cuts = whole.cuts;
    piece.piece.name = whole.piece.name;
    piece.piece.body = whole.piece.body;
    piece.piece.volume = fracture::solid_properties(one, 1).volume;
    piece.piece.mesh = std::make_shared<const fracture::Mesh>(std::move(one));
    for (const auto& [near, count] : samples(*piece.piece.mesh, whole.parts)) piece.parts.push_back(near);
  }
  return found;
}

/// What of a piece lies on the chunk's panel, over the chunk, goes with it. False when that is nothing.
bool VisualMesh::State::cut_out_chunk(const Source& source, const ChunkPrism& chunk,
                                      std::vector<Source>& result) const {
  constexpr double margin = 0.02;  // m
  if (source.chunk >= 0 || std::find(source.parts.begin(), source.parts.end(), Part(chunk.panel)) == source.parts.end())
    return false;
  // How far from the panel it reaches.
  double low = unlimited, high = -unlimited;
  for (const Vec3& at : source.piece.mesh->positions) {
    if (places.nearest(at, source.parts) != Part(chunk.panel)) continue;
    low = std::min(low, height_over(building, chunk.panel, at) - margin);
    high = std::max(high, height_over(building, chunk.panel, at) + margin);
  }
  if (!(low < high)) return false;
  const CutOut cut = cut_out(*source.piece.mesh, building, chunk, low, high);
  if (cut.inside.triangles.empty()) return false;
  for (Source& piece : pieces_in(source, cut.inside)) {
    piece.chunk = chunk.body;
    piece.piece.body = {chunk.body};
    result.push_back(std::move(piece));
  }
  for (const fracture::Mesh& outside : cut.outside)
    for (Source& piece : pieces_in(source, outside)) result.push_back(std::move(piece));
  return true;
}

/// Chunks of panels take along what is drawn over them; what is left of a panel that shattered goes with the nearest.
void VisualMesh::State::follow_chunks(const Simulation& simulation) {
  const NameIndex names(building);
  std::vector<ChunkPrism> fresh;
  for (const BodyView& body : simulation.bodies()) {
    if (!body.chunk || chunks_followed.contains(body.id.value)) continue;
    chunks_followed.insert(body.id.value);
    if (auto prism = chunk_prism(building, names, body)) fresh.push_back(std::move(*prism));
  }
  for (const ChunkPrism& chunk : fresh) {
    std::vector<Source> now;
    for (Source& source : sources)
      if (!cut_out_chunk(source, chunk, now)) now.push_back(std::move(source));
    sources = std::move(now);
  }
  for (Source& source : sources) {
    if (source.piece.body.value != -2 || source.chunk >= 0 || source.parts.size() != 1) continue;
    const Vec3 middle = fracture::solid_properties(*source.piece.mesh, 1).centre;
    double least = unlimited;
    for (const ChunkPrism& chunk : fresh) {
      const double away = (chunk.centre(building) - middle).norm();
      if (Part(chunk.panel) != source.parts.front() || away >= least) continue;
      least = away;
      source.chunk = chunk.body;
      source.piece.body = {chunk.body};
    }
  }
}

/// What is drawn around a member that was cut in two is cut there as well; each half goes with its piece.
void VisualMesh::State::follow_cut_members(const Simulation& simulation) {
  for (const SimulationEvent& event : simulation.events()) {
    if (event.kind != SimulationEvent::Kind::joint_broke || !event.joint.inside) continue;
    const MemberId cut_member = building[event.joint.joint].member;
    if (!members_cut.insert(cut_member).second) continue;
    const Member& member = building[cut_member];
    const Vec3 along = member.axes.row(0).transpose();
    const Vec3 start = building[member.nodes[0]].position + member.offsets[0];
    const fracture::Plane plane{start + *event.joint.inside * member.length * along, along};
    std::array<std::int64_t, 2> pieces_of_it{-1, -1};
    for (const BodyView& body : simulation.bodies())
      for (std::size_t end = 0; end < 2; ++end)
        if (body.name == member.name + "#" + std::to_string(end + 1)) pieces_of_it[end] = body.id.value;
    std::vector<Source> now;
    for (Source& source : sources) {
      if (source.chunk >= 0 || source.parts != std::vector<Part>{Part(cut_member)}) {
        now.push_back(std::move(source));
        continue;
      }
      const fracture::CutSolid halves = fracture::cut(*source.piece.mesh, plane);
      const std::array<const fracture::Mesh*, 2> of_ends{&halves.below, &halves.above};
      for (std::size_t end = 0; end < 2; ++end) {
        if (of_ends[end]->triangles.empty()) continue;
        for (Source& piece : pieces_in(source, *of_ends[end])) {
          piece.chunk = pieces_of_it[end];
          if (piece.chunk >= 0) piece.piece.body = {piece.chunk};
          now.push_back(std::move(piece));
        }
      }
    }
    sources = std::move(now);
  }
}

void VisualMesh::State::find_bones(Source& source) const {
  if (source.piece.body.value != stands) source.piece.bones = nullptr;
  if (source.piece.body.value != stands || source.piece.bones) return;
  std::vector<std::int32_t> bones;
  bones.reserve(source.piece.mesh->positions.size());
  for (const Vec3& position : source.piece.mesh->positions)
    bones.push_back(static_cast<std::int32_t>(part_number(building, places.nearest(position, source.parts))));
  source.piece.bones = std::make_shared<const std::vector<std::int32_t>>(std::move(bones));
}

/// Pieces of one mesh are numbered in their order.
void VisualMesh::State::list() {
  ++revision;
  for (Source& source : sources) find_bones(source);
  std::map<std::string, int> of_name, number;
  for (const Source& source : sources) ++of_name[source.piece.name];
  pieces.clear();
  for (const Source& source : sources) {
    pieces.push_back(source.piece);
    if (of_name[source.piece.name] > 1) pieces.back().name += "#" + std::to_string(++number[source.piece.name]);
  }
}

VisualMesh::VisualMesh(const Building& building, std::vector<DrawnMesh> meshes)
    : state_(std::make_unique<State>(building)) {
  State& s = *state_;
  for (DrawnMesh& drawn : meshes) {
    const fracture::MeshAudit audit = fracture::audit(drawn.mesh, 1e-9, true);
    if (audit.open_edges > 0 || !(audit.volume > 0))
      throw InputError(building.file + ", meshes: \"" + drawn.name + "\" is not closed (" + audit.text() +
                       "); accepted: closed triangle meshes whose triangles go counter-clockwise seen from outside");
    State::Source source;
    source.piece.name = drawn.name;
    source.piece.volume = fracture::solid_properties(drawn.mesh, 1).volume;
    s.volume += source.piece.volume;
    source.piece.mesh = std::make_shared<const fracture::Mesh>(std::move(drawn.mesh));
    if (drawn.member.valid())
      source.parts = s.pieces_of(drawn.member);
    else if (drawn.panel.valid())
      source.parts = {Part(drawn.panel)};
    else
      for (const auto& [part, count] : s.samples(*source.piece.mesh, s.places.all())) source.parts.push_back(part);
    source.piece.body = {stands};
    s.sources.push_back(std::move(source));
  }
  s.list();
}

VisualMesh::~VisualMesh() = default;

void VisualMesh::update(const Simulation& simulation) {
  State& s = *state_;
  std::vector<std::int64_t> bodies;
  for (const BodyView& body : simulation.bodies()) bodies.push_back(body.id.value);
  if (simulation.events().size() == s.events_seen && bodies == s.bodies_seen) return;
  s.events_seen = simulation.events().size();
  s.bodies_seen = std::move(bodies);
  std::vector<State::Source> now;
  for (State::Source& source : s.sources) s.follow(std::move(source), simulation, now);
  s.sources = std::move(now);
  s.follow_chunks(simulation);
  s.follow_cut_members(simulation);
  s.list();
}

const std::vector<VisualMesh::Piece>& VisualMesh::pieces() const { return state_->pieces; }
double VisualMesh::volume() const { return state_->volume; }
std::uint64_t VisualMesh::revision() const { return state_->revision; }

}  // namespace topple::structure
