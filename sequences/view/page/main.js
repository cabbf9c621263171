// The live view: asks for plans and pictures, and says on `document.body.dataset` how far it is.

const kWait_ms = 30, kStill_ms = 250, kCoarse = 0.5;
const at = (id) => document.getElementById(id);

class LiveView {
  constructor(about) {
    Object.assign(this, {about, tab: crypto.randomUUID(), request: 0, generation: 0, epoch: 0, drawing: false, again: false, moving: false, runs: [], playing: 0});
    this.controls = new Controls(at("controls"), about, (began) => this.changed(began));
    this.flight = new Flight(about.camera);
    this.stage();
  }
  // Status 0: nobody answers any more, and the page says so; what is shown stays.
  async ask(path, extra) {
    const flight = this.flight.poses.length > 0 ? {flight: this.flight.poses} : {};
    const body = JSON.stringify({tab: this.tab, request: ++this.request, settings: this.controls.settings, without: this.controls.without, ...flight, ...extra});
    const response = await fetch(path, {method: "POST", body}).catch(() => Response.error());
    at("fault").hidden = response.status !== 0;
    at("fault").textContent = response.status === 0 ? "talisman view does not answer any more; what is shown stays." : "";
    return response;
  }
  // The last of many moves counts.
  changed(began) {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.plan(began), kWait_ms);
  }
  // The plan arrives slice by slice; a newer setting ends the loop. An invalid one keeps what is there. While a slice is painted, the next one is planned.
  async plan(began) {
    const generation = ++this.generation, {dataset} = document.body;
    let run = null, asked = this.ask("/plan", {from: 0});
    while (!run?.complete) {
      const response = await asked;
      if (generation !== this.generation || [0, 409].includes(response.status)) return;
      const answer = await response.json();
      if (generation !== this.generation) return;
      if (response.status !== 200) {
        this.controls.say(answer.error);
        return;
      }
      const isLost = run && answer.planned < run.planned;  // another tab took its place: it is planned again
      if (isLost || answer.planned < answer.frames) asked = this.ask("/plan", {from: isLost ? run.planned : answer.planned});
      if (isLost) continue;
      if (!run) {
        this.controls.say("");
        run = new LiveRun(this.about, answer);
      }
      const isFirst = run.planned === 0;
      run.take(answer);
      this.show(run);
      if (isFirst) dataset.first_ms = performance.now() - began;
    }
    dataset.complete_ms = performance.now() - began;
    dataset.plans = Number(dataset.plans ?? 0) + 1;
    this.instrument.curves.draw();
    this.look(true);
  }
  // What is planned so far.
  show(run) {
    const before = this.runs[0];
    run.pictures = before?.pictures ?? [];
    this.runs[0] = run;
    if (!this.instrument) {
      at("instrument").hidden = false;
      this.instrument = new Instrument(this.runs);
      Object.assign(selection, {frame: 0, layer: run.layers[0] ?? ""}, selection.fromAddress(this.runs));
      selection.listeners.push(() => this.look(false));
    }
    const {map, spans} = this.instrument;
    if (before?.count !== run.count) {
      map.whole = {from: run.first, to: run.last + 1};
      map.shown = {...map.whole};
      selection.frame = Math.min(selection.frame, run.last);
      at("frame-slider").max = run.last;
    }
    spans.name = null;
    map.rebuild();
    const progress = at("progress");
    progress.hidden = run.complete;
    progress.max = run.count;
    progress.value = run.planned;
    at("sum").textContent = `${run.complete ? "" : `${run.planned} of `}${run.count} frames planned: ${run.sum("renders")} sprites drawn, ` +
      `${shortNumber(run.sum("polygons"))} polygons, ${shortNumber(run.sum("pixels"))} texels; largest error ${Number(Math.max(0, ...run.totals.map((t) => t.max_px)).toPrecision(3))} px`;
  }
  // The chosen frame: its picture, and all that is known of its decisions.
  look(urgent) {
    at("frame-slider").value = selection.frame;
    at("frame-number").textContent = selection.frame;
    this.instrument.draw();
    this.details();
    this.picture(urgent);
  }
  async details() {
    const run = this.runs[0], response = await this.ask("/frame", {frame: selection.frame});
    if (response.status !== 200 || run !== this.runs[0]) return;
    run.takeFrame(await response.json());
    this.instrument.draw();
    document.body.dataset.details = selection.frame;
  }
  // One picture at a time; what was asked meanwhile is asked once, behind it. What is urgent makes that before it stale.
  async picture(urgent) {
    if (this.drawing && !urgent) {
      this.again = true;
      return;
    }
    const epoch = ++this.epoch;
    this.drawing = true;
    do {
      this.again = false;
      const frame = this.flight.poses.length > 0 && this.moving ? this.flight.poses.length - 1 : selection.frame, mode = at("mode").value;
      const response = await this.ask("/picture", {frame, mode, scale: this.moving ? kCoarse : 1});
      if (epoch !== this.epoch) return;
      if (response.status === 200) {
        if (this.refused) this.controls.say("");
        this.showPicture(frame, mode, await response.blob());
      } else if (response.status === 422) {
        this.controls.say((await response.json()).error);
      }
      this.refused = response.status === 422;
    } while (this.again);
    this.drawing = false;
  }
  showPicture(frame, mode, blob) {
    const image = at("picture"), old = image.src, run = this.runs[0];
    image.src = URL.createObjectURL(blob);
    image.alt = `frame ${frame}, ${mode}`;
    image.hidden = false;
    run.pictures = mode === "shown" ? [{frame, src: image.src}] : [];
    this.instrument.frame.draw(run);
    if (old) setTimeout(() => URL.revokeObjectURL(old), 1000);
    document.body.dataset.pictures = Number(document.body.dataset.pictures ?? 0) + 1;
  }
  goTo(frame) {
    selection.set({frame: Math.max(0, Math.min(this.runs[0].last, frame))});
  }
  play() {
    const starts = this.playing === 0;
    clearInterval(this.playing);
    at("play").textContent = starts ? "Pause" : "Play";
    this.playing = starts ? setInterval(() => { if (!this.drawing) this.goTo((selection.frame + 1) % this.runs[0].count); }, 1000 / this.about.fps) : 0;
  }
  // While the camera moves pictures are coarse; when it is still they are sharp, and the whole flight is planned.
  move(right, down, ahead) {
    const began = performance.now();
    if (!this.flight.record(right, down, ahead)) return;
    this.moving = true;
    this.sayFlight();
    this.picture(false);
    clearTimeout(this.still);
    this.still = setTimeout(() => {
      this.moving = false;
      selection.frame = this.flight.poses.length - 1;
      this.plan(began);
    }, kStill_ms);
  }
  sayFlight() {
    const count = this.flight.poses.length;
    at("flight-words").textContent = count === 0 ? "" : `drag the picture, wheel or W A S D; ${count} of ${kMostPoses} frames recorded`;
    at("saving").hidden = !this.about.can_save || count === 0;
    at("picture").classList.toggle("flown", count > 0);
  }
  async save() {
    const response = await this.ask("/flight", {name: at("flight-name").value});
    if (response.status === 0) return;
    const answer = await response.json();
    at("saved").textContent = answer.file ? `saved: ${answer.file}` : answer.error;
  }
  stage() {
    for (const mode of this.about.modes) at("mode").append(element("option", {value: mode}, mode));
    at("mode").addEventListener("change", () => this.picture(true));
    at("frame-slider").addEventListener("input", () => this.goTo(Number(at("frame-slider").value)));
    at("play").addEventListener("click", () => this.play());
    at("camera").addEventListener("change", () => {
      this.flight.start(at("camera").value);
      selection.frame = 0;
      this.sayFlight();
      this.plan(performance.now());
    });
    at("save").addEventListener("click", () => this.save());
    watchCamera(at("picture"), this.flight, (...by) => this.move(...by));
    this.sayFlight();
  }
}

async function start() {
  const response = await fetch("/about"), about = await response.json();
  if (response.status !== 200) {
    at("fault").hidden = false;
    at("fault").textContent = about.error;
    document.body.dataset.fault = about.error;
    return;
  }
  at("title").textContent = `${about.sequence} · talisman view`;
  document.title = at("title").textContent;
  at("live").hidden = false;
  window.view = new LiveView(about);
  await window.view.plan(performance.now());
}

start().catch((error) => {
  at("fault").hidden = false;
  at("fault").textContent = `The view does not answer any more: ${error.message}`;
});
