#pragma once
// What is fuzzed: each target takes any bytes as one file, or as one sequence of calls. It returns when they were taken
// or refused as the interface promises; anything else (another exception, a state that is none) ends the program.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "formats/frame3dd/frame3dd.h"
#include "fuzz/promised.h"
#include "fuzz/side_targets.h"
#include "simulation/accounts/replay_hash.h"
#include "structure/fuzzed_readers.h"
#include "topple/fracture/gltf_reader.h"
#include "topple/fracture/panel.h"
#include "topple/structure/analysis.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/panel_file.h"
#include "topple/structure/simulation.h"

namespace topple::fuzz {

/// What a reader took is a building, and a small one is analysed or refused.
inline void use(const Building& building) {
  if (const std::string fault = test::fuzzed::unsound(building); !fault.empty()) found(fault);
  constexpr std::size_t small = 60;
  if (building.members.size() + building.panels.size() > small) return;
  for (const Panel& panel : building.panels)
    if (panel.mesh[0] * panel.mesh[1] > 16) return;
  refuse_unbuilt(building, Purpose::analyse);
  const AnalysisResult result = analyse(building, {});
  for (const CombinationResult& combination : result.combinations)
    for (const auto& displacement : combination.displacements)
      if (!displacement.allFinite()) found("a displacement that is no number");
}

inline void model(std::string_view text) {
  promised([&] { use(parse_model(text, "m.json", Purpose::inspect)); });
}

inline void frame3dd(std::string_view text) {
  promised([&] { use(parse_frame3dd(text, "m.3dd")); });
}

/// Tables one after another, each behind a line "== NAME".
inline void tables(std::string_view text) {
  std::vector<std::pair<std::string, std::string>> all;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.starts_with("== "))
      all.emplace_back(line.substr(3), "");
    else if (!all.empty())
      all.back().second += std::string(line) + "\n";
  }
  promised([&] { use(parse_tables(all, "t", Purpose::inspect)); });
}

/// So many steps at most: a fuzzer lives by the number of its runs.
inline void run(Simulation& simulation, int steps) {
  for (int i = 0; i < steps && !simulation.finished(); ++i) {
    simulation.skip_idle();
    simulation.step();
  }
  for (const double coordinate : simulation.poses())
    if (!std::isfinite(coordinate)) found("a pose that is no number");
}

inline void scenario(std::string_view text) {
  promised([&] {
    auto [building, scenario] = parse_scenario(text, "s.json", folder().path());
    if (building.members.size() > 60) return;
    Simulation simulation(std::move(building), std::move(scenario));
    run(simulation, 20);
  });
}

inline void panel(std::string_view text) {
  promised([&] {
    const PanelFile file = parse_panel(text, "p.json");
    if (file.hits.size() > 20) return;
    fracture::BreakablePanel panel(file.shape, file.settings);
    const double whole = panel.intact_area();
    double area = 0;
    for (const PanelHit& hit : file.hits)
      for (const fracture::Chunk& chunk : panel.hit(hit.at, hit.radius).chunks) area += fracture::area(chunk.outline);
    if (!(std::abs(area + panel.area() - whole) <= 1e-6 * whole)) found("areas that do not add up");
  });
}

inline void gltf(std::string_view bytes) {
  const std::filesystem::path file = folder() / "drawing.glb";
  write_file(file, bytes);
  try {
    for (const fracture::NamedMesh& mesh : fracture::read_gltf(file.string()))
      for (const auto& position : mesh.mesh.positions)
        if (!position.allFinite()) found("a position that is no number");
  } catch (const std::runtime_error&) {
    return;
  }
}

inline void snapshot(std::string_view bytes) {
  static Simulation bay = [] {
    auto [building, scenario] = parse_scenario(R"({"topple": 1, "model": "bay.json"})", "s.json", folder().path());
    return Simulation(std::move(building), std::move(scenario));
  }();
  promised([&] {
    std::string file(bytes);  // all but the checksum, which no mutation would hit
    ReplayHash sum;
    sum.add(bytes);
    const std::uint64_t value = sum.value();
    file.append(reinterpret_cast<const char*>(&value), sizeof value);
    Snapshot saved = parse_snapshot(file, "saved");
    if (saved.step > 100) return;
    saved.scene = bay.save().scene;  // nor this
    bay.restore(saved);
  });
}

/// Bytes as choices and numbers.
class Choices {
 public:
  explicit Choices(std::string_view bytes) : bytes_(bytes) {}
  [[nodiscard]] bool done() const { return bytes_.empty(); }
  std::uint8_t byte() { return take<std::uint8_t>(); }
  /// Often sound, at times any bits at all.
  double number(double least, double most) {
    const std::uint8_t kind = byte();
    if (kind < 16) return take<double>();
    return least + (most - least) * take<std::uint16_t>() / 65535.0;
  }
  Vec3 vector(double reach) {
    const double x = number(-reach, reach), y = number(-reach, reach), z = number(-reach, reach);
    return {x, y, z};
  }
  template <class Id>
  Id id(std::size_t count) {
    const std::uint8_t kind = byte();
    Id id;
    id.index = kind < 16 ? take<std::int32_t>() : static_cast<std::int32_t>(kind % count);
    return id;
  }

 private:
  template <class T>
  T take() {
    T value{};
    const std::size_t size = std::min(sizeof value, bytes_.size());
    std::memcpy(&value, bytes_.data(), size);
    bytes_.remove_prefix(size);
    return value;
  }
  std::string_view bytes_;
};

inline Tool tool_of(Choices& c, const Building& b) {
  const auto members = [&] { return std::vector{c.id<MemberId>(b.members.size())}; };
  const auto joints = [&] { return std::vector{c.id<JointId>(b.joints.size())}; };
  switch (c.byte() % 8) {
    case 0:
      return Projectile{c.vector(10), c.vector(100), c.number(1, 1000), c.number(0.05, 1)};
    case 1:
      return WreckingBall{c.vector(10), c.vector(10), c.number(1, 30), c.number(10, 5000), c.number(0.1, 1)};
    case 2:
      return CutTool{joints()};
    case 3:
      return RemoveTool{members(), {c.id<PanelId>(b.panels.size())}, {c.id<NodeId>(b.nodes.size())}};
    case 4:
      return ChargeTool{c.vector(6), c.number(0.1, 5), c.number(0, 1), c.number(0, 1)};
    case 5:
      return WeakenTool{joints(), members(), c.number(0, 1), c.number(0.1, 1), c.number(0, 2), c.byte()};
    case 6:
      return GravityTool{c.vector(20)};
    default:
      return LoadTool{{{c.id<NodeId>(b.nodes.size()), Vec6::Constant(c.number(-1e4, 1e4))}}};
  }
}

inline HostContact contact_of(Choices& c, const Building& b) {
  HostContact contact;
  const std::uint8_t what = c.byte() % 4;
  if (what == 0) contact.member = c.id<MemberId>(b.members.size());
  if (what == 1) contact.panel = c.id<PanelId>(b.panels.size());
  if (what >= 2) contact.body.value = c.byte();
  contact.point = contact.centre = c.vector(6);
  contact.normal = c.vector(1).normalized();
  contact.velocity = c.vector(30);
  contact.angular_velocity = c.vector(3);
  contact.mass = c.number(1, 2000);
  contact.inertia = Mat3::Identity() * c.number(0.1, 500);
  return contact;
}

/// One call of a host.
inline void call(Simulation& s, Choices& c, Snapshot& saved) {
  const Building& b = s.building();
  switch (c.byte() % 12) {
    case 0:
    case 1:
      return s.apply(tool_of(c, b));
    case 2:
      return s.touch(contact_of(c, b));
    case 3: {
      std::pair<JointId, JointCapacity> change{c.id<JointId>(b.joints.size()), {}};
      change.second.breakable = true;
      change.second.value.fill(c.number(0, 1e6));
      change.second.ductility.fill(c.number(0, 0.1));
      return s.set_capacities({&change, 1});
    }
    case 4:
      saved = s.save();
      return;
    case 5:
      return s.restore(saved);
    case 6:
      return (void)s.what_carries(c.id<MemberId>(b.members.size()));
    case 7:
      return (void)s.what_carries(c.id<PanelId>(b.panels.size()));
    case 8:
      (void)s.body_of(c.id<MemberId>(b.members.size()));
      return (void)s.broken_panel(c.id<PanelId>(b.panels.size()));
    case 9:
      return (void)s.ray_cast(c.vector(10), c.vector(1));
    case 10:
      (void)s.next_to_break(c.byte());
      return (void)(s.skip_idle(), s.ledger());
    default:
      for (int i = c.byte() % 8; i >= 0; --i) s.step();
      for (const double coordinate : s.poses())
        if (!std::isfinite(coordinate)) found("a pose that is no number");
  }
}

inline void host(std::string_view bytes) {
  auto [building, scenario] =
      parse_scenario(R"({"topple": 1, "model": "bay.json", "duration": 5})", "s.json", folder().path());
  Simulation simulation(std::move(building), std::move(scenario));
  Snapshot saved = simulation.save();
  Choices choices(bytes);
  for (int calls = 0; calls < 60 && !choices.done() && simulation.steps() < 200; ++calls) try {
      call(simulation, choices, saved);
    } catch (const InputError&) {
    } catch (const std::out_of_range&) {
    } catch (const UnstableModel&) {
      return;
    }
  // Whatever was done can be done again.
  const Snapshot end = simulation.save();
  simulation.restore(end);
  if (simulation.hash() != end.hash) found("a run that does not come back to where it was");
}

/// By name: what scripts/stress fuzz builds, and the corpus that lies under this name.
inline const std::map<std::string, void (*)(std::string_view)>& targets() {
  static const std::map<std::string, void (*)(std::string_view)> all{
      {"model", model}, {"tables", tables},     {"frame3dd", frame3dd}, {"scenario", scenario},
      {"panel", panel}, {"snapshot", snapshot}, {"gltf", gltf},         {"host", host},
      {"study", study}, {"journal", journal},   {"history", history},   {"cuts", cuts}};
  return all;
}

}  // namespace topple::fuzz
