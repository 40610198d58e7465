#pragma once
// Decimal text of a double, as short as reads back to the same bits, and of the shortest ones the nearest (Giulietti,
// "The Schubfach way to render doubles", 2021). Results are millions of numbers: this takes about half as long as
// std::to_chars.

namespace topple::structure {

/// No text is longer than so many characters.
inline constexpr int longest_number = 24;
inline constexpr int number_room = 48;

/// Writes a finite number above zero and returns the end of the text. Needs `number_room` characters to write on,
/// whatever the length of the text.
char* write_shortest(double number, char* to);

}  // namespace topple::structure
