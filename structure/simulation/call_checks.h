#pragma once
// What a host hands to a simulation, checked before anything is done or kept: a call that throws leaves no trace.
// Ids that the building does not have throw std::out_of_range; values that physics has no use for throw InputError.
// Both name the call or tool and the thing.
#include <span>
#include <utility>

#include "topple/structure/building.h"
#include "topple/structure/host_contact.h"
#include "topple/structure/scenario.h"

namespace topple::structure {

/// Throws std::out_of_range: "body_of: there is no member with index 7 (there are 3)".
void require_id(const Building& building, NodeId id, const char* call);
void require_id(const Building& building, MemberId id, const char* call);
void require_id(const Building& building, PanelId id, const char* call);
void require_id(const Building& building, JointId id, const char* call);

void require_tool(const Building& building, const Tool& tool);
void require_capacities(const Building& building, std::span<const std::pair<JointId, JointCapacity>> capacities);
void require_contact(const Building& building, const HostContact& contact);
/// Rules, times and events of a scenario that no file brought, and the building that they are about.
void require_scene(const Building& building, const Scenario& scenario);

}  // namespace topple::structure
