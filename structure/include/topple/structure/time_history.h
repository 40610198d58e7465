#pragma once
// A time history from numbers that a host holds already.
#include <map>
#include <string>
#include <vector>

#include "topple/structure/motion.h"

namespace topple::structure {

/// Columns by name, as a CSV file has them (read_time_history): `time` in s, `ax`, `ay`, `az` here in m/s2, or load
/// cases of the model (factors). Throws InputError for a column that is none of these, and for columns of unequal
/// length, numbers that are not finite, times that do not ascend from 0 or later, fewer than two of them.
[[nodiscard]] TimeHistory make_time_history(const std::map<std::string, std::vector<double>>& columns,
                                            const Building& building);

}  // namespace topple::structure
