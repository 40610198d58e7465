#pragma once
// Loads of what touches a standing frame, by the key that their owner chose: where each acts, and as which loads on
// members and nodes the frame has it.
#include <map>

#include "standing/frame_response.h"

namespace topple::structure {

class ContactLoads {
 public:
  /// Both must outlive it.
  ContactLoads(const FrameResponse& response, FrameLoads& loads) : response_(response), loads_(loads) {}

  /// A new load, or another one under its key; the place must stand. True when that changes what acts.
  bool set(const ContactLoad& load) {
    all_[load.key] = load;
    return loads_.set_contact(load.key, response_.load_at(load.place, load.force, load.moment));
  }
  bool remove(std::int64_t key) {
    all_.erase(key);
    return loads_.remove_contact(key);
  }
  /// Those on what is about to be gone. One on a panel that also bears on a member that left is placed again when the
  /// panel's bearings change.
  void drop(MemberId gone) {
    drop_if([gone](const ContactPlace& place) { return place.member == gone; });
  }
  void drop(NodeId gone) {
    drop_if([gone](const ContactPlace& place) { return place.node == gone; });
  }
  void drop(PanelId gone) {
    drop_if([gone](const ContactPlace& place) { return place.panel == gone; });
  }
  /// The panel hands on what lies on it another way.
  void update_loads_on(PanelId panel) {
    for (const auto& [key, load] : all_)
      if (load.place.panel == panel) (void)loads_.set_contact(key, response_.load_at(load.place, load.force));
  }

  /// In order of key.
  [[nodiscard]] const std::map<std::int64_t, ContactLoad>& all() const { return all_; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [response, loads, all] = *this;
    archive(all);
  }

 private:
  template <class Test>
  void drop_if(const Test& test) {
    std::erase_if(all_, [&](const auto& one) {
      if (!test(one.second.place)) return false;
      (void)loads_.remove_contact(one.first);
      return true;
    });
  }

  const FrameResponse& response_;
  FrameLoads& loads_;
  std::map<std::int64_t, ContactLoad> all_;
};

}  // namespace topple::structure
