#!/usr/bin/python3
"""Opens reports in headless Chromium: every number that a page shows is that of the result files, hostile names are text,
the console is silent. usage: cells.py TALISMAN OUT [--all]"""
import json
import pathlib
import random
import subprocess
import sys
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

SEED = 16
HOSTILE = ["</script><script>document.title='broken'</script>", "\"quotes' & <b>bold</b>", "x" * 1000, "\u202eright to left"]


def browser():
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    for word in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"):
        options.add_argument(word)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def flat(value, path=""):
    """The leaves of a line, by path as the table of columns writes it."""
    if isinstance(value, dict):
        return {k: v for name, part in value.items() for k, v in flat(part, f"{path}/{name}").items()}
    if isinstance(value, list):
        return {k: v for i, part in enumerate(value) for k, v in flat(part, f"{path}/{i}").items()}
    return {path[1:]: value}


PATHS = {"warp_xx": "warp/0", "warp_x": "warp/2", "geometric_px": "geometric_px", "warp_geometric_px": "fiducials/warp_geometric_px",
         "magnification": "fiducials/magnification", "anisotropy": "fiducials/anisotropy", "cost_polygons": "cost/polygons",
         "cost_pixels": "cost/pixels", "frames_since_render": "fiducials/frames_since_render", "sprite_x": "sprite/screen_from_sprite/2",
         "sprite_width": "sprite/size/0", "depicts_frame": "depicts_frame", "photometric_color": "fiducials/photometric/color"}


def open_report(driver, file, fragment=""):
    driver.get("about:blank")
    began = time.time()
    driver.get(f"file://{file}{fragment}")
    while not driver.execute_script("return document.body.dataset.ready_ms"):
        assert time.time() - began < 60, f"{file}: not ready after a minute"
        time.sleep(0.02)
    times = driver.execute_script("return {...document.body.dataset}")
    log = [entry["message"] for entry in driver.get_log("browser")]
    assert not log, f"{file}: the console says {log}"
    print(f"{file.parent.name}: {file.stat().st_size / 1e6:.2f} MB, painted {float(times['painted_ms']):.0f} ms, "
          f"ready {float(times['ready_ms']):.0f} ms, click {float(times['click_ms']):.0f} ms")


# Chooses a cell as a link does, and reads what the panel then shows.
READ = """
selection.set({frame: arguments[0], layer: arguments[1]});
const cells = {};
for (const td of document.querySelectorAll('#properties td[data-column]')) {
  const data = td.querySelector('data');
  cells[td.dataset.column] = data ? data.value : ['–', 'out of view'].includes(td.textContent) ? null : td.textContent;
}
return {cells, why: document.querySelector('#properties .why').textContent};
"""


def check_cells(driver, folder, count):
    name = folder / "decisions.jsonl"
    lines = [json.loads(text) for text in open(name if name.exists() else f"{name}.partial") if text.endswith("\n")]
    random.seed(SEED)
    compared = 0
    while compared < count:
        line = random.choice(lines)
        seen, leaves = driver.execute_script(READ, line["frame"], line["layer"]), flat(line)
        assert line["reason"] in seen["why"], (line["frame"], line["layer"], line["reason"], seen["why"])
        for column, path in PATHS.items():
            shown, value = seen["cells"].get(column), leaves.get(path)
            assert (shown is None) == (value is None), (line["frame"], line["layer"], column, shown, value)
            if value is not None:
                assert float(shown) == value, (line["frame"], line["layer"], column, shown, value)
            compared += 1
    print(f"{folder.name}: {compared} cells equal the file (seed {SEED})")


def rename(folder, names):
    """The same run with other names of layers."""
    for file in folder.glob("*.json*"):
        text = file.read_text()
        for old, new in names.items():
            text = text.replace(json.dumps(old), json.dumps(new))
        file.write_text(text)


def run(tool, *words):
    subprocess.run([tool, *words], check=True, stdout=subprocess.DEVNULL)


def main():
    tool, out, everything = sys.argv[1], pathlib.Path(sys.argv[2]).absolute(), "--all" in sys.argv
    out.mkdir(parents=True, exist_ok=True)
    small = ["--size", "160x120", "--progress", "none"]
    folders = {name: out / name for name in ("carousel", "plan", "one", "partial", "hostile")}
    run(tool, "render", "carousel", "--frames", "0-47", *small, "--out", folders["carousel"])
    run(tool, "plan", "carousel", *small, "--out", folders["plan"])
    run(tool, "render", "carousel", "--frames", "20", *small, "--out", folders["one"])
    for name in ("partial", "hostile"):
        run(tool, "plan", "carousel", "--frames", "0-9", *small, "--out", folders[name])
    lines = (folders["partial"] / "decisions.jsonl").read_text()
    (folders["partial"] / "decisions.jsonl").unlink()
    (folders["partial"] / "summary.json").unlink()
    (folders["partial"] / "decisions.jsonl.partial").write_text(lines[: len(lines) * 2 // 3])
    rename(folders["hostile"], dict(zip(["ground", "disc", "pole", "roof"], HOSTILE)))
    for name in ("partial", "hostile"):
        run(tool, "report", folders[name])
    driver = browser()
    try:
        for name, folder in folders.items():
            open_report(driver, folder / "report.html")
            check_cells(driver, folder, 1000 if everything or name == "carousel" else 200)
        assert driver.title.startswith("carousel"), driver.title
        names = driver.execute_script("return [...document.querySelectorAll('#layers-panel .name')].map((a) => a.textContent)")
        assert set(HOSTILE) <= set(names), names
        check_keys_and_links(driver, folders["carousel"] / "report.html")
        check_widths(driver, folders["carousel"] / "report.html")
    finally:
        driver.quit()


def check_keys_and_links(driver, file):
    open_report(driver, file, "#frame=17&layer=horse%201")
    at = "return `${selection.frame} ${selection.layer}`"
    assert driver.execute_script(at) == "17 horse 1", driver.execute_script(at)
    driver.find_element("id", "map").send_keys("\ue014")  # right
    assert driver.execute_script(at) == "18 horse 1", driver.execute_script(at)
    assert driver.execute_script("return location.hash") == "#frame=18&layer=horse%201"
    rate = driver.execute_script("""
        const x = document.querySelector('#tables a[href^="#frame"]'); x.click();
        return selection.link() === x.getAttribute('href') || new Promise((r) => setTimeout(() => r(selection.link() === x.getAttribute('href')), 200));""")
    assert rate, "a link of the tables chooses nothing"


def check_widths(driver, file):
    for width in (360, 800, 1400, 2400):
        for theme in ("light", "dark"):
            driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
            driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": theme}]})
            open_report(driver, file)
            wide = driver.execute_script("return document.documentElement.scrollWidth")
            assert wide <= width, f"{width} px wide, {theme}: the page is {wide} px wide"


if __name__ == "__main__":
    main()
