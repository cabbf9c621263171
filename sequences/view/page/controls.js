// The settings: a control per option that the tool offers, with its help, and its line where a value is refused.

// Where a setting has another name than its option, and how far its slider goes.
const kSettingOf = {hold: "hold_frames", blend: "blend_frames", lookahead: "lookahead_frames", "expected-reuse": "expected_reuse_frames",
                    resolution: "resolution_scale", size: "display_px"};
const kRanges = {"tree-k": [2, 16, 1], "regroup-dwell": [1, 120, 1], "depth-complexity": [0, 8, 0.1], "material-points": [0, 1024, 16], compression: [0, 100, 1],
                 "geometric-px": [0, 16, 0.05], photometric: [0, 1, 0.005], "light-angle-deg": [0, 90, 0.5], "shadow-map-px": [0, 16, 0.1],
                 "turned-px": [0, 64, 0.5], hold: [1, 30, 1], blend: [0, 16, 1], lookahead: [0, 64, 1], "min-resolution": [0.1, 1, 0.05],
                 resolution: [0.1, 2, 0.05], "expected-reuse": [0, 30, 1], "cutoff-px": [0, 8, 0.1]};
const kOpenGroups = ["Policy", "Thresholds"];

// What the sequence itself has, as the option would be typed.
function settingOf(settings, option) {
  if (option === "light-angle-deg") return String(Number(((settings.light_angle_rad * 180) / Math.PI).toPrecision(6)));
  if (option === "compression") return String(settings.compression ?? 0);
  const value = settings[kSettingOf[option] ?? option.replaceAll("-", "_")];
  if (Array.isArray(value)) return value.join("x");
  if (typeof value === "boolean") return value ? "on" : "off";
  return value === null || value === undefined ? "" : String(value);
}

class Controls {
  // `change` is called with the number of ms at which a control was moved.
  constructor(form, about, change) {
    Object.assign(this, {form, change, settings: {}, without: [], fields: new Map()});
    const groups = new Map();
    for (const control of about.controls) {
      if (!groups.has(control.group)) groups.set(control.group, this.group(control.group));
      groups.get(control.group).append(this.control(control, settingOf(about.settings, control.option)));
    }
    const effects = this.group("Effects");
    for (const effect of about.effects) effects.append(this.effect(effect));
    this.general = element("p", {class: "error", role: "alert", id: "error-general"});
    form.prepend(this.general);
    form.addEventListener("submit", (event) => event.preventDefault());
  }
  group(name) {
    const group = element("details", {open: kOpenGroups.includes(name)}, element("summary", {}, name));
    this.form.append(group);
    return group;
  }
  control({option, meaning, words}, value) {
    const error = element("span", {class: "error", role: "alert", id: `error-${option}`}), range = kRanges[option], id = `set-${option}`;
    const changed = (text, from) => {
      const began = performance.now();
      if (text === "") delete this.settings[option];
      else this.settings[option] = text;
      for (const input of inputs) if (input !== from) input.value = text;
      this.change(began);
    };
    const listens = (tag, attributes, ...children) => element(tag, {...attributes, oninput: (event) => changed(event.target.value, event.target)}, ...children);
    const inputs = words.length > 0
      ? [listens("select", {id, class: "wide"}, ...words.map((word) => element("option", {value: word, selected: word === value}, word)))]
      : range
        ? [listens("input", {type: "range", min: range[0], max: range[1], step: range[2], value, id: `slide-${option}`, "aria-label": option}),
           listens("input", {type: "text", inputmode: "decimal", value, id})]
        : [listens("input", {type: "text", value, id, class: "wide"})];
    this.fields.set(option, error);
    return element("div", {class: "control", title: meaning}, element("label", {for: id}, option), ...inputs, error);
  }
  effect({name, why}) {
    const box = element("input", {type: "checkbox", checked: true, id: `effect-${name}`, onchange: () => {
      this.without = this.without.filter((other) => other !== name).concat(box.checked ? [] : [name]);
      this.change(performance.now());
    }});
    return element("label", {class: "effect", title: why}, box, name.replaceAll("_", " "));
  }
  // The tool's line beside the control that it names; "": all is well.
  say(line) {
    const isNamed = (option) => [option, option.replaceAll("-", "_"), kSettingOf[option]].some((name) => name && new RegExp(`(^|[^a-z_-])(--)?${name}([^a-z_-]|$)`).test(line));
    const named = [...this.fields.keys()].filter(isNamed);
    const option = named.sort((a, b) => line.indexOf(a) - line.indexOf(b) || b.length - a.length)[0];
    for (const [name, error] of this.fields) error.textContent = name === option ? line : "";
    this.general.textContent = line !== "" && option === undefined ? line : "";
    if (option !== undefined) this.fields.get(option).closest("details").open = true;
  }
}
