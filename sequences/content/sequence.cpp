// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/sequence.h"

#include <algorithm>
#include <filesystem>

#include "layers/glob.h"
#include "sequences/content/asset_paths.h"
#include "sequences/content/bare_model.h"
#include "sequences/content/factoring/cuts.h"
#include "sequences/content/factoring/factoring.h"
#include "sequences/content/images/place_images.h"
#include "sequences/content/levels.h"
#include "sequences/content/nearest_word.h"
#include "sequences/content/own_settings.h"
#include "sequences/content/scene_builder.h"
#include "sequences/content/seams.h"
#include "sequences/content/sequence_file.h"
#include "sequences/files/number_text.h"
#include "sequences/files/quoted.h"
#include "sequences/files/utf8.h"

namespace talisman::sequences {

namespace {

bool is_yaml(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".yaml" || extension == ".yml";
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

/// The nearest name, or those whose end is near: "hul" is 'ship/hull'.
std::string did_you_mean_part(std::string glob, const std::vector<std::string>& parts) {
  std::erase(glob, '*');
  if (std::string nearest = did_you_mean(glob, parts); !nearest.empty()) return nearest;
  std::vector<std::string> ends, near;
  const std::string end = glob.substr(glob.rfind('/') + 1);
  const auto end_of = [](const std::string& part) { return part.substr(part.rfind('/') + 1); };
  for (const std::string& part : parts) ends.push_back(end_of(part));
  const std::string nearest = nearest_word(end, ends);
  for (const std::string& part : parts)
    if (!nearest.empty() && end_of(part) == nearest) near.push_back(part);
  return near.empty() ? "" : "; did you mean " + quoted(near);
}

/// "; did you mean 'ship/hull'", or what there is, of the first glob that matches no part; empty where all do.
std::string help_with_globs(const layers::Scene& scene, const std::vector<std::string>& globs) {
  std::vector<std::string> parts;
  for (const layers::Part& part : scene.parts) parts.push_back(part.name);
  for (const std::string& glob : globs) {
    if (std::any_of(parts.begin(), parts.end(),
                    [&](const std::string& part) { return layers::glob_matches(glob, part); }))
      continue;
    const std::string nearest = did_you_mean_part(glob, parts);
    return nearest.empty() ? "; parts are " + quoted(parts) : nearest;
  }
  return {};
}

void finish(Sequence& sequence, BuiltScene built, std::vector<layers::LayerSpec> specs) {
  sequence.layers = layers::factor(built.scene, specs);
  sequence.layer_specs = std::move(specs);
  sequence.warnings.insert(sequence.warnings.end(), built.warnings.begin(), built.warnings.end());
  sequence.notes.insert(sequence.notes.end(), built.notes.begin(), built.notes.end());
  sequence.content_files.insert(sequence.content_files.end(), built.files.begin(), built.files.end());
  if (const std::vector<std::string> parts = parts_in_no_layer(built.scene, sequence.layers); !parts.empty())
    sequence.warnings.push_back(sequence.file + ": " + std::to_string(parts.size()) +
                                (parts.size() == 1 ? " part is taken by no layer and is not drawn: "
                                                   : " parts are taken by no layer and are not drawn: ") +
                                quoted(parts));
  sequence.scene = std::make_shared<const layers::Scene>(std::move(built.scene));
  if (sequence.content.levels.value_or(sequence.regulator.lod.by != regulator::LodSelector::None))
    add_levels(sequence);
  if (!built.cells.cells.empty())
    sequence.cells = std::make_shared<const layers::CellSet>(std::move(built.cells));
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

/// The layers of a file that leaves them to us; images keep their own. What of the order was not always seen so is a
/// warning.
Factoring found_layers(Sequence& sequence, BuiltScene& built, const std::vector<ImageRecipe>& images,
                       const AutoLayers& options) {
  std::vector<layers::LayerSpec> kept = tagged_specs(built.scene, built.layer_tags);
  add_image_layers(images, kept);
  const std::size_t kept_count = kept.size();
  CutStudy with_cuts = study_with_cuts({built.scene, std::move(kept), {}, own_settings(sequence)}, options);
  FactoringStudy& study_of_layers = with_cuts.study;
  Factoring& found = study_of_layers.chosen;
  const std::size_t made = found.specs.size() - kept_count;
  if (!options.joins_to_limit() && made > static_cast<std::size_t>(options.limit()))
    throw InputError((options.way == FactoringWay::Motion
                          ? "layers: auto is 'motion', which makes a layer for each of " +
                                std::to_string(made) + " groups that move as one"
                          : "layers: auto is 'amortised', which begins with a layer for each of " +
                                std::to_string(made) + " parts") +
                         ", must be no more than max, which is " + std::to_string(options.limit()),
                     sequence.file);
  if (options.way == FactoringWay::Amortised) sequence.regulator.regroup.by = regulator::Regroup::Amortised;
  for (const std::string& line : hidden_in_words(found))
    sequence.warnings.push_back(sequence.file + ": " + line);
  const std::size_t looked_at = study_of_layers.instants.size();
  if (!found.order.empty() && looked_at < static_cast<std::size_t>(sequence.frames))
    sequence.notes.push_back(
        formatted("%zu pair%s of layers whose bounds know no order %s ordered as seen in %zu of %d frames",
                  found.order.size(), found.order.size() == 1 ? "" : "s",
                  found.order.size() == 1 ? "is" : "are", looked_at, sequence.frames));
  for (const CutEntry& cut : with_cuts.cuts)
    sequence.notes.push_back(formatted("part '%s' is cut into %d, with seam: auto: one warp would not serve",
                                       layers::name_of_glob(cut.parts).c_str(), cut.into));
  if (!with_cuts.cuts.empty()) {
    apply_cuts(with_cuts.cuts, built.scene);
    sequence.seam = Seam::Auto;  // else cracks open between what was whole
  }
  return std::move(found);
}

Sequence load_yaml(const std::string& path, const ContentOptions& options) {
  SequenceFile file = read_sequence_file(path);
  apply(options, path, file.recipe);
  file.recipe.times = {file.settings.fps, file.settings.frames, file.settings.display_px};
  BuiltScene built = build_scene(file.recipe);
  if (const std::string defect = layers::first_defect(built.scene); !defect.empty())
    throw InputError(defect, path);
  if (built.scene.parts.empty())
    throw InputError(
        "shows nothing, rule: at least one of shapes, models, images, terrain, sky, swarm and building",
        path);
  apply_cuts(file.cuts, built.scene);
  std::vector<layers::LayerSpec> specs;
  for (const LayerEntry& entry : file.layers) specs.push_back(entry.spec);
  Sequence sequence = std::move(file.settings);
  sequence.content = options;
  std::vector<SpecPair> found_order;
  if (file.auto_layers) {
    Factoring found = found_layers(sequence, built, file.recipe.images, *file.auto_layers);
    specs = std::move(found.specs);
    found_order = found.pairs();
  } else {
    if (specs.empty()) specs = specs_of_model(built.scene, built.layer_tags);
    add_image_layers(file.recipe.images, specs);
  }
  if (options.seam.value_or(sequence.seam) == Seam::Auto)
    add_seams(built.scene, seam_options(sequence), specs);
  finish(sequence, std::move(built), std::move(specs));
  if (!sequence.layers.defect.empty()) {
    file.settings.file = path;
    fail_at_layer(file, *sequence.scene, sequence.layers.defect);
  }
  sequence.explicit_order = resolve_layer_pairs(file.order, sequence.layers.layers);
  add_free_pairs(ids_of(found_order, sequence.layers), sequence.layers.layers, sequence.explicit_order);
  return sequence;
}

Sequence load_model(const std::string& path, const ContentOptions& options) {
  BareModel bare = read_bare_model(path, options);
  Sequence sequence;
  sequence.content = options;
  sequence.name = utf8_from(std::filesystem::path(path).stem().string());
  sequence.file = path;
  sequence.fps = bare.fps;
  sequence.frames = bare.frames;
  std::vector<layers::LayerSpec> specs = std::move(bare.specs);
  const std::vector<SpecPair> found_order = std::move(bare.order);
  add_model_view(bare.model.scene, specs, bare.view);
  for (const std::string& note : bare.model.notes) sequence.notes.push_back(path + ": " + note);
  BuiltScene built;
  built.scene = std::move(bare.model.scene);
  for (const std::string& warning : bare.model.warnings) built.warnings.push_back(path + ": " + warning);
  built.files = files_read(bare.model);
  finish(sequence, std::move(built), std::move(specs));
  if (!sequence.layers.defect.empty()) throw InputError(sequence.layers.defect, path);
  add_free_pairs(ids_of(found_order, sequence.layers), sequence.layers.layers, sequence.explicit_order);
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
