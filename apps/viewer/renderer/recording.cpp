#include "renderer/recording.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "renderer/shapes/dust.h"

namespace topple::viewer {
namespace {

/// A large building's answers are kept this far apart (s), so that a minute of collapse fits into memory.
constexpr double answer_interval = 0.1;
constexpr std::size_t large_building = 4000;  ///< joints

PoseKey key_of(const BodyPose& body, std::int32_t frame) {
  PoseKey key;
  key.frame = frame;
  const Eigen::Vector3d offset = body.position - body.rest_centre;
  for (int c = 0; c < 3; ++c) key.offset[static_cast<std::size_t>(c)] = static_cast<float>(offset[c]);
  for (int c = 0; c < 4; ++c) key.turn[static_cast<std::size_t>(c)] = static_cast<float>(body.orientation.coeffs()[c]);
  return key;
}

Eigen::Quaterniond turn_of(const PoseKey& key) {
  return Eigen::Quaterniond(static_cast<double>(key.turn[3]), static_cast<double>(key.turn[0]),
                            static_cast<double>(key.turn[1]), static_cast<double>(key.turn[2]))
      .normalized();
}
Eigen::Vector3d offset_of(const PoseKey& key) {
  return Eigen::Vector3f(key.offset[0], key.offset[1], key.offset[2]).cast<double>();
}

}  // namespace

BodyPose BodyTrack::pose(std::int32_t frame) const {
  BodyPose body;
  body.id = id;
  body.rest_centre = rest_centre;
  body.radius = radius;
  body.chunk = chunk;
  body.chunk_of = chunk_of;
  body.cable_anchor = cable_anchor;
  auto next = std::upper_bound(keys.begin(), keys.end(), frame,
                               [](std::int32_t f, const PoseKey& key) { return f < key.frame; });
  const PoseKey& here = next == keys.begin() ? keys.front() : *(next - 1);
  body.position = rest_centre + offset_of(here);
  body.orientation = turn_of(here);
  body.asleep = next == keys.end() && frame > here.frame;
  if (next == keys.end() || next == keys.begin() || frame == here.frame) return body;
  const double share = static_cast<double>(frame - here.frame) / (next->frame - here.frame);
  body.position += share * (offset_of(*next) - offset_of(here));
  body.orientation = body.orientation.slerp(share, turn_of(*next));
  return body;
}

void Recording::clear() {
  const std::lock_guard lock(mutex_);
  frames_.clear(), tracks_.clear(), alive_.clear(), events_.clear(), dust_.clear();
  resting_ = false;
}

void Recording::cut_from(std::int64_t step) {
  const auto first =
      std::lower_bound(frames_.begin(), frames_.end(), step, [](const Frame& f, std::int64_t s) { return f.step < s; });
  if (first == frames_.end()) return;
  const auto kept = static_cast<std::int32_t>(first - frames_.begin());
  std::erase_if(dust_, [&](const DustPuff& puff) { return puff.time >= first->time; });
  frames_.erase(first, frames_.end());
  std::erase_if(tracks_, [kept](const BodyTrack& track) { return track.first >= kept; });
  alive_.clear();
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    BodyTrack& track = tracks_[t];
    std::erase_if(track.keys, [kept](const PoseKey& key) { return key.frame >= kept; });
    if (track.end > kept) track.end = -1;
    if (track.end < 0) alive_.push_back(t);
  }
  resting_ = false;
}

void Recording::add(const Snapshot& snapshot) {
  const std::lock_guard lock(mutex_);
  cut_from(snapshot.step);
  // Events of this very step stay: they led to it.
  std::erase_if(events_, [&](const Event& event) { return event.time > snapshot.time + 1e-9; });
  Frame frame{snapshot.time,  snapshot.step,  snapshot.at_rest,  snapshot.answer,  snapshot.membership,
              snapshot.tuned, snapshot.drawn, snapshot.counters, snapshot.energies};
  bool news = frames_.empty();
  if (!news) {
    const Frame& last = frames_.back();
    const bool too_soon = snapshot.answer != last.answer && snapshot.answer->joints.size() > large_building &&
                          std::fmod(last.time, answer_interval) <= std::fmod(snapshot.time, answer_interval);
    if (too_soon) frame.answer = last.answer;
    news = frame.answer != last.answer || frame.membership != last.membership || frame.tuned != last.tuned ||
           frame.drawn != last.drawn || too_soon;
  }
  if (snapshot.dust)
    for (const DustPuff& puff : *snapshot.dust)
      if (dust_.empty() || std::tie(dust_.back().time, dust_.back().number) < std::tie(puff.time, puff.number))
        dust_.push_back(puff), news = true;
  const auto number = static_cast<std::int32_t>(frames_.size());
  std::vector<std::size_t> still;
  std::size_t next = 0;
  for (const BodyPose& body : snapshot.bodies) {
    while (next < alive_.size() && tracks_[alive_[next]].id < body.id)
      tracks_[alive_[next++]].end = number, news = true;
    const PoseKey key = key_of(body, number);
    if (next < alive_.size() && tracks_[alive_[next]].id == body.id) {
      still.push_back(alive_[next]);
      BodyTrack& track = tracks_[alive_[next++]];
      const PoseKey last = track.keys.back();
      if (last.offset == key.offset && last.turn == key.turn) continue;
      // It lay still until the frame before this one.
      if (last.frame < number - 1) {
        track.keys.push_back(last);
        track.keys.back().frame = number - 1;
      }
      track.keys.push_back(key);
    } else {
      still.push_back(tracks_.size());
      tracks_.push_back(
          {body.id, body.rest_centre, body.radius, body.chunk, body.chunk_of, body.cable_anchor, number, -1, {key}});
    }
    news = true;
  }
  for (; next < alive_.size(); ++next) tracks_[alive_[next]].end = number, news = true;
  alive_ = std::move(still);
  if (!news && resting_) {
    frames_.back() = std::move(frame);
    return;
  }
  resting_ = !news;
  frames_.push_back(std::move(frame));
}

void Recording::add_event(Event event) {
  const std::lock_guard lock(mutex_);
  events_.push_back(std::move(event));
}

std::array<double, 2> Recording::span() const {
  const std::lock_guard lock(mutex_);
  if (frames_.empty()) return {0, 0};
  return {frames_.front().time, frames_.back().time};
}

std::size_t Recording::frame_at(double time) const {
  const auto after = std::upper_bound(frames_.begin(), frames_.end(), time,
                                      [](double t, const Frame& frame) { return t < frame.time; });
  return after == frames_.begin() ? 0 : static_cast<std::size_t>(after - frames_.begin()) - 1;
}

std::shared_ptr<const std::vector<DustPuff>> Recording::dust_at(double time) const {
  const auto first = std::partition_point(dust_.begin(), dust_.end(),
                                          [=](const DustPuff& puff) { return puff.time + dust_life <= time; });
  const auto end = std::partition_point(first, dust_.end(), [=](const DustPuff& puff) { return puff.time <= time; });
  std::vector<DustPuff> there(first, end);
  return there.empty() ? nullptr : std::make_shared<const std::vector<DustPuff>>(std::move(there));
}

Snapshot Recording::frame_snapshot(std::size_t number) const {
  const Frame& frame = frames_[number];
  Snapshot snapshot;
  snapshot.time = frame.time;
  snapshot.step = frame.step;
  snapshot.at_rest = frame.at_rest;
  snapshot.answer = frame.answer;
  snapshot.membership = frame.membership;
  snapshot.tuned = frame.tuned;
  snapshot.drawn = frame.drawn;
  snapshot.counters = frame.counters;
  snapshot.energies = frame.energies;
  snapshot.dust = dust_at(frame.time);
  const auto at = static_cast<std::int32_t>(number);
  for (const BodyTrack& track : tracks_)
    if (track.first <= at && (track.end < 0 || at < track.end)) snapshot.bodies.push_back(track.pose(at));
  return snapshot;
}

Snapshot Recording::at(double time) const {
  const std::lock_guard lock(mutex_);
  const std::size_t frame = frame_at(time);
  Snapshot here = frame_snapshot(frame);
  if (frame + 1 == frames_.size() || time <= here.time) return here;
  const Snapshot next = frame_snapshot(frame + 1);
  const double share = (time - here.time) / (next.time - here.time);
  Snapshot between = interpolate(here, next, share);
  // Over steps that brought nothing new one of them is meant, else the one that is over.
  between.step =
      here.step + static_cast<std::int64_t>(std::floor(share * static_cast<double>(next.step - here.step) + 1e-6));
  return between;
}

std::vector<Recording::Event> Recording::events() const {
  const std::lock_guard lock(mutex_);
  return events_;
}

namespace {

/// Even instants from the first to the last frame, the first and the last among them.
std::vector<double> even_instants(std::size_t count, double begin, double end) {
  std::vector<double> times;
  for (std::size_t i = 0; i < count; ++i)
    times.push_back(begin +
                    (count > 1 ? (end - begin) * static_cast<double>(i) / static_cast<double>(count - 1) : 0.0));
  return times;
}

constexpr double rounding = 1e-9;  // s

}  // namespace

std::vector<std::array<float, 2>> Recording::history(structure::JointId joint, std::size_t most) const {
  const std::lock_guard lock(mutex_);
  std::vector<std::array<float, 2>> points;
  if (frames_.empty()) return points;
  const auto used = [&](std::size_t frame) {
    return frames_[frame].answer->joints[static_cast<std::size_t>(joint.index)].utilisation;
  };
  // A frame that sways has its peaks between two instants of a long run.
  std::size_t next = 0;
  for (const double time : even_instants(std::min(most, frames_.size()), frames_.front().time, frames_.back().time)) {
    const std::size_t last = frame_at(time + rounding);
    float largest = used(last);
    for (; next <= last; ++next) largest = std::max(largest, used(next));
    points.push_back({static_cast<float>(time), largest});
  }
  return points;
}

std::vector<Recording::Energies> Recording::energies(std::size_t most) const {
  const std::lock_guard lock(mutex_);
  std::vector<Energies> points;
  if (frames_.empty()) return points;
  for (const double time : even_instants(std::min(most, frames_.size()), frames_.front().time, frames_.back().time))
    points.push_back({time, frames_[frame_at(time + rounding)].energies});
  return points;
}

}  // namespace topple::viewer
