#pragma once
// Texts that come from outside (file names, titles, what a person typed) and go out again: to a terminal, into a file.
#include <string>
#include <string_view>

namespace topple::structure {

/// Where the first byte lies that begins no character of UTF-8 (overlong forms and surrogates are none), else npos.
[[nodiscard]] std::size_t first_not_utf8(std::string_view text);

/// Where the first character lies that steers a terminal or turns the order of a line: C0 and C1 controls but the tab,
/// DEL, line and paragraph separators, marks of direction; else npos. For texts that are UTF-8.
[[nodiscard]] std::size_t first_control(std::string_view text);

/// The text as one line that shows and steers nothing: each byte that is no UTF-8 becomes U+FFFD, each control '?'.
[[nodiscard]] std::string one_line(std::string_view text);

}  // namespace topple::structure
