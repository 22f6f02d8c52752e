// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/gl/context.h"
#include "lantern/gl/program.h"

#include "tests/gl/apis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lantern {
namespace {

using ::testing::ElementsAre;
using ::testing::StartsWith;

class ProgramTest : public ::testing::TestWithParam<gl::Api> {
 protected:
  static std::string full_screen() {
    return *gl::ShaderFiles().find("shaders/full_screen.vert.glsl");
  }
  static std::string message_of(const gl::FileTexts& texts) {
    try {
      const gl::Program program(gl::ShaderFiles(texts), "v", "f");
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  }

  gl::Context context_{{.api = GetParam(), .device = {}}};
};
INSTANTIATE_TEST_SUITE_P(Apis, ProgramTest, ::testing::Values(gl::Api::kDesktop, gl::Api::kEs));

TEST_P(ProgramTest, AnErrorShowsTheFileAndLineOfWhatIsIncluded) {
  const std::string main =
      "#include \"shaders/sum.glsl\"\n"
      "layout(location = 0) out vec4 colour;\nvoid main() { colour = vec4(sum(1.0)); }\n";
  const std::string good = "float sum(float a) {\n  return a + a;\n}\n";
  const std::string bad = "float sum(float a) {\n\n  return a + b;\n}\n";
  EXPECT_EQ(message_of({{"v", full_screen()}, {"f", main}, {"shaders/sum.glsl", good}}),
            "no error");
  EXPECT_THAT(message_of({{"v", full_screen()}, {"f", main}, {"shaders/sum.glsl", bad}}),
              StartsWith("shaders/sum.glsl:3"));
  // And behind an include the lines are those of the file itself.
  EXPECT_THAT(
      message_of({{"v", full_screen()}, {"f", main + "\nnonsense;\n"}, {"shaders/sum.glsl", good}}),
      StartsWith("f:5"));
}

TEST_P(ProgramTest, StagesThatDoNotFitAreAnError) {
  EXPECT_THAT(
      message_of({{"v", "out vec2 odd;\nvoid main() { odd = vec2(0); gl_Position = vec4(0); }\n"},
                  {"f",
                   "in vec3 odd;\nlayout(location = 0) out vec4 colour;\n"
                   "void main() { colour = vec4(odd, 1.0); }\n"}}),
      StartsWith("v: does not link with f"));
}

TEST_P(ProgramTest, TakesItsDefinitionsAndUniforms) {
  const gl::ShaderFiles files(gl::FileTexts{
      {"v", full_screen()},
      {"f",
       "uniform int i;\nuniform uint u;\nuniform float x;\nuniform vec2 a;\n"
       "uniform vec3 b;\nuniform vec4 c;\nuniform mat3 m;\nuniform mat4 n;\n"
       "layout(location = 0) out vec4 colour;\n"
       "void main() {\n"
       "  colour = vec4(float(i) + float(u), x + a.y, (m * b).x, (n * c).y) * FACTOR;\n"
       "}\n"}});
  const gl::Program program(files, "v", "f", {{"FACTOR", "2.0"}});
  program.set("i", -3);
  program.set("u", 7u);
  program.set("x", 0.5f);
  program.set("a", Vec2(9.0f, 0.25f));
  program.set("b", Vec3(1.0f, 2.0f, 3.0f));
  program.set("c", Vec4(1.0f, 2.0f, 3.0f, 4.0f));
  Mat3 m(0.0f);
  m[2][0] = 5.0f;  // column 2, row 0
  program.set("m", m);
  Mat4 n(0.0f);
  n[3][1] = 0.5f;
  program.set("n", n);
  gl::Texture colour(gl::Format::kRgba32f, 1, 1);
  const gl::Framebuffer framebuffer({&colour});
  framebuffer.bind();
  gl::draw_full_screen(gl::VertexArray());
  EXPECT_THAT(framebuffer.read<float>(), ElementsAre(8.0f, 1.5f, 30.0f, 4.0f));
}

}  // namespace
}  // namespace lantern
