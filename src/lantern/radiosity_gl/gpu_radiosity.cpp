// SPDX-License-Identifier: MIT
#include "lantern/radiosity_gl/gpu_radiosity.h"

#include "lantern/core/error.h"
#include "lantern/core/hash.h"
#include "lantern/gl/check.h"
#include "lantern/gl/info.h"
#include "lantern/radiosity/element_points.h"
#include "lantern/radiosity/hemicube.h"
#include "lantern/radiosity_gl/item_buffer.h"
#include "lantern/radiosity_gl/occluder_textures.h"
#include "lantern/radiosity_gl/reduction.h"
#include "lantern/radiosity_gl/texels.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lantern {
namespace {

double sum_of(const glm::dvec3& v) { return v.r + v.g + v.b; }

HemicubePose pose_at(const Vec3& origin, const Vec3& normal, float angle) {
  const Frame frame(normal);
  const Vec3 tangent = std::cos(angle) * frame.tangent + std::sin(angle) * frame.bitangent;
  return {origin, glm::transpose(Mat3(tangent, glm::cross(normal, tangent), normal))};
}

gl::Framebuffer cleared(const gl::Texture& texture) {
  gl::Framebuffer framebuffer({&texture});
  framebuffer.bind();
  glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  return framebuffer;
}

}  // namespace

/// Texel i is the element element_of_texel()[i].
class GpuRadiosity::Work {
 public:
  Work(const World& world, const Tracer& tracer, const Patches& patches,
       std::span<const glm::dvec3> external, const GpuRadiosityOptions& options);

  bool shoot();
  std::vector<glm::dvec3> irradiance() const;
  glm::dvec3 ambient() const;

  std::size_t shots_ = 0;
  double unshot_share_ = 1.0;
  GpuFluxBalance balance_;

 private:
  using Values = std::vector<Vec4>;
  gl::Texture make_points(const World& world, const Tracer& tracer);
  gl::Texture make_normals() const;
  gl::Texture make_corners() const;
  std::uint32_t element(std::size_t texel) const { return tree_.element_of_texel()[texel]; }
  std::size_t size() const { return tree_.element_of_texel().size(); }
  const glm::dvec3& reflectance(std::size_t texel) const {
    return patches_.reflectance[patches_.patch[element(texel)]];
  }
  double area(std::size_t texel) const { return patches_.exposed_area(element(texel)); }

  void take_stock();
  bool begin_round();
  void end_round();
  void shoot_from(const Cluster& cluster, std::uint32_t shot);
  std::size_t viewpoint(const Cluster& cluster) const;
  Values received_values() const;

  const Patches& patches_;
  GpuRadiosityOptions options_;
  float scale_;
  double scene_radius_;
  ShooterTree tree_;
  TexelGrid grid_;
  gl::ShaderFiles files_;
  std::vector<Vec3> views_;  // ElementPoints of each texel
  gl::Texture points_, normals_, corners_, unshot_texture_, gathered_, received_, tally_;
  gl::Framebuffer gathered_target_, received_target_, tally_target_;
  ItemBuffer items_;
  OccluderTextures occluders_;
  gl::Program gather_, receive_, count_lost_;
  Reduction arrived_;
  gl::VertexArray no_attributes_;

  // Radiosity in W/m² over exposed areas, and irradiance: in double precision, at the ends of
  // rounds.
  std::vector<glm::dvec3> unshot_, irradiance_;
  std::vector<Cluster> round_;
  std::size_t next_in_round_ = 0;
  std::uint32_t next_of_cluster_ = 0;
};

GpuRadiosity::Work::Work(const World& world, const Tracer& tracer, const Patches& patches,
                         std::span<const glm::dvec3> external, const GpuRadiosityOptions& options)
    : patches_(patches),
      options_(options),
      scale_(world.coordinate_scale()),
      scene_radius_(static_cast<double>(world.bounds.radius())),
      tree_(patches),
      grid_(patches.elements()),
      points_(make_points(world, tracer)),
      normals_(make_normals()),
      corners_(make_corners()),
      unshot_texture_(gl::Format::kRgba32f, grid_.width, grid_.height),
      gathered_(gl::Format::kRgba32f, grid_.width, grid_.height),
      received_(gl::Format::kRgba32f, grid_.width, grid_.height),
      tally_(gl::Format::kRgba32f, 1, 1),
      gathered_target_({&gathered_}),
      received_target_(cleared(received_)),
      tally_target_(cleared(tally_)),
      items_(world, patches.lit.back, options.hemicube, files_),
      occluders_(world, patches.mesh),
      gather_(files_, "shaders/full_screen.vert.glsl", "shaders/gather.frag.glsl"),
      receive_(files_, "shaders/full_screen.vert.glsl", "shaders/receive.frag.glsl"),
      count_lost_(files_, "shaders/full_screen.vert.glsl", "shaders/receive.frag.glsl",
                  {{"TALLY", "1"}}),
      arrived_(grid_.width, grid_.height, &normals_, files_),
      unshot_(size()),
      irradiance_(size()) {
  assert(external.size() == patches.elements());
  for (std::size_t i = 0; i < size(); ++i) {
    irradiance_[i] = external[element(i)];
    unshot_[i] = patches.emission[element(i)] + reflectance(i) * irradiance_[i];
    balance_.emitted += area(i) * (patches.emission[element(i)] + irradiance_[i]);
  }
  take_stock();
}

gl::Texture GpuRadiosity::Work::make_points(const World& world, const Tracer& tracer) {
  const ElementPoints points(world, tracer, patches_);
  constexpr std::size_t kLayers = ElementPoints::kPoints;
  Values values(kLayers * grid_.texels(), Vec4(0.0f));
  views_.resize(kLayers * size());
  for (std::size_t i = 0; i < size(); ++i) {
    for (std::size_t k = 0; k < kLayers; ++k) {
      views_[i * kLayers + k] = points.at(element(i), k);
      values[k * grid_.texels() + i] = Vec4(points.at(element(i), k), 0.0f);
    }
  }
  return make_texture(grid_, values, kLayers);
}

gl::Texture GpuRadiosity::Work::make_normals() const {
  Values values(grid_.texels(), Vec4(0.0f));
  for (std::size_t i = 0; i < size(); ++i) {
    values[i] = Vec4(Vec3(patches_.element_normal(element(i))), static_cast<float>(area(i)));
  }
  return make_texture(grid_, values);
}

gl::Texture GpuRadiosity::Work::make_corners() const {
  constexpr int kCorners = 3;
  Values values(kCorners * grid_.texels(), Vec4(0.0f));
  for (std::size_t i = 0; i < size(); ++i) {
    for (int k = 0; k < kCorners; ++k) {
      const bool front = patches_.is_front(element(i));
      const Vec3 corner(patches_.mesh.corner(patches_.patch[element(i)], front ? k : 2 - k));
      values[static_cast<std::size_t>(k) * grid_.texels() + i] = Vec4(corner, 0.0f);
    }
  }
  return make_texture(grid_, values, kCorners);
}

bool GpuRadiosity::Work::shoot() {
  if (next_in_round_ == round_.size() && !begin_round()) return false;
  shoot_from(round_[next_in_round_], next_of_cluster_);
  ++shots_;
  if (++next_of_cluster_ == round_[next_in_round_].shots) {
    ++next_in_round_;
    next_of_cluster_ = 0;
  }
  if (next_in_round_ == round_.size()) end_round();
  return true;
}

bool GpuRadiosity::Work::begin_round() {
  if (unshot_share_ <= options_.cutoff) return false;
  std::vector<double> flux(size());
  Values radiosity(grid_.texels(), Vec4(0.0f));
  for (std::size_t i = 0; i < size(); ++i) {
    flux[i] = area(i) * sum_of(unshot_[i]);
    radiosity[i] = Vec4(Vec3(unshot_[i]), static_cast<float>(patches_.exposed[element(i)]));
  }
  unshot_texture_.write<float>(channels_of(radiosity));
  round_ = tree_.choose(flux, sum_of(balance_.emitted), scene_radius_, options_.limits);
  next_in_round_ = 0;
  return !round_.empty();
}

/// A texel of the cluster, chosen in proportion to its flux.
std::size_t GpuRadiosity::Work::viewpoint(const Cluster& cluster) const {
  double sum = 0.0;
  for (std::size_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
    sum += area(i) * sum_of(unshot_[i]);
  }
  double rest = sum * static_cast<double>(to_unit_float(hash(options_.seed, shots_, 0)));
  std::size_t texel = cluster.first;
  for (std::size_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
    const double flux = area(i) * sum_of(unshot_[i]);
    if (flux <= 0.0) continue;
    texel = i;
    rest -= flux;
    if (rest < 0.0) break;
  }
  return texel;
}

void GpuRadiosity::Work::shoot_from(const Cluster& cluster, std::uint32_t shot) {
  glm::dvec3 flux(0.0), centre(0.0);
  double weight = 0.0;
  for (std::size_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
    flux += area(i) * unshot_[i];
    const double share = area(i) * sum_of(unshot_[i]);
    centre += share * patches_.centre[patches_.patch[element(i)]];
    weight += share;
  }
  centre /= weight;
  const std::size_t texel = viewpoint(cluster);
  constexpr std::size_t kPoints = ElementPoints::kPoints;
  // The shots of one element start from points well apart.
  const std::size_t point = hash(options_.seed, shots_ - shot, 1) + shot * kPoints / cluster.shots;
  const Vec3 origin = views_[texel * kPoints + point % kPoints];
  const float angle = 2.0f * kPi * to_unit_float(hash(options_.seed, shots_, 2));
  const HemicubePose pose = pose_at(origin, Vec3(patches_.element_normal(element(texel))), angle);
  items_.draw(pose);

  // Nearer than this the elements of the cluster are summed; farther away a disc in place of it
  // errs by a few hundredths of its form factor at most.
  constexpr double kFar = 5.0;
  // A pixel in the middle of the top, as a share of its distance.
  const float tolerance = 2.0f / static_cast<float>(options_.hemicube);
  // A quarter of what points are lifted off their surfaces, and eight roundings of coordinates.
  const float hair = scale_ * 0x1p-20f;
  gathered_target_.bind();
  gather_.set("points", 0, points_);
  gather_.set("normals", 1, normals_);
  gather_.set("corners", 2, corners_);
  gather_.set("unshot", 3, unshot_texture_);
  gather_.set("items", 4, items_.items());
  gather_.set("planes", 5, items_.planes());
  gather_.set("triangles", 6, occluders_.corners());
  gather_.set("neighbours", 7, occluders_.neighbours());
  gather_.set("layers", static_cast<int>(kPoints));
  gather_.set("layer", static_cast<int>(shots_ % kPoints));
  gather_.set("origin", pose.origin);
  gather_.set("to_local", pose.to_local);
  gather_.set("tolerance", tolerance);
  gather_.set("hair", hair);
  gather_.set("first", static_cast<int>(cluster.first));
  gather_.set("count", static_cast<int>(cluster.count));
  gather_.set("centre", Vec3(centre));
  gather_.set("area", static_cast<float>(cluster.area));
  gather_.set("radiosity", Vec3(flux / cluster.area));
  gather_.set("near_square", static_cast<float>(kFar * kFar * cluster.radius * cluster.radius));
  gl::draw_full_screen(no_attributes_);
  arrived_.run(gathered_);

  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  const auto add = [&](const gl::Framebuffer& target, const gl::Program& program) {
    target.bind();
    program.set("arrived", 0, arrived_.result());
    program.set("lost", 1, items_.lost());
    program.set("flux", Vec3(flux / static_cast<double>(cluster.shots)));
    gl::draw_full_screen(no_attributes_);
  };
  receive_.set("gathered", 2, gathered_);
  add(received_target_, receive_);
  add(tally_target_, count_lost_);
  glDisable(GL_BLEND);
  gl::check("gathering radiosity");
}

GpuRadiosity::Work::Values GpuRadiosity::Work::received_values() const {
  const std::vector<float> channels = received_target_.read<float>();
  Values values(size());
  for (std::size_t i = 0; i < size(); ++i) {
    values[i] = Vec4(channels[4 * i], channels[4 * i + 1], channels[4 * i + 2], 0.0f);
  }
  return values;
}

void GpuRadiosity::Work::end_round() {
  for (const Cluster& cluster : round_) {
    for (std::size_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
      unshot_[i] = glm::dvec3(0.0);
    }
  }
  const Values received = received_values();
  for (std::size_t i = 0; i < size(); ++i) {
    irradiance_[i] += glm::dvec3(received[i]);
    unshot_[i] += reflectance(i) * glm::dvec3(received[i]);
  }
  const std::vector<float> lost = tally_target_.read<float>();
  balance_.lost += glm::dvec3(lost[0], lost[1], lost[2]);
  cleared(received_);
  cleared(tally_);
  round_.clear();
  next_in_round_ = 0;
  take_stock();
}

void GpuRadiosity::Work::take_stock() {
  balance_.unshot = balance_.absorbed = glm::dvec3(0.0);
  for (std::size_t i = 0; i < size(); ++i) {
    balance_.unshot += area(i) * unshot_[i];
    balance_.absorbed += area(i) * (1.0 - reflectance(i)) * irradiance_[i];
  }
  const double emitted = sum_of(balance_.emitted);
  unshot_share_ = emitted > 0.0 ? sum_of(balance_.unshot) / emitted : 0.0;
}

std::vector<glm::dvec3> GpuRadiosity::Work::irradiance() const {
  std::vector<glm::dvec3> result(size());
  const Values received = round_.empty() ? Values(size(), Vec4(0.0f)) : received_values();
  for (std::size_t i = 0; i < size(); ++i) {
    result[element(i)] = irradiance_[i] + glm::dvec3(received[i]);
  }
  return result;
}

glm::dvec3 GpuRadiosity::Work::ambient() const {
  double total = 0.0;
  glm::dvec3 reflecting(0.0), unshot = balance_.unshot;
  for (std::size_t i = 0; i < size(); ++i) {
    total += area(i);
    reflecting += area(i) * reflectance(i);
  }
  const auto take_off = [&](const Cluster& cluster, double share) {
    for (std::size_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
      unshot -= share * area(i) * unshot_[i];
    }
  };
  for (std::size_t c = 0; c < next_in_round_; ++c) take_off(round_[c], 1.0);
  if (next_of_cluster_ > 0) {
    const Cluster& current = round_[next_in_round_];
    take_off(current, static_cast<double>(next_of_cluster_) / current.shots);
  }
  return unshot / (total - reflecting);
}

double GpuFluxBalance::error() const {
  double largest = 0.0;
  for (int c = 0; c < 3; ++c) {
    if (emitted[c] == 0.0) continue;
    largest =
        std::max(largest, std::abs(absorbed[c] + lost[c] + unshot[c] - emitted[c]) / emitted[c]);
  }
  return largest;
}

GpuRadiosity::GpuRadiosity(const World& world, const Tracer& tracer, const Patches& patches,
                           std::span<const glm::dvec3> external,
                           const GpuRadiosityOptions& options) {
  constexpr int kStep = Hemicube::kResolutionStep;
  if (options.hemicube < kStep || options.hemicube % kStep != 0) {
    throw Error(fmt::format("a hemicube of {} pixels along its edge; it takes a multiple of {}",
                            options.hemicube, kStep));
  }
  const gl::Info info = gl::query_info();
  for (const char* needed : {gl::kFloatTargets, gl::kFloatBlending}) {
    if (!info.has(needed)) {
      throw Error(
          fmt::format("radiosity on the GPU needs {}, which {} has not", needed, info.renderer));
    }
  }
  work_ = std::make_unique<Work>(world, tracer, patches, external, options);
}

GpuRadiosity::~GpuRadiosity() = default;

bool GpuRadiosity::shoot() { return work_->shoot(); }
std::size_t GpuRadiosity::shots() const { return work_->shots_; }
double GpuRadiosity::unshot_share() const { return work_->unshot_share_; }
GpuFluxBalance GpuRadiosity::balance() const { return work_->balance_; }
std::vector<glm::dvec3> GpuRadiosity::irradiance() const { return work_->irradiance(); }
glm::dvec3 GpuRadiosity::ambient() const { return work_->ambient(); }

}  // namespace lantern
