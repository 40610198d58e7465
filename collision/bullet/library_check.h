#pragma once

namespace topple::collision {

/// Headers for double precision can be linked with a library in single precision, which then moves nothing. Asks the
/// library itself how large its objects are. Throws std::runtime_error when they are not those of the headers.
void require_double_precision_library();

}  // namespace topple::collision
