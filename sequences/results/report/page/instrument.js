// The instrument: map, curves and panels put together. The report and the live view have the same.

function choice(label, words, chosen, change) {
  const select = element("select", {onchange: () => change(select.value)},
                         ...Object.entries(words).map(([value, text]) => element("option", {value, selected: value === chosen}, text)));
  return element("label", {}, `${label} `, select);
}

// What the colours of the map mean: kinds of decisions, or steps of the error up to `most` px.
function legend(mode, most) {
  const entry = (background, words) => {
    const swatch = element("span", {class: "swatch"});
    swatch.style.background = background;
    return element("li", {}, swatch, words);
  };
  const px = (k) => Number(((k * most) / 7).toPrecision(3));
  if (mode === "error") return [0, 1, 2, 3, 4, 5, 6].map((k) => entry(`var(--step-${k})`, k === 6 ? `${px(6)} to ${px(7)} px` : `from ${px(k)}`));
  if (mode === "difference")
    return [["var(--both)", "drawn in both"], [color("geometric"), "drawn here alone"], [color("policy"), "drawn there alone"], [color("reuse"), "drawn in neither"]].map((e) => entry(...e));
  return kKinds.map((kind) => entry(`var(--kind-${kind})`, kKindWords[kind]));
}

// The elements of the instrument, by name.
function layOut(runs) {
  const canvas = element("canvas", {id: "map", tabindex: "0", role: "img",
    "aria-label": "Map of layers by frames. Arrows choose a layer and a frame, plus and minus zoom; the table below has the chosen layer's decisions in words."});
  const parts = {canvas, tools: element("div", {class: "tools"}), curve: element("div", {id: "curve", role: "img"}),
                 frame: element("section", {id: "frame", class: "panel", "aria-label": "frame"}),
                 layers: element("section", {id: "layers-panel", class: "panel scrolls", tabindex: "0", "aria-label": "layers of the frame"}),
                 properties: element("section", {id: "properties", class: "panel", "aria-label": "decision", "aria-live": "polite"}),
                 spans: element("section", {id: "spans", class: "panel scrolls", tabindex: "0", "aria-label": "decisions of the layer"}),
                 goTo: element("input", {type: "number", id: "go-to", min: runs[0].first, max: runs[0].last, step: 1}),
                 legend: element("ul", {class: "legend"}), curveTools: element("div", {class: "tools"})};
  document.getElementById("instrument").append(
    element("div", {class: "left"}, parts.tools, element("div", {class: "map"}, canvas), parts.legend, parts.curveTools, parts.curve, parts.spans),
    element("div", {class: "right"}, parts.frame, parts.properties, parts.layers));
  return parts;
}

function addTools(parts, runs, map, curves) {
  const again = () => { map.rebuild(); };
  const modes = {reason: "reason", error: "error"};
  if (runs.length > 1) modes.difference = "A against B";
  const zoom = (text, label, act) => element("button", {type: "button", "aria-label": label, title: label, onclick: act}, text);
  // Enter: the first layer that was found.
  const chooseFirst = (event) => {
    if (event.key === "Enter" && map.rows.length > 0) selection.set({layer: map.run.layers[map.rows[0]]});
  };
  parts.goTo.addEventListener("change", () => selection.set({frame: Math.max(map.run.first, Math.min(map.run.last, Math.round(Number(parts.goTo.value))))}));
  parts.legend.replaceChildren(...legend(map.mode, 0));
  const middle = () => (selection.frame >= map.shown.from && selection.frame < map.shown.to ? selection.frame + 0.5 : (map.shown.from + map.shown.to) / 2);
  parts.tools.append(
    ...(runs.length > 1 ? [choice("run", {0: `A: ${runs[0].folder}`, 1: `B: ${runs[1].folder}`}, "0", (v) => selection.set({run: Number(v)}))] : []),
    choice("rows by", {cost: "cost", rate: "rate", error: "error", order: "order", name: "name", group: "group of names"}, "cost", (v) => { map.by = v; again(); }),
    choice("colours", modes, "reason", (v) => { map.mode = v; again(); parts.legend.replaceChildren(...legend(v, map.largestError())); }),
    element("label", {}, "find ", element("input", {type: "search", id: "find", size: "10", oninput: (e) => { map.filter = e.target.value; again(); }, onkeydown: chooseFirst})),
    element("label", {}, "frame ", parts.goTo),
    element("span", {class: "buttons"}, zoom("−", "see more frames", () => map.zoom(2, middle())), zoom("+", "see fewer frames", () => map.zoom(0.5, middle())),
            zoom("all", "see all frames", () => map.show(map.whole.from, map.whole.to))));
  const names = Object.fromEntries(curvesOf(runs[0]).map((key) => [key, kCurves[key].label]));
  parts.curveTools.append(choice("curve", names, curves.key, (v) => { curves.key = v; curves.draw(); }), element("span", {id: "curve-legend"}));
}

class Instrument {
  // Of runs that are open; `runs` may be given others later.
  constructor(runs) {
    this.parts = layOut(runs);
    this.runs = runs;
    this.map = new TimelineMap(this.parts.canvas, runs);
    this.curves = new Curves(this.parts.curve, this.map);
    this.curves.key = curvesOf(runs[0])[0];
    addTools(this.parts, runs, this.map, this.curves);
    this.frame = new FramePanel(this.parts.frame);
    this.properties = new PropertiesPanel(this.parts.properties, runs);
    this.layers = new LayersPanel(this.parts.layers, this.map);
    this.spans = new SpansTable(this.parts.spans);
    this.drawnRun = selection.run;
    selection.listeners.push(() => this.draw());
    addEventListener("hashchange", () => {
      selection.set(selection.fromAddress(runs));
      const box = this.parts.canvas.getBoundingClientRect();
      if (box.bottom < 0 || box.top > innerHeight) this.parts.canvas.scrollIntoView({block: "center"});
    });
    new ResizeObserver(() => this.resize()).observe(this.parts.canvas.parentElement);
    setUpTheme(() => this.redrawAll());
    matchMedia("print").addEventListener("change", () => this.redrawAll());
  }
  resize() {
    this.map.paint();
    if (this.curves.graph) this.curves.graph.resize(this.map.width, 110);
  }
  // What depends on the selection: the decision at once, all that is beside it when the page has shown that, once for many
  // moves.
  draw() {
    const clicked = performance.now();
    if (this.drawnRun !== selection.run) { this.drawnRun = selection.run; this.map.rebuild(); this.curves.draw(); }
    this.map.reveal();
    this.properties.draw();
    this.curves.mark();
    this.parts.goTo.value = selection.frame;
    document.body.dataset.click_ms = performance.now() - clicked;
    if (this.waiting) return;
    this.waiting = true;
    (document.hidden ? setTimeout : requestAnimationFrame)(() => setTimeout(() => this.drawBeside()));
  }
  drawBeside() {
    this.waiting = false;
    this.frame.draw(this.map.run);
    this.layers.draw();
    this.spans.draw(this.map.run);
    document.body.dataset.beside = `${selection.frame} ${selection.layer}`;
  }
  drawAll() {
    this.draw();
    this.drawBeside();
  }
  redrawAll() {
    themeColors.clear();
    this.map.rebuild();
    this.curves.draw();
    this.drawAll();
  }
}
