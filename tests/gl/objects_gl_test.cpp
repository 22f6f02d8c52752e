// SPDX-License-Identifier: MIT
// What is written to GL's objects is what comes back, and what is drawn lands where it should.
#include "lantern/core/error.h"
#include "lantern/core/hash.h"
#include "lantern/gl/check.h"
#include "lantern/gl/context.h"
#include "lantern/gl/objects.h"
#include "lantern/gl/program.h"
#include "lantern/gl/timer.h"

#include "tests/gl/apis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <numeric>

namespace lantern {
namespace {

using gl::Format;
using ::testing::Each;
using ::testing::HasSubstr;

constexpr int kWidth = 13, kHeight = 7;  // nothing that any alignment would suit

class ObjectsTest : public ::testing::TestWithParam<gl::Api> {
 protected:
  gl::Context context_{{.api = GetParam(), .device = {}}};
};
INSTANTIATE_TEST_SUITE_P(Apis, ObjectsTest, ::testing::Values(gl::Api::kDesktop, gl::Api::kEs));

template <typename T>
std::vector<T> noise(int channels) {
  std::vector<T> values(static_cast<std::size_t>(channels) * kWidth * kHeight);
  for (std::size_t i = 0; i < values.size(); ++i) {
    // Floats beyond half's range and resolution; integers of all bits.
    if constexpr (std::is_floating_point_v<T>) {
      values[i] = (to_unit_float(hash(i)) - 0.5f) * 1e6f;
    } else {
      values[i] = static_cast<T>(hash(i));
    }
  }
  return values;
}

template <typename T>
void expect_same_back(Format format, int channels) {
  const std::vector<T> values = noise<T>(channels);
  gl::Texture texture(format, kWidth, kHeight);
  texture.write<T>(values);
  const gl::Framebuffer framebuffer({&texture});
  EXPECT_EQ(framebuffer.read<T>(), values);
}

TEST_P(ObjectsTest, TexelsComeBackAsTheyWere) {
  expect_same_back<std::uint8_t>(Format::kRgba8, 4);
  expect_same_back<std::uint32_t>(Format::kRgba32ui, 4);
  expect_same_back<float>(Format::kRgba32f, 4);
  // ES promises no way to read the next two by themselves; what draws them reads them in a shader.
  if (GetParam() == gl::Api::kDesktop) {
    expect_same_back<std::uint32_t>(Format::kR32ui, 1);
    expect_same_back<float>(Format::kR32f, 1);
  }
}

TEST_P(ObjectsTest, APartOfATextureIsWrittenAlone) {
  gl::Texture texture(Format::kRgba32f, 4, 3);
  texture.write<float>(std::vector<float>(48, 1.0f));
  texture.write<float>({1, 2, 2, 1}, std::vector<float>(8, 5.0f));
  const std::vector<float> back = gl::Framebuffer({&texture}).read<float>();
  for (std::size_t i = 0; i < back.size(); ++i) {
    const std::size_t x = i / 4 % 4, y = i / 16;
    EXPECT_EQ(back[i], y == 2 && (x == 1 || x == 2) ? 5.0f : 1.0f) << x << ' ' << y;
  }
}

TEST_P(ObjectsTest, AMipmapsLastLevelIsTheMean) {
  if (!context_.info().has(gl::kFloatFiltering)) GTEST_SKIP() << "no filtering of floats";
  gl::Texture texture(Format::kRgba32f, 8, 8, {.linear = true, .mipmaps = true});
  std::vector<float> values(256);
  std::iota(values.begin(), values.end(), 0.0f);
  texture.write<float>(values);
  texture.make_mipmaps();
  ASSERT_EQ(texture.levels(), 4);
  gl::Texture seen(Format::kRgba32f, 1, 1);
  const gl::Framebuffer framebuffer({&seen});
  framebuffer.bind();
  const gl::ShaderFiles files(
      gl::FileTexts{{"v", *gl::ShaderFiles().find("shaders/full_screen.vert.glsl")},
                    {"f",
                     "uniform sampler2D values;\nlayout(location = 0) out vec4 mean;\n"
                     "void main() { mean = texelFetch(values, ivec2(0), 3); }\n"}});
  const gl::Program program(files, "v", "f");
  program.set("values", 0, texture);
  gl::draw_full_screen(gl::VertexArray());
  const std::vector<float> mean = framebuffer.read<float>();
  // Whole numbers below 2^8 and their quarters: exact in floats.
  for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(mean[c], 126.0f + static_cast<float>(c));
}

TEST_P(ObjectsTest, TriangleCoversItsPixelsAndTheNearerOneWins) {
  const gl::ShaderFiles files(gl::FileTexts{
      {"v",
       "layout(location = 0) in vec3 position;\nlayout(location = 1) in uint id;\n"
       "flat out uint face;\nvoid main() { face = id; gl_Position = vec4(position, 1.0); }\n"},
      {"f",
       "flat in uint face;\nlayout(location = 0) out uvec4 colour;\n"
       "void main() { colour = uvec4(face); }\n"}});
  const gl::Program program(files, "v", "f");
  // A far square of two triangles, then nearer than it the lower left half; drawn in this order and
  // in the other one.
  const std::array<Vec3, 9> positions = {
      Vec3(-1, -1, 0.5f),  Vec3(1, -1, 0.5f),  Vec3(1, 1, 0.5f),
      Vec3(-1, -1, 0.5f),  Vec3(1, 1, 0.5f),   Vec3(-1, 1, 0.5f),
      Vec3(-1, -1, -0.5f), Vec3(1, -1, -0.5f), Vec3(-1, 1, -0.5f)};
  const std::array<std::uint32_t, 9> ids = {1, 1, 1, 1, 1, 1, 2, 2, 2};
  const gl::Buffer position_buffer{std::span<const Vec3>(positions)};
  const gl::Buffer id_buffer{std::span<const std::uint32_t>(ids)};
  const gl::VertexArray vertices(
      {{.location = 0, .buffer = &position_buffer, .channels = 3, .integer = false},
       {.location = 1, .buffer = &id_buffer, .channels = 1, .integer = true}});
  constexpr int kSize = 16;
  gl::Texture colour(Format::kRgba32ui, kSize, kSize);
  gl::Texture depth(Format::kDepth32f, kSize, kSize);
  const gl::Framebuffer framebuffer({&colour}, &depth);
  for (const bool far_first : {true, false}) {
    framebuffer.bind();
    const std::array<GLuint, 4> nothing = {0, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, nothing.data());
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    program.use();
    vertices.bind();
    if (far_first) {
      glDrawArrays(GL_TRIANGLES, 0, 9);
    } else {
      glDrawArrays(GL_TRIANGLES, 6, 3);
      glDrawArrays(GL_TRIANGLES, 0, 6);
    }
    glDisable(GL_DEPTH_TEST);
    gl::check("drawing");
    const std::vector<std::uint32_t> seen = framebuffer.read<std::uint32_t>();
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        if (x + y == kSize - 1) continue;  // on the edge either is right
        EXPECT_EQ(seen[static_cast<std::size_t>(4 * (y * kSize + x))], x + y < kSize ? 2u : 1u);
      }
    }
  }
}

TEST_P(ObjectsTest, FloatsAddUpByBlending) {
  if (!context_.info().has(gl::kFloatBlending)) GTEST_SKIP() << "no blending of floats";
  gl::Texture sum(Format::kRgba32f, kWidth, kHeight);
  sum.write<float>(std::vector<float>(4 * kWidth * kHeight, 0.0f));
  const gl::Framebuffer framebuffer({&sum});
  const gl::ShaderFiles files(
      gl::FileTexts{{"v", *gl::ShaderFiles().find("shaders/full_screen.vert.glsl")},
                    {"f",
                     "uniform vec4 share;\nlayout(location = 0) out vec4 colour;\n"
                     "void main() { colour = share; }\n"}});
  const gl::Program program(files, "v", "f");
  const gl::VertexArray nothing;
  framebuffer.bind();
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  for (int i = 1; i <= 300; ++i) {
    program.set("share", Vec4(static_cast<float>(i), 1.0f, 0.5f, 0.0f));
    gl::draw_full_screen(nothing);
  }
  glDisable(GL_BLEND);
  const std::vector<float> back = framebuffer.read<float>();
  for (std::size_t i = 0; i < back.size(); i += 4) {
    EXPECT_EQ(back[i], 45150.0f);  // more than half float holds exactly, and sums of its steps
    EXPECT_EQ(back[i + 1], 300.0f);
    EXPECT_EQ(back[i + 2], 150.0f);
  }
}

TEST_P(ObjectsTest, TooLargeATextureIsAnError) {
  const int size = context_.info().limit(gl::kTextureSize) + 1;
  try {
    const gl::Texture texture(Format::kRgba8, 1, size);
    FAIL() << "of " << size << " rows";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr(std::to_string(size)));
  }
}

TEST_P(ObjectsTest, TimersTellHowLongAClearTakes) {
  gl::Texture colour(Format::kRgba32f, 1024, 1024);
  const gl::Framebuffer framebuffer({&colour});
  gl::Timer timer;
  timer.begin();
  framebuffer.bind();
  glClear(GL_COLOR_BUFFER_BIT);
  timer.end();
  const std::optional<double> seconds = timer.seconds();
  if (!context_.info().has(gl::kTimers)) {
    EXPECT_FALSE(seconds);
  } else if (seconds) {
    constexpr double kHour = 3600.0;  // a counter of the wrong unit or width would exceed it
    EXPECT_GT(*seconds, 0.0);
    EXPECT_LT(*seconds, kHour);
  }
}

}  // namespace
}  // namespace lantern
