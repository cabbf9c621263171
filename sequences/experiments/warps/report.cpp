// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/warps/report.h"

#include <array>
#include <ostream>

#include "sequences/files/atomic_file.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {
namespace {

using warp::Curve;

std::string text_of(Curve curve) { return std::string(warp::name(curve)); }

/// Of a figure or of a run in pictures.
template <typename Shown>
const WarpObject& object_of(const WarpReport& report, const Shown& shown) {
  return report.objects[shown.object];
}

std::string file_of(const WarpReport& report, const RateFigure& figure) {
  return object_of(report, figure).name + "-" + figure.motion.name;
}

std::string title_of(const WarpReport& report, const RateFigure& figure) {
  return object_of(report, figure).title + ", " + figure.motion.title;
}

// --- Tables of numbers

std::string csv_of_rates(const WarpReport& report) {
  std::string csv = "object,motion,curve,threshold_px,renders,frames,update_rate\n";
  for (const RateFigure& figure : report.figures)
    for (const UpdateCurve& curve : figure.curves)
      for (std::size_t t = 0; t < report.thresholds.size(); ++t)
        csv += object_of(report, figure).name + "," + figure.motion.name + "," + text_of(curve.curve) + "," +
               fixed(report.thresholds[t], 6) + "," + std::to_string(curve.renders[t]) + "," +
               std::to_string(kMotion_frames) + "," + fixed(curve.renders[t] / double(kMotion_frames), 6) +
               "\n";
  return csv;
}

std::string csv_of_quality(const WarpReport& report) {
  std::string csv = "object,curve,threshold_px,renders,frames,psnr_db,ssim,flip\n";
  for (const QualityRun& run : report.qualities)
    for (const CurveQuality& q : run.curves)
      csv += object_of(report, run).name + "," + text_of(q.curve) + "," + fixed(q.threshold_px, 6) + "," +
             std::to_string(q.renders) + "," + std::to_string(report.rate.frames) + "," +
             fixed(q.mean.psnr_db, 4) + "," + fixed(q.mean.ssim, 6) + "," + fixed(q.mean.flip, 6) + "\n";
  return csv;
}

Plot plot_of(const WarpReport& report, const RateFigure& figure) {
  return update_rate_plot(title_of(report, figure), report.thresholds, figure.curves);
}

// --- The page

PageTable table_of(const std::vector<Statement>& statements) {
  PageTable table{{"the paper", "this run (update rate relative to aff)", "agreement"}, {}, 3};
  for (const Statement& s : statements)
    table.rows.push_back({s.paper, s.ours, std::string(name(s.agreement))});
  return table;
}

PageTable table_of(const Ranking& ranking) {
  PageTable table{{"curve", "update rate relative to aff"}, {}, 1};
  for (const CurveMerit& merit : ranking.merits)
    table.rows.push_back({text_of(merit.curve), fixed(merit.ratio, 3)});
  return table;
}

/// The paper's figure 15 is the flat teapot.
bool is_flat(const WarpObject& object) { return object.name.rfind("flat", 0) == 0; }

PageTable agreement_table(const WarpReport& report, const RateFigure& figure) {
  return table_of(is_flat(object_of(report, figure)) ? compare_with_figure_15(figure.ranking)
                                                     : compare_with_figure_16(figure.ranking));
}

void add_main_figure(Page& page, const WarpReport& report, const RateFigure& figure) {
  page.blocks.push_back(Heading{3, object_of(report, figure).title});
  page.blocks.push_back(Figure{file_of(report, figure) + ".svg", title_of(report, figure)});
  page.blocks.push_back(Paragraph{"Clusters, most renders first: " + in_words(figure.ranking) + "."});
  if (!figure.studied) return;
  page.blocks.push_back(agreement_table(report, figure));
  page.blocks.push_back(table_of(figure.ranking));
}

PageTable table_of_motions(const WarpReport& report) {
  constexpr std::array shown = {Curve::trn,  Curve::iso, Curve::so,   Curve::pers,
                                Curve::affi, Curve::per, Curve::per2, Curve::per2i};
  PageTable table{{"object", "motion", "clusters, most renders first"}, {}, 3};
  for (const Curve curve : shown) table.header.push_back(text_of(curve));
  for (const RateFigure& figure : report.figures) {
    std::vector<std::string> row{object_of(report, figure).title, figure.motion.title,
                                 in_words(figure.ranking)};
    for (const Curve curve : shown)
      row.push_back(figure.ranking.thresholds_used > 0 ? fixed(figure.ranking.ratio(curve), 2) : "-");
    table.rows.push_back(row);
  }
  return table;
}

PageTable table_of(const QualityRun& run) {
  PageTable table{{"curve", "threshold px", "renders", "PSNR dB", "SSIM", "FLIP", "worst FLIP"}, {}, 1};
  for (const CurveQuality& q : run.curves)
    table.rows.push_back({text_of(q.curve), fixed(q.threshold_px, 3), std::to_string(q.renders),
                          fixed(q.mean.psnr_db, 2), fixed(q.mean.ssim, 4), fixed(q.mean.flip, 4),
                          fixed(q.worst.flip, 4)});
  return table;
}

void add_first_series(Page& page, const WarpReport& report) {
  page.blocks.push_back(Heading{2, "Update rate against error threshold"});
  page.blocks.push_back(Paragraph{
      "Update rate: share of " + std::to_string(kMotion_frames) +
      " frames in which the object had to be drawn again, at 1024 × 1024, without a pixel being drawn. "
      "The order is that of the mean logarithm of the update rate relative to aff, over the thresholds at "
      "which not all curves render equally often; neighbours closer than " +
      fixed(100 * kAlike, 0) +
      " % are one cluster. A curve's name with i minimises the maximum error, one without the sum of "
      "squares. The paper's motions are not published, so what can agree is order and clusters."});
  for (const RateFigure& figure : report.figures)
    if (figure.main) add_main_figure(page, report, figure);
  page.blocks.push_back(Heading{2, "All objects and motions"});
  page.blocks.push_back(
      Paragraph{"Numbers are update rates relative to aff; a dash: no threshold tells the "
                "curves apart."});
  page.blocks.push_back(table_of_motions(report));
  for (const RateFigure& figure : report.figures)
    if (!figure.main)
      page.blocks.push_back(Figure{file_of(report, figure) + ".svg", title_of(report, figure)});
}

void add_second_series(Page& page, const WarpReport& report) {
  page.blocks.push_back(Heading{2, "Picture quality at one update rate"});
  page.blocks.push_back(
      Paragraph{"Each curve gets the smallest threshold at which it draws at most " +
                fixed(100 * report.rate.update_rate, 0) + " % of " + std::to_string(report.rate.frames) +
                " frames of the main motion, " + fixed(report.rate.fps, 0) + " per second, at " +
                std::to_string(report.rate.display_px.x) + " × " + std::to_string(report.rate.display_px.y) +
                "; mean over all frames against the policy reference. The paper judged by eye: affine is "
                "better than the less general warps, and perspective brings no improvement."});
  for (const QualityRun& run : report.qualities) {
    page.blocks.push_back(Heading{3, object_of(report, run).title});
    page.blocks.push_back(table_of(run));
  }
}

Page page_of(const WarpReport& report) {
  Page page;
  page.title = "Comparison of warps";
  page.file = "report.html";
  page.blocks.push_back(
      Paragraph{"After Lengyel and Snyder 1997, section 4.2, figures 15 and 16. Characteristic points: " +
                report.bound + "."});
  for (const MissingObject& object : report.missing)
    page.blocks.push_back(Paragraph{"Left out: " + object.why + "."});
  add_first_series(page, report);
  add_second_series(page, report);
  return page;
}

}  // namespace

Plot update_rate_plot(const std::string& title, const std::vector<double>& thresholds_px,
                      const std::vector<UpdateCurve>& curves) {
  // A curve and its maximum-norm (or refined) partner share a colour, the partner is dashed.
  constexpr std::array order = {Curve::trn,  Curve::so,    Curve::aff,  Curve::per,  Curve::pers,
                                Curve::iso,  Curve::per2,  Curve::trni, Curve::soi,  Curve::affi,
                                Curve::peri, Curve::pers2, Curve::isoi, Curve::per2i};
  constexpr std::size_t kColors = order.size() / 2;
  Plot plot;
  plot.title = title;
  plot.x = {"error threshold", "px", true};
  plot.y = {"update rate", "%", false};
  for (std::size_t place = 0; place < order.size(); ++place)
    for (const UpdateCurve& curve : curves) {
      if (curve.curve != order[place]) continue;
      PlotSeries series{text_of(curve.curve), {}, SeriesStyle::LinePoints};
      series.color = static_cast<int>(place % kColors);
      for (std::size_t t = 0; t < thresholds_px.size(); ++t)
        series.points.push_back({thresholds_px[t], 100.0 * curve.renders[t] / kMotion_frames});
      plot.series.push_back(series);
    }
  return plot;
}

void write_report(const WarpReport& report, const std::string& dir) {
  write_text_atomically(dir + "/warps.csv", csv_of_rates(report));
  write_text_atomically(dir + "/quality.csv", csv_of_quality(report));
  for (const RateFigure& figure : report.figures)
    write_plot(dir, file_of(report, figure), plot_of(report, figure));
  const Page page = page_of(report);
  write_text_atomically(dir + "/warps.md", markdown(page));
  write_page(page, dir);
}

void print_report(const WarpReport& report, std::ostream& out) {
  for (const RateFigure& figure : report.figures)
    if (figure.main) out << object_of(report, figure).title << ": " << in_words(figure.ranking) << "\n";
  for (const RateFigure& figure : report.figures)
    if (figure.main && figure.studied)
      out << "\n"
          << object_of(report, figure).title << " against "
          << (is_flat(object_of(report, figure)) ? "figure 15" : "figure 16") << "\n"
          << plain_text(agreement_table(report, figure));
  for (const QualityRun& run : report.qualities)
    out << "\n"
        << object_of(report, run).title << " at " << fixed(100 * report.rate.update_rate, 0) << " % renders\n"
        << plain_text(table_of(run));
  for (const MissingObject& object : report.missing) out << "left out: " << object.why << "\n";
}

}  // namespace talisman::sequences
