// SPDX-License-Identifier: MIT
// What the same lights cost a frame of 640x480 by Ogre 1.12's additive stencil shadows and by ours:
// processor time of whole processes (Mesa draws on the CPU), frames taken in turns. Needs Debian's
// libogre-1.12-dev, xvfb and xauth, and -DLANTERN_OGRE_BENCH=ON for CMake.
//   xvfb-run -a ogre_bench SCENE|balls [--lights PATHS,...] [--rounds N] [--pictures FOLDER]
#include "lantern/core/error.h"
#include "lantern/gl/context.h"
#include "lantern/image/write.h"
#include "lantern/lights/emitters.h"
#include "lantern/lights/walk.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/camera.h"
#include "lantern/raster/rasteriser.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/embree.h"

#include "bench/contender.h"
#include "bench/ogre_scene.h"
#include "tests/raster/raster_scenes.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <csignal>
#include <epoxy/gl.h>
#include <filesystem>
#include <list>

namespace {

using namespace lantern;

constexpr int kWidth = 640, kHeight = 480;

// Where vertices are lit those of walls must be near to each other: each triangle cut into 12 x 12,
// Ogre's picture of the Cornell box, in floats, is 3.5 % off ours.
constexpr std::uint32_t kWallPieces = 12;

/// What each process makes for itself, and the same in each.
struct Stage : test::RasterStage {
  std::vector<std::size_t> paths;  // of each set of lights
  Camera camera;

  Stage(const std::string& path, std::vector<std::size_t> with_paths)
      : RasterStage(path == "balls" ? test::room_of_balls(16, 16) : load_scene(path).scene),
        paths(std::move(with_paths)),
        camera(choose_camera(scene, world, *tracer, {}, static_cast<float>(kWidth) / kHeight)) {}
};

class OurPainter : public Painter {
 public:
  OurPainter(const std::string& path, const std::vector<std::size_t>& paths, RasterOptions options)
      : stage_(path, paths), rasteriser_(stage_.scene, stage_.world, context_.info(), options) {}

  std::size_t take_lights(std::uint32_t set) override {
    lights_ = stage_.lights(stage_.paths[set]);
    return lights_.size();
  }
  void draw() override {
    rasteriser_.draw_frame(stage_.camera, lights_, {}, 0);
    glFinish();
  }
  Image picture() override {
    const StopFlag never = false;
    return rasteriser_.draw(stage_.camera, lights_, {}, 0, never);
  }

 private:
  Stage stage_;
  gl::Context context_;
  Rasteriser rasteriser_;
  VirtualLights lights_;
};

class OgrePainter : public Painter {
 public:
  OgrePainter(const std::string& path, const std::vector<std::size_t>& paths,
              const OgreOptions& options)
      : stage_(path, paths), ogre_(stage_.scene, stage_.world, stage_.camera, options) {}

  std::size_t take_lights(std::uint32_t set) override {
    const VirtualLights lights = stage_.lights(stage_.paths[set]);
    ogre_.set_lights(lights);
    return lights.size();
  }
  void draw() override { ogre_.draw(); }
  Image picture() override { return ogre_.picture(); }

 private:
  Stage stage_;
  OgreScene ogre_;
};

struct OurWay {
  std::string name;
  RasterOptions options;
};
struct OgreWay {
  std::string name;
  OgreOptions options;
};

std::vector<OurWay> our_ways() {
  RasterOptions size;
  size.width = kWidth;
  size.height = kHeight;
  std::vector<OurWay> ways = {{"stencil", size}, {"interleaved", size}, {"maps", size}};
  ways[1].options.tile = 4;
  ways[1].options.shadows = ShadowMethod::kCheaper;
  ways[1].options.samples_of_lights = 100;  // of a walk through the scene
  ways[2].options.shadows = ShadowMethod::kMaps;
  return ways;
}

std::vector<OgreWay> ogre_ways(float exposure) {
  const OgreOptions by_default{.exposure = exposure, .width = kWidth, .height = kHeight};
  std::vector<OgreWay> ways;
  const auto add = [&](const std::string& name, const std::string& system, bool per_pixel) {
    ways.push_back({"Ogre " + name, by_default});
    OgreOptions& options = ways.back().options;
    options.render_system = system;
    options.per_pixel = per_pixel;
    options.wall_pieces = per_pixel ? 1 : kWallPieces;
    return &options;
  };
  add("GL, vertices lit, walls uncut", "GL", false)->wall_pieces = 1;
  add("GL, vertices lit", "GL", false);
  add("GL, vertices lit, software volumes", "GL", false)->extrude_in_software = true;
  add("GL3Plus, vertices lit", "GL3Plus", false);
  add("GL3Plus, vertices lit, floats", "GL3Plus", false)->floats = true;
  add("GL, pixels lit", "GL", true);
  add("GL3Plus, pixels lit", "GL3Plus", true);
  add("GL3Plus, pixels lit, floats", "GL3Plus", true)->floats = true;
  return ways;
}

/// Of some frames with the same lights.
struct Cost {
  std::vector<double> milliseconds;
  std::uint64_t lights = 0;

  double best() const { return *std::min_element(milliseconds.begin(), milliseconds.end()); }
  double median() const {
    std::vector<double> sorted = milliseconds;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
  }
};

/// Mean of |a - b| over that of b, of what is not above `white`, which 8 bits do not hold.
double mean_difference(const Image& a, const Image& b, float white) {
  double off = 0.0, all = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double of_a = std::min(a.pixels[i][c], white), of_b = std::min(b.pixels[i][c], white);
      off += std::abs(of_a - of_b);
      all += of_b;
    }
  }
  return off / all;
}

/// "Ogre GL, pixels lit" -> "ogre_gl_pixels_lit".
std::string file_name(const std::string& name) {
  std::string file;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      file += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (c == ' ') {
      file += '_';
    }
  }
  return file;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app;
  std::string path, pictures;
  std::vector<std::size_t> paths = {8, 16, 32};
  int rounds = 5;
  float stops = 0.0f;
  app.add_option("scene", path)->required();
  app.add_option("--lights", paths, "Paths of each set of lights")->delimiter(',');
  app.add_option("--rounds", rounds, "Frames of each that are measured");
  app.add_option("--exposure", stops, "Stops, for what 8 bits can hold of Ogre's picture");
  app.add_option("--pictures", pictures, "Folder for the pictures with the last set of lights");
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGPIPE, SIG_IGN);  // a process that ended is an Error

  try {
    std::list<Contender> contenders;
    for (const OurWay& way : our_ways()) {
      contenders.emplace_back(
          way.name, [&] { return std::make_unique<OurPainter>(path, paths, way.options); });
    }
    const std::size_t ours = contenders.size();
    for (const OgreWay& way : ogre_ways(std::exp2(stops))) {
      contenders.emplace_back(
          way.name, [&] { return std::make_unique<OgrePainter>(path, paths, way.options); });
    }

    for (std::uint32_t set = 0; set < paths.size(); ++set) {
      std::vector<Cost> costs(contenders.size());
      for (int round = 0; round < rounds; ++round) {
        auto cost = costs.begin();
        for (Contender& contender : contenders) {
          const Contender::Frame frame = contender.draw(set);
          cost->milliseconds.push_back(1e3 * frame.processor_seconds);
          (cost++)->lights = frame.lights;
        }
      }
      fmt::print("\n{} lights, {} frames              best   median a light", costs[0].lights,
                 rounds);
      for (auto way = contenders.begin();
           way != std::next(contenders.begin(), static_cast<std::ptrdiff_t>(ours)); ++way) {
        fmt::print(" / {}", way->name());
      }
      fmt::print("\n");
      std::size_t i = 0;
      for (const Contender& contender : contenders) {
        const Cost& cost = costs[i++];
        fmt::print("{:40} {:8.1f} {:8.1f} {:6.2f}", contender.name(), cost.best(), cost.median(),
                   cost.best() / static_cast<double>(cost.lights));
        for (std::size_t our = 0; i > ours && our < ours; ++our) {
          fmt::print(" {:8.2f}", cost.best() / costs[our].best());
        }
        fmt::print("\n");
      }
      std::fflush(stdout);
    }

    if (!pictures.empty()) {
      std::filesystem::create_directories(pictures);
      const auto last = static_cast<std::uint32_t>(paths.size() - 1);
      WriteOptions write_with;
      write_with.tone.exposure = stops;
      const Image reference = contenders.front().picture(last);
      for (Contender& contender : contenders) {
        const Image picture = contender.picture(last);
        write_image(std::filesystem::path(pictures) / (file_name(contender.name()) + ".png"),
                    picture, write_with);
        fmt::print("{:40} off {} by {:.1f} %\n", contender.name(), contenders.front().name(),
                   100.0 * mean_difference(picture, reference, std::exp2(-stops)));
      }
    }
  } catch (const Error& error) {
    fmt::print(stderr, "ogre_bench: {}\n", error.what());
    return 1;
  }
}
