// What did each frame cost, and how wrong was it? Curves by dygraphs below the map, over the same frames.

const kCurves = {
  cost: {label: "modelled ms", columns: ["modelled_ms", "modelled_drawing_ms"], names: ["frame", "drawing, as planned"]},
  polygons: {label: "polygons", columns: ["polygons_rendered", "polygons_reference"], names: ["drawn", "reference"]},
  texels: {label: "texels", columns: ["pixels_rendered", "pixels_reference"], names: ["drawn", "reference"]},
  error: {label: "error px", columns: ["max", "mean_geometric_px"], names: ["largest", "mean"]},
  memory: {label: "bytes", columns: ["sprite_bytes"], names: ["of the sprites shown"]},
  picture: {label: "FLIP", columns: ["quality_total_flip", "quality_reuse_flip"], names: ["against direct", "against reference"]},
  clock: {label: "measured ms", columns: ["plan_ms", "render_ms", "composite_ms", "io_ms"], names: ["plan", "render", "composite", "write"], timing: true},
};

// Which of them this run has.
function curvesOf(run) {
  return Object.keys(kCurves).filter((key) => {
    const table = kCurves[key].timing ? run.timing : run.frames;
    return key === "error" || table.has(kCurves[key].columns[0]);
  });
}

// Rows [frame, value, …]; null where a frame is not there.
function curveRows(run, key) {
  const {columns, timing} = kCurves[key], table = timing ? run.timing : run.frames;
  const frames = table.columns.get("frame").values || [], rows = new Map();
  for (let r = 0; r < frames.length; ++r)
    rows.set(frames[r], columns.map((name) => (name === "modelled_ms" && run.run.kind === "plan" ? null : name === "max" ? run.maxError[frames[r] - run.first] : table.value(name, r))));
  if (key === "error")
    for (let f = run.first; f <= run.last; ++f) if (!rows.has(f)) rows.set(f, [run.maxError[f - run.first], null]);
  const sorted = [...rows.entries()].sort((a, b) => a[0] - b[0]).map(([frame, values]) => [frame, ...values.map((v) => (Number.isNaN(v) ? null : v))]);
  return sorted.length > 0 ? sorted : [[run.first, ...columns.map(() => null)]];
}

class Curves {
  constructor(box, map) {
    Object.assign(this, {box, map, key: "cost"});
    // Over the curves, so that another frame does not draw them anew.
    this.here = element("div", {id: "curve-mark", "aria-hidden": "true"});
    box.addEventListener("click", (event) => { if (this.graph) this.choose(event); });
    map.moved.push((shown) => {
      if (this.graph) this.graph.updateOptions({dateWindow: [shown.from, shown.to]});
    });
  }
  // A build may come without the library; then there are no curves.
  async draw() {
    if (typeof Dygraph === "undefined") return;
    const run = this.map.run, {label, names, timing} = kCurves[this.key];
    if (timing) await run.timing.needAll();
    if (this.graph) this.graph.destroy();
    this.box.setAttribute("aria-label", `Curve of ${label} by frame: ${names.join(", ")}`);
    const quiet = css("--quiet"), narrow = this.map.labels;
    this.graph = new Dygraph(this.box, curveRows(run, this.key), {
      labels: ["frame", ...names], colors: [color("geometric"), color("policy"), color("visibility"), color("sampling")],
      dateWindow: [this.map.shown.from, this.map.shown.to], strokeWidth: 1.2, axisLineColor: css("--line"), gridLineColor: css("--line"),
      axisLabelFontSize: 11, rightGap: 0, includeZero: true, yRangePad: 9, legend: "always", labelsDiv: document.getElementById("curve-legend"),
      interactionModel: {}, animatedZooms: false, height: 110, width: this.map.width,
      axes: {y: {axisLabelWidth: narrow - 6, pixelsPerLabel: 28, axisLabelFormatter: shortNumber}, x: {drawAxis: false, drawGrid: false}},
      axisLabelColor: quiet,
      legendFormatter: (data) => (data.x === undefined ? "" : `${data.x}: `) + data.series.map((series) =>
        `<span class="swatch" style="background: ${series.color}"></span>${series.labelHTML}${series.yHTML === undefined ? "" : `: ${series.yHTML}`}`).join(" &nbsp; "),
      drawCallback: (graph) => this.placeMark(graph),
    });
    this.box.append(this.here);
  }
  // A click chooses the frame below it.
  choose(event) {
    const run = this.map.run, frame = Math.floor(this.graph.toDataXCoord(event.clientX - this.box.getBoundingClientRect().left));
    if (Number.isFinite(frame)) selection.set({frame: Math.max(run.first, Math.min(run.last, frame))});
  }
  placeMark(graph) {
    const x = graph.toDomXCoord(selection.frame), wide = Math.max(2, graph.toDomXCoord(selection.frame + 1) - x);
    this.here.style.left = `${x}px`;
    this.here.style.width = `${wide}px`;
    this.here.hidden = x < this.map.labels;
  }
  mark() {
    if (!this.graph) return;
    this.placeMark(this.graph);
    const rows = this.graph.numRows();
    let low = 0, high = rows - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.graph.getValue(middle, 0) < selection.frame) low = middle + 1;
      else high = middle;
    }
    if (rows > 0 && this.graph.getValue(low, 0) === selection.frame) this.graph.setSelection(low);
  }
}

function shortNumber(value) {
  for (const [size, unit] of [[1e9, "G"], [1e6, "M"], [1e4, "k"]])
    if (Math.abs(value) >= size) return `${Number((value / (size === 1e4 ? 1e3 : size)).toPrecision(3))} ${unit}`;
  return String(Number(Number(value).toPrecision(3)));
}
