// What is heard: modes against the theory of bars, loudness by distance and energy, delay by the speed of sound.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <numeric>

#include "app/sound/speaker.h"
#include "app/sound/synthesis.h"
#include "support/scratch_folder.h"

namespace {

using namespace topple::viewer;

DustPuff impact(double time, double distance, Look look = Look::concrete, float mass = 300, float size = 1.5F) {
  DustPuff puff;
  puff.time = time;
  puff.position = {distance, 0, 0};
  puff.size = size;
  puff.material = static_cast<std::uint8_t>(look);
  puff.mass = mass;
  return puff;
}

/// The eye in the origin looks along y: what lies at x > 0 is on its right.
Camera ear() {
  Camera camera;
  camera.eye = {0, 0, 0};
  camera.target = {0, 10, 0};
  return camera;
}

struct Heard {
  std::vector<double> left, right;
  [[nodiscard]] static double power(const std::vector<double>& s) {
    return std::inner_product(s.begin(), s.end(), s.begin(), 0.0);
  }
  /// s, of the first sample that is not silent.
  [[nodiscard]] double begin() const {
    for (std::size_t i = 0; i < left.size(); ++i)
      if (std::abs(left[i]) + std::abs(right[i]) > 1e-4) return static_cast<double>(i) / sample_rate;
    return -1;
  }
};

/// Two seconds in steps of a sixtieth, with these puffs.
Heard listen(const std::vector<DustPuff>& puffs, double pace = 1) {
  const auto speaker = Speaker::into_memory();
  Heard heard;
  Snapshot moment;
  moment.dust = std::make_shared<const std::vector<DustPuff>>(puffs);
  for (int step = 0; step < 120; ++step) {
    moment.time = step / 60.0;
    speaker->hear(moment, ear(), pace);
    const std::vector<float> samples = speaker->render(sample_rate / 60);
    for (std::size_t i = 0; i < samples.size(); i += 2) {
      heard.left.push_back(static_cast<double>(samples[i]));
      heard.right.push_back(static_cast<double>(samples[i + 1]));
    }
  }
  return heard;
}

/// Power at a frequency, by Goertzel's sum over the first half second.
double power_at(const std::vector<float>& sound, double frequency) {
  double re = 0, im = 0;
  const std::size_t count = std::min<std::size_t>(sound.size(), sample_rate / 2);
  for (std::size_t i = 0; i < count; ++i) {
    const double phase = 2 * M_PI * frequency * static_cast<double>(i) / sample_rate;
    re += static_cast<double>(sound[i]) * std::cos(phase);
    im += static_cast<double>(sound[i]) * std::sin(phase);
  }
  return re * re + im * im;
}

}  // namespace

TEST_CASE("modes are those of a free bar") {
  // A steel bar of 1 m x 0.1 m x 0.1 m weighs 78.5 kg; its first mode by hand: f = 1.028 h / L^2 sqrt(E / rho), with
  // 1.028 = 4.730^2 / (2 pi sqrt 12).
  const Modes modes = modes_of(Look::steel, 78.5);
  REQUIRE(modes.frequencies.size() > 3);
  CHECK(modes.frequencies[0] == Approx(1.028 * 0.1 * 5100).epsilon(1e-3));  // the rounded factor
  // Their ratios are those of the roots of cosh x cos x = 1.
  CHECK(modes.frequencies[1] / modes.frequencies[0] == Approx(2.7565).epsilon(1e-3));
  for (const double f : modes.frequencies) CHECK((f >= 20 && f <= 1e4));
  // Eight times the mass is twice as long: half as high.
  CHECK(modes_of(Look::steel, 8 * 78.5).frequencies[0] == Approx(modes.frequencies[0] / 2));
}

TEST_CASE("steel rings at its modes, and longer than concrete") {
  const auto steel = synthesise(impact(0, 0, Look::steel, 78.5F), 0);
  const double f = modes_of(Look::steel, 78.5).frequencies[0];
  double at = 0;  // pieces are a little apart from the theory: up to 2 %
  for (double share = 0.98; share <= 1.02; share += 0.002) at = std::max(at, power_at(steel, share * f));
  double aside = 0;
  for (const double away : {0.7, 0.8, 1.25, 1.4}) aside = std::max(aside, power_at(steel, away * f));
  CHECK(at > 5 * aside);
  const auto tail = [](Look look) {
    const auto sound = synthesise(impact(0, 0, look, 78.5F), 0);
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < sound.size(); ++i) {
      const double square = static_cast<double>(sound[i]) * static_cast<double>(sound[i]);
      all += square;
      if (i > sample_rate / 8) sum += square;
    }
    return sum / all;
  };
  CHECK(tail(Look::steel) > 2 * tail(Look::concrete));
}

TEST_CASE("every kind of sound is finite, within bounds, ends in silence, and is the same again") {
  for (const auto kind : {DustPuff::Kind::dust, DustPuff::Kind::sparks, DustPuff::Kind::blast, DustPuff::Kind::fire})
    for (unsigned look = 1; look <= 6; ++look)
      for (const float mass : {0.0F, 1.0F, 5000.0F, 1e7F}) {
        DustPuff puff = impact(0, 0, static_cast<Look>(look), mass);
        puff.kind = kind;
        const auto sound = synthesise(puff, 1);
        const auto [low, high] = std::minmax_element(sound.begin(), sound.end());
        CHECK((*low >= -1 && *high <= 1 && *high > 0.001F));
        CHECK(std::abs(sound.back()) < 0.01F);
        CHECK(sound == synthesise(puff, 1));
      }
}

TEST_CASE("sound comes from where it is made, as late as it is far, and weaker") {
  const Heard near = listen({impact(0.1, 15)}), far = listen({impact(0.1, 150)});
  // On the right.
  CHECK(Heard::power(near.right) > 2 * Heard::power(near.left));
  // A step of the run, and what the device's own blocks and filters delay.
  CHECK(near.begin() == Approx(0.1 + 15 / speed_of_sound).margin(0.03));
  CHECK(far.begin() == Approx(0.1 + 150 / speed_of_sound).margin(0.03));
  // Pressure goes with the inverse of the distance: a hundredth of the power at ten times as far.
  const double ratio = Heard::power(far.right) / Heard::power(near.right);
  CHECK(ratio == Approx(0.01).epsilon(0.4));  // variants of noise, and its later end is cut off
}

TEST_CASE("nothing is heard of nothing, of what a jump in time passes over, or of what was heard before") {
  CHECK(Heard::power(listen({}).left) == 0);
  const auto speaker = Speaker::into_memory();
  Snapshot moment;
  moment.dust = std::make_shared<const std::vector<DustPuff>>(std::vector<DustPuff>{impact(1.0, 12)});
  for (const double time : {0.0, 2.0}) {
    moment.time = time;
    speaker->hear(moment, ear(), 1);
  }
  CHECK(speaker->playing() == 0);
  for (const double time : {0.95, 1.0, 1.05, 1.06}) {
    moment.time = time;
    speaker->hear(moment, ear(), 1);
  }
  CHECK(speaker->playing() == 1);
}

TEST_CASE("what is heavier and faster is louder, and many sounds at once stay within bounds") {
  CHECK(loudness(impact(0, 0, Look::brick, 500, 3)) > 2 * loudness(impact(0, 0, Look::brick, 500, 0.8F)));
  std::vector<DustPuff> many;
  for (int i = 0; i < 400; ++i) {
    many.push_back(impact(0.2 + 0.004 * (i / 10), 13 + i % 10, Look::brick, 2000, 4));
    many.back().number = i;
  }
  const Heard heard = listen(many);
  for (const auto* side : {&heard.left, &heard.right})
    CHECK(std::all_of(side->begin(), side->end(), [](double x) { return std::abs(x) <= 1; }));
  CHECK(Heard::power(heard.right) > Heard::power(listen({many[0]}).right));
}

TEST_CASE("a WAV file holds the samples") {
  const topple::test::ScratchFolder folder;
  const std::string file = (folder / "sound.wav").string();
  write_wav(file, {0.5F, -0.5F, 1.0F, 0.0F});
  std::ifstream in(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  REQUIRE(bytes.size() == 44 + 8);
  CHECK(bytes.substr(0, 4) == "RIFF");
  CHECK(static_cast<unsigned char>(bytes[24]) + 256 * static_cast<unsigned char>(bytes[25]) == sample_rate);
  CHECK(static_cast<unsigned char>(bytes[48]) + 256 * static_cast<unsigned char>(bytes[49]) == 32767);
}
