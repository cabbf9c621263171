// The instrument: puts the parts together, and says on `document.body.dataset` how far it is.

function choice(label, words, chosen, change) {
  const select = element("select", {onchange: () => change(select.value)},
                         ...Object.entries(words).map(([value, text]) => element("option", {value, selected: value === chosen}, text)));
  return element("label", {}, `${label} `, select);
}

function legend() {
  return element("ul", {class: "legend"}, ...kKinds.map((kind) => {
    const swatch = element("span", {class: "swatch"});
    swatch.style.background = `var(--kind-${kind})`;
    return element("li", {}, swatch, kKindWords[kind]);
  }));
}

function setUpTheme(again) {
  const button = document.getElementById("theme"), dark = matchMedia("(prefers-color-scheme: dark)");
  const isDark = () => (document.documentElement.dataset.theme || (dark.matches ? "dark" : "light")) === "dark";
  const say = () => (button.textContent = isDark() ? "Light" : "Dark");
  button.hidden = false;
  button.setAttribute("aria-label", "change between light and dark");
  button.addEventListener("click", () => {
    document.documentElement.dataset.theme = isDark() ? "light" : "dark";
    say();
    again();
  });
  dark.addEventListener("change", () => { say(); again(); });
  say();
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
                 curveTools: element("div", {class: "tools"})};
  document.getElementById("instrument").append(
    element("div", {class: "left"}, parts.tools, element("div", {class: "map"}, canvas), legend(), parts.curveTools, parts.curve, parts.spans),
    element("div", {class: "right"}, parts.frame, parts.properties, parts.layers));
  return parts;
}

function addTools(parts, runs, map, curves) {
  const again = () => { map.rebuild(); };
  const modes = {reason: "reason", error: "error"};
  if (runs.length > 1) modes.difference = "A against B";
  const zoom = (text, label, act) => element("button", {type: "button", "aria-label": label, title: label, onclick: act}, text);
  const middle = () => (map.shown.from + map.shown.to) / 2;
  parts.tools.append(
    ...(runs.length > 1 ? [choice("run", {0: `A: ${runs[0].folder}`, 1: `B: ${runs[1].folder}`}, "0", (v) => selection.set({run: Number(v)}))] : []),
    choice("rows by", {cost: "cost", rate: "rate", error: "error", order: "order", name: "name"}, "cost", (v) => { map.by = v; again(); }),
    choice("colours", modes, "reason", (v) => { map.mode = v; again(); }),
    element("label", {}, "find ", element("input", {type: "search", id: "find", size: "10", oninput: (e) => { map.filter = e.target.value; again(); }})),
    element("span", {class: "buttons"}, zoom("−", "see more frames", () => map.zoom(2, middle())), zoom("+", "see fewer frames", () => map.zoom(0.5, middle())),
            zoom("all", "see all frames", () => map.show(map.whole.from, map.whole.to))));
  const names = Object.fromEntries(curvesOf(runs[0]).map((key) => [key, kCurves[key].label]));
  parts.curveTools.append(choice("curve", names, curves.key, (v) => { curves.key = v; curves.draw(); }), element("span", {id: "curve-legend"}));
}

async function start() {
  const began = performance.now(), data = JSON.parse(document.getElementById("report").textContent);
  const runs = data.runs.map((json) => new Run(json));
  for (const run of runs) await run.open();
  document.getElementById("instrument").hidden = false;
  document.getElementById("still")?.remove();
  const parts = layOut(runs), map = new TimelineMap(parts.canvas, runs), curves = new Curves(parts.curve, map);
  curves.key = curvesOf(runs[0])[0];
  addTools(parts, runs, map, curves);
  const frame = new FramePanel(parts.frame), properties = new PropertiesPanel(parts.properties, runs);
  const layers = new LayersPanel(parts.layers, map), spans = new SpansTable(parts.spans);
  const worst = runs[0].worst ?? {frame: runs[0].first, layer: runs[0].layers[0] ?? ""};
  Object.assign(selection, worst, selection.fromAddress(runs));
  map.rebuild();
  let drawnRun = selection.run;
  const draw = () => {
    const clicked = performance.now();
    if (drawnRun !== selection.run) { drawnRun = selection.run; map.rebuild(); curves.draw(); }
    map.reveal();
    frame.draw(map.run);
    properties.draw();
    layers.draw();
    spans.draw(map.run);
    curves.mark();
    document.body.dataset.click_ms = performance.now() - clicked;
  };
  const redrawAll = () => { map.rebuild(); curves.draw(); draw(); };
  selection.listeners.push(draw);
  addEventListener("hashchange", () => selection.set(selection.fromAddress(runs)));
  new ResizeObserver(() => { map.paint(); if (curves.graph) curves.graph.resize(map.width, 110); }).observe(parts.canvas.parentElement);
  setUpTheme(redrawAll);
  await curves.draw();
  draw();
  document.body.dataset.painted_ms = performance.now() - began;
  for (const run of runs) await run.decisions.needAll();
  draw();
  document.body.dataset.ready_ms = performance.now() - began;
}

start().catch((error) => {
  document.getElementById("instrument").hidden = true;
  console.error(error);
});
