#pragma once
// What a window and its panels tell each other beside what is drawn.
#include <string>

namespace topple::viewer {

struct WindowState {
  double picture_graphics = 0;   ///< ms that the graphics card took for a picture lately
  double picture_processor = 0;  ///< ms of processor time that the last picture took on the window's thread
  double volume = 0.8;           ///< of the sound, 0 to 1
  bool has_sound = false;        ///< the window found a device
  bool panels_wanted = false;    ///< the keyboard goes to the panels with the next picture
  bool photo = false;            ///< without the panels
  bool help = false;
  bool asks_to_leave = false;  ///< a person is asked whether the program is to end
  bool leaves = false;         ///< and has said so
  bool wants_another = false;  ///< scene, from the start page
  /// Files that pictures are to be written to (outputs.h); empty: none is wanted.
  std::string picture_wanted, sequence_wanted;
};

}  // namespace topple::viewer
