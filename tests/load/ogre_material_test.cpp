// SPDX-License-Identifier: MIT
#include "lantern/load/ogre_material.h"

#include "lantern/core/file.h"
#include "lantern/load/ogre_script.h"

#include "tests/load/ogre_files.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>

namespace lantern {
namespace {

using ogre::Materials;
using test::error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

struct Used {
  Material material;
  Scene scene;
  LoadReport report;
};

/// The material `name` of the scripts, the first of which is "0.material".
Used use(const std::vector<std::string>& scripts, const std::string& name = "m",
         const std::map<std::string, std::string>& textures = {}) {
  Used used;
  Materials materials(used.scene, used.report, {});
  for (std::size_t i = 0; i < scripts.size(); ++i) {
    materials.add_script(scripts[i], std::to_string(i) + ".material");
  }
  used.material = used.scene.materials[index(materials.use(name, textures))];
  return used;
}

Used pass(const std::string& lines) {
  return use({"material m\n{\n technique\n {\n pass\n {\n" + lines + "\n}\n}\n}\n"});
}

std::string script_error(const std::string& text, const std::string& name = "m") {
  return error_of([&] { use({text}, name); });
}

TEST(OgreMaterial, ColoursAreLinearNumbers) {
  const Used used =
      pass("diffuse 0.1 0.2 0.3\nspecular 0.4 0.5 0.6 20\nemissive 17 12 4\nambient 9 9 9");
  EXPECT_EQ(used.material.reflectance, Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(used.material.specular, Rgb(0.4f, 0.5f, 0.6f));
  EXPECT_EQ(used.material.shininess, 20.0f);
  EXPECT_EQ(used.material.emission, Rgb(17, 12, 4));
  EXPECT_EQ(used.material.opacity, 1.0f);
  EXPECT_FALSE(used.material.double_sided);
  EXPECT_FALSE(used.material.alpha_cutoff);
  EXPECT_TRUE(used.report.unknown.empty());
  EXPECT_TRUE(used.report.warnings.empty());
  EXPECT_EQ(pass("self_illumination 1 2 3 1").material.emission, Rgb(1, 2, 3));
  EXPECT_EQ(pass("specular 0.4 0.5 0.6 1 30").material.shininess, 30.0f);
}

TEST(OgreMaterial, WhatHasNoDiffuseIsWhiteThatLosesLight) {
  EXPECT_EQ(pass("").material.reflectance, Rgb(0.8f));
  EXPECT_EQ(pass("texture_unit {\n texture a.png\n}").material.reflectance, Rgb(1.0f));
}

TEST(OgreMaterial, VertexColours) {
  const Used used = pass("diffuse vertexcolour");
  EXPECT_TRUE(used.material.vertex_colours);
  EXPECT_EQ(used.material.reflectance, Rgb(1.0f));
  EXPECT_EQ(pass("emissive vertexcolour").report.unknown.at("material: emissive"), 1);
}

TEST(OgreMaterial, CullingAlphaAndBlending) {
  EXPECT_TRUE(pass("cull_hardware none").material.double_sided);
  EXPECT_FALSE(pass("cull_hardware clockwise").material.double_sided);
  EXPECT_EQ(pass("alpha_rejection greater_equal 128").material.alpha_cutoff, 128.0f / 255.0f);
  EXPECT_GT(pass("alpha_rejection greater 128").material.alpha_cutoff, 128.0f / 255.0f);
  EXPECT_FALSE(pass("alpha_rejection always_pass 0").material.alpha_cutoff);
  EXPECT_EQ(pass("alpha_rejection less 3").report.unknown.at("material: alpha_rejection"), 1);
  EXPECT_EQ(pass("diffuse 1 1 1 0.5").material.opacity, 1.0f);
  EXPECT_EQ(pass("diffuse 1 1 1 0.5\nscene_blend alpha_blend").material.opacity, 0.5f);
  EXPECT_FALSE(pass("diffuse 1 1 1 0.5\nscene_blend alpha_blend").material.alpha_cutoff);
  EXPECT_TRUE(pass("scene_blend alpha_blend").material.blend);
  EXPECT_FALSE(pass("alpha_rejection greater 1").material.blend);
  EXPECT_EQ(pass("scene_blend add").report.unknown.at("material: scene_blend"), 1);
}

TEST(OgreMaterial, UnknownIsCountedAndNeverFatal) {
  const Used used = pass(
      "frobnicate 1 2\nfrobnicate\nlighting off\nvertex_program_ref x\n{\na b\n}\n"
      "texture_unit\n{\ncubic_texture a b\nanim_texture a 3 1\nscale 2 2\n}");
  EXPECT_EQ(used.report.unknown, (std::map<std::string, int>{{"material: frobnicate", 2},
                                                             {"material: lighting", 1},
                                                             {"material: vertex_program_ref", 1},
                                                             {"material: cubic_texture", 1},
                                                             {"material: anim_texture", 1},
                                                             {"material: scale", 1}}));
}

TEST(OgreMaterial, OtherBlocksAreSkipped) {
  const Used used =
      use({"import * from \"base.material\"\n"
           "vertex_program v glsl { source a.glsl default_params { x 1 } }\n"
           "fragment_program f glsl\n{\n}\ncompositor c { technique { } }\n"
           "abstract pass p { }\nmaterial m { technique { pass { diffuse 1 0 0 } } }"});
  EXPECT_EQ(used.material.reflectance, Rgb(1, 0, 0));
  EXPECT_TRUE(used.report.warnings.empty());
}

TEST(OgreMaterial, CommentsQuotesAndBracesOnTheLine) {
  const Used used =
      use({"// m is next\nmaterial \"my stone\" { technique { pass { /* no\n diffuse 1 1 1 */ "
           "diffuse 0.1 0.1 0.1 // grey\n} } }"},
          "my stone");
  EXPECT_EQ(used.material.reflectance, Rgb(0.1f));
}

TEST(OgreMaterial, TheFirstPassThatWritesColourCounts) {
  EXPECT_EQ(
      use({"material m { technique { } technique { pass {\n colour_write off\n diffuse 1 0 0\n}\n"
           "pass {\n diffuse 0 1 0\n} pass {\n diffuse 0 0 1\n} } }"})
          .material.reflectance,
      Rgb(0, 1, 0));
}

TEST(OgreMaterial, InheritanceAcrossScripts) {
  const std::string base =
      "material base {\ntechnique {\npass lit {\ndiffuse 0.1 0.2 0.3\nemissive 1 1 1\n}\n}\n}";
  const std::string derived =
      "material m : base {\ntechnique {\npass lit {\ndiffuse 0.5 0.5 0.5\n}\n}\n}";
  // The order of the scripts does not matter.
  for (const auto& scripts : {std::vector{base, derived}, std::vector{derived, base}}) {
    const Used used = use(scripts);
    EXPECT_EQ(used.material.reflectance, Rgb(0.5f));
    EXPECT_EQ(used.material.emission, Rgb(1.0f));
  }
  // Unnamed parts are matched by their place.
  EXPECT_EQ(use({base, "material m : base { technique { pass {\nemissive 2 2 2\n} } }"})
                .material.reflectance,
            Rgb(0.1f, 0.2f, 0.3f));
}

TEST(OgreMaterial, MissingParentIsAWarningAndACycleAnError) {
  const Used used = use({"\nmaterial m : gone { technique { pass {\n diffuse 1 0 0\n} } }"});
  EXPECT_EQ(used.material.reflectance, Rgb(1, 0, 0));
  EXPECT_THAT(used.report.warnings,
              ElementsAre("0.material:2: material 'm' inherits 'gone', which no script defines"));
  EXPECT_EQ(script_error("material m : n { }\nmaterial n : m { }"),
            "0.material:1: material 'm' inherits itself");
  std::string chain;
  for (int i = 0; i < 5000; ++i) {
    chain += "material m" + std::to_string(i) + " : m" + std::to_string(i + 1) + " {}\n";
  }
  EXPECT_THAT(script_error(chain, "m0"), HasSubstr("inherits more than"));
  // Each inherits the next twice: 2^30 paths.
  std::string doubling;
  for (int i = 0; i < 30; ++i) {
    const std::string next = " m" + std::to_string(i + 1);
    doubling += "material m" + std::to_string(i) + " :" + next + next + " {}\n";
  }
  EXPECT_THAT(script_error(doubling + "material m30 {}", "m0"), HasSubstr("inherits more than"));
}

TEST(OgreMaterial, Variables) {
  const std::string base =
      "abstract material base {\nset $colour \"0.1 0.2 0.3\"\nset $picture none.png\ntechnique {\n"
      "pass {\ndiffuse $colour\ntexture_unit {\ntexture $picture\n}\n}\n}\n}\n";
  EXPECT_EQ(use({base + "material m : base { }"}).material.reflectance, Rgb(0.1f, 0.2f, 0.3f));
  const Used derived =
      use({base + "material m : base {\nset $colour \"1 0 0\"\nset $picture a.png\n}"});
  EXPECT_EQ(derived.material.reflectance, Rgb(1, 0, 0));
  EXPECT_THAT(derived.scene.textures.at(0).name, HasSubstr("a.png"));
  const Used unset = pass("texture_unit {\ntexture $nothing\n}");
  EXPECT_THAT(unset.report.warnings, ElementsAre("0.material:8: $nothing is not set"));
}

TEST(OgreMaterial, VariablesDoNotGrowWithoutEnd) {
  std::string script = "set $v0 word\n";
  for (int i = 0; i < 60; ++i) script += fmt::format("set $v{} $v{} $v{}\n", i + 1, i, i);
  EXPECT_THAT(script_error(script + "material m { }"), HasSubstr("longer than 4096 characters"));
}

TEST(OgreMaterial, AbstractPartsAreInherited) {
  const std::string parts =
      "abstract pass red {\n diffuse 1 0 0\n emissive 1 1 1\n}\n"
      "abstract pass loop : loop { }\n";
  const Used used = use({parts + "material m { technique { pass : red {\n emissive 2 2 2\n} } }"});
  EXPECT_EQ(used.material.reflectance, Rgb(1, 0, 0));
  EXPECT_EQ(used.material.emission, Rgb(2.0f));
  EXPECT_THAT(script_error(parts + "material m { technique { pass : loop { } } }"),
              HasSubstr("inherits itself"));
}

TEST(OgreMaterial, TextureAliases) {
  const std::string base =
      "material base { technique { pass { texture_unit {\ntexture_alias skin\ntexture a.png\n} } } "
      "}\n";
  EXPECT_THAT(use({base}, "base").scene.textures.at(0).name, HasSubstr("a.png"));
  EXPECT_THAT(use({base + "material m : base {\nset_texture_alias skin b.png\n}"})
                  .scene.textures.at(0)
                  .name,
              HasSubstr("b.png"));
  EXPECT_THAT(use({base}, "base", {{"skin", "c.png"}}).scene.textures.at(0).name,
              HasSubstr("c.png"));
}

TEST(OgreMaterial, TexturesAreFoundWrappedAndSharedOrACheckerStandsIn) {
  const Used used =
      pass("emissive 1 1 1\ntexture_unit {\ntexture gone.png\ntex_address_mode clamp mirror\n}");
  ASSERT_THAT(used.scene.textures, SizeIs(1));
  EXPECT_EQ(used.scene.textures[0].wrap_u, Wrap::kClamp);
  EXPECT_EQ(used.scene.textures[0].wrap_v, Wrap::kMirror);
  EXPECT_THAT(used.report.warnings, ElementsAre(HasSubstr("gone.png")));
  EXPECT_EQ(used.material.reflectance_texture, TextureId{0});
  EXPECT_EQ(used.material.emission_texture, TextureId{0});

  test::TemporaryFolder folder;
  write_file(folder / "broken.png", "this is no picture");
  write_file(folder / "a.material",
             "material m { technique { pass { texture_unit {\ntexture broken.png\n} } } }");
  Scene scene;
  LoadReport report;
  Materials materials(scene, report, {});
  materials.add_folder(folder.path());
  EXPECT_THAT(error_of([&] { materials.use("m"); }), StartsWith((folder / "broken.png").string()));
}

TEST(OgreMaterial, ScriptsOfAFolderInOrderOfTheirNamesThenOthers) {
  test::TemporaryFolder folder;
  const auto material = [](const std::string& c) {
    return "material m { technique { pass {\ndiffuse " + c + "\n} } }";
  };
  write_file(folder / "b.material", material("0 1 0"));
  write_file(folder / "a.material", material("1 0 0"));
  write_file(folder / "c.txt", material("1 1 1"));
  Scene scene;
  LoadReport report;
  {
    Materials materials(scene, report, {});
    materials.add_folder(folder.path());
    EXPECT_EQ(scene.materials[index(materials.use("m"))].reflectance, Rgb(0, 1, 0));
  }
  Materials materials(scene, report, {});
  materials.add_folder(folder.path());
  materials.add_script(material("0 0 1"), "given.material");
  EXPECT_EQ(scene.materials[index(materials.use("m"))].reflectance, Rgb(0, 0, 1));
  EXPECT_EQ(materials.use("m"), materials.use("m"));
}

TEST(OgreMaterial, MaterialsThatNoScriptDefines) {
  const Used gone = use({}, "gone");
  EXPECT_EQ(gone.material.reflectance, Rgb(0.8f, 0.2f, 0.8f));
  EXPECT_THAT(gone.report.warnings, ElementsAre(HasSubstr("'gone'")));
  for (const char* name : {"BaseWhite", "BaseWhiteNoLighting"}) {
    const Used white = use({}, name);
    EXPECT_EQ(white.material.reflectance, Rgb(0.8f));
    EXPECT_TRUE(white.report.warnings.empty());
  }
  EXPECT_EQ(use({"material BaseWhite { technique { pass {\n diffuse 1 0 0\n} } }"}, "BaseWhite")
                .material.reflectance,
            Rgb(1, 0, 0));
}

TEST(OgreMaterial, ErrorsNameTheLine) {
  EXPECT_EQ(script_error("material m\n{\n technique\n {\n"), "0.material:4: '{' is not closed");
  EXPECT_EQ(script_error("material m { }\n}"), "0.material:2: '}' closes nothing");
  EXPECT_EQ(script_error("\n{ }"), "0.material:2: the block has no name");
  EXPECT_EQ(script_error("material \"m"), "0.material:1: the quotation mark is not closed");
  EXPECT_EQ(script_error("\n/* a\n b"), "0.material:2: the comment is not closed");
  EXPECT_EQ(script_error("material { }"), "0.material:1: the material has no name");
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "a {\n";
  EXPECT_THAT(script_error(deep), HasSubstr("nest deeper than 32"));
  for (const char* bad : {"nan", "inf", "1e999", "abc", "1,0"}) {
    EXPECT_THAT(error_of([&] { pass(std::string("diffuse 0 ") + bad + " 0"); }),
                StartsWith("0.material:7: diffuse: '"))
        << bad;
  }
  EXPECT_THAT(error_of([&] { pass("diffuse 1 1\nemissive x y z\nspecular 1 1 1 2 3 4 5"); }),
              ::testing::AllOf(HasSubstr("diffuse has 2 numbers"),
                               HasSubstr("0.material:8: emissive"), HasSubstr("more")));
}

TEST(OgreMaterial, TruncatedScriptsAreErrorsOrWhole) {
  const std::string text =
      "material m : n\n{\n technique\n {\n  pass\n  {\n   diffuse 1 1 1 /* c */ \"q\"\n  }\n "
      "}\n}\n";
  for (std::size_t size = 16; size < text.size() - 2; ++size) {
    EXPECT_NE(script_error(text.substr(0, size)), "no error") << size;
  }
}

}  // namespace
}  // namespace lantern
