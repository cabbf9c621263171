"use strict";
// A plan that arrives slice by slice, as a run: map, curves and panels take it for one of a report.

// Columns fill up from the left; those of a frame that was asked for are there for its rows alone.
class LiveTable extends Table {
  constructor(columns) {
    super({rows: 0, columns: columns.map((column) => ({...column, values: []}))}, "");
    this.loaded = true;
  }
  has(name) {
    return this.columns.has(name);
  }
  async need() {}
  value(name, row) {
    return row < 0 ? null : this.columns.get(name)?.values[row] ?? null;
  }
  // A list per column.
  add(lists) {
    for (const [name, list] of Object.entries(lists)) {
      const values = this.columns.get(name).values;
      for (const value of list) values.push(value);
    }
    this.rows = this.columns.get("frame").values.length;
  }
}

class LiveRun extends Run {
  // `answer`: the first slice.
  constructor(about, answer) {
    const none = {rows: 0, columns: []};
    super({name: about.sequence, folder: about.folder, what: "", run: {kind: "plan", settings: answer.settings}, pictures: [], still: -1,
           worst: null, complete: false, changes: true, layers: [], decisions: none, frames: none, timing: none});
    this.decisions = new LiveTable(about.columns);
    this.frames = new LiveTable(Object.keys(answer.frame_lines).map((name) => ({name})));
    Object.assign(this, {first: 0, last: answer.frames - 1, count: answer.frames, planned: 0, layers: [], layerAt: new Map(), kinds: [],
                         rowAt: new Int32Array(0), maxError: new Float64Array(answer.frames).fill(NaN), kindOfWords: new Map()});
  }
  // Rows of frames that are not there yet.
  take(answer) {
    const {frame, layer, decision, reason, geometric_px, cost_polygons, cost_pixels} = answer.decisions, before = this.decisions.rows;
    this.decisions.add(answer.decisions);
    this.frames.add(answer.frame_lines);
    for (let k = 0; k < frame.length; ++k) {
      const l = this.layerNamed(layer[k]), totals = this.totals[l], error = geometric_px[k] ?? 0;
      this.rowAt[l * this.count + frame[k]] = before + k;
      this.kinds.push(this.kindIndex(decision[k], reason[k]));
      if (decision[k] === "rerender") ++totals.renders;
      totals.polygons += cost_polygons[k];
      totals.pixels += cost_pixels[k];
      if (decision[k] === "drop") continue;
      totals.max_px = Math.max(totals.max_px, error);
      if (!(this.maxError[frame[k]] >= error)) this.maxError[frame[k]] = error;
    }
    this.planned = answer.planned;
    this.complete = this.planned === this.count;
  }
  // All columns of one frame.
  takeFrame(answer) {
    const lists = answer.columns;
    lists.layer.forEach((name, k) => {
      const row = this.row(name, answer.frame);
      if (row >= 0) for (const [column, list] of Object.entries(lists)) this.decisions.columns.get(column).values[row] = list[k];
    });
  }
  layerNamed(name) {
    if (!this.layerAt.has(name)) {
      this.layerAt.set(name, this.layers.length);
      this.layers.push(name);
      this.totals.push({name, renders: 0, polygons: 0, pixels: 0, max_px: 0});
      if (this.layers.length * this.count > this.rowAt.length) {
        const grown = new Int32Array(2 * this.layers.length * this.count).fill(-1);
        grown.set(this.rowAt);
        this.rowAt = grown;
      }
    }
    return this.layerAt.get(name);
  }
  // Reasons that differ in their numbers alone are of one kind.
  kindIndex(decision, reason) {
    const words = `${decision} ${reason.replace(/[0-9.]+/g, "0")}`;
    if (!this.kindOfWords.has(words)) this.kindOfWords.set(words, kKinds.indexOf(kindOf(decision, reason)));
    return this.kindOfWords.get(words);
  }
  sum(name) {
    return this.totals.reduce((sum, totals) => sum + totals[name], 0);
  }
}
