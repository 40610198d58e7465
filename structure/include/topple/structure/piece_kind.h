#pragma once
#include "topple/structure/building.h"

namespace topple::structure {

/// What a chunk of a panel, or a piece of a member that was cut in two, is a piece of.
enum class PieceKind { slab, wall, post, beam, brace };
[[nodiscard]] constexpr PieceKind piece_kind(PanelKind kind) {
  return kind == PanelKind::slab ? PieceKind::slab : PieceKind::wall;
}
[[nodiscard]] constexpr PieceKind piece_kind(MemberKind kind) {
  return kind == MemberKind::post ? PieceKind::post : kind == MemberKind::beam ? PieceKind::beam : PieceKind::brace;
}

}  // namespace topple::structure
