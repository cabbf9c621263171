// The report: opens the runs that the page holds, and says on `document.body.dataset` how far it is.

async function start() {
  const began = performance.now(), data = JSON.parse(document.getElementById("report").textContent);
  const runs = data.runs.map((json) => new Run(json));
  for (const run of runs) await run.open();
  document.getElementById("instrument").hidden = false;
  document.getElementById("still")?.remove();
  const worst = runs[0].worst ?? {frame: runs[0].first, layer: runs[0].layers[0] ?? ""};
  const instrument = new Instrument(runs);
  Object.assign(selection, worst, selection.fromAddress(runs));
  instrument.map.rebuild();
  await instrument.curves.draw();
  instrument.drawAll();
  document.body.dataset.painted_ms = performance.now() - began;
  for (const run of runs) await run.decisions.needAll();
  instrument.drawAll();
  document.body.dataset.ready_ms = performance.now() - began;
}

start().catch((error) => {
  document.getElementById("instrument").hidden = true;
  console.error(error);
});
