// Processor time of what the viewer does for one picture, without what the graphics card or a software rasteriser does:
// interpolation between two snapshots and the arrays that are sent. Asked: under 1 ms for the seed building, under 4 ms
// for 10 x 10 x 40 with slabs and 5,000 debris bodies, and in every shipped scene with as many of its members falling.
// How long the start takes until the first picture's arrays are there; asked: a picture within 2 s.
// And how long a changed strength takes to be seen: the answer's utilisations and the standing arrays; asked: under 50
// ms for the large one.
//   bench_viewer_frame
#include <ctime>

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/open_scene.h"
#include "app/session.h"
#include "app/start/shipped_scenes.h"
#include "renderer/instances/scene_instances.h"
#include "support/measure.h"
#include "support/provenance.h"

namespace {

using namespace topple::viewer;

double processor_milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

template <class Work>
double median_time(int rounds, Work work) {
  std::vector<double> times;
  for (int i = 0; i < rounds; ++i) {
    const double before = processor_milliseconds();
    work(i);
    times.push_back(processor_milliseconds() - before);
  }
  return topple::bench::median(times);
}

/// So many members, from the top down, are bodies of their own that turn and fall.
std::vector<std::shared_ptr<const Snapshot>> falling(const topple::structure::Building& building, const Snapshot& rest,
                                                     std::size_t debris) {
  auto membership = std::make_shared<Membership>(*rest.membership);
  std::vector<BodyPose> bodies;
  for (std::size_t k = 0; k < debris; ++k) {
    const std::size_t m = building.members.size() - 1 - k;
    membership->member[m] = static_cast<int>(k);
    BodyPose body;
    body.id = static_cast<std::int64_t>(k);
    body.rest_centre = body.position = building[building.members[m].nodes[0]].position;
    bodies.push_back(body);
  }
  std::vector<std::shared_ptr<const Snapshot>> snapshots;
  for (int step = 0; step < 8; ++step) {
    auto snapshot = std::make_shared<Snapshot>(rest);
    snapshot->step = step;
    snapshot->membership = membership;
    for (BodyPose& body : bodies) {
      body.position.z() -= 0.1;
      body.orientation =
          body.orientation * Eigen::Quaterniond(Eigen::AngleAxisd(0.05, Eigen::Vector3d(1, 2, 3).normalized()));
    }
    snapshot->bodies = bodies;
    snapshots.push_back(snapshot);
  }
  return snapshots;
}

double seconds_since(std::chrono::steady_clock::time_point begun) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

/// From a scene's name to the arrays of its first picture, which shows the building unloaded; then until the run has
/// begun. Once: what a person waits for.
void measure_start(const std::string& name) {
  const auto begun = std::chrono::steady_clock::now();
  const Scene scene = open_scene(name);
  SceneInstances instances(*scene.building);
  instances.update(undeformed(*scene.building), ViewOptions());
  const double first = seconds_since(begun);
  Session session(scene.building, scene.scenario, scene.drawn);
  (void)session.snapshot();
  std::printf("%-26s first picture after %6.3f s   run begins after %7.3f s\n", name.c_str(), first,
              seconds_since(begun));
}

void measure(const std::string& name, std::size_t most) {
  const Scene scene = open_scene(name);
  const std::size_t debris = std::min(most, scene.building->members.size());
  Session session(scene.building, scene.scenario);
  const auto rest = session.snapshot();
  SceneInstances instances(*scene.building);
  ViewOptions options;
  const auto moving = falling(*scene.building, *rest, debris);
  instances.update(*moving[0], options);
  const double picture = median_time(50, [&](int i) {
    const auto k = static_cast<std::size_t>(i) % (moving.size() - 1);
    instances.update(interpolate(*moving[k], *moving[k + 1], 0.4), options);
  });
  options.colouring = Colouring::utilisation;
  topple::structure::JointChange change;
  change.joints = "*";
  const double tuned = median_time(20, [&](int i) {
    change.strength = 1 + 0.01 * i;
    session.tune(change);
    instances.update(*session.snapshot(), options);
  });
  std::printf("%-26s %6zu members %6zu panels %5zu bodies   picture %7.3f ms   changed strength %7.3f ms\n",
              name.c_str(), scene.building->members.size(), scene.building->panels.size(), debris, picture, tuned);
}

}  // namespace

int main() {
  topple::bench::print_provenance("The viewer's processor time for a picture (median, rasterising excluded)", 1);
  measure("seed_building", 200);
  measure("tower_10x10x40", 2000);
  for (const ShippedScene& scene : shipped_scenes()) measure(scene.name, 5000);
  for (const ShippedScene& scene : shipped_scenes()) measure_start(scene.name);
}
