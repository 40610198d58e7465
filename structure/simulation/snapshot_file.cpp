#include <bit>
#include <cstring>

#include "simulation/accounts/replay_hash.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/input_files.h"
#include "topple/structure/formats/plain_text.h"
#include "topple/structure/snapshot.h"

namespace topple::structure {

namespace {

static_assert(std::endian::native == std::endian::little, "snapshots are written in the byte order of this machine");

constexpr char magic[8] = {'T', 'O', 'P', 'P', 'L', 'E', 'S', 'N'};
constexpr std::uint32_t format = 3;

/// Of all bytes before it: tells what was damaged on its way from what was made so. FNV-1a, 64 bits.
std::uint64_t checksum(std::string_view bytes) {
  ReplayHash hash;
  hash.add(bytes);
  return hash.value();
}

class Writer {
 public:
  std::string bytes;
  void raw(void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
  std::uint64_t count(std::size_t size) {
    auto value = static_cast<std::uint64_t>(size);
    raw(&value, sizeof value);
    return value;
  }
};

class Reader {
 public:
  Reader(const std::string& bytes, const std::string& name) : bytes_(bytes), name_(name) {}
  void raw(void* data, std::size_t size) {
    if (bytes_.size() - at_ < size) fail("is cut short");
    std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }
  std::uint64_t count(std::size_t) {
    std::uint64_t value = 0;
    raw(&value, sizeof value);
    if (value > bytes_.size()) fail("is damaged");  // nothing takes less than a byte
    return value;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(one_line(name_ + ": " + what) + "; accepted: a snapshot that `topple demolish --save` wrote");
  }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }
  [[nodiscard]] std::size_t position() const { return at_; }

 private:
  const std::string& bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
};

// Each thing is described once, for both directions.
template <class A, class T>
void pass(A& archive, T& value);

template <class A, class... T>
void each(A& archive, T&... values) {
  (pass(archive, values), ...);
}
template <class A>
void fields(A& archive, Vec3& v) {
  archive.raw(v.data(), 3 * sizeof(double));
}
template <class A>
void fields(A& archive, Vec6& v) {
  archive.raw(v.data(), 6 * sizeof(double));
}
template <class A>
void fields(A& archive, Mat3& m) {
  archive.raw(m.data(), 9 * sizeof(double));
}
template <class A, class Tag>
void fields(A& archive, Id<Tag>& id) {
  archive.raw(&id.index, sizeof id.index);
}
template <class A, class T>
void fields(A& archive, std::vector<T>& list) {
  list.resize(archive.count(list.size()));
  for (T& value : list) pass(archive, value);
}
template <class A>
void fields(A& archive, std::string& text) {
  text.resize(archive.count(text.size()));
  archive.raw(text.data(), text.size());
}
template <class A>
void fields(A& archive, Projectile& p) {
  each(archive, p.from, p.velocity, p.mass, p.radius);
}
template <class A>
void fields(A& archive, WreckingBall& w) {
  each(archive, w.anchor, w.from, w.cable, w.mass, w.radius);
}
template <class A>
void fields(A& archive, CutTool& cut) {
  each(archive, cut.joints);
}
template <class A>
void fields(A& archive, RemoveTool& remove) {
  each(archive, remove.members, remove.panels, remove.supports);
}
template <class A>
void fields(A& archive, ChargeTool& charge) {
  each(archive, charge.centre, charge.radius, charge.strength_at_centre, charge.strength_at_radius);
}
template <class A>
void fields(A& archive, WeakenTool& weaken) {
  each(archive, weaken.joints, weaken.members, weaken.strength, weaken.stiffness, weaken.over, weaken.stages);
}
template <class A>
void fields(A& archive, GravityTool& tool) {
  each(archive, tool.gravity);
}
template <class A>
void fields(A& archive, NodeLoad& load) {
  each(archive, load.node, load.load);
}
template <class A>
void fields(A& archive, LoadTool& load) {
  each(archive, load.nodes);
}

template <std::size_t i = 0>
Tool tool_of_kind(std::size_t kind) {
  if constexpr (i + 1 < std::variant_size_v<Tool>)
    if (kind != i) return tool_of_kind<i + 1>(kind);
  return Tool(std::in_place_index<i>);
}

template <class A>
void fields(A& archive, Tool& tool) {
  auto kind = static_cast<std::uint8_t>(tool.index());
  archive.raw(&kind, sizeof kind);
  if constexpr (std::is_same_v<A, Reader>) {
    if (kind >= std::variant_size_v<Tool>) archive.fail("holds a tool of an unknown kind");
    tool = tool_of_kind(kind);
  }
  std::visit([&](auto& one) { pass(archive, one); }, tool);
}
template <class A>
void fields(A& archive, HostContact& contact) {
  each(archive, contact.key, contact.member, contact.panel, contact.body.value, contact.point, contact.normal,
       contact.mass, contact.inertia, contact.centre, contact.velocity, contact.angular_velocity);
}
template <class A>
void fields(A& archive, std::pair<JointId, JointCapacity>& change) {
  auto& [joint, capacity] = change;
  auto sum = static_cast<std::uint8_t>(capacity.interaction == Interaction::sum);
  auto breakable = static_cast<std::uint8_t>(capacity.breakable);
  pass(archive, joint);
  for (double& value : capacity.value) pass(archive, value);
  for (double& value : capacity.ductility) pass(archive, value);
  each(archive, sum, breakable);
  capacity.interaction = sum != 0 ? Interaction::sum : Interaction::max;
  capacity.breakable = breakable != 0;
}
template <class A>
void fields(A& archive, CapacityChange& change) {
  each(archive, change.joints);
}
template <class A>
void fields(A& archive, Snapshot::Action& action) {
  auto kind = static_cast<std::uint8_t>(action.what.index());
  each(archive, action.step, kind);
  if constexpr (std::is_same_v<A, Reader>) {
    if (kind > 2) archive.fail("holds an action of an unknown kind");
    if (kind == 1) action.what = HostContact();
    if (kind == 2) action.what = CapacityChange();
  }
  std::visit([&](auto& one) { pass(archive, one); }, action.what);
}
template <class A>
void fields(A& archive, Snapshot& snapshot) {
  each(archive, snapshot.step, snapshot.hash, snapshot.scene, snapshot.actions);
}

template <class A, class T>
void pass(A& archive, T& value) {
  if constexpr (std::is_arithmetic_v<T>)
    archive.raw(&value, sizeof value);
  else
    fields(archive, value);
}

}  // namespace

std::string snapshot_bytes(const Snapshot& snapshot) {
  Snapshot copy = snapshot;
  std::string version = TOPPLE_VERSION;
  std::uint32_t number = format;
  Writer writer;
  writer.bytes.assign(magic, sizeof magic);
  each(writer, number, version, copy);
  std::uint64_t sum = checksum(writer.bytes);
  pass(writer, sum);
  return writer.bytes;
}

Snapshot parse_snapshot(const std::string& bytes, const std::string& name) {
  Reader reader(bytes, name);
  char begin[sizeof magic] = {};
  std::uint32_t number = 0;
  std::string version;
  Snapshot snapshot;
  if (bytes.size() < sizeof magic) reader.fail("is no snapshot");
  reader.raw(begin, sizeof begin);
  if (std::memcmp(begin, magic, sizeof magic) != 0) reader.fail("is no snapshot");
  pass(reader, number);
  if (number != format)
    reader.fail("is of format " + std::to_string(number) + ", this program reads " + std::to_string(format));
  pass(reader, version);
  // Another version may calculate otherwise in the last bit, which a collapse makes visible.
  if (version != TOPPLE_VERSION) reader.fail("was made by version " + version + ", this program is " + TOPPLE_VERSION);
  pass(reader, snapshot);
  const std::uint64_t sum = checksum(std::string_view(bytes).substr(0, reader.position()));
  std::uint64_t written = 0;
  pass(reader, written);
  if (!reader.at_end()) reader.fail("goes on after its end");
  if (written != sum) reader.fail("is damaged: its checksum is another");
  std::int64_t before = 0;
  for (const Snapshot::Action& action : snapshot.actions) {
    if (action.step < before || action.step > snapshot.step) reader.fail("holds actions out of order");
    before = action.step;
  }
  return snapshot;
}

Snapshot read_snapshot(const std::filesystem::path& file) {
  return parse_snapshot(read_whole_file(file), one_line(file.string()));
}

}  // namespace topple::structure
