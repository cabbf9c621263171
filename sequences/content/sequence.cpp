// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/sequence.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "sequences/content/asset_paths.h"
#include "sequences/content/default_view.h"
#include "sequences/content/nearest_word.h"
#include "sequences/content/scene_builder.h"
#include "sequences/content/sequence_file.h"
#include "sequences/files/quoted.h"

namespace talisman::sequences {

namespace {

constexpr double kMaxModel_s = 20;   // longer animations are cut
constexpr double kTurntable_s = 20;  // one turn around a bare model

bool is_yaml(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".yaml" || extension == ".yml";
}

/// The layer tag of the nearest tagged node above (or at) each node; empty: none.
std::vector<std::string> tags_of_nodes(const layers::Scene& scene, const std::vector<LayerTag>& tags) {
  std::vector<std::string> tag_of(scene.nodes.size());
  for (const LayerTag& tag : tags) tag_of[tag.node] = tag.layer;
  for (std::size_t i = 0; i < tag_of.size(); ++i)
    if (tag_of[i].empty() && scene.nodes[i].parent >= 0) tag_of[i] = tag_of[scene.nodes[i].parent];
  return tag_of;
}

/// Layers that the model's author named, then what the moving and top-level nodes give for the rest.
std::vector<layers::LayerSpec> specs_of_model(const layers::Scene& scene, const std::vector<LayerTag>& tags) {
  const std::vector<std::string> tag_of = tags_of_nodes(scene, tags);
  std::vector<layers::LayerSpec> specs;
  std::map<std::string, std::size_t> spec_of;
  std::vector<std::string> tagged_parts;
  for (const layers::Part& part : scene.parts) {
    const std::string& layer = tag_of[part.node];
    if (layer.empty()) continue;
    const auto [entry, is_new] = spec_of.emplace(layer, specs.size());
    if (is_new) specs.push_back({layer, {}, layers::OrderGroup::Normal, {}});
    std::string glob = part.name;
    std::replace(glob.begin(), glob.end(), '*', '?');
    specs[entry->second].part_globs.push_back(glob);
    tagged_parts.push_back(glob);
  }
  for (layers::LayerSpec& spec : layers::default_layer_specs(scene)) {
    std::erase_if(spec.part_globs, [&](const std::string& glob) {
      return std::find(tagged_parts.begin(), tagged_parts.end(), glob) != tagged_parts.end();
    });
    while (spec_of.count(spec.name)) spec.name += "'";
    if (!spec.part_globs.empty()) specs.push_back(std::move(spec));
  }
  return specs;
}

std::vector<std::string> parts_in_no_layer(const layers::Scene& scene, const layers::LayerSet& set) {
  std::vector<std::string> names;
  if (set.unassigned_parts == 0) return names;
  std::vector<bool> taken(scene.parts.size());
  for (const layers::Layer& layer : set.layers)
    for (const int part : layer.parts) taken[static_cast<std::size_t>(part)] = true;
  for (std::size_t i = 0; i < taken.size(); ++i)
    if (!taken[i]) names.push_back(scene.parts[i].name);
  return names;
}

/// "; did you mean 'ship/hull'", or what there is, of the first glob that matches no part; empty where all do.
std::string help_with_globs(const layers::Scene& scene, const std::vector<std::string>& globs) {
  std::vector<std::string> parts;
  for (const layers::Part& part : scene.parts) parts.push_back(part.name);
  for (const std::string& glob : globs) {
    if (std::any_of(parts.begin(), parts.end(),
                    [&](const std::string& part) { return layers::glob_matches(glob, part); }))
      continue;
    const std::string nearest = did_you_mean(glob, parts);
    return nearest.empty() ? "; parts are " + quoted(parts) : nearest;
  }
  return {};
}

void finish(Sequence& sequence, BuiltScene built, std::vector<layers::LayerSpec> specs) {
  sequence.layers = layers::factor(built.scene, specs);
  sequence.layer_specs = std::move(specs);
  sequence.warnings.insert(sequence.warnings.end(), built.warnings.begin(), built.warnings.end());
  sequence.content_files.insert(sequence.content_files.end(), built.files.begin(), built.files.end());
  if (const std::vector<std::string> parts = parts_in_no_layer(built.scene, sequence.layers); !parts.empty())
    sequence.warnings.push_back(sequence.file + ": " + std::to_string(parts.size()) +
                                (parts.size() == 1 ? " part is taken by no layer and is not drawn: "
                                                   : " parts are taken by no layer and are not drawn: ") +
                                quoted(parts));
  sequence.scene = std::make_shared<const layers::Scene>(std::move(built.scene));
}

/// The place of the layer that a defect speaks of; the defect begins with "layer 'NAME'".
[[noreturn]] void fail_at_layer(const SequenceFile& file, const layers::Scene& scene,
                                const std::string& defect) {
  for (const LayerEntry& entry : file.layers)
    if (defect.rfind("layer '" + entry.spec.name + "':", 0) == 0)
      throw InputError(defect + help_with_globs(scene, entry.spec.part_globs), entry.file, entry.line);
  throw InputError(defect, file.settings.file);
}

/// Folders of the sequence and of the command line.
void apply(const ContentOptions& options, const std::string& path, SceneRecipe& recipe) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  recipe.assets.insert(recipe.assets.begin(), folder.empty() ? "." : folder);
  recipe.assets.insert(recipe.assets.end(), options.assets.begin(), options.assets.end());
  if (options.exposure_lx) recipe.exposure_lx = *options.exposure_lx;
  if (options.turntable_s) recipe.turntable_s = *options.turntable_s;
}

Sequence load_yaml(const std::string& path, const ContentOptions& options) {
  SequenceFile file = read_sequence_file(path);
  apply(options, path, file.recipe);
  BuiltScene built = build_scene(file.recipe);
  if (const std::string defect = layers::first_defect(built.scene); !defect.empty())
    throw InputError(defect, path);
  if (built.scene.parts.empty())
    throw InputError("shows nothing, rule: at least one of shapes, models, terrain and sky", path);
  std::vector<layers::LayerSpec> specs;
  for (const LayerEntry& entry : file.layers) specs.push_back(entry.spec);
  if (specs.empty()) specs = specs_of_model(built.scene, built.layer_tags);
  Sequence sequence = std::move(file.settings);
  sequence.content = options;
  finish(sequence, std::move(built), std::move(specs));
  if (!sequence.layers.defect.empty()) {
    file.settings.file = path;
    fail_at_layer(file, *sequence.scene, sequence.layers.defect);
  }
  sequence.explicit_order = resolve_layer_pairs(file.order, sequence.layers.layers);
  return sequence;
}

/// The lights of the file as they are under another exposure.
void expose(ImportedModel& model, double exposure_lx) {
  for (layers::Light& light : model.scene.lights)
    light.color *= static_cast<float>(model.exposure_lx / exposure_lx);
  if (!model.scene.lights.empty())
    model.notes.push_back("the exposure that was asked for, " + shown(exposure_lx) +
                          " lx, takes the place of the file's");
}

/// As many as the animation lasts, else one turn of the camera.
int frames_of_model(const layers::Scene& scene, double turntable_s, double fps) {
  const double duration = std::min(scene.duration_s(), kMaxModel_s);
  const double frames = std::round((duration > 0 ? duration : turntable_s) * fps);
  return static_cast<int>(std::clamp<double>(frames, 1, kLongestRun_frames));
}

Sequence load_model(const std::string& path, const ContentOptions& options) {
  ImportedModel model = import_model(path, {}, options.assets);
  Sequence sequence;
  sequence.content = options;
  const double turntable_s = options.turntable_s.value_or(kTurntable_s);
  sequence.name = std::filesystem::path(path).stem().string();
  sequence.file = path;
  sequence.frames = frames_of_model(model.scene, turntable_s, sequence.fps);
  if (options.exposure_lx) expose(model, *options.exposure_lx);
  std::vector<layers::LayerSpec> specs = specs_of_model(model.scene, model.layer_tags);
  add_model_view(model.scene, specs, {turntable_s, options.stage, options.exposure_lx.value_or(1)});
  for (const std::string& note : model.notes) sequence.notes.push_back(path + ": " + note);
  BuiltScene built;
  built.scene = std::move(model.scene);
  for (const std::string& warning : model.warnings) built.warnings.push_back(path + ": " + warning);
  built.files = files_read(model);
  finish(sequence, std::move(built), std::move(specs));
  if (!sequence.layers.defect.empty()) throw InputError(sequence.layers.defect, path);
  return sequence;
}

}  // namespace

Sequence load_sequence(const std::string& name_or_path, const ContentOptions& options) {
  // A name means the same in every working directory; a file that happens to have it is ./NAME.
  if (const std::string shipped = sequence_file_of(name_or_path); !shipped.empty())
    return load_yaml(shipped, options);
  std::error_code error;
  if (std::filesystem::is_directory(name_or_path, error))
    throw InputError("'" + name_or_path +
                     "' is a folder, rule: the name of a sequence, its YAML file or a model");
  if (!std::filesystem::is_regular_file(name_or_path, error)) {
    const std::string nearest = did_you_mean(name_or_path, known_sequences());
    throw InputError("'" + name_or_path + "' is no sequence and no file" +
                     (nearest.empty() ? "; sequences are: " + joined(known_sequences()) : nearest));
  }
  return is_yaml(name_or_path) ? load_yaml(name_or_path, options) : load_model(name_or_path, options);
}

std::vector<std::string> known_sequences() { return sequence_names(); }

}  // namespace talisman::sequences
