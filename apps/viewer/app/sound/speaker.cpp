#include "app/sound/speaker.h"

#include <AL/al.h>
#include <AL/alc.h>
#include <AL/alext.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <tuple>

#include "app/sound/synthesis.h"
#include "topple/structure/formats/output_files.h"

namespace topple::viewer {
namespace {

constexpr int voices = 48;
/// Of one call: the loudest. More at once are a roar of which none is heard alone.
constexpr std::size_t most_at_once = 10;
/// A longer step between two calls is a jump, s of the run.
constexpr double jump = 0.5;
constexpr unsigned variants = 3;
/// Of all together: many sounds add up.
constexpr double mix = 0.9;

/// What sounds alike has one buffer: kind, material, broke, class of mass, variant.
using Key = std::tuple<int, int, bool, int, unsigned>;

/// While it lives, nothing reaches standard error: ALSA's library tells of every device that it does not find, and a
/// machine without any is no fault.
class Hush {
 public:
  Hush() : kept_(dup(STDERR_FILENO)) {
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    dup2(nowhere, STDERR_FILENO);
    close(nowhere);
  }
  ~Hush() {
    if (kept_ < 0) return;
    dup2(kept_, STDERR_FILENO);
    close(kept_);
  }
  Hush(const Hush&) = delete;
  Hush& operator=(const Hush&) = delete;

 private:
  int kept_;
};

struct Waiting {
  double at = 0;  ///< s of the run, when it is heard
  DustPuff puff;
  double gain = 0;
};

}  // namespace

struct Speaker::State {
  ALCdevice* device = nullptr;
  ALCcontext* context = nullptr;
  LPALCRENDERSAMPLESSOFT render = nullptr;
  std::array<ALuint, voices> sources{};
  std::map<Key, ALuint> buffers;
  std::deque<Waiting> waiting;
  double time = -1e9;
  double volume = 1;
  bool wide = false;  ///< sources may have a size

  ~State() {
    if (context != nullptr) {
      alcMakeContextCurrent(context);
      alDeleteSources(voices, sources.data());
      for (const auto& [key, buffer] : buffers) alDeleteBuffers(1, &buffer);
      alcMakeContextCurrent(nullptr);
      alcDestroyContext(context);
    }
    if (device != nullptr) alcCloseDevice(device);
  }
  [[nodiscard]] bool begin(const ALCint* attributes) {
    context = device == nullptr ? nullptr : alcCreateContext(device, attributes);
    if (context == nullptr || alcMakeContextCurrent(context) == ALC_FALSE) return false;
    alGenSources(voices, sources.data());
    wide = alIsExtensionPresent("AL_EXT_SOURCE_RADIUS") == AL_TRUE;
    alDistanceModel(AL_INVERSE_DISTANCE_CLAMPED);
    for (const ALuint source : sources) {
      alSourcef(source, AL_REFERENCE_DISTANCE, static_cast<float>(reference_distance));
      alSourcef(source, AL_ROLLOFF_FACTOR, 1);
    }
    return alGetError() == AL_NO_ERROR;
  }
  ALuint buffer_for(const DustPuff& puff);
  void listen(const Camera& camera);
  void gather(const Snapshot& moment, const Camera& camera);
  void play(const Waiting& one, double pace);
};

ALuint Speaker::State::buffer_for(const DustPuff& puff) {
  const int mass_class = static_cast<int>(std::lround(2 * std::log10(std::max(puff.mass, 0.1F))));
  const auto variant = static_cast<unsigned>(puff.number) % variants;
  const Key key{static_cast<int>(puff.kind), puff.material, puff.broke, mass_class, variant};
  const auto [found, is_new] = buffers.try_emplace(key, 0);
  if (!is_new) return found->second;
  DustPuff typical = puff;
  typical.mass = static_cast<float>(std::pow(10.0, mass_class / 2.0));
  std::vector<ALshort> samples;
  for (const float x : synthesise(typical, variant)) samples.push_back(static_cast<ALshort>(std::lround(32767 * x)));
  alGenBuffers(1, &found->second);
  alBufferData(found->second, AL_FORMAT_MONO16, samples.data(), static_cast<ALsizei>(samples.size() * sizeof(ALshort)),
               sample_rate);
  return found->second;
}

void Speaker::State::listen(const Camera& camera) {
  const glm::vec3 ahead(camera.forward());
  const std::array<float, 6> turn{ahead.x, ahead.y, ahead.z, 0, 0, 1};
  alListener3f(AL_POSITION, static_cast<float>(camera.eye.x), static_cast<float>(camera.eye.y),
               static_cast<float>(camera.eye.z));
  alListenerfv(AL_ORIENTATION, turn.data());
  alListenerf(AL_GAIN, static_cast<float>(mix * volume));
}

void Speaker::State::gather(const Snapshot& moment, const Camera& camera) {
  if (!moment.dust) return;
  std::vector<Waiting> heard;
  for (const DustPuff& puff : *moment.dust) {
    if (puff.time <= time || puff.time > moment.time + 1e-9) continue;
    const glm::dvec3 at(puff.position.x(), puff.position.y(), puff.position.z());
    const double distance = glm::length(at - camera.eye);
    heard.push_back({puff.time + distance / speed_of_sound, puff, loudness(puff)});
  }
  const std::size_t kept = std::min(heard.size(), most_at_once);
  std::partial_sort(heard.begin(), heard.begin() + static_cast<std::ptrdiff_t>(kept), heard.end(),
                    [](const Waiting& a, const Waiting& b) { return a.gain > b.gain; });
  waiting.insert(waiting.end(), heard.begin(), heard.begin() + static_cast<std::ptrdiff_t>(kept));
}

void Speaker::State::play(const Waiting& one, double pace) {
  // A voice that is free, else the one that has played longest of what is quieter.
  ALuint chosen = 0;
  float quietest = static_cast<float>(one.gain);
  for (const ALuint source : sources) {
    ALint state = 0;
    alGetSourcei(source, AL_SOURCE_STATE, &state);
    if (state != AL_PLAYING && state != AL_PAUSED) {
      chosen = source;
      break;
    }
    float gain = 0;
    alGetSourcef(source, AL_GAIN, &gain);
    if (gain < quietest) quietest = gain, chosen = source;
  }
  if (chosen == 0) return;
  alSourceStop(chosen);
  alSourcei(chosen, AL_BUFFER, static_cast<ALint>(buffer_for(one.puff)));
  alSource3f(chosen, AL_POSITION, static_cast<float>(one.puff.position.x()), static_cast<float>(one.puff.position.y()),
             static_cast<float>(one.puff.position.z()));
  // What is near and wide is heard on both sides.
  if (wide) alSourcef(chosen, AL_SOURCE_RADIUS, std::max(4.0F, 4 * one.puff.size));
  alSourcef(chosen, AL_GAIN, static_cast<float>(one.gain));
  alSourcef(chosen, AL_PITCH, static_cast<float>(std::clamp(pace, 0.25, 1.0)));
  alSourcePlay(chosen);
}

Speaker::Speaker(std::unique_ptr<State> state) : state_(std::move(state)) {}
Speaker::~Speaker() = default;

std::unique_ptr<Speaker> Speaker::open() {
  auto state = std::make_unique<State>();
  {
    const Hush hush;
    state->device = alcOpenDevice(nullptr);
  }
  if (!state->begin(nullptr)) return nullptr;
  return std::unique_ptr<Speaker>(new Speaker(std::move(state)));
}

std::unique_ptr<Speaker> Speaker::into_memory() {
  auto state = std::make_unique<State>();
  const auto open_loopback =
      reinterpret_cast<LPALCLOOPBACKOPENDEVICESOFT>(alcGetProcAddress(nullptr, "alcLoopbackOpenDeviceSOFT"));
  state->render = reinterpret_cast<LPALCRENDERSAMPLESSOFT>(alcGetProcAddress(nullptr, "alcRenderSamplesSOFT"));
  if (open_loopback != nullptr && state->render != nullptr) state->device = open_loopback(nullptr);
  const std::array<ALCint, 9> stereo{ALC_FORMAT_CHANNELS_SOFT,
                                     ALC_STEREO_SOFT,
                                     ALC_FORMAT_TYPE_SOFT,
                                     ALC_FLOAT_SOFT,
                                     ALC_FREQUENCY,
                                     sample_rate,
                                     ALC_HRTF_SOFT,
                                     ALC_FALSE,
                                     0};
  if (!state->begin(stereo.data())) throw std::runtime_error("no sound can be made: OpenAL has no loopback device");
  return std::unique_ptr<Speaker>(new Speaker(std::move(state)));
}

void Speaker::hear(const Snapshot& moment, const Camera& camera, double pace) {
  State& s = *state_;
  alcMakeContextCurrent(s.context);
  s.listen(camera);
  if (moment.time < s.time || moment.time > s.time + jump)
    s.waiting.clear();
  else
    s.gather(moment, camera);
  s.time = moment.time;
  for (auto one = s.waiting.begin(); one != s.waiting.end();) {
    if (one->at > moment.time) {
      ++one;
      continue;
    }
    s.play(*one, pace);
    one = s.waiting.erase(one);
  }
}

void Speaker::set_volume(double volume) { state_->volume = std::clamp(volume, 0.0, 1.0); }

std::vector<float> Speaker::render(int count) {
  std::vector<float> samples(2 * static_cast<std::size_t>(std::max(count, 0)), 0.0F);
  if (state_->render == nullptr) throw std::logic_error("render() is for a speaker into memory");
  state_->render(state_->device, samples.data(), count);
  for (float& x : samples) x = std::clamp(x, -1.0F, 1.0F);
  return samples;
}

int Speaker::playing() const {
  alcMakeContextCurrent(state_->context);
  return static_cast<int>(std::count_if(state_->sources.begin(), state_->sources.end(), [](ALuint source) {
    ALint state = 0;
    alGetSourcei(source, AL_SOURCE_STATE, &state);
    return state == AL_PLAYING;
  }));
}

void write_wav(const std::string& file, const std::vector<float>& samples) {
  constexpr std::uint32_t channels = 2, bytes = 2;
  std::string text;
  const auto put = [&](std::uint32_t number, int size) {
    for (int i = 0; i < size; ++i) text += static_cast<char>((number >> (8 * i)) & 255U);
  };
  const auto data = static_cast<std::uint32_t>(samples.size() * bytes);
  text += "RIFF", put(36 + data, 4), text += "WAVEfmt ";
  put(16, 4), put(1, 2), put(channels, 2), put(sample_rate, 4);
  put(sample_rate * channels * bytes, 4), put(channels * bytes, 2), put(8 * bytes, 2);
  text += "data", put(data, 4);
  for (const float x : samples) put(static_cast<std::uint32_t>(std::lround(32767 * std::clamp(x, -1.0F, 1.0F))), 2);
  structure::write_file(file, text);
}

}  // namespace topple::viewer
