// What a broken panel is, as bytes and back.
#include "panel_impl.h"
#include "state_archive.h"

namespace topple::fracture {

void BreakablePanel::save_state(std::ostream& to) const { StateWriter{to}(*impl_); }

void BreakablePanel::load_state(std::istream& from) { StateReader{from}(*impl_); }

}  // namespace topple::fracture
