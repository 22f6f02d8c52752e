// SPDX-License-Identifier: MIT
#include "bench/ogre_scene.h"

#include "lantern/core/error.h"
#include "lantern/raster/edge_list.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/scene/subdivide.h"

#include <Ogre.h>
#include <OgreRTShaderSystem.h>
#include <OgreSGTechniqueResolverListener.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <epoxy/gl.h>
#include <map>
#include <numeric>
#include <optional>
#include <vector>

namespace lantern {
namespace {

using RTShader = Ogre::RTShader::ShaderGenerator;

Ogre::Vector3 to_ogre(const Vec3& v) { return {v.x, v.y, v.z}; }

/// Surfaces of one material that are connected.
struct Object {
  World surfaces;
  bool wall = true;  // all of it
};

std::vector<Object> objects_of(const World& world) {
  std::vector<std::uint32_t> parent(world.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t vertex) {
    while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
    return vertex;
  };
  std::map<std::tuple<float, float, float, MaterialId>, std::uint32_t> places;
  for (std::size_t t = 0; t < world.size(); ++t) {
    const uvec3 corners = world.triangles[t];
    for (int c = 0; c < 3; ++c) {
      const Vec3 p = world.positions[corners[c]];
      const auto place = places.try_emplace({p.x, p.y, p.z, world.materials[t]}, corners[c]).first;
      parent[root(corners[c])] = root(place->second);
      parent[root(corners[c])] = root(corners.x);
    }
  }
  const std::vector<Vec4> walls = find_walls(world);
  std::map<std::uint32_t, Object> objects;
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    Object& object = objects[root(world.triangles[t].x)];
    object.surfaces.triangles.push_back(world.triangles[t]);
    object.surfaces.materials.push_back(world.materials[t]);
    object.wall = object.wall && wall_of(world, t, walls).has_value();
  }
  std::vector<Object> list;
  for (auto& [vertex, object] : objects) {
    object.surfaces.positions = world.positions;
    object.surfaces.normals = world.normals;
    list.push_back(std::move(object));
  }
  return list;
}

/// A mesh with the edge list that shadow volumes are made from.
Ogre::MeshPtr make_mesh(Ogre::SceneManager& manager, const World& surfaces,
                        const Ogre::MaterialPtr& material, const std::string& name) {
  Ogre::ManualObject* object = manager.createManualObject();
  object->begin(material);
  std::map<std::tuple<std::uint32_t, float, float, float>, std::uint32_t> added;
  for (std::uint32_t t = 0; t < surfaces.size(); ++t) {
    std::array<std::uint32_t, 3> corners;
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t vertex = surfaces.triangles[t][c];
      Vec3 normal = surfaces.normals.empty() ? Vec3(0.0f) : surfaces.normals[vertex];
      if (normal == Vec3(0.0f)) normal = glm::normalize(surfaces.area_vector(t));
      const auto [place, is_new] =
          added.try_emplace({vertex, normal.x, normal.y, normal.z}, added.size());
      if (is_new) {
        object->position(to_ogre(surfaces.positions[vertex]));
        object->normal(to_ogre(normal));
      }
      corners[static_cast<std::size_t>(c)] = place->second;
    }
    object->triangle(corners[0], corners[1], corners[2]);
  }
  object->end();
  const Ogre::MeshPtr mesh = object->convertToMesh(name);
  mesh->buildEdgeList();
  manager.destroyManualObject(object);
  return mesh;
}

/// Emission and depth in a first pass, then a pass a light that adds up.
Ogre::MaterialPtr make_material(const Material& material, float exposure, const std::string& name) {
  const Ogre::MaterialPtr made =
      Ogre::MaterialManager::getSingleton().create(name, Ogre::RGN_DEFAULT);
  const Rgb emission = material.emission * exposure;
  Ogre::Pass* first = made->getTechnique(0)->getPass(0);
  first->setAmbient(Ogre::ColourValue::Black);
  first->setDiffuse(Ogre::ColourValue::Black);
  first->setSelfIllumination(emission.x, emission.y, emission.z);
  Ogre::Pass* lit = made->getTechnique(0)->createPass();
  lit->setAmbient(Ogre::ColourValue::Black);
  lit->setDiffuse(material.reflectance.x, material.reflectance.y, material.reflectance.z, 1.0f);
  lit->setSceneBlending(Ogre::SBF_ONE, Ogre::SBF_ONE);
  lit->setDepthWriteEnabled(false);
  lit->setIteratePerLight(true, true, Ogre::Light::LT_SPOTLIGHT);
  return made;
}

}  // namespace

struct OgreScene::State {
  OgreOptions options;
  float radius, coordinate_scale;  // of the world
  Ogre::LogManager log;
  std::optional<Ogre::Root> root;
  std::unique_ptr<OgreBites::SGTechniqueResolverListener> shaders;
  Ogre::SceneManager* manager = nullptr;
  Ogre::SceneNode* light_nodes = nullptr;
  Ogre::RenderTarget* target = nullptr;

  State(const World& world, const OgreOptions& with)
      : options(with), radius(world.bounds.radius()), coordinate_scale(world.coordinate_scale()) {
    log.createLog("", true, false, true);  // nothing is written
    root.emplace("", "", "");
    start();
    make_target();
  }

  void start() {
    root->loadPlugin(LANTERN_OGRE_PLUGINS "/RenderSystem_" + options.render_system);
    Ogre::RenderSystem* const system = root->getAvailableRenderers().front();
    root->setRenderSystem(system);
    root->initialise(false);
    const Ogre::NameValuePairList window = {{"hidden", "true"}, {"vsync", "false"}};
    root->createRenderWindow("hidden", 1, 1, false, &window);
    if (options.extrude_in_software) {
      system->getMutableCapabilities()->unsetCapability(Ogre::RSC_VERTEX_PROGRAM);
    }
    auto& resources = Ogre::ResourceGroupManager::getSingleton();
    for (const char* folder : {"/ShadowVolume", "/RTShaderLib/GLSL"}) {
      resources.addResourceLocation(std::string(LANTERN_OGRE_MEDIA) + folder, "FileSystem",
                                    Ogre::RGN_INTERNAL);
    }
    resources.initialiseAllResourceGroups();
    manager = root->createSceneManager();
    light_nodes = manager->getRootSceneNode()->createChildSceneNode();
    if (options.per_pixel || !system->getCapabilities()->hasCapability(Ogre::RSC_FIXED_FUNCTION)) {
      use_shaders();
    }
    manager->setShadowTechnique(Ogre::SHADOWTYPE_STENCIL_ADDITIVE);
    manager->setShadowUseInfiniteFarPlane(true);
  }

  void use_shaders() {
    RTShader::initialize();
    RTShader& generator = RTShader::getSingleton();
    generator.addSceneManager(manager);
    shaders = std::make_unique<OgreBites::SGTechniqueResolverListener>(&generator);
    Ogre::MaterialManager::getSingleton().addListener(shaders.get());
    generator.getRenderState(RTShader::DEFAULT_SCHEME_NAME)
        ->addTemplateSubRenderState(generator.createSubRenderState(
            options.per_pixel ? Ogre::RTShader::PerPixelLighting::Type
                              : Ogre::RTShader::FFPLighting::Type));
  }

  void make_target() {
    const Ogre::TexturePtr texture = Ogre::TextureManager::getSingleton().createManual(
        "target", Ogre::RGN_DEFAULT, Ogre::TEX_TYPE_2D, static_cast<Ogre::uint>(options.width),
        static_cast<Ogre::uint>(options.height), 0,
        options.floats ? Ogre::PF_FLOAT32_RGBA : Ogre::PF_BYTE_RGBA, Ogre::TU_RENDERTARGET);
    target = texture->getBuffer()->getRenderTarget();
  }

  void add_objects(const Scene& scene, const World& world) {
    std::vector<Ogre::MaterialPtr> materials;
    for (const Material& material : scene.materials) {
      materials.push_back(make_material(material, options.exposure,
                                        "material " + std::to_string(materials.size())));
    }
    int number = 0;
    for (const Object& object : objects_of(world)) {
      const MaterialId material = object.surfaces.materials.front();
      const World surfaces = subdivided(object.surfaces, object.wall ? options.wall_pieces : 1);
      Ogre::Entity* const entity = manager->createEntity(make_mesh(
          *manager, surfaces, materials[index(material)], "object " + std::to_string(number++)));
      entity->setCastShadows(!object.wall && is_black(scene.materials[index(material)].emission));
      manager->getRootSceneNode()->attachObject(entity);
    }
  }

  void add_camera(const Camera& camera) {
    Ogre::Camera* const eye = manager->createCamera("camera");
    Ogre::SceneNode* const node = manager->getRootSceneNode()->createChildSceneNode();
    node->attachObject(eye);
    node->setPosition(to_ogre(camera.eye));
    const Vec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
    Ogre::Quaternion turn;
    turn.FromAxes(to_ogre(right), to_ogre(glm::cross(right, camera.forward)),
                  to_ogre(-camera.forward));
    node->setOrientation(turn);
    eye->setFOVy(Ogre::Radian(camera.vertical_fov));
    eye->setAspectRatio(static_cast<float>(options.width) / static_cast<float>(options.height));
    constexpr float kNear = 1e-3f;  // of the radius; depth has 24 bits
    eye->setNearClipDistance(kNear * radius);
    eye->setFarClipDistance(0.0f);  // infinite
    Ogre::Viewport* const viewport = target->addViewport(eye);
    viewport->setBackgroundColour(Ogre::ColourValue::Black);
    if (shaders) viewport->setMaterialScheme(RTShader::DEFAULT_SCHEME_NAME);
  }
};

OgreScene::OgreScene(const Scene& scene, const World& world, const Camera& camera,
                     const OgreOptions& options)
    : state_(std::make_unique<State>(world, options)) {
  state_->add_objects(scene, world);
  state_->add_camera(camera);
}

OgreScene::~OgreScene() {
  if (!state_->shaders) return;
  Ogre::MaterialManager::getSingleton().removeListener(state_->shaders.get());
  RTShader::destroy();
}

void OgreScene::set_lights(const VirtualLights& lights) {
  Ogre::SceneManager& manager = *state_->manager;
  manager.destroyAllLights();
  state_->light_nodes->removeAndDestroyAllChildren();
  for (const LightGroup& group : group_lights(lights, {}, state_->coordinate_scale)) {
    if (group.formula != LightFormula::kSurface) throw Error("Ogre is given surfaces' lights only");
    for (const LightRecord& record : group.records) {
      Ogre::Light* const light = manager.createLight();
      light->setType(Ogre::Light::LT_SPOTLIGHT);
      Ogre::SceneNode* const node = state_->light_nodes->createChildSceneNode();
      node->attachObject(light);
      node->setPosition(to_ogre(record.place));
      node->setDirection(to_ogre(record.axis), Ogre::Node::TS_WORLD);
      // OpenGL takes no half angle beyond 90 degrees, as rounding would have it.
      light->setSpotlightRange(Ogre::Degree(0.0f), Ogre::Degree(179.99f), 1.0f);
      const Vec3 colour = Vec3(record.strength) * kInvPi * state_->options.exposure;
      light->setDiffuseColour(colour.x, colour.y, colour.z);
      const float beyond_all = 10.0f * state_->radius;
      light->setAttenuation(beyond_all, 0.0f, 0.0f, 1.0f);
    }
  }
}

void OgreScene::draw() {
  state_->root->_fireFrameStarted();
  state_->target->update(false);
  state_->root->_fireFrameEnded();
  glFinish();
}

Image OgreScene::picture() const {
  const OgreOptions& options = state_->options;
  Image image(options.width, options.height);
  const Ogre::PixelBox box(static_cast<Ogre::uint32>(options.width),
                           static_cast<Ogre::uint32>(options.height), 1, Ogre::PF_FLOAT32_RGB,
                           image.pixels.data());
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  state_->target->copyContentsToMemory(box, box);
  for (Rgb& pixel : image.pixels) pixel /= options.exposure;
  return image;
}

}  // namespace lantern
