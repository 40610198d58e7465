// OpenGL's errors are told where they were made.
#include <epoxy/gl.h>

#include <catch2/catch.hpp>
#include <memory>

#include "renderer/gl_errors.h"
#include "renderer/headless_context.h"

using namespace topple::viewer;

TEST_CASE("an error that nobody asked about is not told in another context, and one that is asked about is told once") {
  constexpr GLenum nothing = 0xffff;
  auto first = std::make_unique<HeadlessContext>();
  glEnable(nothing);
  first.reset();
  const HeadlessContext second;
  CHECK_NOTHROW(check_gl_errors());
  glEnable(nothing);
  CHECK_THROWS_WITH(check_gl_errors(), Catch::Matchers::Contains("0x0500"));
  CHECK_NOTHROW(check_gl_errors());
}
