// SPDX-License-Identifier: Apache-2.0

/// What does our renderer's work cost, term by term? Fits the profile `software-1` (regulator/profile.h) and tells how far
/// it is off where it was not fitted. Prints the terms as they are committed; nothing reads them from here.
///
///   fit_profile [FRAMES [DRAWS.csv]]      FRAMES of each sequence, 4
///
/// Each layer of those frames is drawn kRounds times by one thread, all layers in turn, so that what slows the machine for
/// a second does not slow all rounds of one draw. Before each draw a sphere that is always the same is drawn: thread time
/// is divided by that of the sphere, and multiplied by the sphere's least; so the figures are those of the machine when
/// nothing else runs on it. The median of the rounds after the first counts. Draws of less than kLeast_ms are left out.
///
///   minimise   Σ h((Σ terms · work - ms) / ms)    terms ≥ 0, h: Huber's, so that few odd draws do not decide
///
/// by Ceres. Error: |modelled - measured| / measured, of draws, and of frames (the sum of their draws).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <ceres/ceres.h>
#include <tbb/global_control.h>

#include "layers/part_box.h"
#include "layers/region.h"
#include "regulator/profile.h"
#include "sequences/content/own_settings.h"
#include "sequences/content/sequence.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/lod/levels_now.h"
#include "sequences/pipeline/shade_passes.h"
#include "sequences/pipeline/step.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using regulator::DrawWork;
using regulator::kDrawTerms;

constexpr int kRounds = 10;
constexpr double kLeast_ms = 0.1, kOddFrom = 0.1;
constexpr std::array kFitted = {"canyon", "canyon/1997", "hall", "park", "chicken", "carousel"};
constexpr std::array kHeldOut = {"barnyard", "hall/turn", "headset", "fearing/blocks", "stage"};

double thread_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// One layer in one frame.
struct MeasuredDraw {
  std::string sequence, layer;
  int frame = 0;
  DrawWork work{};
  double ms = 0;  ///< in units of the yardstick until all are measured
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * double(values.size())))];
}

/// A sphere of 2,000 triangles in 128².
class Yardstick {
 public:
  Yardstick() { placement_.size_px = {128, 128}; }
  double measure() {
    const double begin = thread_ms();
    chunker::render(prepared_, frame_, std::vector<int>{0}, placement_.size_px, placement_);
    const double ms = thread_ms() - begin;
    all_.push_back(ms);
    return ms;
  }
  double least_ms() const { return quantile(all_, 0.02); }

 private:
  layers::Scene scene_ = tests::displaced_sphere_scene(2000);
  chunker::PreparedScene prepared_{scene_};
  layers::SceneFrame frame_ = scene_.at(0);
  layers::SpritePlacement placement_;
  std::vector<double> all_;
};

/// What its counters do not say of a draw.
struct Makeup {
  double vertices = 0, triangles = 0, lit = 0, highlit = 0;  ///< in sight
};

Makeup makeup_of(const layers::SceneFrame& frame, const layers::Layer& layer, layers::ivec2 display_px) {
  const layers::Scene& scene = *frame.scene;
  const layers::Region region = layers::view_region(frame.camera, display_px, 0);
  Makeup makeup;
  for (const int index : layer.parts) {
    const layers::Part& part = scene.parts[index];
    const layers::Mesh& mesh = scene.meshes[part.mesh];
    const layers::Box3 box = layers::part_box(frame, part, layers::mesh_box(mesh));
    if (layers::RegionTest(region, layers::reach_of({&box, 1})).misses(box)) continue;  // its vertices rest
    const layers::Material& m = scene.materials[part.material];
    const auto count = static_cast<double>(mesh.triangle_count());
    makeup.triangles += count;
    makeup.vertices += static_cast<double>(mesh.positions.size());
    if (m.unlit) continue;
    makeup.lit += count;
    if (m.shininess > 0 && m.specular != layers::vec3(0)) makeup.highlit += count;
  }
  return makeup;
}

DrawWork work_of(const layers::SceneFrame& frame, const layers::Layer& layer, layers::ivec2 display_px,
                 const chunker::RenderCounters& c) {
  using layers::LayerKind;
  const Makeup makeup = makeup_of(frame, layer, display_px);
  const auto lights = static_cast<double>(
      std::count_if(frame.scene->lights.begin(), frame.scene->lights.end(),
                    [](const layers::Light& light) { return light.kind != layers::Light::Kind::Ambient; }));
  const double all = std::max(makeup.triangles, 1.0);
  const bool is_dark = layer.kind == LayerKind::Reflection || layer.kind == LayerKind::Specular;
  const bool has_highlights = layer.kind == LayerKind::Geometry || layer.kind == LayerKind::Specular;
  regulator::DrawCounts counts;
  counts.vertices = makeup.vertices;
  counts.polygons = static_cast<double>(c.polygons_drawn);
  counts.pixels = static_cast<double>(c.pixels_filled);
  counts.lights = is_dark ? 0 : makeup.lit / all * lights;
  counts.highlights = has_highlights ? makeup.highlit / all * lights : 0;
  counts.texture_lookups = static_cast<double>(c.texture_samples);
  counts.shadow_lookups = static_cast<double>(c.shadow_lookups);
  return regulator::draw_work(counts);
}

/// The layers of some frames of a sequence, each in turn, round after round.
class SequenceDraws {
 public:
  SequenceDraws(const std::string& name, int frames, Yardstick& yardstick)
      : sequence_(load_sequence(name)),
        pipeline_(make_pipeline(*sequence_.scene, sequence_.layers, settings())),
        prepared_(*sequence_.scene, pipeline_.settings.render),
        state_(pipeline_),
        yardstick_(yardstick) {
    for (int k = 0; k < frames; ++k) add_frame((2 * k + 1) * sequence_.frames / (2 * frames), name);
  }

  std::vector<MeasuredDraw> measure() {
    for (int round = 0; round < kRounds; ++round)
      for (std::size_t i = 0; i < draws_.size(); ++i) draw(i, round > 0);
    for (std::size_t i = 0; i < draws_.size(); ++i) draws_[i].ms = median(times_[i]);
    return draws_;
  }

 private:
  struct Wanted {
    layers::Layer layer;
    layers::SpritePlacement placement;
    std::size_t scene = 0;
  };

  Settings settings() const {
    Settings settings = own_settings(sequence_);
    settings.regulator = {};
    settings.regulator.policy = regulator::Policy::Reference;
    return settings;
  }

  void add_frame(int frame, const std::string& name) {
    const FrameReport report = step(pipeline_, state_, frame, nullptr);
    scenes_.push_back(scene_at(pipeline_, frame));
    maps_.emplace_back();
    for (const regulator::LayerDecision& d : report.plan.decisions) {
      if (d.action != regulator::Action::Rerender) continue;
      const LayerMemory& memory = state_.memory[d.layer];
      wanted_.push_back(
          {drawn_layer(pipeline_, state_.layers[d.layer], memory), memory.placement, scenes_.size() - 1});
      draws_.push_back({name, wanted_.back().layer.name, frame, {}, 0});
    }
    times_.resize(draws_.size());
  }

  void draw(std::size_t i, bool counts) {
    const Wanted& wanted = wanted_[i];
    const double unit = yardstick_.measure(), begin = thread_ms();
    const chunker::RenderResult result =
        draw_layer({pipeline_, state_.layers, maps_[wanted.scene], prepared_, scenes_[wanted.scene]},
                   wanted.layer, wanted.placement);
    const double ms = thread_ms() - begin;
    if (counts) times_[i].push_back(ms / unit);
    if (!counts)
      draws_[i].work =
          work_of(scenes_[wanted.scene], wanted.layer, pipeline_.settings.view.display_px, result.counters);
  }

  Sequence sequence_;
  Pipeline pipeline_;
  chunker::PreparedScene prepared_;
  PipelineState state_;
  Yardstick& yardstick_;
  std::vector<layers::SceneFrame> scenes_;
  std::vector<ShadowMapStore> maps_;
  std::vector<Wanted> wanted_;
  std::vector<MeasuredDraw> draws_;
  std::vector<std::vector<double>> times_;
};

/// (modelled - measured) / measured of one draw.
struct RelativeError {
  MeasuredDraw draw;
  template <typename T>
  bool operator()(const T* terms, T* residual) const {
    T ms(0);
    for (std::size_t k = 0; k < kDrawTerms; ++k) ms += terms[k] * (draw.work[k] * 1e-6);
    residual[0] = ms / draw.ms - 1.0;
    return true;
  }
};

DrawWork fitted_terms(const std::vector<MeasuredDraw>& draws) {
  DrawWork terms;
  terms.fill(1);
  ceres::Problem problem;
  for (const MeasuredDraw& draw : draws)
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<RelativeError, 1, static_cast<int>(kDrawTerms)>(
                                 new RelativeError{draw}),
                             new ceres::HuberLoss(kOddFrom), terms.data());
  for (int k = 0; k < static_cast<int>(kDrawTerms); ++k) problem.SetParameterLowerBound(terms.data(), k, 0);
  ceres::Solver::Options options;
  options.max_num_iterations = 2000;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return terms;
}

void print_errors(const std::string& name, const std::vector<MeasuredDraw>& draws, const DrawWork& terms) {
  std::vector<double> of_draws, of_frames;
  std::map<std::pair<std::string, int>, std::pair<double, double>> frames;
  double modelled = 0, measured = 0;
  for (const MeasuredDraw& draw : draws) {
    const double ms = regulator::draw_ms(terms, draw.work);
    of_draws.push_back(std::fabs(ms - draw.ms) / draw.ms);
    auto& [frame_modelled, frame_measured] = frames[{draw.sequence, draw.frame}];
    frame_modelled += ms, frame_measured += draw.ms;
    modelled += ms, measured += draw.ms;
  }
  if (draws.empty()) return;
  for (const auto& [frame, ms] : frames) of_frames.push_back(std::fabs(ms.first - ms.second) / ms.second);
  std::printf("%-16s %6zu %10.1f %8.2f %9.1f %7.1f %10.1f %7.1f\n", name.c_str(), draws.size(), measured,
              modelled / measured, 100 * median(of_draws), 100 * quantile(of_draws, 0.95),
              100 * median(of_frames), 100 * quantile(of_frames, 0.95));
}

void write_draws(const char* file, const std::vector<MeasuredDraw>& draws) {
  std::FILE* out = std::fopen(file, "w");
  if (!out) {
    std::fprintf(stderr, "error: %s: cannot be written\n", file);
    std::exit(1);
  }
  std::fprintf(out, "sequence,frame,layer,ms");
  for (const std::string_view term : regulator::kDrawTermNames)
    std::fprintf(out, ",%s", std::string(term).c_str());
  for (const MeasuredDraw& draw : draws) {
    std::fprintf(out, "\n%s,%d,\"%s\",%.6f", draw.sequence.c_str(), draw.frame, draw.layer.c_str(), draw.ms);
    for (const double count : draw.work) std::fprintf(out, ",%.1f", count);
  }
  std::fprintf(out, "\n");
  std::fclose(out);
}

template <typename Names>
std::vector<MeasuredDraw> measured(const Names& names, int frames, Yardstick& yardstick) {
  std::vector<MeasuredDraw> all;
  for (const char* name : names) {
    for (MeasuredDraw& draw : SequenceDraws(name, frames, yardstick).measure())
      all.push_back(std::move(draw));
    std::fprintf(stderr, "%s\n", name);
  }
  return all;
}

void print_by_sequence(const char* what, const std::vector<MeasuredDraw>& draws, const DrawWork& terms) {
  std::map<std::string, std::vector<MeasuredDraw>> by_sequence;
  for (const MeasuredDraw& draw : draws) by_sequence[draw.sequence].push_back(draw);
  for (const auto& [name, own] : by_sequence) print_errors(name, own, terms);
  print_errors(what, draws, terms);
}

int fit(int frames, const char* csv) {
  Yardstick yardstick;
  yardstick.measure();
  std::vector<MeasuredDraw> fitted = measured(kFitted, frames, yardstick);
  std::vector<MeasuredDraw> held_out = measured(kHeldOut, frames, yardstick);
  const double unit = yardstick.least_ms();
  for (std::vector<MeasuredDraw>* draws : {&fitted, &held_out}) {
    for (MeasuredDraw& draw : *draws) draw.ms *= unit;
    std::erase_if(*draws, [](const MeasuredDraw& draw) { return draw.ms < kLeast_ms; });
  }
  if (csv) {
    std::vector<MeasuredDraw> all = fitted;
    all.insert(all.end(), held_out.begin(), held_out.end());
    write_draws(csv, all);
  }
  const DrawWork terms = fitted_terms(fitted);
  const DrawWork& committed = regulator::software_1().terms;
  std::printf("yardstick %.3f ms\n%-16s %10s %12s\n", unit, "ns per", "fitted", "committed");
  for (std::size_t k = 0; k < kDrawTerms; ++k)
    std::printf("%-16s %10.1f %12.1f\n", std::string(regulator::kDrawTermNames[k]).c_str(), terms[k],
                committed[k]);
  for (const auto& [whose, of] : {std::pair("fitted", &terms), std::pair("committed", &committed)}) {
    std::printf("\nerror of the %s terms, %%\n%-16s %6s %10s %8s %9s %7s %10s %7s\n", whose, "", "draws",
                "ms", "mod/meas", "draw med", "p95", "frame med", "p95");
    print_by_sequence("FITTED", fitted, *of);
    print_by_sequence("HELD OUT", held_out, *of);
  }
  return 0;
}

}  // namespace
}  // namespace talisman::sequences

int main(int argc, char** argv) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const int frames = argc > 1 ? std::atoi(argv[1]) : 4;
  if (frames < 1) {
    std::fprintf(stderr, "usage: fit_profile [FRAMES >= 1 [DRAWS.csv]]\n");
    return 2;
  }
  return talisman::sequences::fit(frames, argc > 2 ? argv[2] : nullptr);
}
