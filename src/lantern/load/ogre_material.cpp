// SPDX-License-Identifier: MIT
#include "lantern/load/ogre_material.h"

#include "lantern/core/file.h"
#include "lantern/load/ogre_script.h"
#include "lantern/load/ogre_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <initializer_list>
#include <optional>
#include <set>

namespace lantern::ogre {
namespace {

constexpr std::size_t kMostInherited = 256;  // materials, or parts of them
constexpr std::size_t kLongestValue = 4096;

constexpr Rgb kOwnWhite{0.8f};
constexpr Rgb kUndefined{0.8f, 0.2f, 0.8f};

/// Say how a rasteriser draws, not what the surface is.
constexpr std::array<std::string_view, 30> kLeftOut{"ambient",
                                                    "depth_check",
                                                    "depth_write",
                                                    "depth_func",
                                                    "depth_bias",
                                                    "cull_software",
                                                    "shading",
                                                    "normalise_normals",
                                                    "fog_override",
                                                    "max_lights",
                                                    "start_light",
                                                    "light_scissor",
                                                    "light_clip_planes",
                                                    "transparent_sorting",
                                                    "receive_shadows",
                                                    "transparency_casts_shadows",
                                                    "scheme",
                                                    "lod_index",
                                                    "lod_strategy",
                                                    "lod_values",
                                                    "lod_distances",
                                                    "gpu_vendor_rule",
                                                    "gpu_device_rule",
                                                    "shadow_caster_material",
                                                    "shadow_receiver_material",
                                                    "filtering",
                                                    "max_anisotropy",
                                                    "mipmap_bias",
                                                    "content_type",
                                                    "point_size"};

bool is_left_out(std::string_view name) {
  return std::find(kLeftOut.begin(), kLeftOut.end(), name) != kLeftOut.end();
}

struct Script {
  std::filesystem::path file;
  std::vector<Statement> statements;
};

/// A statement and the script it stands in.
struct Source {
  const Script* script;
  const Statement* statement;
};

struct Picture {
  std::string name;
  std::filesystem::path folder;
};

struct TextureUnit {
  std::string name;
  std::string alias;
  Picture picture;
  Wrap wrap_u = Wrap::kRepeat;
  Wrap wrap_v = Wrap::kRepeat;
};

struct Pass {
  std::string name;
  std::optional<Vec4> diffuse;
  bool vertex_colours = false;
  Rgb specular{0.0f};
  float shininess = 0.0f;
  Rgb emissive{0.0f};
  bool double_sided = false;
  bool blends = false;
  std::optional<float> alpha_cutoff;
  bool writes_colour = true;
  std::vector<TextureUnit> units;
};

struct Technique {
  std::string name;
  std::vector<Pass> passes;
};

std::filesystem::path first_existing(const std::vector<std::filesystem::path>& candidates) {
  std::error_code ignored;
  for (const auto& candidate : candidates) {
    if (std::filesystem::exists(candidate, ignored)) return candidate;
  }
  return candidates.front();
}

}  // namespace

struct Materials::Scripts {
  std::deque<Script> files;
  std::map<std::string, Source> materials;
  std::map<std::string, Source> abstracts;  // "pass NAME": what blocks of that kind may inherit
};

/// One material while its statements, and those of what it inherits, are carried out.
class Materials::Draft {
 public:
  Draft(const Scripts& scripts, LoadReport& report) : scripts_(scripts), report_(report) {}

  void build(const std::string& name, const std::map<std::string, std::string>& textures) {
    const Source source = scripts_.materials.at(name);
    name_ = name;
    collect(name, source);
    for (const Source& s : chain_) set_variables(s, s.script->statements);
    // A derived material sets what its parents use, so variables come before all attributes.
    for (const Source& s : chain_) set_variables(s, s.statement->children);
    for (const Source& s : chain_) material(s);
    for (const auto& [alias, picture] : textures) {
      aliases_[alias] = {picture, source.script->file.parent_path()};
    }
    for (Technique& technique : techniques_) {
      for (Pass& pass : technique.passes) {
        for (TextureUnit& unit : pass.units) {
          const auto found = aliases_.find(unit.alias.empty() ? unit.name : unit.alias);
          if (found != aliases_.end()) unit.picture = found->second;
        }
      }
    }
    findings_.throw_if_any();
  }

  /// The pass that counts; one that says nothing if there is none.
  const Pass& pass() const {
    for (const Technique& technique : techniques_) {
      for (const Pass& pass : technique.passes) {
        if (pass.writes_colour) return pass;
      }
    }
    static const Pass kSilent;
    return kSilent;
  }

  void count_unknown(std::string_view name) {
    ++report_.unknown[fmt::format("material: {}", name)];
  }

 private:
  using Words = std::vector<std::string>;

  static Place place(const Source& s) { return {s.script->file.string(), s.statement->line}; }

  /// What the material inherits, eldest first, and then itself.
  void collect(const std::string& name, const Source& source) {
    if (std::find(lineage_.begin(), lineage_.end(), name) != lineage_.end()) {
      fail(place(source), "material '{}' inherits itself", name);
    }
    if (lineage_.size() + chain_.size() >= kMostInherited) {
      fail(place(source), "material '{}' inherits more than {} others", name_, kMostInherited);
    }
    lineage_.push_back(name);
    for (const std::string& parent : source.statement->parents) {
      const auto found = scripts_.materials.find(parent);
      if (found != scripts_.materials.end()) {
        collect(parent, found->second);
      } else {
        report_.warn(fmt::format("{}: material '{}' inherits '{}', which no script defines",
                                 to_string(place(source)), name, parent));
      }
    }
    lineage_.pop_back();
    chain_.push_back(source);
  }

  /// The word, or what its variable is set to.
  std::string expand(const Source& s, const Word& word) {
    if (!word.is_variable) return word.text;
    const auto set = std::find_if(variables_.rbegin(), variables_.rend(),
                                  [&](const auto& v) { return v.first == word.text; });
    if (set != variables_.rend()) return set->second;
    report_.warn(fmt::format("{}: {} is not set", to_string(place(s)), word.text));
    return {};
  }

  Words words_of(const Source& s) {
    Words result;
    for (const Word& word : s.statement->words) {
      const std::string text = expand(s, word);
      if (!word.is_variable) {
        result.push_back(text);
      } else {
        // A variable may stand for several words, such as a colour.
        for (std::string_view part : split(text)) result.emplace_back(part);
      }
    }
    return result;
  }

  void set_variables(const Source& s, const std::vector<Statement>& statements) {
    for (const Statement& child : statements) {
      if (child.is_block || child.words.size() < 3 || child.words[0].text != "set") continue;
      std::string value;
      for (std::size_t i = 2; i < child.words.size(); ++i) {
        if (i > 2) value += ' ';
        value += expand({s.script, &child}, child.words[i]);
      }
      // Variables made of variables could grow without end.
      if (value.size() > kLongestValue) {
        fail({s.script->file.string(), child.line}, "the value of {} is longer than {} characters",
             child.words[1].text, kLongestValue);
      }
      variables_.emplace_back(child.words[1].text, std::move(value));
    }
  }

  /// Carries out a block's statements: `attribute` for lines, `block` for blocks.
  template <typename Attribute, typename Block>
  void carry_out(const Source& s, Attribute attribute, Block block) {
    for (const Statement& child : s.statement->children) {
      const Source here{s.script, &child};
      const Words words = words_of(here);
      if (words.empty() || words[0] == "set" || words[0] == "abstract") continue;
      if (is_left_out(words[0])) continue;
      const bool known = child.is_block ? block(here, words) : attribute(here, words);
      if (!known) count_unknown(words[0]);
    }
  }

  /// The same for a part of a material: variables set in it end with it.
  template <typename Attribute, typename Block>
  void carry_out_part(const Source& s, Attribute attribute, Block block) {
    const std::size_t outer = variables_.size();
    set_variables(s, s.statement->children);
    carry_out(s, attribute, block);
    variables_.resize(outer);
  }

  /// The part of that name, or in that place among its kind where names are not given; made if it
  /// is not there.
  template <typename Part>
  static Part& part(std::vector<Part>& parts, const Words& words, std::size_t place_in_block) {
    const std::string name = words.size() > 1 ? words[1] : "";
    if (!name.empty()) {
      const auto found =
          std::find_if(parts.begin(), parts.end(), [&](const Part& p) { return p.name == name; });
      if (found != parts.end()) return *found;
    } else if (place_in_block < parts.size()) {
      return parts[place_in_block];
    }
    parts.emplace_back();
    parts.back().name = name;
    return parts.back();
  }

  /// Carries out the abstract blocks that a block inherits.
  template <typename CarryOut>
  void inherit(const Source& s, const Words& words, CarryOut carry_out_block) {
    for (const std::string& parent : s.statement->parents) {
      const auto found = scripts_.abstracts.find(words[0] + " " + parent);
      if (found == scripts_.abstracts.end()) {
        report_.warn(fmt::format("{}: {} inherits '{}', which no script defines",
                                 to_string(place(s)), words[0], parent));
        continue;
      }
      // Counted over the whole material, so that neither cycles nor fans go on for long.
      if (++inherited_ > kMostInherited) {
        fail(place(s), "material '{}' inherits itself or more than {} parts", name_,
             kMostInherited);
      }
      carry_out_block(found->second);
    }
  }

  void material(const Source& s) {
    std::size_t techniques = 0;
    carry_out(
        s, [&](const Source& here, const Words& w) { return material_attribute(here, w); },
        [&](const Source& here, const Words& w) {
          if (w[0] != "technique") return false;
          technique(here, w, part(techniques_, w, techniques++));
          return true;
        });
  }

  bool material_attribute(const Source& s, const Words& w) {
    if (w[0] != "set_texture_alias" || w.size() < 3) return false;
    aliases_[w[1]] = {w[2], s.script->file.parent_path()};
    return true;
  }

  void technique(const Source& s, const Words& words, Technique& target) {
    inherit(s, words, [&](const Source& base) { technique(base, words, target); });
    std::size_t passes = 0;
    carry_out_part(
        s, [](const Source&, const Words&) { return false; },
        [&](const Source& here, const Words& w) {
          if (w[0] != "pass") return false;
          pass(here, w, part(target.passes, w, passes++));
          return true;
        });
  }

  void pass(const Source& s, const Words& words, Pass& target) {
    inherit(s, words, [&](const Source& base) { pass(base, words, target); });
    std::size_t units = 0;
    carry_out_part(
        s, [&](const Source& here, const Words& w) { return pass_attribute(here, w, target); },
        [&](const Source& here, const Words& w) {
          if (w[0] != "texture_unit") return false;
          texture_unit(here, w, part(target.units, w, units++));
          return true;
        });
  }

  /// Words from the second on as numbers; what is none, or too few of them, is a finding.
  std::vector<float> numbers(const Source& s, const Words& w, std::size_t least, std::size_t most) {
    std::vector<float> result;
    for (std::size_t i = 1; i < w.size(); ++i) {
      const auto number = parse_float(w[i]);
      if (!number) findings_.add(place(s), "{}: '{}' is no finite number", w[0], w[i]);
      result.push_back(number.value_or(0.0f));
    }
    if (result.size() < least || result.size() > most) {
      findings_.add(place(s), "{} has {} numbers where {} to {} are expected", w[0], result.size(),
                    least, most);
    }
    result.resize(std::max(least, std::min(result.size(), most)));
    return result;
  }

  bool pass_attribute(const Source& s, const Words& w, Pass& pass) {
    const std::string& name = w[0];
    const std::string value = w.size() > 1 ? w[1] : "";
    if (name == "diffuse") {
      pass.vertex_colours = value == "vertexcolour";
      if (pass.vertex_colours) {
        pass.diffuse = Vec4(1.0f);
      } else {
        const auto n = numbers(s, w, 3, 4);
        pass.diffuse = Vec4(n[0], n[1], n[2], n.size() > 3 ? n[3] : 1.0f);
      }
      return true;
    }
    if (name == "specular") {
      if (value == "vertexcolour") return false;
      const auto n = numbers(s, w, 4, 5);
      pass.specular = {n[0], n[1], n[2]};
      pass.shininess = n.back();
      return true;
    }
    if (name == "emissive" || name == "self_illumination") {
      if (value == "vertexcolour") return false;
      const auto n = numbers(s, w, 3, 4);
      pass.emissive = {n[0], n[1], n[2]};
      return true;
    }
    if (name == "cull_hardware") {
      pass.double_sided = value == "none";
      return value == "none" || value == "clockwise";
    }
    if (name == "alpha_rejection") return alpha_rejection(s, w, pass);
    if (name == "scene_blend") {
      pass.blends = value == "alpha_blend" ||
                    (value == "src_alpha" && w.size() > 2 && w[2] == "one_minus_src_alpha");
      return pass.blends || value == "replace" ||
             (value == "one" && w.size() > 2 && w[2] == "zero");
    }
    if (name == "colour_write") {
      pass.writes_colour = value != "off";
      return true;
    }
    // Without lighting Ogre shows colours that no light made; nothing here corresponds to that.
    return name == "lighting" && value == "on";
  }

  bool alpha_rejection(const Source& s, const Words& w, Pass& pass) {
    const std::string function = w.size() > 1 ? w[1] : "";
    pass.alpha_cutoff.reset();
    if (function == "always_pass") return true;
    if (function != "greater" && function != "greater_equal") return false;
    const auto n = w.size() > 2 ? parse_float(w[2]) : std::optional(0.0f);
    if (!n) findings_.add(place(s), "alpha_rejection: '{}' is no finite number", w[2]);
    const float cutoff = n.value_or(0.0f) / 255.0f;
    pass.alpha_cutoff = function == "greater" ? std::nextafter(cutoff, kInfinity) : cutoff;
    return true;
  }

  void texture_unit(const Source& s, const Words& words, TextureUnit& target) {
    inherit(s, words, [&](const Source& base) { texture_unit(base, words, target); });
    carry_out_part(
        s,
        [&](const Source& here, const Words& w) {
          if (w.size() < 2) return false;
          if (w[0] == "texture") {
            target.picture = {w[1], here.script->file.parent_path()};
          } else if (w[0] == "texture_alias") {
            target.alias = w[1];
          } else if (w[0] == "tex_address_mode") {
            const bool u = wrap(w[1], target.wrap_u);
            return wrap(w[w.size() > 2 ? 2 : 1], target.wrap_v) && u;
          } else if (w[0] == "tex_coord_set") {
            return w[1] == "0";
          } else {
            return false;
          }
          return true;
        },
        [](const Source&, const Words&) { return false; });
  }

  static bool wrap(std::string_view word, Wrap& target) {
    if (word == "wrap") {
      target = Wrap::kRepeat;
    } else if (word == "clamp" || word == "border") {
      target = Wrap::kClamp;
    } else if (word == "mirror") {
      target = Wrap::kMirror;
    }
    return word == "wrap" || word == "clamp" || word == "mirror";
  }

  const Scripts& scripts_;
  LoadReport& report_;
  Findings findings_;
  std::string name_;
  std::vector<std::string> lineage_;
  std::vector<Source> chain_;
  std::vector<std::pair<std::string, std::string>> variables_;  // the last of a name counts
  std::map<std::string, Picture> aliases_;
  std::vector<Technique> techniques_;
  std::size_t inherited_ = 0;
};

Materials::Materials(Scene& scene, LoadReport& report, std::vector<std::filesystem::path> folders)
    : scene_(scene),
      report_(report),
      folders_(std::move(folders)),
      textures_(scene, report),
      scripts_(std::make_unique<Scripts>()) {}

Materials::~Materials() = default;

void Materials::add_script(std::string_view text, const std::filesystem::path& file) {
  Script& script = scripts_->files.emplace_back();
  script.file = file;
  script.statements = parse_script(text, file.string());
  std::set<std::string> here;
  for (const Statement& statement : script.statements) {
    if (!statement.is_block) continue;
    std::vector<std::string> words;
    for (const Word& word : statement.words) words.push_back(word.text);
    const bool is_abstract = words.size() > 2 && words[0] == "abstract";
    if (is_abstract) words.erase(words.begin());
    if (words[0] == "material") {
      if (words.size() < 2) fail({file.string(), statement.line}, "the material has no name");
      if (!here.insert(words[1]).second) {
        report_.warn(fmt::format("{}: material '{}' is defined again; this one counts",
                                 to_string({file.string(), statement.line}), words[1]));
      }
      scripts_->materials[words[1]] = Source{&script, &statement};
    } else if (is_abstract) {
      scripts_->abstracts[words[0] + " " + words[1]] = Source{&script, &statement};
    }
  }
}

void Materials::add_file(const std::filesystem::path& file) { add_script(read_text(file), file); }

void Materials::add_folder(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> scripts;
  std::error_code ignored;
  for (const auto& entry :
       std::filesystem::directory_iterator(folder.empty() ? "." : folder, ignored)) {
    if (extension(entry.path()) == ".material" && entry.is_regular_file(ignored)) {
      scripts.push_back(folder / entry.path().filename());
    }
  }
  std::sort(scripts.begin(), scripts.end());
  for (const auto& script : scripts) add_file(script);
}

bool Materials::defines(const std::string& name) const {
  return scripts_->materials.contains(name);
}

MaterialId Materials::use(const std::string& name,
                          const std::map<std::string, std::string>& textures) {
  const auto [known, is_new] = used_.try_emplace({name, textures});
  if (!is_new) return known->second;

  Material material;
  material.name = name;
  if (defines(name)) {
    Draft draft(*scripts_, report_);
    draft.build(name, textures);
    const Pass& pass = draft.pass();
    const auto unit = std::find_if(pass.units.begin(), pass.units.end(),
                                   [](const TextureUnit& u) { return !u.picture.name.empty(); });
    if (unit != pass.units.end()) {
      const std::filesystem::path picture = unit->picture.name;
      std::vector<std::filesystem::path> candidates{unit->picture.folder / picture};
      for (const auto& folder : folders_) {
        candidates.push_back(folder / picture);
        candidates.push_back(folder / picture.filename());
      }
      material.reflectance_texture =
          textures_.load(first_existing(candidates), unit->wrap_u, unit->wrap_v);
      for (auto more = unit + 1; more != pass.units.end(); ++more) {
        draft.count_unknown("texture_unit after the first");
      }
    }
    const Vec4 diffuse =
        pass.diffuse.value_or(material.reflectance_texture ? Vec4(1.0f) : Vec4(kOwnWhite, 1.0f));
    material.reflectance = Rgb(diffuse);
    material.vertex_colours = pass.vertex_colours;
    material.emission = pass.emissive;
    if (!is_black(pass.emissive)) material.emission_texture = material.reflectance_texture;
    material.double_sided = pass.double_sided;
    material.alpha_cutoff = pass.alpha_cutoff;
    material.blend = pass.blends;
    if (pass.blends || pass.alpha_cutoff) material.opacity = std::clamp(diffuse.a, 0.0f, 1.0f);
    material.specular = pass.specular;
    material.shininess = pass.shininess;
  } else if (name.empty() || name == "BaseWhite" || name == "BaseWhiteNoLighting") {
    material.reflectance = kOwnWhite;
  } else {
    material.reflectance = kUndefined;
    report_.warn(fmt::format("no script defines material '{}'; a conspicuous one stands in", name));
  }
  known->second = to_id<MaterialId>(scene_.materials.size());
  scene_.materials.push_back(std::move(material));
  return known->second;
}

}  // namespace lantern::ogre
