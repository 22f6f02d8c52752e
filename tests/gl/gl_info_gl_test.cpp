// SPDX-License-Identifier: MIT
#include "lantern/gl/context.h"
#include "lantern/pipeline/gl_info.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace lantern {
namespace {

TEST(GlInfo, TellsWhatTheContextTells) {
  const gl::Info info = gl::Context().info();
  const nlohmann::json told = nlohmann::json::parse(describe_gl_as_json());
  EXPECT_EQ(told.at("renderer"), info.renderer);
  EXPECT_EQ(told.at("version"), info.version);
  EXPECT_EQ(told.at("limits").at(gl::kTextureSize), info.limit(gl::kTextureSize));
  EXPECT_EQ(!told.at("features").at(gl::kTimers).is_null(), info.has(gl::kTimers));
  EXPECT_THAT(describe_gl(), testing::HasSubstr(info.renderer));
}

}  // namespace
}  // namespace lantern
