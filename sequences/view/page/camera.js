// The camera, flown by hand: a pose per frame, six numbers, position and target; recorded while the picture is dragged.

const kMostPoses = 500, kTurn_px = 300, kSteepest = 0.99;

const plus = (a, b, s) => a.map((v, k) => v + b[k] * s);
const crossed = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((v) => v / (Math.hypot(...a) || 1));
const dotted = (a, b) => a.reduce((sum, v, k) => sum + v * b[k], 0);

class Flight {
  constructor(camera) {
    Object.assign(this, {camera, kind: "own", poses: []});
  }
  // "own", "orbit" or "fly". What orbits goes round the place on the line of sight that is nearest to the origin.
  start(kind) {
    const {position, forward} = this.camera, ahead = -dotted(position, forward);
    const reach = ahead > 0.1 ? ahead : Math.max(1, Math.hypot(...position) / 2);
    this.kind = kind;
    this.poses = kind === "own" ? [] : [this.rounded(position, plus(position, forward, reach))];
  }
  rounded(position, target) {
    return [...position, ...target].map((v) => Number(v.toPrecision(7)));
  }
  // Turned by shares of a radian, gone ahead by a share of what lies before it. False where it would stand on its head, or
  // the flight is long enough.
  record(right, down, ahead) {
    if (this.poses.length === 0 || this.poses.length >= kMostPoses) return false;
    const last = this.poses[this.poses.length - 1], position = last.slice(0, 3), target = last.slice(3);
    const sight = plus(target, position, -1), reach = Math.hypot(...sight), f = unit(sight);
    const side = unit(crossed(f, [0, 1, 0])), up = crossed(side, f), turned = unit(plus(plus(f, side, right), up, -down));
    if (Math.abs(turned[1]) > kSteepest) return false;
    if (this.kind === "orbit") {
      this.poses.push(this.rounded(plus(target, turned, -reach * (1 - ahead)), target));
    } else {
      const moved = plus(position, turned, ahead * reach);
      this.poses.push(this.rounded(moved, plus(moved, turned, reach)));
    }
    return true;
  }
}

// Drags of the picture and keys, as calls of `move(right, down, ahead)`.
function watchCamera(picture, flight, move) {
  let at = null;
  picture.addEventListener("pointerdown", (event) => {
    at = [event.clientX, event.clientY];
    picture.setPointerCapture(event.pointerId);
  });
  picture.addEventListener("pointermove", (event) => {
    if (!at || flight.kind === "own") return;
    const turn = flight.kind === "orbit" ? -1 : 1;
    move((turn * (event.clientX - at[0])) / kTurn_px, (turn * (event.clientY - at[1])) / kTurn_px, 0);
    at = [event.clientX, event.clientY];
  });
  for (const end of ["pointerup", "pointercancel"]) picture.addEventListener(end, () => { at = null; });
  picture.addEventListener("wheel", (event) => {
    if (flight.kind === "own") return;
    event.preventDefault();
    move(0, 0, -Math.sign(event.deltaY) * 0.05);
  }, {passive: false});
  addEventListener("keydown", (event) => {
    const step = {w: [0, 0, 0.05], s: [0, 0, -0.05], a: [-0.05, 0, 0], d: [0.05, 0, 0]}[event.key];
    if (flight.kind === "own" || !step || event.target.matches("input, select, textarea")) return;
    move(...step);
  });
}
