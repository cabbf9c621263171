#!/usr/bin/python3
"""Opens pages in headless Chromium and asks of each: has axe-core anything to say, light and dark, wide and narrow; does it
fit; is it whole when printed? Reports of one and of two runs, of many layers and of some that come late, pages of
experiments, the live view; and a trace in speedscope. With --times also how large and how fast large reports are.
usage: pages.py TALISMAN OUT NPM [--times]     NPM: a folder with axe-core and speedscope (tests/fetch-npm)"""
import base64
import contextlib
import csv
import functools
import http.server
import json
import math
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import threading
import time

from selenium.webdriver.common.action_chains import ActionChains

from cells import browser, check_cells, open_report, run
from view import open_view, serving, wait_for

AXE, SPEEDSCOPE = "axe-core@4.10.3", "speedscope@1.22.2"
MOST_CLICK_MS, MOST_PAINT_MS, MOST_HEAP_MB, LEAST_PANS = 50, 3000, 400, 20


def look(driver, width, theme, media="screen"):
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": media, "features": [{"name": "prefers-color-scheme", "value": theme}]})


def check_axe(driver, axe, name):
    """All rules of axe-core, in what is there now."""
    driver.execute_script(axe)
    found = driver.execute_async_script(
        "const done = arguments[0]; axe.run(document, {resultTypes: ['violations']}).then((r) => done(r.violations), (e) => done([{id: String(e), nodes: []}]));")
    said = [f"{v['id']}: {v.get('help', '')}: {[n['html'][:160] for n in v['nodes'][:3]]}" for v in found]
    assert not said, f"{name}: axe-core says\n  " + "\n  ".join(said)


def check_looks(driver, axe, name, shots, reopen):
    """`reopen` shows the page anew."""
    for width in (360, 1400):
        for theme in ("light", "dark"):
            look(driver, width, theme)
            reopen()
            wide = driver.execute_script("return document.documentElement.scrollWidth")
            assert wide <= width, f"{name}: {width} px wide, {theme}: the page is {wide} px wide"
            check_axe(driver, axe, f"{name}, {width} px, {theme}")
            driver.save_screenshot(str(shots / f"{name}-{width}-{theme}.png"))
    print(f"{name}: axe-core is silent at 360 and 1400 px, light and dark", flush=True)


def check_print(driver, name, shots):
    """On paper nothing is cut off by a box that scrolls, and the ground is white in the dark, too."""
    look(driver, 1000, "dark", "print")
    cut = driver.execute_script("""return [...document.querySelectorAll('.scroll, .scrolls')].filter((box) => box.scrollHeight > box.clientHeight + 2 ||
      box.scrollWidth > box.clientWidth + 2).map((box) => box.getAttribute('aria-label'));""")
    assert not cut, f"{name}: printed, these are cut off: {cut}"
    ground = driver.execute_script("return getComputedStyle(document.body).backgroundColor")
    assert ground == "rgb(255, 255, 255)", f"{name}: printed on {ground}"
    pdf = base64.b64decode(driver.execute_cdp_cmd("Page.printToPDF", {"printBackground": True})["data"])
    (shots / f"{name}.pdf").write_bytes(pdf)
    pages = len(re.findall(rb"/Type\s*/Page\b", pdf))
    assert pages >= 1, f"{name}: {pages} pages"
    look(driver, 1400, "light")
    print(f"{name}: printed on {pages} pages", flush=True)


def heap_mb(driver):
    """Objects, and what typed arrays hold beside them."""
    driver.execute_cdp_cmd("HeapProfiler.collectGarbage", {})
    usage = driver.execute_cdp_cmd("Runtime.getHeapUsage", {})
    return sum(usage.get(part, 0) for part in ("usedSize", "embedderHeapUsedSize", "backingStorageSize")) / 1e6


def thread_ms(driver):
    """Processor time of the page's thread so far: what a busy machine does not change."""
    metrics = {m["name"]: m["value"] for m in driver.execute_cdp_cmd("Performance.getMetrics", {})["metrics"]}
    return 1000 * metrics["TaskDuration"]


def spheres(count, frames, late=False):
    """A sequence of that many layers; `late`: the last ones come into view in the second half."""
    side = math.ceil(math.sqrt(count))
    text = f"name: spheres\nframes: {frames}\nfps: 24\ndisplay: [320, 240]\nshapes:\n"
    for k in range(count):
        x, y = 10 * ((k % side + 0.5) / side - 0.5), 8 * ((k // side + 0.5) / side - 0.5)
        far = late and k > count // 2
        place = (f"flight: [{{t: 0, position: [{x + 100:.3f}, {y:.3f}, 0], target: [{x + 100:.3f}, {y:.3f}, -50]}}, {{t: {frames / 24:.3f}, position: [{x:.3f}, {y:.3f}, 0], target: [{x:.3f}, {y:.3f}, -50]}}]"
                 if far else f"position: [{x:.3f}, {y:.3f}, {k % 5}], spin: {{axis: [0, 1, 0], deg_per_s: {20 + k % 60}}}")
        text += f"  - {{id: group {k % 7}/ball {k}, sphere: [0.2, 0.15, 0.1], segments: 4, {place}}}\n"
    text += "camera: {fov_deg: 45, near_m: 1, far_m: 100, flight: [{t: 0, position: [0, 0, 16], target: [0, 0, 0]}, "
    text += f"{{t: {frames / 24:.3f}, position: [2, 1, 12], target: [0, 0, 0]}}]}}\nlayers:\n"
    return text + "".join(f"  - {{name: group {k % 7}/ball {k}, parts: [\"group {k % 7}/ball {k}\"]}}\n" for k in range(count))


def planned(tool, out, name, sequence, *words):
    folder = out / name
    shutil.rmtree(folder, ignore_errors=True)
    run(tool, "plan", sequence, "--progress", "none", "--quiet", "--out", folder, *words)
    return folder


def check_reports(driver, tool, out, axe):
    shots = out / "shots"
    carousel = planned(tool, out, "carousel-plan", "carousel", "--size", "160x120")
    other = planned(tool, out, "carousel-hold", "carousel", "--size", "160x120", "--policy", "hold", "--frames", "0-47")
    run(tool, "report", carousel, other, "--out", out / "two.html")
    for name, file in (("report", carousel / "report.html"), ("two-runs", out / "two.html")):
        check_looks(driver, axe, name, shots, lambda file=file: open_report(driver, file))
        check_print(driver, name, shots)
    for name, count, frames, late in (("late", 12, 48, True), ("thousand", 1000, 8, False)):
        (out / f"{name}.yaml").write_text(spheres(count, frames, late))
        folder = planned(tool, out, name, out / f"{name}.yaml")
        open_report(driver, folder / "report.html")
        check_cells(driver, folder, 200)
        layers = driver.execute_script("return new Set(document.querySelectorAll('#layers-panel .name')).size")
        assert layers == min(400, count), (name, layers)
        driver.save_screenshot(str(shots / f"{name}.png"))
    for name in ("canyon", "stage"):
        told = subprocess.run([tool, "plan", name, "--size", "256x256", "--progress", "none", "--quiet", "--out", out / name], capture_output=True, text=True)
        if told.returncode:
            print(f"{name}: not looked at: {told.stderr.strip()}", flush=True)
            continue
        open_report(driver, out / name / "report.html")
        check_cells(driver, out / name, 1000)
        driver.save_screenshot(str(shots / f"{name}.png"))


FEW = ["--frames", "0-11", "--size", "160x120", "--quality-every", "6"]
# Of every experiment: its page, and how it is asked for, with content that lies in the repository.
EXPERIMENTS = {
    "reproduce": ["reproduce", "--quick", "--only", "LS97:15"],
    "solvers": ["accuracy", "--solvers", "--inputs", "2"],
    "hard": ["accuracy", "--hard"],
    "regulator": ["accuracy", "--regulator", "carousel", *FEW],
    "renderer": ["accuracy", "--renderer", "carousel", "--frames", "0-3", "--size", "160x120", "--quality-every", "2"],
    "factoring": ["accuracy", "--factoring", "tour/shade-layers", *FEW],
    "predictive": ["accuracy", "--predictive", "fearing/blocks", *FEW],
    "amortised": ["accuracy", "--amortised", "tour/lookahead", *FEW],
    "latency": ["accuracy", "--latency", "hall", "--size", "160x120"],
    "lod": ["accuracy", "--lod", "tour/lookahead", *FEW],
    "culling": ["accuracy", "--culling", "hall", "--frames", "0-3", "--size", "160x120"],
    "visibility": ["accuracy", "--visibility", "hall", "--frames", "0-3", "--size", "160x120"],
    "memory": ["accuracy", "--memory", "hall", "--frames", "0-9"],
    "compare": ["compare", "carousel", "threshold:1", "hold:3", "--no-video", "--frames", "0-11", "--size", "160x120"],
    "tune": ["tune", "carousel", "--flip", "0.02", "--frames", "0-5", "--size", "160x120"]}


def check_console(driver, page):
    log = [entry["message"] for entry in driver.get_log("browser")]
    assert not log, f"{page}: the console says {log}"


def check_experiments(driver, tool, out, axe):
    shots = out / "shots"
    for name, words in EXPERIMENTS.items():
        folder = out / name
        shutil.rmtree(folder, ignore_errors=True)
        run(tool, *words, "--progress", "none", "--out", folder)
        page = folder / f"{name}.html"
        text = page.read_text()
        # The policy names no place to load from; nor may the text.
        outside = [link for link in re.findall(r'(?:src|href)="([^"]*)"', text) if not link.startswith(("#", "data:image/png;base64,", "runs/"))]
        assert not outside, f"{page}: refers to {outside[:3]}"
        check_looks(driver, axe, name, shots, lambda page=page: driver.get(f"file://{page}"))
        check_console(driver, page)
        assert driver.find_element("id", "verdict").text, f"{page}: no verdict"
        before = driver.execute_script("return getComputedStyle(document.body).backgroundColor")
        driver.find_element("id", "theme").send_keys("\n")  # by a key
        assert driver.execute_script("return getComputedStyle(document.body).backgroundColor") != before, "the theme does not change"
        check_print(driver, name, shots)
    check_points(driver, out / "regulator")


def check_points(driver, folder):
    """A point of the ladder opens its run: its report has the polygons of the point."""
    page = folder / "regulator.html"
    table = list(csv.DictReader(open(folder / "regulator.csv")))
    for policy, knob, words in (("threshold", "1", "threshold 1 px"), ("oracle", "4", "oracle 4 px"), ("budget", "20", "budget 20 %")):
        driver.get(f"file://{page}")
        place = driver.find_element("css selector", f'figure a[aria-label="{words}"]')
        driver.execute_script("arguments[0].focus()", place)
        place.send_keys("\n")  # by a key
        began = time.time()
        while not driver.execute_script("return document.body.dataset.ready_ms"):
            assert time.time() - began < 30, f"{words}: its run does not open"
            time.sleep(0.05)
        check_console(driver, words)
        shown = driver.execute_script("return JSON.parse(document.getElementById('report').textContent).runs[0].layers.reduce((sum, layer) => sum + layer.polygons, 0)")
        row = next(row for row in table if row["policy"] == policy and row["knob"] == knob)
        assert shown == int(float(row["polygons"])), (words, shown, row["polygons"])
    driver.get(f"file://{page}")
    place = driver.find_element("css selector", 'figure a[aria-label="threshold 1 px"]')
    driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", place)
    ActionChains(driver).move_to_element(place).click().perform()
    wait_for(driver, "location.href.endsWith('/runs/threshold-1-px.html')", "a click on a point")
    print("regulator: points open their runs, by key and by click", flush=True)


def check_view(driver, tool, out, axe):
    with serving(tool, "carousel", "--size", "160x120", "--out", out / "viewed") as (url, _):
        look(driver, 1400, "light")
        open_view(driver, url)
        address = driver.current_url

        def again():
            driver.get(address)
            wait_for(driver, "Number(document.body.dataset.pictures) > 0 && view.runs[0].complete", "the plan")
        check_looks(driver, axe, "view", out / "shots", again)


@contextlib.contextmanager
def folder_server(folder):
    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=str(folder)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}"
    finally:
        server.shutdown()


def check_speedscope(driver, tool, out, npm):
    """An independent reader of the trace: a profile per track, each with the names of our slices."""
    folder = out / "carousel-plan"
    run(tool, "export", folder, "--trace")
    trace = json.loads((folder / "trace.json").read_text())
    events = trace["traceEvents"] if isinstance(trace, dict) else trace
    tracks = {(e["pid"], e["tid"]) for e in events if e["ph"] in "BEX"}
    site = out / "speedscope"
    shutil.rmtree(site, ignore_errors=True)
    shutil.copytree(npm / SPEEDSCOPE / "dist" / "release", site)
    shutil.copy(folder / "trace.json", site / "trace.json")
    look(driver, 1400, "light")
    with folder_server(site) as address:
        driver.get(f"{address}/index.html#profileURL={address}/trace.json")
        began = time.time()
        shown = ""
        while not (found := re.search(r"\((\d+)/(\d+)\)", shown)):
            assert time.time() - began < 30, f"speedscope shows '{shown[:300]}'"
            time.sleep(0.2)
            shown = driver.execute_script("return document.body.innerText")
        driver.save_screenshot(str(out / "shots" / "speedscope.png"))
    assert int(found[2]) == len(tracks), f"speedscope has {found[2]} profiles of {len(tracks)} tracks"
    print(f"speedscope reads the trace: {found[2]} tracks", flush=True)


def time_page(driver, file):
    """First paint, clicks, panning and the heap, measured in the page."""
    driver.get("about:blank")
    driver.execute_cdp_cmd("Performance.disable", {})
    driver.execute_cdp_cmd("Performance.enable", {"timeDomain": "threadTicks"})
    began, thread = time.time(), [thread_ms(driver)]
    driver.get(f"file://{file}")
    while not driver.execute_script("return document.body.dataset.ready_ms"):
        assert time.time() - began < 120, f"{file}: not ready after two minutes"
        time.sleep(0.05)
    data = driver.execute_script("return {...document.body.dataset}")
    thread.append(thread_ms(driver))
    clicks = driver.execute_script("""
      const map = document.getElementById('map'), box = map.getBoundingClientRect(), times = [];
      for (let k = 0; k < 40; ++k) {
        const at = {clientX: box.left + 160 + (k * 97) % (box.width - 170), clientY: box.top + 5 + (k * 53) % (box.height - 40), pointerId: 1, bubbles: true};
        const began = performance.now();
        map.dispatchEvent(new PointerEvent('pointerdown', at));
        map.dispatchEvent(new PointerEvent('pointerup', at));
        document.getElementById('properties').getBoundingClientRect();
        times.push(performance.now() - began);
      }
      return times;""")
    thread.append(thread_ms(driver))
    pans = driver.execute_async_script("""
      const done = arguments[0], map = document.getElementById('map'), box = map.getBoundingClientRect(); let frames = 0;
      const zoom = [...document.querySelectorAll('.buttons button')][1]; zoom.click(); zoom.click();
      const at = (x) => ({clientX: x, clientY: box.top + 20, pointerId: 1, bubbles: true});
      map.dispatchEvent(new PointerEvent('pointerdown', at(box.left + 300)));
      const began = performance.now();
      function step() {
        map.dispatchEvent(new PointerEvent('pointermove', at(box.left + 300 + 200 * Math.sin(frames / 5)))); ++frames;
        if (performance.now() - began < 2000) requestAnimationFrame(step);
        else { map.dispatchEvent(new PointerEvent('pointerup', at(box.left + 300))); done(frames); }
      }
      requestAnimationFrame(step);""") / 2
    thread.append(thread_ms(driver))
    of_thread = [b - a for a, b in zip(thread, thread[1:])]
    click, heap = statistics.median(clicks), heap_mb(driver)
    print(f"{file.parent.name}: {file.stat().st_size / 1e6:.2f} MB, first paint {float(data['painted_ms']):.0f} ms, ready {float(data['ready_ms']):.0f} ms, "
          f"click to properties {click:.0f} ms (largest {max(clicks):.0f}), {pans:.0f} pans a second, heap {heap:.0f} MB; processor time of the page: {of_thread[0]:.0f} ms until ready, "
          f"{of_thread[1] / len(clicks):.1f} ms a click, {of_thread[2] / max(1, 2 * pans):.1f} ms a pan", flush=True)
    return {"click ms": click <= MOST_CLICK_MS, "paint": float(data["painted_ms"]) <= MOST_PAINT_MS, "pans": pans >= LEAST_PANS, "heap": heap <= MOST_HEAP_MB}


def check_times(driver, tool, out):
    look(driver, 1400, "light")
    (out / "long.yaml").write_text(spheres(40, 10000))
    missed = []
    for name, sequence, words in (("canyon", "canyon", ["--size", "512x512"]), ("barnyard", "barnyard", ["--size", "512x512"]), ("long", out / "long.yaml", [])):
        try:
            folder = planned(tool, out, f"times-{name}", sequence, *words)
        except subprocess.CalledProcessError:
            print(f"{name}: cannot be planned here")
            continue
        missed += [f"{name}: {what}" for what, held in time_page(driver, folder / "report.html").items() if not held]
        shutil.rmtree(folder)
    assert not missed, missed


def main():
    tool, out, npm = str(pathlib.Path(sys.argv[1]).absolute()), pathlib.Path(sys.argv[2]).absolute() / "pages", pathlib.Path(sys.argv[3]).absolute()
    (out / "shots").mkdir(parents=True, exist_ok=True)
    axe = (npm / AXE / "axe.min.js").read_text()
    driver = browser()
    driver.set_script_timeout(120)
    try:
        if "--times" in sys.argv:
            check_times(driver, tool, out)
            return
        check_reports(driver, tool, out, axe)
        check_experiments(driver, tool, out, axe)
        check_view(driver, tool, out, axe)
        check_speedscope(driver, tool, out, npm)
    finally:
        driver.quit()


if __name__ == "__main__":
    main()
