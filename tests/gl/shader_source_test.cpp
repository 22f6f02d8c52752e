// SPDX-License-Identifier: MIT
// Shaders out of several files, without GL.
#include "lantern/gl/shader_source.h"

#include "lantern/core/file.h"

#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace lantern {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

std::string message_of(const gl::ShaderFiles& files, const std::string& name) {
  try {
    gl::compose(files, name, "");
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

TEST(ShaderSource, KnowsWhereItsLinesComeFrom) {
  const gl::ShaderFiles files(gl::FileTexts{
      {"shaders/a", "a1\n#include \"shaders/b\"\na3\n  #  include \"shaders/c\" // again\na5"},
      {"shaders/b", "#pragma once\nb2\n#include \"shaders/c\"\nb4\n"},
      {"shaders/c", "c1\n#include \"shaders/a\"\n"}});
  const gl::ShaderSource source = gl::compose(files, "shaders/a", "#version\n");
  EXPECT_THAT(source.files, ElementsAre("shaders/a", "shaders/b", "shaders/c"));
  EXPECT_EQ(source.text, "#version\na1\nb2\nc1\nb4\na3\na5\n");
  std::vector<std::string> origins;
  for (const auto& [file, line] : source.origins) {
    origins.push_back("abc"[file] + std::to_string(line));
  }
  EXPECT_THAT(origins, ElementsAre("a0", "a1", "b2", "c1", "b4", "a3", "a5"));
}

TEST(ShaderSource, SaysWhereAnIncludeIsWrong) {
  const gl::ShaderFiles files(gl::FileTexts{{"a", "one\n#include \"b\"\n"},
                                            {"b", "\n\n#include \"none\"\n"},
                                            {"bare", "#include none\n"}});
  EXPECT_EQ(message_of(files, "a"), "b:3: there is no 'none'");
  EXPECT_EQ(message_of(files, "bare"), "bare:1: #include takes a name in quotes");
  EXPECT_EQ(message_of(files, "c"), "c: there is no such shader");
}

TEST(CompileError, LeadsBackToTheFile) {
  const gl::ShaderSource source{
      .text = "p\na\nb\n", .files = {"a", "b"}, .origins = {{0, 0}, {0, 1}, {1, 20}}};
  const auto what = [&](const char* log) { return std::string(compile_error(source, log).what()); };
  EXPECT_EQ(what("0:2(3): warning: odd\n0:3(3): error: `x' undeclared\n0:2(1): error: more\n"),
            "b:20:3: `x' undeclared");
  EXPECT_EQ(what("0(3) : error C1503: undefined variable \"x\"\n"),
            "b:20: C1503: undefined variable \"x\"");
  EXPECT_EQ(what("ERROR: 0:2: 'x' : undeclared identifier\n"), "a:1: 'x' : undeclared identifier");
  EXPECT_EQ(what("something else\nentirely\n"), "a: something else entirely");
  EXPECT_EQ(what("0:9(3): error: behind the end\n"), "a: 0:9(3): error: behind the end");
}

TEST(ShaderFiles, AllThatLieThereAreEmbedded) {
  gl::FileTexts expected;
  const fs::path root(LANTERN_SOURCE_DIR);
  for (const auto& entry : fs::directory_iterator(root / "shaders")) {
    expected.emplace(fs::relative(entry.path(), root).string(), read_text(entry.path()));
  }
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(gl::embedded_files(), expected);
}

TEST(ShaderFiles, AFolderTakesTheirPlace) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "shaders");
  write_file(folder / "shaders/a", std::string_view("first"));
  ::setenv("LANTERN_SHADERS", folder.path().c_str(), 1);
  const gl::ShaderFiles files;
  ::unsetenv("LANTERN_SHADERS");
  EXPECT_EQ(files.find("shaders/a"), "first");
  write_file(folder / "shaders/a", std::string_view("second"));
  EXPECT_EQ(files.find("shaders/a"), "second");
  EXPECT_FALSE(files.find("shaders/full_screen.vert.glsl"));
  EXPECT_TRUE(gl::ShaderFiles().find("shaders/full_screen.vert.glsl"));
}

}  // namespace
}  // namespace lantern
