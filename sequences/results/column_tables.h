// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The column tables of all result files, and the rows that they are got from.
///
///   decisions   a line of decisions.jsonl, a row of decisions.csv      decision_columns.cpp
///   frames      a line of frames.jsonl, a row of frames.csv            frame_columns.cpp
///   layers      an entry of `layers` in summary.json, layers.csv       run_columns.cpp
///   effects     an entry of `effects` in summary.json, effects.csv     run_columns.cpp
///   run         summary.json, the one row of run.csv                   run_columns.cpp
///   audit       an entry of `audit` in summary.json                    audit_columns.cpp
///   timing      a line of timing.jsonl, a row of timing.csv            timing_columns.cpp

#include "sequences/results/columns.h"
#include "sequences/results/frame_lines.h"
#include "sequences/results/summary.h"

namespace talisman::sequences {

/// A layer, or a shadow map, at one frame. Keeps references.
struct DecisionRow {
  DecisionRow(const FrameReport& report, const regulator::LayerDecision& of_layer,
              const layers::SpritePlacement* sprite_placement = nullptr)
      : frame(report.frame),
        name(report.layers[of_layer.layer].name),
        assessment(report.assessments[of_layer.layer]),
        decision(of_layer),
        placement(sprite_placement),
        late(report.late ? &*report.late : nullptr) {}
  DecisionRow(const FrameReport& report, const ShadowMapRow& map)
      : frame(report.frame), name(map.name), assessment(map.assessment), decision(map.decision) {}

  int frame;
  const std::string& name;
  const regulator::LayerAssessment& assessment;
  const regulator::LayerDecision& decision;
  const layers::SpritePlacement* placement =
      nullptr;                        ///< of the sprite shown; null: none is, or it is a map's
  const LateDisplay* late = nullptr;  ///< null: no pose is old, or it is a map's
};

/// All rows of a frame, in the order of decisions.jsonl: the author's layers, the aggregates that exist, the
/// shadow maps.
std::vector<DecisionRow> decision_rows(const PipelineState& state, const FrameReport& report);

struct LayerRow {
  const LayerSummary& layer;
  int frames = 0;  ///< of the run
  double share_of_cost = 0;
};

struct EffectRow {
  const layers::EffectCall& effect;
  int passes = 0;
};

/// A run with what is added up over its frames once. Keeps a reference.
struct RunRow {
  explicit RunRow(const Summary& summary);
  const Summary& summary;
  FrameTotals sums;
  VisibilityTotals visibility;
  ResolvedCounters resolved;
  GapSummary gap;
  std::optional<CompressionReport> compression;  ///< of a run that drew compressed sprites
  std::optional<MeanQuality> quality, quality_of_reuse, quality_of_resampling;
};

const ColumnTable<DecisionRow>& decision_table();
const ColumnTable<FrameLine>& frame_table();
const ColumnTable<LayerRow>& layer_table();
const ColumnTable<EffectRow>& effect_table();
const ColumnTable<RunRow>& run_table();
const ColumnTable<FrameLine>& timing_table();
const ColumnTable<LayerAudit>& audit_table();

}  // namespace talisman::sequences
