// Why was it drawn, or why not? One decision in full, beside that of the other run where there are two; and the layers of
// its frame.

// A fiducial: its column, the setting that limits it, its unit; `least`: the limit is from below; `off`: the limit's value
// that switches it off.
const kFiducials = [
  {name: "geometric", column: "warp_geometric_px", limit: "geometric_px", unit: "px", off: null},
  {name: "photometric", column: "photometric_color", limit: "photometric", unit: "", off: 0},
  {name: "light angle", column: "light_angle_rad", limit: "light_angle_rad", unit: "rad", off: 0},
  {name: "magnification", column: "magnification", limit: "magnification", unit: "", off: 0},
  {name: "minification", column: "minification", limit: "minification", unit: "", off: 0, least: true},
  {name: "anisotropy", column: "anisotropy", limit: "anisotropy", unit: "", off: 0},
  {name: "uncovered edge", column: "uncovered_px", limit: "uncovered_px", unit: "px", off: -1},
  {name: "turned side", column: "turned_px", limit: "turned_px", unit: "px", off: 0}];
// What may have changed since a sprite was drawn; the error that each would have made alone.
const kCauses = {camera_px: "camera", own_motion_px: "own motion", light_px: "light", other_layers_px: "other layers"};
const kOfChanges = ["since_frame", "error_px", "separable", ...Object.keys(kCauses)];
const kWithLimits = ["threshold", "lookahead", "oracle"];
const kDone = {rerender: "Drawn again", reuse: "Its sprite is used again",
               refresh: "Some chunks of its sprite are drawn again", drop: "Not shown"};

// The limit of one decision; null: not regulated.
function limitOf(run, fiducial, row) {
  if (!kWithLimits.includes(run.settings.policy)) return null;
  let limit = run.settings[fiducial.limit];
  if (run.value("layer", row).startsWith("shadow map of ")) {
    if (fiducial.limit !== "geometric_px") return null;
    return run.settings.shadow_map_px || null;
  }
  if (typeof limit !== "number" || limit === fiducial.off || (fiducial.off === -1 && limit < 0)) return null;
  if (fiducial.limit === "geometric_px") limit /= run.value("geometric_weight", row) ?? 1;
  return limit;
}

// The value as a share of its limit, as a bar.
function bar(value, limit, least) {
  const share = least ? limit / Math.max(value, 1e-9) : limit > 0 ? value / limit : value > 0 ? 2 : 0;
  const beyond = least ? value < limit : value > limit;
  const box = element("span", {class: `bar${beyond ? " beyond" : ""}`, "aria-hidden": "true"});
  const fill = element("span");
  fill.style.width = `${Math.min(100, 50 * share)}%`;
  box.append(fill);
  return box;
}

class PropertiesPanel {
  constructor(box, runs) {
    Object.assign(this, {box, runs});
  }
  rows() {
    return this.runs.map((run) => run.row(selection.layer, selection.frame));
  }
  draw() {
    const rows = this.rows(), several = this.runs.length > 1;
    const parts = [element("h2", {}, element("bdi", {}, selection.layer), ` in frame ${selection.frame}`)];
    if (selection.refused) parts.push(element("p", {class: "note", role: "status"}, element("bdi", {}, selection.refused)));
    this.runs.forEach((run, k) => {
      const row = rows[k], decision = run.value("decision", row);
      const reason = run.value("reason", row) ?? "", done = reason.startsWith("first_appearance") ? "Drawn" : kDone[decision];
      const words = row < 0 ? "No line: the layer is not there in this frame." : `${done}: ${reason}`;
      const swatch = element("span", {class: "swatch", "aria-hidden": "true"});
      swatch.style.background = color(run.kind(row));
      parts.push(element("p", {class: "why"}, swatch, several ? element("b", {}, `${"AB"[k]} `) : "", element("bdi", {}, words)));
    });
    const isLoaded = this.runs.every((run) => run.decisions.loaded);
    parts.push(...(isLoaded ? [this.fiducials(rows), this.changes(rows), this.rest(rows)] : [element("p", {class: "note", role: "status"}, "The rest of the run is being unpacked …")]));
    this.box.replaceChildren(...parts);
  }
  head(...words) {
    const names = this.runs.length > 1 ? this.runs.map((_, k) => "AB"[k]) : ["value"];
    return element("thead", {}, element("tr", {}, ...words.slice(0, 1).map((w) => element("th", {scope: "col"}, w)),
                                        ...names.map((n) => element("th", {scope: "col", class: "n"}, n)),
                                        ...words.slice(1).map((w) => element("th", {scope: "col", class: "n"}, w))));
  }
  fiducials(rows) {
    const lines = [];
    for (const fiducial of kFiducials) {
      const values = this.runs.map((run, k) => run.value(fiducial.column, rows[k]));
      if (values.every((value) => value === null)) continue;
      const at = selection.run, value = values[at], limit = rows[at] < 0 ? null : limitOf(this.runs[at], fiducial, rows[at]);
      lines.push(element("tr", {},
        element("th", {scope: "row"}, `${fiducial.name}${fiducial.unit ? ", " + fiducial.unit : ""}`),
        ...values.map((v) => element("td", {class: "n", "data-column": fiducial.column}, numberElement(v))),
        element("td", {class: "n"}, limit === null ? "–" : fiducial.least ? "≥ " : "≤ ", limit === null ? "" : numberElement(limit)),
        element("td", {}, value === null || limit === null ? "" : bar(value, limit, fiducial.least))));
    }
    if (lines.length === 0) return element("p", {class: "note"}, "No fiducials: there is no old sprite in view.");
    return element("table", {class: "properties"}, element("caption", {}, "Fiducials of the old sprite against their limits"),
                   this.head("fiducial", "limit", "share"), element("tbody", {}, ...lines));
  }
  // What the error of the old sprite comes from.
  changes(rows) {
    const at = (name) => this.runs.map((run, k) => run.value(name, rows[k])), since = at("since_frame");
    if (since.every((frame) => frame === null)) {
      const why = this.runs.every((run) => !run.changes) ? "not known (no changes.jsonl)" : "nothing that moves it";
      return at("warp_geometric_px").every((error) => error === null) ? "" : element("p", {class: "note", id: "changes"}, `Changed since it was drawn: ${why}.`);
    }
    const line = (name, words) => element("tr", {}, element("th", {scope: "row"}, words), ...at(name).map((v, k) => element("td", {class: "n", "data-column": name},
      v === null && since[k] !== null ? "out of view" : numberElement(v))));
    const whole = at("error_px"), several = this.runs.length > 1;
    const sums = at("separable").map((is, k) => (since[k] === null ? "–" : is === 1 ? "sum up to it" : "not separable"));
    const frames = [...new Set(since.filter((frame) => frame !== null))].join(" and ");
    return element("table", {class: "properties", id: "changes"},
      element("caption", {}, `Error by each change alone, since frame ${frames}`), this.head("cause, px"),
      element("tbody", {}, ...Object.entries(kCauses).map(([name, words]) => line(name, words)),
        element("tr", {}, element("th", {scope: "row"}, "all, the geometric error"), ...whole.map((v) => element("td", {class: "n", "data-column": "error_px"}, numberElement(v)))),
        element("tr", {}, element("th", {scope: "row"}, several ? "the parts" : "these parts"), ...sums.map((words) => element("td", {class: "n sums"}, words)))));
  }
  // All other columns, by what they are about.
  rest(rows) {
    const skip = new Set(["frame", "layer", "decision", "reason", ...kFiducials.map((f) => f.column), ...kOfChanges]), lines = [];
    const names = [...this.runs[0].decisions.columns.keys()].filter((name) => !skip.has(name));
    const first = ["geometric_px", "frames_since_render", "depicts_frame", "resolution", "cost_polygons", "cost_pixels", "cost_chunks", "cost_bytes", "held_geometric_px", "shade_px"];
    names.sort((a, b) => (first.indexOf(a) + 1 || 99) - (first.indexOf(b) + 1 || 99));
    for (const name of names) {
      const values = this.runs.map((run, k) => run.value(name, rows[k]));
      if (values.every((value) => value === null)) continue;
      const {unit, meaning} = this.runs[0].column(name);
      lines.push(element("tr", {title: meaning}, element("th", {scope: "row"}, name.replaceAll("_", " "), unit && !name.endsWith("_px") && !name.endsWith(`_${unit}`) && !name.includes(unit) ? `, ${unit}` : ""),
                         ...values.map((v) => element("td", {class: "n", "data-column": name}, numberElement(v)))));
    }
    if (lines.length === 0) return "";
    const table = element("table", {class: "properties"}, element("caption", {}, "What is shown, where, and at what cost"), this.head("column"), element("tbody", {}, ...lines));
    return element("details", {open: this.isOpen ?? false, ontoggle: (event) => { this.isOpen = event.target.open; }},
                   element("summary", {}, `All ${lines.length} other columns of this decision`), table);
  }
}

class LayersPanel {
  constructor(box, map) {
    Object.assign(this, {box, map, lines: []});
  }
  // A line for each row of the map; what is in it is filled in anew for each frame.
  layOut() {
    const run = this.map.run;
    this.rows = this.map.rows;
    this.caption = element("caption");
    this.lines = this.rows.slice(0, 400).map((layer) => {
      const name = run.layers[layer], swatch = element("span", {class: "swatch", "aria-hidden": "true"});
      const link = element("a", {class: "name"}, element("bdi", {}, name)), done = element("td");
      const numbers = ["geometric_px", "cost_pixels"].map((column) => ({column, cell: element("td", {class: "n"})}));
      return {name, swatch, link, done, numbers, line: element("tr", {}, element("th", {scope: "row"}, swatch, link), done, ...numbers.map((n) => n.cell))};
    });
    const head = element("thead", {}, element("tr", {}, ...["layer", "done", "error px", "texels"].map((w, k) => element("th", {scope: "col", class: k > 1 ? "n" : null}, w))));
    this.box.replaceChildren(element("table", {class: "properties"}, this.caption, head, element("tbody", {}, ...this.lines.map((l) => l.line))));
  }
  draw() {
    const run = this.map.run, frame = selection.frame;
    if (this.rows !== this.map.rows) this.layOut();
    this.caption.textContent = `Layers in frame ${frame}`;
    for (const {name, swatch, link, done, numbers, line} of this.lines) {
      const row = run.row(name, frame), kind = run.kind(row);
      swatch.style.background = color(kind);
      link.setAttribute("href", selection.link(frame, name));
      done.textContent = row < 0 ? "–" : kKindWords[kind];
      for (const {column, cell} of numbers) cell.replaceChildren(numberElement(run.value(column, row)));
      if (name === selection.layer) line.setAttribute("aria-current", "true");
      else line.removeAttribute("aria-current");
    }
  }
}
