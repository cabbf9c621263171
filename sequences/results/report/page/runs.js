// When did that layer change? Runs of equal decisions of the chosen layer as a table: what the map shows, for who reads
// rather than looks.

const kMostSpans = 500;

function spansOf(run, layer) {
  const spans = [];
  for (let frame = run.first; frame <= run.last; ++frame) {
    const row = run.row(layer, frame), kind = row < 0 ? "" : run.kind(row), last = spans[spans.length - 1];
    const error = run.value("geometric_px", row) ?? 0;
    if (last && last.kind === kind) {
      last.to = frame;
      last.error = Math.max(last.error, error);
    } else {
      spans.push({from: frame, to: frame, kind, error});
    }
  }
  return spans.filter((span) => span.kind !== "");
}

class SpansTable {
  constructor(box) {
    this.box = box;
  }
  draw(run) {
    const spans = spansOf(run, selection.layer), name = `${selection.run} ${selection.layer}`;
    if (this.name === name) return;
    this.name = name;
    const lines = spans.slice(0, kMostSpans).map((span) => element("tr", {},
      element("th", {scope: "row"}, element("a", {href: selection.link(span.from)}, span.from === span.to ? `${span.from}` : `${span.from} to ${span.to}`)),
      element("td", {}, kKindWords[span.kind]), element("td", {class: "n"}, numberElement(span.error))));
    const more = spans.length > kMostSpans ? `, the first ${kMostSpans} of ${spans.length}` : "";
    this.box.replaceChildren(element("table", {class: "properties"}, element("caption", {}, "Runs of equal decisions of ", element("bdi", {}, selection.layer), more),
      element("thead", {}, element("tr", {}, element("th", {scope: "col"}, "frames"), element("th", {scope: "col"}, "done"), element("th", {scope: "col", class: "n"}, "largest error px"))),
      element("tbody", {}, ...lines)));
  }
}
