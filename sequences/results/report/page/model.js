// What is known of a run: which row is the decision of a layer in a frame, and of what kind it is.

// Kinds of decisions, in the order of the legend. Colours of the first nine are told apart by colour-blind readers, too
// (Okabe and Ito); theme.css has them.
const kKinds = ["first", "geometric", "photometric", "sampling", "visibility", "policy", "other", "deferred", "merged", "reuse", "drop"];
const kKindWords = {
  first: "drawn: first appearance", geometric: "drawn: out of place", photometric: "drawn: light changed",
  sampling: "drawn: stretched", visibility: "drawn: a side came into view", policy: "drawn: policy, budget",
  other: "drawn: other", deferred: "reused, though beyond a limit", merged: "merged into another sprite",
  reuse: "reused", drop: "not in view"};

function kindOf(decision, words) {
  const reason = words.replace(/^split from .*?: /, "");
  if (decision === "drop") return reason.startsWith("merged into") ? "merged" : "drop";
  if (decision === "reuse") return /deferred|put off/.test(reason) ? "deferred" : "reuse";
  if (/^first/.test(reason)) return "first";
  if (/^(geometric|shadow|settled)/.test(reason)) return "geometric";
  if (/^(photometric|light)/.test(reason)) return "photometric";
  if (/^(sampling|magnif|minif|anisotropy|resolution)/.test(reason)) return "sampling";
  if (/^(visibility|uncovered|turned)/.test(reason)) return "visibility";
  if (/^(policy|benefit|budget|hold|beat)/.test(reason)) return "policy";
  return "other";
}

class Run {
  constructor(json) {
    Object.assign(this, {name: json.name, folder: json.folder, what: json.what, run: json.run, pictures: json.pictures,
                         still: json.still, worst: json.worst, complete: json.complete, changes: json.changes});
    this.settings = json.run.settings;
    this.totals = json.layers;
    this.decisions = new Table(json.decisions, "layer");
    this.frames = new Table(json.frames, "");
    this.timing = new Table(json.timing, "");
  }
  async open() {
    await this.decisions.need(["layer", "frame", "decision", "reason", "geometric_px"]);
    await this.frames.needAll();
    this.index();
  }
  column(name) {
    return this.decisions.columns.get(name);
  }
  // Which row is it? And of which kind?
  index() {
    const layers = this.column("layer"), frames = this.column("frame"), rows = this.decisions.rows;
    this.layers = layers.words ? layers.words.slice(1) : [];
    this.layerAt = new Map(this.layers.map((name, k) => [name, k]));
    const asked = Array.isArray(this.run.frames) ? this.run.frames : [0, 0];
    this.first = asked[0];
    this.last = asked[1];
    for (let r = 0; r < rows; ++r) {
      this.first = Math.min(this.first, frames.values[r]);
      this.last = Math.max(this.last, frames.values[r]);
    }
    this.count = this.last - this.first + 1;
    this.rowAt = new Int32Array(this.layers.length * this.count).fill(-1);
    this.kinds = new Uint8Array(rows);
    this.maxError = new Float64Array(this.count).fill(NaN);
    const kinds = this.kindTable(), decision = this.column("decision"), reason = this.column("reason");
    const error = this.column("geometric_px");
    for (let r = 0; r < rows; ++r) {
      const f = frames.values[r] - this.first;
      this.rowAt[(layers.values[r] - 1) * this.count + f] = r;
      this.kinds[r] = kinds[decision.values[r]][reason.values[r]];
      if (error.values && !(error.values[r] <= this.maxError[f])) this.maxError[f] = error.values[r];
    }
  }
  // By index of the decision's word and of the reason's.
  kindTable() {
    const decision = this.column("decision"), reason = this.column("reason");
    if (!decision.words) return [];
    return decision.words.map((done) => reason.words.map((word, k) => kKinds.indexOf(kindOf(done, reason.kinds[k] || word))));
  }
  // The number of the row; -1: no line.
  row(layer, frame) {
    const l = this.layerAt.get(layer);
    if (l === undefined || frame < this.first || frame > this.last) return -1;
    return this.rowAt[l * this.count + frame - this.first];
  }
  kind(row) {
    return row < 0 ? "drop" : kKinds[this.kinds[row]];
  }
  value(name, row) {
    return this.decisions.value(name, row);
  }
  frameRow(frame) {
    const column = this.frames.columns.get("frame");
    if (!column.values) return -1;
    const guess = frame - column.values[0];
    if (column.values[guess] === frame) return guess;
    return column.values.indexOf(frame);
  }
  // The nearest picture that is not after the frame.
  picture(frame) {
    let best = null;
    for (const picture of this.pictures) if (picture.frame <= frame) best = picture;
    return best;
  }
  // What the author's name of a layer begins with: "horse" of "horse 1", "farm" of "farm/barn".
  groupOf(layer) {
    const name = this.layers[layer], slash = name.indexOf("/");
    return slash > 0 ? name.slice(0, slash) : name.replace(/[\s_.#-]*\d+$/, "") || name;
  }
  // Layers in the order asked for.
  order(by) {
    const at = [...this.layers.keys()];
    const key = {cost: (k) => -this.totals[k].pixels, rate: (k) => -this.totals[k].renders, error: (k) => -this.totals[k].max_px}[by];
    if (by === "group") {
      const costs = new Map(), first = new Map();
      for (const k of at) {
        const group = this.groupOf(k);
        costs.set(group, (costs.get(group) ?? 0) + this.totals[k].pixels);
        if (!first.has(group)) first.set(group, k);
      }
      const groups = at.map((k) => this.groupOf(k));
      at.sort((a, b) => costs.get(groups[b]) - costs.get(groups[a]) || first.get(groups[a]) - first.get(groups[b]) || this.totals[b].pixels - this.totals[a].pixels || a - b);
    }
    if (by === "name") at.sort((a, b) => this.layers[a].localeCompare(this.layers[b], undefined, {numeric: true}));
    if (key) at.sort((a, b) => key(a) - key(b) || a - b);
    return at;
  }
}
