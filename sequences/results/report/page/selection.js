// What is looked at? A layer in a frame of a run: in the address as #frame=120&layer=leader, so that a link shows it.

const selection = {
  frame: 0, layer: "", run: 0, listeners: [], refused: "",  // what the address asked for and the run does not have, in words
  // `by`: who asks; all listeners are told.
  set(change) {
    const before = `${this.run} ${this.frame} ${this.layer}`;
    const refused = this.refused;
    this.refused = "";
    Object.assign(this, change);
    if (this.refused === refused && `${this.run} ${this.frame} ${this.layer}` === before) return;
    history.replaceState(null, "", this.link());
    this.tell();
  },
  tell() {
    for (const listener of this.listeners) listener(this);
  },
  link(frame = this.frame, layer = this.layer) {
    return `#frame=${frame}&layer=${encodeURIComponent(layer)}${this.run > 0 ? "&run=b" : ""}`;
  },
  // What the address says; nothing where it says nothing.
  fromAddress(runs) {
    const words = new URLSearchParams(location.hash.slice(1)), change = {};
    const frame = Number.parseInt(words.get("frame"), 10), run = words.get("run") === "b" && runs.length > 1 ? 1 : 0;
    if (words.has("run")) change.run = run;
    const of = runs[change.run ?? this.run];
    const refused = [];
    if (frame >= of.first && frame <= of.last) change.frame = frame;
    else if (words.has("frame")) refused.push(`The run has no frame ${words.get("frame")}: it has ${of.first} to ${of.last}.`);
    if (of.layerAt.has(words.get("layer"))) change.layer = words.get("layer");
    else if (words.has("layer")) refused.push(`It has no layer "${words.get("layer").slice(0, 100)}".`);
    return {...change, refused: refused.join(" ")};
  },
};

// An element with text: names are never read as HTML.
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value !== null && value !== false) made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children);
  return made;
}

// What is read has four digits; the exact number is its value, and its title.
function numberElement(value) {
  if (value === null || value === undefined) return document.createTextNode("–");
  if (typeof value === "string") return document.createTextNode(value);
  const text = Math.abs(value) < 1e-9 ? "0" : Number.isInteger(value) ? String(value) : String(Number(value.toPrecision(4)));
  return element("data", {value: String(value), title: String(value)}, text.replace("-", "−"));
}

// Colours of the theme, looked up once: to ask for a style makes the browser work out all of them.
const themeColors = new Map();
function css(name) {
  if (!themeColors.has(name)) themeColors.set(name, getComputedStyle(document.documentElement).getPropertyValue(name).trim());
  return themeColors.get(name);
}
function color(kind) {
  return css(`--kind-${kind}`);
}
