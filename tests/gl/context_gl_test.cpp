// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/gl/check.h"
#include "lantern/gl/context.h"
#include "lantern/gl/devices.h"

#include "tests/gl/apis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <epoxy/gl.h>

namespace lantern {
namespace {

using ::testing::HasSubstr;

class ContextTest : public ::testing::TestWithParam<gl::Api> {};

TEST_P(ContextTest, HasTheLeastThatShadersNeed) {
  const gl::Context context({.api = GetParam(), .device = {}});
  const gl::Info& info = context.info();
  EXPECT_EQ(info.es, GetParam() == gl::Api::kEs);
  EXPECT_GE(10 * info.major + info.minor, info.es ? 30 : 33);
  EXPECT_NE(info.vendor, "");
  EXPECT_NE(info.renderer, "");
  EXPECT_NE(context.place(), "");
  EXPECT_GE(info.limit(gl::kTextureSize), 2048);  // what ES 3.0 guarantees
  if (!info.es) {
    EXPECT_TRUE(info.has(gl::kFloatTargets));
  }
}
INSTANTIATE_TEST_SUITE_P(Apis, ContextTest, ::testing::Values(gl::Api::kDesktop, gl::Api::kEs));

TEST(Context, GivesWayToOneMadeLaterAndComesBack) {
  const gl::Context outer({.api = gl::Api::kDesktop, .device = {}});
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  {
    const gl::Context inner({.api = gl::Api::kEs, .device = {}});
    EXPECT_FALSE(epoxy_is_desktop_gl());
    EXPECT_FALSE(glIsTexture(texture));
  }
  EXPECT_TRUE(epoxy_is_desktop_gl());
  EXPECT_TRUE(glIsTexture(texture));
  glDeleteTextures(1, &texture);
  EXPECT_NO_THROW(gl::check("testing"));
}

TEST(Context, OnADeviceByItsNumber) {
  gl::require_egl();
  const std::vector<std::string> devices = gl::devices();
  if (!devices.empty()) {
    // Not every device of a machine can be used, but one that is refused says why.
    try {
      const gl::Context context({.api = {}, .device = 0});
      EXPECT_THAT(context.place(), HasSubstr("device 0"));
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), HasSubstr("device 0"));
    }
  }
  for (const int none : {-1, static_cast<int>(devices.size())}) {
    try {
      const gl::Context context({.api = {}, .device = none});
      FAIL() << "there is no device " << none;
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), HasSubstr("no OpenGL device"));
    }
  }
}

TEST(Check, SaysWhatWasTried) {
  const gl::Context context;
  glEnable(GL_TEXTURE_2D + 0x1000);
  try {
    gl::check("trying nonsense");
    FAIL() << "an error was there";
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "OpenGL, trying nonsense: invalid enum");
  }
  EXPECT_NO_THROW(gl::check("nothing more"));
}

}  // namespace
}  // namespace lantern
