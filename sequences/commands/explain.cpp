// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/explain.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <ostream>

#include <nlohmann/json.hpp>

#include "sequences/content/nearest_word.h"
#include "sequences/content/value_type.h"
#include "sequences/files/errors.h"
#include "sequences/files/folders.h"
#include "sequences/files/number_text.h"
#include "sequences/results/explained_frame.h"
#include "sequences/results/explanation.h"
#include "sequences/results/flip_threshold.h"
#include "sequences/results/layer_words.h"
#include "sequences/results/settings_json.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

int frame_asked_for(const ExplainOptions& options) {
  if (!options.frame) throw InputError("--frame is required: the number of the frame that is explained");
  if (*options.frame < 0)
    throw InputError("--frame is " + std::to_string(*options.frame) + ", must be at least 0");
  return *options.frame;
}

const LayerHistory& layer_asked_for(const std::string& name, const std::vector<LayerHistory>& layers) {
  std::vector<std::string> names;
  for (const LayerHistory& layer : layers) {
    if (layer.layer == name) return layer;
    names.push_back(layer.layer);
  }
  throw InputError("--layer is '" + name + "', must be a layer of the frame: " + listed(names) +
                   did_you_mean(name, names));
}

/// What is said of a layer whose work is done elsewhere.
std::string hint_of(const LayerHistory& layer) {
  const std::string reason = layer.line.at("reason").get<std::string>();
  if (reason.rfind("merged into ", 0) != 0) return {};
  const std::string into = reason.substr(12, reason.find(':') - 12);
  return "  (the merged sprite: --layer '" + into + "')\n";
}

layers::dvec2 worst_place(const LayerHistory& layer) {
  const Json::json_pointer place("/fiducials/worst_at_px");
  if (!layer.line.contains(place) || layer.line.at(place).is_null()) return {0, 0};
  return {layer.line.at(place).at(0).get<double>(), layer.line.at(place).at(1).get<double>()};
}

std::string write_sheet(const std::string& folder, const LayerHistory& layer, const LayerPictures& pictures) {
  prepare_folder(folder);
  const int frame = layer.line.at("frame").get<int>();
  std::string file = folder + "/" + picture_of(frame, layer.layer);
  const std::vector<std::string> title = {
      layer.layer + ", frame " + std::to_string(frame) + ": " + layer.line.at("decision").get<std::string>(),
      layer.line.at("reason").get<std::string>(), "the cross is where the geometric error is largest"};
  write_png(file, explanation_sheet(title, pictures, worst_place(layer)));
  return file;
}

int explain_folder(const ExplainOptions& options, std::ostream& out) {
  const int frame = frame_asked_for(options);
  if (!options.others.empty())
    throw InputError(options.others.front() + " is an option of a run, and " + options.line.sequence +
                     " is one already, must be given with a SEQUENCE");
  Json settings;
  const ExplainedFrame explained = explained_folder(options.line.sequence, frame, settings);
  const std::string title = options.line.sequence + ", frame " + std::to_string(frame) + " of 0-" +
                            std::to_string(explained.last_planned) + ", policy " +
                            settings.at("policy").get<std::string>() + "\n\n";
  if (options.layer.empty()) {
    out << title + overview_of(explained.layers);
    return kSuccess;
  }
  const LayerHistory& layer = layer_asked_for(options.layer, explained.layers);
  out << title + explanation_of(layer, settings) + hint_of(layer);
  return kSuccess;
}

int explain_sequence(const ExplainOptions& options, std::ostream& out) {
  const int frame = frame_asked_for(options);
  const Sequence sequence = load_with_warnings(options.line);
  const ResolvedRun run = resolve(options.line, sequence, true);
  if (frame >= sequence.frames)
    throw InputError("--frame is " + std::to_string(frame) + ", must be at most " +
                     std::to_string(sequence.frames - 1));
  const ExplainedFrame explained = explained_frame(sequence, run.settings, frame, options.layer);
  const std::string title = sequence.name + ", frame " + std::to_string(frame) + " of 0-" +
                            std::to_string(sequence.frames - 1) + ", policy " +
                            std::string(regulator::name(run.settings.regulator.policy)) + "\n\n";
  if (options.layer.empty()) {
    out << title + overview_of(explained.layers);
    return kSuccess;
  }
  const LayerHistory& layer = layer_asked_for(options.layer, explained.layers);
  out << title << explanation_of(layer, json_of(run.settings)) << hint_of(layer);
  out << "  threshold        " << text_of(flip_threshold_of(sequence, run.settings, layer)) << "\n";
  if (explained.pictures) {
    const std::string folder =
        options.line.out.empty() ? "out/" + sequence.name + "-explain" : options.line.out;
    const std::string sheet = write_sheet(folder, layer, *explained.pictures);
    out << "\n" << sheet << "\n";
  }
  return kSuccess;
}

}  // namespace

int run_explain(const ExplainOptions& options, std::ostream& out) {
  std::error_code error;
  const bool is_folder = std::filesystem::exists(options.line.sequence + "/run.json", error);
  if (!is_folder) return explain_sequence(options, out);
  try {
    return explain_folder(options, out);
  } catch (const Json::exception&) {
    throw InputError("run.json or decisions.jsonl is not as a run writes it", options.line.sequence);
  }
}

}  // namespace talisman::sequences
