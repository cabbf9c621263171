// When was which layer drawn? Layers × frames as a picture of one pixel a cell, drawn large: panning moves a picture.

const kLabels_px = 150, kAxis_px = 18, kTile = 8192;

class TimelineMap {
  constructor(canvas, runs) {
    Object.assign(this, {canvas, runs, by: "cost", mode: "reason", top: 0, kindFilter: "", filter: ""});
    this.shown = {from: Math.min(...runs.map((r) => r.first)), to: Math.max(...runs.map((r) => r.last)) + 1};
    this.whole = {...this.shown};
    this.moved = [];
    this.listen();
  }
  get run() {
    return this.runs[selection.run];
  }
  // After a change of order, colours or run.
  rebuild() {
    const run = this.run;
    const word = this.filter.toLowerCase();
    this.rows = run.order(this.by).filter((k) => run.layers[k].toLowerCase().includes(word));
    this.tiles = [];
    for (let from = 0; from < run.count; from += kTile) this.tiles.push({from, picture: this.tile(from, Math.min(kTile, run.count - from))});
    this.paint();
  }
  tile(from, count) {
    const run = this.run, picture = document.createElement("canvas");
    picture.width = count;
    picture.height = Math.max(1, this.rows.length);
    const context = picture.getContext("2d"), image = context.createImageData(picture.width, picture.height);
    const pixels = new Uint32Array(image.data.buffer), colors = this.palette();
    this.rows.forEach((layer, y) => {
      for (let f = 0; f < count; ++f) {
        const row = run.rowAt[layer * run.count + from + f];
        if (row >= 0) pixels[y * count + f] = colors(row, run.layers[layer], run.first + from + f);
      }
    });
    context.putImageData(image, 0, 0);
    return picture;
  }
  // A function that gives a row its colour, as a pixel.
  palette() {
    const pixel = (hex) => {
      const n = Number.parseInt(hex.slice(1), 16);
      return (0xff000000 | ((n & 0xff) << 16) | (n & 0xff00) | (n >> 16)) >>> 0;
    };
    const byKind = kKinds.map((kind) => pixel(color(kind))), run = this.run;
    if (this.mode === "difference" && this.runs.length > 1) {
      const other = this.runs[1 - selection.run], is = (kind) => kKinds.indexOf(kind) < 7;
      const same = pixel(color("reuse")), both = pixel(css("--both")), here = pixel(color("geometric")), there = pixel(color("policy"));
      return (row, layer, frame) => {
        const a = is(run.kind(row)), b = is(other.kind(other.row(layer, frame)));
        return a && b ? both : a ? here : b ? there : same;
      };
    }
    if (this.mode === "error") {
      const errors = run.column("geometric_px").values, most = this.largestError();
      const steps = [0, 1, 2, 3, 4, 5, 6].map((k) => pixel(css(`--step-${k}`)));
      const drop = pixel(color("drop")), merged = pixel(color("merged"));
      return (row) => {
        const kind = kKinds[run.kinds[row]];
        if (kind === "drop" || kind === "merged" || !errors) return kind === "merged" ? merged : drop;
        return steps[Math.min(6, Math.floor((7 * errors[row]) / most))];
      };
    }
    return (row) => byKind[run.kinds[row]];
  }
  // The largest of all layers and frames, px; above 0.
  largestError() {
    let most = 1e-9;
    for (const e of this.run.column("geometric_px").values ?? []) if (e > most) most = e;
    return most;
  }
  get rowHeight() {
    return Math.max(this.rows.length > 200 ? 8 : 11, Math.min(18, Math.floor((this.height - kAxis_px) / Math.max(1, this.rows.length))));
  }
  get rowsInView() {
    return Math.max(1, Math.floor((this.height - kAxis_px) / this.rowHeight));
  }
  resize() {
    const box = this.canvas.parentElement.getBoundingClientRect(), scale = window.devicePixelRatio || 1;
    this.width = Math.max(200, Math.floor(box.width));
    this.labels = Math.min(kLabels_px, Math.floor(this.width / 3));
    const rows = (this.rows || []).length;
    this.height = Math.max(120, Math.min(440, rows * 18 + kAxis_px));
    this.canvas.style.height = `${this.height}px`;
    this.canvas.width = this.width * scale;
    this.canvas.height = this.height * scale;
    this.canvas.getContext("2d").setTransform(scale, 0, 0, scale, 0, 0);
  }
  x(frame) {
    return this.labels + ((frame - this.shown.from) / (this.shown.to - this.shown.from)) * (this.width - this.labels);
  }
  frameAt(x) {
    return Math.floor(this.shown.from + ((x - this.labels) / (this.width - this.labels)) * (this.shown.to - this.shown.from));
  }
  paint() {
    this.resize();
    const c = this.canvas.getContext("2d"), run = this.run, height = this.rowHeight;
    c.clearRect(0, 0, this.width, this.height);
    this.top = Math.max(0, Math.min(this.top, this.rows.length - this.rowsInView));
    const count = Math.min(this.rowsInView, this.rows.length - this.top);
    c.fillStyle = color("drop");
    c.fillRect(this.labels, 0, this.width - this.labels, count * height);
    c.save();
    c.beginPath();
    c.rect(this.labels, 0, this.width - this.labels, this.height);
    c.clip();
    c.imageSmoothingEnabled = this.width < this.shown.to - this.shown.from;
    c.imageSmoothingQuality = "high";
    for (const {from, picture} of this.tiles) {
      const x0 = this.x(run.first + from), x1 = this.x(run.first + from + picture.width);
      if (count > 0 && x1 > this.labels && x0 < this.width) c.drawImage(picture, 0, this.top, picture.width, count, x0, 0, x1 - x0, count * height);
    }
    this.paintGrid(c, count, height);
    c.restore();
    this.paintLabels(c, count, height);
    this.paintAxis(c, count * height);
  }
  paintGrid(c, count, height) {
    c.fillStyle = css("--gap");
    for (let k = 1; k <= count; ++k) c.fillRect(this.labels, k * height - 1, this.width, 1);
    if (this.by === "group") {
      c.fillStyle = css("--quiet");
      for (let k = 1; k < count; ++k)
        if (this.run.groupOf(this.rows[this.top + k]) !== this.run.groupOf(this.rows[this.top + k - 1])) c.fillRect(this.labels, k * height - 1, this.width, 2);
    }
    const cell = this.x(1) - this.x(0);
    if (cell > 7) for (let f = Math.ceil(this.shown.from); f <= this.shown.to; ++f) c.fillRect(this.x(f) - 0.5, 0, 1, count * height);
    const x = this.x(selection.frame), wide = Math.max(cell, 2), k = this.rows.indexOf(this.run.layerAt.get(selection.layer)) - this.top;
    c.strokeStyle = css("--select");
    c.lineWidth = 1;
    c.strokeRect(x - 0.5, -2, wide + 1, count * height + 2);
    if (k < 0 || k >= count) return;
    c.lineWidth = 2;
    c.strokeRect(x - 2, k * height - 1, wide + 3, height + 1);
  }
  paintLabels(c, count, height) {
    c.textBaseline = "middle";
    c.font = `${Math.min(12, Math.max(9, height - 1))}px ${css("--sans")}`;
    for (let k = 0; k < count; ++k) {
      const name = this.run.layers[this.rows[this.top + k]], chosen = name === selection.layer;
      c.fillStyle = chosen ? css("--ink") : css("--quiet");
      if (chosen) c.fillRect(this.labels - 4, k * height, 2, height - 1);
      c.fillText(clipped(c, name, this.labels - 12), 2, k * height + height / 2);
    }
  }
  paintAxis(c, y) {
    const span = this.shown.to - this.shown.from, room = (this.width - this.labels) / 60;
    const step = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000].find((s) => span / s <= room) || 100000;
    c.fillStyle = css("--quiet");
    c.font = `11px ${css("--sans")}`;
    c.textBaseline = "top";
    if (this.rows.length === 0) c.fillText("no layer has that in its name", this.labels + 4, y + 24);
    for (let f = Math.ceil(this.shown.from / step) * step; f < this.shown.to; f += step) {
      const x = this.x(f);
      c.fillRect(x, y, 1, 4);
      const text = String(f);
      if (x + c.measureText(text).width + 3 < this.width) c.fillText(text, x + 3, y + 3);
    }
    const below = this.rows.length - this.top - this.rowsInView;
    if (below > 0 || this.top > 0) c.fillText(`${this.rows.length} layers ↕`, 2, y + 3);
  }
  // Frames [from, to) in view, inside the run.
  show(from, to) {
    const span = Math.max(4, Math.min(to - from, this.whole.to - this.whole.from));
    from = Math.max(this.whole.from, Math.min(from, this.whole.to - span));
    this.shown = {from, to: from + span};
    this.paint();
    for (const listener of this.moved) listener(this.shown);
  }
  zoom(factor, around) {
    const {from, to} = this.shown;
    this.show(around + (from - around) * factor, around + (to - around) * factor);
  }
  // The chosen cell comes into view.
  reveal() {
    const k = this.rows.indexOf(this.run.layerAt.get(selection.layer));
    if (k >= 0 && k < this.top) this.top = k;
    if (k >= this.top + this.rowsInView) this.top = k - this.rowsInView + 1;
    const {from, to} = this.shown;
    if (selection.frame < from || selection.frame + 1 > to) this.show(selection.frame - (to - from) / 2, selection.frame + (to - from) / 2);
    else this.paint();
  }
  choose(event) {
    const box = this.canvas.getBoundingClientRect();
    const k = this.top + Math.floor((event.clientY - box.top) / this.rowHeight), change = {};
    if (k >= 0 && k < this.rows.length) change.layer = this.run.layers[this.rows[k]];
    if (event.clientX - box.left >= this.labels) change.frame = Math.max(this.run.first, Math.min(this.run.last, this.frameAt(event.clientX - box.left)));
    selection.set(change);
  }
  step(layers, frames) {
    const at = this.rows.indexOf(this.run.layerAt.get(selection.layer));
    const k = Math.max(0, Math.min(this.rows.length - 1, at + layers));
    selection.set({layer: this.run.layers[this.rows[k]], frame: Math.max(this.run.first, Math.min(this.run.last, selection.frame + frames))});
  }
  listen() {
    let drag = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      drag = {x: event.clientX, shown: this.shown, moved: false};
      this.canvas.setPointerCapture(event.pointerId);
    });
    this.canvas.addEventListener("pointermove", (event) => {
      if (!drag) return;
      const frames = ((drag.x - event.clientX) / (this.width - this.labels)) * (drag.shown.to - drag.shown.from);
      if (Math.abs(drag.x - event.clientX) > 4) drag.moved = true;
      if (drag.moved) this.show(drag.shown.from + frames, drag.shown.to + frames);
    });
    this.canvas.addEventListener("pointerup", (event) => {
      if (drag && !drag.moved) this.choose(event);
      drag = null;
    });
    this.canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      if (event.ctrlKey || event.shiftKey || this.rows.length <= this.rowsInView) {
        this.zoom(Math.exp((event.deltaY || event.deltaX) / 400), this.frameAt(event.offsetX));
      } else {
        this.top += Math.sign(event.deltaY) * 3;
        this.paint();
      }
    }, {passive: false});
    const keys = {ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0], PageUp: [-10, 0], PageDown: [10, 0],
                  Home: [0, -1e9], End: [0, 1e9]};
    this.canvas.addEventListener("keydown", (event) => {
      if (event.key === "+" || event.key === "-") this.zoom(event.key === "+" ? 0.5 : 2, selection.frame + 0.5);
      else if (keys[event.key]) this.step(...keys[event.key]);
      else return;
      event.preventDefault();
    });
  }
}

// As much of the text as there is room for.
function clipped(context, text, room) {
  text = text.slice(0, 200);
  if (context.measureText(text).width <= room) return text;
  let low = 0, high = text.length;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (context.measureText(text.slice(0, middle) + "…").width <= room) low = middle;
    else high = middle - 1;
  }
  return text.slice(0, low) + "…";
}
