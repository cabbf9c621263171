// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A sequence: a scene, its layers and how it is filmed. It is read from a YAML file under sequences/<name>/
/// (or the user's own) or made up around a bare model file (one layer per moving or top-level node, and what
/// default_view.h adds).

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "chunker/compression.h"
#include "layers/layer.h"
#include "layers/polyhedron.h"
#include "layers/sprite_transform.h"
#include "regulator/plan.h"
#include "sequences/files/errors.h"
#include "sequences/pipeline/culling/visibility.h"
#include "sequences/pipeline/frame_order.h"

namespace talisman::layers {
struct CellSet;  // layers/cells.h
}  // namespace talisman::layers

namespace talisman::sequences {

/// Some eleven hours at 24 frames a second.
inline constexpr int kLongestRun_frames = 1'000'000;

/// Are layers that share an edge drawn beyond it, so that no crack opens (layers/seam.h)?
enum class Seam {
  None,  ///< as the scene is; terrain has its own overlap
  Auto,  ///< as far as the threshold lets warps open it
};

/// What is said on the command line about content. What is said goes before the keys of a sequence file.
struct ContentOptions {
  std::vector<std::string> assets = {};  ///< folders in whose trees files that models name may lie
  std::optional<double> exposure_lx =
      {};  ///< > 0; the illuminance that shows 1 on white that faces the light
  std::optional<double> turntable_s = {};  ///< > 0; one turn of the orbiting camera
  bool stage = true;                       ///< bare models stand on a ground, before a backdrop
  std::optional<Seam> seam = {};
  std::optional<bool> levels = {};  ///< parts get levels of detail
  /// Of the run, where it is not the file's: how far seams reach depends on both.
  std::optional<double> geometric_px = {};
  std::optional<layers::ivec2> display_px = {};
  bool operator==(const ContentOptions&) const = default;
};

struct Sequence {
  std::string name;  ///< "canyon", or the model's file name without extension
  std::string file;  ///< what was read
  /// Every file whose content the sequence depends on, in the order in which it was opened: `file`, those that
  /// it extends, models and what they refer to, textures, terrain and lists. One that is used twice may be
  /// listed twice.
  std::vector<std::string> content_files;
  int frames = 0;   ///< ≥ 1
  double fps = 24;  ///< > 0; frame f is at f / fps seconds
  layers::ivec2 display_px{1024, 1024};
  Seam seam = Seam::None;
  std::shared_ptr<const layers::Scene> scene;
  std::vector<layers::LayerSpec> layer_specs;  ///< what the author, or the model, asks for
  layers::LayerSet layers;                     ///< layers::factor of both
  std::vector<layers::ExplicitPair> explicit_order;
  Cycles cycles = Cycles::Merge;
  Compositor compositor = Compositor::Talisman;
  layers::BoundKind bound = layers::BoundKind::Box8;
  int material_points = layers::kDefaultMaterialPoints;
  layers::ExtentOptions extents;
  layers::PlacementOptions placement;
  std::optional<chunker::CompressionOptions> compression;  ///< empty: sprites are kept as they are
  std::optional<double> clip_margin;                       ///< View::clip_margin where the file sets it
  regulator::RegulatorOptions regulator;         ///< defaults of the sequence; the command line overrides
  std::string warp = "aff";                      ///< curve name
  VisibilityOptions visibility;                  ///< which tests decide what is drawn at all
  std::shared_ptr<const layers::CellSet> cells;  ///< null: none
  std::vector<std::string> warnings;             ///< missing textures and the like, one line each
  std::vector<std::string> notes;                ///< what was decided where the model leaves it open
  ContentOptions content;                        ///< with which it was read
};

/// Reads a sequence by name ("canyon", also "canyon/background" for a variant file
/// sequences/canyon/background.yaml), by the path of a YAML file, or a model by the path of any file the
/// importer reads. Throws InputError.
Sequence load_sequence(const std::string& name_or_path, const ContentOptions& options = {});

/// Names of the sequences that ship with the tool.
std::vector<std::string> known_sequences();

}  // namespace talisman::sequences
