// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/warps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>

#include "sequences/commands/experiment_options.h"
#include "sequences/experiments/warps/objects.h"
#include "sequences/experiments/warps/quality.h"
#include "sequences/experiments/warps/ranking.h"
#include "sequences/files/atomic_file.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {
namespace {

using warp::Curve;

std::string text_of(Curve curve) { return std::string(warp::name(curve)); }

// --- What is run

struct RateFigure {
  const WarpObject* object;
  WarpMotion motion;
  std::vector<UpdateCurve> curves;
  Ranking ranking;
  std::string file() const { return object->name + "-" + motion.name; }
};

struct QualityRun {
  const WarpObject* object;
  std::vector<CurveQuality> curves;
};

struct Experiments {
  std::vector<WarpObject> objects;
  std::vector<MissingObject> missing;
  layers::BoundKind bound = layers::BoundKind::Box8;
  std::vector<double> thresholds = figure_thresholds();
  std::vector<RateFigure> figures;
  std::vector<QualityRun> qualities;
  RateOptions rate;
};

const WarpObject* find(const Experiments& e, const std::string& name) {
  for (const WarpObject& object : e.objects)
    if (object.name == name) return &object;
  return nullptr;
}

/// Those that are looked at in every motion and in pictures.
std::vector<const WarpObject*> studied(const Experiments& e) {
  if (e.objects.size() == 1) return {&e.objects.front()};
  std::vector<const WarpObject*> found;
  for (const auto& [first, second] : {std::pair{"flat-teapot", "flat-box"}, std::pair{"teapot", "box"}})
    for (const std::string name : {first, second})
      if (const WarpObject* object = find(e, name)) {
        found.push_back(object);
        break;
      }
  return found;
}

bool is_studied(const std::vector<const WarpObject*>& objects, const WarpObject& object) {
  return std::find(objects.begin(), objects.end(), &object) != objects.end();
}

/// The main motion of all objects, then the other motions of those that are studied.
std::vector<RateFigure> figures_to_draw(const Experiments& e) {
  const std::vector<WarpMotion> motions = warp_motions();
  const std::vector<const WarpObject*> main_objects = studied(e);
  std::vector<RateFigure> figures;
  for (const WarpObject* object : main_objects) figures.push_back({object, motions[0], {}, {}});
  for (const WarpObject& object : e.objects)
    if (!is_studied(main_objects, object)) figures.push_back({&object, motions[0], {}, {}});
  for (const WarpObject* object : main_objects)
    for (std::size_t k = 1; k < motions.size(); ++k) figures.push_back({object, motions[k], {}, {}});
  return figures;
}

void run_experiments(Experiments& e, ProgressKind progress_kind) {
  e.figures = figures_to_draw(e);
  const std::vector<const WarpObject*> in_pictures = studied(e);
  Progress progress(progress_kind, "warps", static_cast<int>(e.figures.size() + in_pictures.size()));
  for (RateFigure& figure : e.figures) {
    const layers::Scene scene = stage(*figure.object, figure.motion);
    figure.curves =
        update_curves(capture_animation(scene, kMotionFrames, kMotionFps, {}, e.bound), e.thresholds);
    figure.ranking = rank(figure.curves);
    progress.advance();
  }
  e.rate.bound = e.bound;
  for (const WarpObject* object : in_pictures) {
    e.qualities.push_back({object, quality_at_rate(stage(*object, warp_motions()[0]), e.rate)});
    progress.advance();
  }
}

// --- Tables of numbers

std::string csv_of_rates(const Experiments& e) {
  std::string csv = "object,motion,curve,threshold_px,renders,frames,update_rate\n";
  for (const RateFigure& figure : e.figures)
    for (const UpdateCurve& curve : figure.curves)
      for (std::size_t t = 0; t < e.thresholds.size(); ++t)
        csv += figure.object->name + "," + figure.motion.name + "," + text_of(curve.curve) + "," +
               fixed(e.thresholds[t], 6) + "," + std::to_string(curve.renders[t]) + "," +
               std::to_string(kMotionFrames) + "," + fixed(curve.renders[t] / double(kMotionFrames), 6) +
               "\n";
  return csv;
}

std::string csv_of_quality(const Experiments& e) {
  std::string csv = "object,curve,threshold_px,renders,frames,psnr_db,ssim,flip\n";
  for (const QualityRun& run : e.qualities)
    for (const CurveQuality& q : run.curves)
      csv += run.object->name + "," + text_of(q.curve) + "," + fixed(q.threshold_px, 6) + "," +
             std::to_string(q.renders) + "," + std::to_string(e.rate.frames) + "," +
             fixed(q.mean.psnr_db, 4) + "," + fixed(q.mean.ssim, 6) + "," + fixed(q.mean.flip, 6) + "\n";
  return csv;
}

Plot plot_of(const RateFigure& figure, const std::vector<double>& thresholds) {
  // Seven colours: a curve and its maximum-norm (or refined) partner share one, the partner is dashed.
  constexpr std::array order = {Curve::trn,  Curve::so,    Curve::aff,  Curve::per,  Curve::pers,
                                Curve::iso,  Curve::per2,  Curve::trni, Curve::soi,  Curve::affi,
                                Curve::peri, Curve::pers2, Curve::isoi, Curve::per2i};
  Plot plot;
  plot.title = figure.object->title + ", " + figure.motion.title;
  plot.x = {"error threshold", "px", true};
  plot.y = {"update rate", "%", false};
  for (const Curve wanted : order)
    for (const UpdateCurve& curve : figure.curves) {
      if (curve.curve != wanted) continue;
      PlotSeries series{text_of(wanted), {}, SeriesStyle::LinePoints};
      for (std::size_t t = 0; t < thresholds.size(); ++t)
        series.points.push_back({thresholds[t], 100.0 * curve.renders[t] / kMotionFrames});
      plot.series.push_back(series);
    }
  return plot;
}

// --- The page

Table table_of(const std::vector<Statement>& statements) {
  Table table{{"the paper", "this run (update rate relative to aff)", "agreement"}, {}, 3};
  for (const Statement& s : statements)
    table.rows.push_back({s.paper, s.ours, std::string(name(s.agreement))});
  return table;
}

Table table_of(const Ranking& ranking) {
  Table table{{"curve", "update rate relative to aff"}, {}, 1};
  for (const CurveMerit& merit : ranking.merits)
    table.rows.push_back({text_of(merit.curve), fixed(merit.ratio, 3)});
  return table;
}

bool is_flat(const WarpObject& object) { return object.name.rfind("flat", 0) == 0; }

void add_main_figure(Page& page, const RateFigure& figure, bool studied_object) {
  page.blocks.push_back(Heading{3, figure.object->title});
  page.blocks.push_back(Figure{figure.file() + ".svg", plot_of(figure, {}).title});
  page.blocks.push_back(Paragraph{"Clusters, most renders first: " + in_words(figure.ranking) + "."});
  if (!studied_object) return;
  page.blocks.push_back(table_of(is_flat(*figure.object) ? compare_with_figure_15(figure.ranking)
                                                         : compare_with_figure_16(figure.ranking)));
  page.blocks.push_back(table_of(figure.ranking));
}

Table table_of_motions(const std::vector<RateFigure>& figures) {
  constexpr std::array shown = {Curve::trn,  Curve::iso, Curve::so,   Curve::pers,
                                Curve::affi, Curve::per, Curve::per2, Curve::per2i};
  Table table{{"object", "motion", "clusters, most renders first"}, {}, 3};
  for (const Curve curve : shown) table.header.push_back(text_of(curve));
  for (const RateFigure& figure : figures) {
    std::vector<std::string> row{figure.object->title, figure.motion.title, in_words(figure.ranking)};
    for (const Curve curve : shown)
      row.push_back(figure.ranking.thresholds_used > 0 ? fixed(figure.ranking.ratio(curve), 2) : "-");
    table.rows.push_back(row);
  }
  return table;
}

Table table_of(const QualityRun& run) {
  Table table{{"curve", "threshold px", "renders", "PSNR dB", "SSIM", "FLIP", "worst FLIP"}, {}, 1};
  for (const CurveQuality& q : run.curves)
    table.rows.push_back({text_of(q.curve), fixed(q.threshold_px, 3), std::to_string(q.renders),
                          fixed(q.mean.psnr_db, 2), fixed(q.mean.ssim, 4), fixed(q.mean.flip, 4),
                          fixed(q.worst.flip, 4)});
  return table;
}

void add_first_series(Page& page, const Experiments& e) {
  page.blocks.push_back(Heading{2, "Update rate against error threshold"});
  page.blocks.push_back(Paragraph{
      "Update rate: share of " + std::to_string(kMotionFrames) +
      " frames in which the object had to be drawn again, at 1024 × 1024, without a pixel being drawn. The "
      "order "
      "is that of the mean logarithm of the update rate relative to aff, over the thresholds at which not "
      "all "
      "curves render equally often; neighbours closer than " +
      fixed(100 * kAlike, 0) +
      " % are one cluster. A curve's name with i minimises the maximum error, one without "
      "the sum of squares. The paper's motions are not published, so what can agree is order and clusters."});
  const std::vector<const WarpObject*> studied_objects = studied(e);
  for (const RateFigure& figure : e.figures)
    if (figure.motion.name == warp_motions()[0].name)
      add_main_figure(page, figure, is_studied(studied_objects, *figure.object));
  page.blocks.push_back(Heading{2, "All objects and motions"});
  page.blocks.push_back(
      Paragraph{"Numbers are update rates relative to aff; a dash: no threshold tells the "
                "curves apart."});
  page.blocks.push_back(table_of_motions(e.figures));
  for (const RateFigure& figure : e.figures)
    if (figure.motion.name != warp_motions()[0].name)
      page.blocks.push_back(Figure{figure.file() + ".svg", plot_of(figure, {}).title});
}

void add_second_series(Page& page, const Experiments& e) {
  page.blocks.push_back(Heading{2, "Picture quality at one update rate"});
  page.blocks.push_back(
      Paragraph{"Each curve gets the smallest threshold at which it draws at most " +
                fixed(100 * e.rate.update_rate, 0) + " % of " + std::to_string(e.rate.frames) +
                " frames of the main motion, " + fixed(e.rate.fps, 0) + " per second, at " +
                std::to_string(e.rate.display_px.x) + " × " + std::to_string(e.rate.display_px.y) +
                "; mean over all frames against the policy reference. The paper judged by eye: affine is "
                "better than the "
                "less general warps, and perspective brings no improvement."});
  for (const QualityRun& run : e.qualities) {
    page.blocks.push_back(Heading{3, run.object->title});
    page.blocks.push_back(table_of(run));
  }
}

Page page_of(const Experiments& e, const WarpsOptions& options) {
  Page page;
  page.title = "Comparison of warps";
  page.blocks.push_back(
      Paragraph{"After Lengyel and Snyder 1997, section 4.2, figures 15 and 16. Characteristic points: " +
                options.bound + "."});
  for (const MissingObject& object : e.missing)
    page.blocks.push_back(Paragraph{"Left out: " + object.why + "."});
  add_first_series(page, e);
  add_second_series(page, e);
  return page;
}

void write_results(const Experiments& e, const WarpsOptions& options) {
  const std::string& dir = options.out;
  write_text_atomically(dir + "/warps.csv", csv_of_rates(e));
  write_text_atomically(dir + "/quality.csv", csv_of_quality(e));
  for (const RateFigure& figure : e.figures) write_plot(dir, figure.file(), plot_of(figure, e.thresholds));
  const Page page = page_of(e, options);
  write_text_atomically(dir + "/warps.md", markdown(page));
  write_text_atomically(dir + "/report.html", html(page, dir));
}

void print_results(const Experiments& e, const WarpsOptions& options, std::ostream& out) {
  for (const RateFigure& figure : e.figures)
    if (figure.motion.name == warp_motions()[0].name)
      out << figure.object->title << ": " << in_words(figure.ranking) << "\n";
  for (const RateFigure& figure : e.figures) {
    if (figure.motion.name != warp_motions()[0].name || !is_studied(studied(e), *figure.object)) continue;
    const bool flat = is_flat(*figure.object);
    out << "\n"
        << figure.object->title << " against " << (flat ? "figure 15" : "figure 16") << "\n"
        << plain_text(table_of(flat ? compare_with_figure_15(figure.ranking)
                                    : compare_with_figure_16(figure.ranking)));
  }
  for (const QualityRun& run : e.qualities)
    out << "\n"
        << run.object->title << " at " << fixed(100 * e.rate.update_rate, 0) << " % renders\n"
        << plain_text(table_of(run));
  for (const MissingObject& object : e.missing) out << "left out: " << object.why << "\n";
  out << "\nresults in " << options.out << "\n";
}

}  // namespace

int run_warps(const WarpsOptions& options, std::ostream& out) {
  Experiments e;
  e.bound = bound_kind_from(options.bound);
  const ProgressKind progress = progress_kind_from(options.progress);
  if (options.object.empty())
    e.objects = load_warp_objects(e.missing);
  else
    e.objects.push_back(load_warp_object(options.object));
  create_folder(options.out);
  run_experiments(e, progress);
  write_results(e, options);
  print_results(e, options, out);
  return e.missing.empty() ? kSuccess : kPartialResult;
}

}  // namespace talisman::sequences
