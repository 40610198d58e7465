#pragma once
// The state of what moves, as bytes (solver/archive/state_archive.h). A frame that moves is made of what it was made of
// when it began to move, and then takes its state.
#include "standing/motion/moving_component.h"

namespace topple::structure {

template <class Archive>
void StandingMotion::save(Archive& archive) const {
  const auto& [from, settings, masses, model, damping, momentum, substep, moving, to_chunks, past, starts,
               past_changes] = *this;
  archive(masses, damping, substep, to_chunks, past, starts, past_changes, moving.size());
  for (const auto& [component, one] : moving) archive(component, one->beginning, *one);
}

template <class Archive>
void StandingMotion::load(Archive& archive) {
  forget_all();
  std::size_t count = 0;
  archive(masses_, damping_, substep_, to_chunks_, past_, starts_, past_changes_, count);
  for (std::size_t i = 0; i < count; ++i) {
    int component = 0;
    auto made = std::make_unique<Moving>();
    archive(component, made->beginning);
    make_frame(component, *made);
    archive(*made);
    from_.statics.follow(component, made->frame.get());
    moving_.emplace(component, std::move(made));
  }
}

}  // namespace topple::structure
