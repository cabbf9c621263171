// Where are the sprites of this frame? The outline of each on the display, over the nearest picture that the page holds.

const kSvg = "http://www.w3.org/2000/svg";

function svgElement(tag, attributes, ...children) {
  const made = document.createElementNS(kSvg, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

// The corners of a decision's sprite on the display: the warp of where it was when it was drawn. Null where nothing is
// shown, or a corner lies behind the viewer.
function corners(run, row) {
  const at = (name, otherwise) => run.value(name, row) ?? otherwise;
  const width = at("sprite_width", 0), height = at("sprite_height", 0), points = [];
  if (width <= 0 || height <= 0 || run.value("decision", row) === "drop") return null;
  for (const [u, v] of [[0, 0], [width, 0], [width, height], [0, height]]) {
    const x = at("sprite_xx", 1) * u + at("sprite_xy", 0) * v + at("sprite_x", 0);
    const y = at("sprite_yx", 0) * u + at("sprite_yy", 1) * v + at("sprite_y", 0);
    const w = at("warp_wx", 0) * x + at("warp_wy", 0) * y + at("warp_w", 1);
    if (!(w > 0)) return null;
    points.push([(at("warp_xx", 1) * x + at("warp_xy", 0) * y + at("warp_x", 0)) / w,
                 (at("warp_yx", 0) * x + at("warp_yy", 1) * y + at("warp_y", 0)) / w]);
  }
  return points;
}

class FramePanel {
  constructor(box) {
    this.box = box;
    this.caption = element("p", {class: "caption"});
  }
  draw(run) {
    const [width, height] = run.settings.display_px, frame = selection.frame;
    const svg = svgElement("svg", {viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `frame ${frame} with the outlines of its sprites`});
    svg.append(svgElement("rect", {width, height, class: "display"}));
    const picture = run.picture(frame);
    if (picture) svg.append(svgElement("image", {href: picture.src, width, height, preserveAspectRatio: "none"}));
    let chosen = null;
    for (const name of run.layers) {
      const row = run.row(name, frame), points = row < 0 ? null : corners(run, row);
      if (!points) continue;
      const fresh = run.value("decision", row) === "rerender";
      const shape = svgElement("polygon", {points: points.map((p) => p.map((x) => x.toFixed(2)).join(",")).join(" "),
                                           class: `${fresh ? "fresh" : "old"}${name === selection.layer ? " chosen" : ""}`},
                               svgElement("title", {}, document.createTextNode(name)));
      shape.addEventListener("click", () => selection.set({layer: name}));
      if (name === selection.layer) chosen = shape;
      else svg.append(shape);
    }
    if (chosen) svg.append(chosen);
    this.box.replaceChildren(svg, this.caption);
    const of = !picture ? "outlines alone" : picture.frame === frame ? "" : `over the picture of frame ${picture.frame}`;
    this.caption.textContent = `Frame ${frame}${of ? ", " + of : ""}. Solid: drawn for it; dashed: an older sprite, warped.`;
  }
}
