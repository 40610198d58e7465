#include "app/sound/synthesis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "renderer/shapes/dust.h"

namespace topple::viewer {
namespace {

constexpr double pi = std::numbers::pi;

/// Speed of sound along a bar (m/s), density (kg/m3), loss factor of rough pieces among others.
struct Acoustics {
  double speed, density, loss;
};
Acoustics acoustics_of(Look look) {
  switch (look) {
    case Look::steel:
      return {5100, 7850, 0.002};
    case Look::brick:
      return {2800, 1800, 0.06};
    case Look::glass:
      return {5300, 2500, 0.005};
    case Look::plaster:
      return {2000, 1000, 0.08};
    case Look::timber:
      return {3500, 500, 0.04};
    case Look::concrete:
      break;
  }
  return {3600, 2400, 0.035};
}

/// White noise that is the same for the same seed (xorshift64: Marsaglia, Xorshift RNGs, 2003).
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 0x1234567u) {
    for (int i = 0; i < 8; ++i) (void)next();
  }
  /// -1 to 1.
  double next() {
    state_ ^= state_ << 13U, state_ ^= state_ >> 7U, state_ ^= state_ << 17U;
    return static_cast<double>(state_ >> 11U) / static_cast<double>(std::uint64_t{1} << 52U) - 1;
  }
  /// 0 to 1.
  double share() { return (next() + 1) / 2; }

 private:
  std::uint64_t state_;
};

std::size_t samples(double seconds) { return static_cast<std::size_t>(seconds * sample_rate); }

/// Adds exp(-decay t) sin(2 pi f t) from a sample on: a two-pole recursion, exact.
void ring(std::vector<float>& sound, std::size_t from, double frequency, double decay, double amplitude) {
  const double w = 2 * pi * frequency / sample_rate, r = std::exp(-decay / sample_rate), turn = 2 * r * std::cos(w);
  double before = 0, now = amplitude * r * std::sin(w);
  for (std::size_t i = from; i < sound.size() && r > 0; ++i) {
    sound[i] += static_cast<float>(before);
    const double next = turn * now - r * r * before;
    before = now, now = next;
    if (std::abs(before) + std::abs(now) < 1e-6 * amplitude) return;
  }
}

/// Adds noise below a corner frequency that swells for `rise` and decays.
void rush(std::vector<float>& sound, Noise& noise, double corner, double rise, double decay, double amplitude) {
  const double share = 1 - std::exp(-2 * pi * corner / sample_rate);
  // What a filter of one pole leaves of white noise: its level is kept.
  const double level = amplitude / std::sqrt(share / (2 - share));
  double low = 0, lower = 0;
  for (std::size_t i = 0; i < sound.size(); ++i) {
    const double t = static_cast<double>(i) / sample_rate;
    low += share * (noise.next() - low);
    lower += share * (low - lower);
    sound[i] += static_cast<float>(level * lower * std::min(1.0, t / rise) * std::exp(-decay * t));
  }
}

/// One impact: all modes at once, each by chance as it is struck somewhere, and the clap of the contact.
void strike(std::vector<float>& sound, std::size_t at, const Modes& modes, Noise& noise, double amplitude) {
  for (std::size_t k = 0; k < modes.frequencies.size(); ++k) {
    const double frequency = modes.frequencies[k] * (1 + 0.02 * noise.next());
    ring(sound, at, frequency, pi * frequency * modes.loss + 2,
         amplitude * (0.3 + 0.7 * noise.share()) / std::sqrt(1.0 + static_cast<double>(k)));
  }
}

/// Small pieces that fall and roll after it: impacts at random times, fewer and weaker as time goes.
void rattle(std::vector<float>& sound, Look look, Noise& noise, int pieces, double over) {
  for (int i = 0; i < pieces; ++i) {
    const double share = noise.share(), at = over * share * share;
    const Modes small = modes_of(look, 0.05 * std::pow(100.0, noise.share()));
    strike(sound, samples(0.01 + at), small, noise, 0.12 * noise.share() * (1 - share));
  }
}

void hit(std::vector<float>& sound, const DustPuff& puff, Noise& noise) {
  const auto look = static_cast<Look>(puff.material);
  const bool broke = puff.broke;
  strike(sound, 0, modes_of(look, static_cast<double>(puff.mass)), noise, broke ? 0.35 : 0.5);
  // The heavier, the duller and the longer the thud.
  const double root = std::cbrt(std::clamp(static_cast<double>(puff.mass), 1.0, 1e5));
  const double thud = look == Look::steel || look == Look::glass ? 0.2 : 0.8;
  rush(sound, noise, std::clamp(1500 / root, 60.0, 1500.0), 0.002, std::clamp(60 / root, 3.0, 40.0), thud);
  if (broke) rush(sound, noise, 6000, 0.0005, 90, 0.5);
  if (look != Look::steel) rattle(sound, look, noise, broke ? 24 : 10, broke ? 1.0 : 0.6);
}

/// Friedlander's wave (overpressure, then suction), and the roar that hills and houses give back.
void explode(std::vector<float>& sound, const DustPuff& puff, Noise& noise) {
  const double length = 0.006 * std::max(1.0F, puff.size);  // s, of the overpressure
  for (std::size_t i = 0; i < sound.size(); ++i) {
    const double t = static_cast<double>(i) / sample_rate / length;
    sound[i] += static_cast<float>(1.2 * (1 - t) * std::exp(-t));
  }
  rush(sound, noise, 140, 0.01, 2.2, 1.1);
  rush(sound, noise, 1800, 0.003, 9, 0.5);
}

void crackle(std::vector<float>& sound, Noise& noise) {
  rush(sound, noise, 400, 0.15, 5, 0.12);
  for (int i = 0; i < 3; ++i)
    ring(sound, samples(0.5 * noise.share()), 900 + 2600 * noise.share(), 500, 0.5 * noise.share());
}

double length_of(const DustPuff& puff) {
  if (puff.kind == DustPuff::Kind::blast) return 3.0;
  if (puff.kind == DustPuff::Kind::fire) return 0.7;
  return puff.mass > 200 ? 2.2 : 1.3;
}

}  // namespace

Modes modes_of(Look material, double mass) {
  constexpr std::array<double, 8> roots{4.7300, 7.8532, 10.9956, 14.1372, 17.2788, 20.4204, 23.5619, 26.7035};
  constexpr double slender = 10, lowest = 20, highest = 1e4;
  const Acoustics a = acoustics_of(material);
  const double length = std::cbrt(std::max(mass, 1e-3) * slender * slender / a.density), depth = length / slender;
  Modes modes;
  modes.loss = a.loss;
  for (const double root : roots) {
    const double frequency = root * root * a.speed * depth / (2 * pi * length * length * std::sqrt(12.0));
    if (frequency >= lowest && frequency <= highest) modes.frequencies.push_back(frequency);
  }
  return modes;
}

std::vector<float> synthesise(const DustPuff& puff, unsigned variant) {
  std::vector<float> sound(samples(length_of(puff)), 0.0F);
  Noise noise(variant * 1000003U + puff.material * 101U + static_cast<unsigned>(puff.kind) * 11U +
              (puff.broke ? 7U : 0U));
  if (puff.kind == DustPuff::Kind::blast)
    explode(sound, puff, noise);
  else if (puff.kind == DustPuff::Kind::fire)
    crackle(sound, noise);
  else
    hit(sound, puff, noise);
  // Soft where it would clip, and silent at its end.
  const std::size_t fade = samples(0.05);
  for (std::size_t i = 0; i < sound.size(); ++i) {
    const std::size_t left = sound.size() - i;
    sound[i] = std::tanh(sound[i]) * (left < fade ? static_cast<float>(left) / static_cast<float>(fade) : 1.0F);
  }
  return sound;
}

double loudness(const DustPuff& puff) {
  constexpr double loudest = 1e6;  // J
  if (puff.kind == DustPuff::Kind::blast) return 1;
  if (puff.kind == DustPuff::Kind::fire) return 0.05;
  return std::min(1.0, std::pow(energy_of(puff) / loudest, 0.25));
}

}  // namespace topple::viewer
