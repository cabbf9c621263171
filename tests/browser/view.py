#!/usr/bin/python3
"""Opens the live view in headless Chromium: sliders make the plan that `plan` prints, an invalid value is said beside its
control, the camera is dragged and saved. usage: view.py TALISMAN OUT"""
import contextlib
import json
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.support.ui import Select

from cells import browser

PATIENCE_S = 30


@contextlib.contextmanager
def serving(tool, *words, expect=0):
    """The address of a live view, and its process."""
    process = subprocess.Popen([tool, "view", *map(str, words)], stdout=subprocess.PIPE, text=True)
    try:
        yield process.stdout.readline().strip(), process
    finally:
        process.send_signal(signal.SIGINT)
        ended = process.wait(20)
    assert ended == expect, f"view ended with {ended}"


def wait_for(driver, script, what):
    began = time.time()
    while not driver.execute_script(f"return {script}"):
        assert time.time() - began < PATIENCE_S, f"{what}: not after {PATIENCE_S} s"
        time.sleep(0.02)


def check_console(driver):
    """Refusals are shown in the page; the console has nothing but the browser's own note of them."""
    said = [entry["message"] for entry in driver.get_log("browser")]
    said = [text for text in said if not re.search(r"status of (409|422)", text)]
    assert not said, f"the console says {said}"


def open_view(driver, url):
    driver.get(url)
    wait_for(driver, "Number(document.body.dataset.pictures) > 0 && document.body.dataset.details !== undefined", "the first picture")
    assert "token" not in driver.current_url, driver.current_url
    assert driver.execute_script("return document.cookie") == "", "a script can read the cookie"


def set_value(driver, option, value):
    """As a user who types it; waits for the answer."""
    plans = driver.execute_script("return document.body.dataset.plans")
    driver.execute_script("""const field = document.getElementById(arguments[0]); field.value = arguments[1];
                             field.dispatchEvent(new Event('input', {bubbles: true}));""", f"set-{option}", str(value))
    wait_for(driver, f"document.body.dataset.plans !== '{plans}' || document.querySelector('.error:not(:empty)')", f"{option} = {value}")


PLAN = """
const {columns, rows} = view.runs[0].decisions;
return [...Array(rows).keys()].map((r) => ["frame", "layer", "decision", "reason", "geometric_px"].map((name) => columns.get(name).values[r] ?? null));"""


def check_plan(driver, tool, out, words, of_pictures=()):
    """`of_pictures`: what plan does not take, and render does."""
    folder = out / "plan"
    shutil.rmtree(folder, ignore_errors=True)
    command = ["render", "--format", "none", *of_pictures] if of_pictures else ["plan"]
    subprocess.run([tool, *command, *words, "--quiet", "--no-report", "--out", folder], check=True)
    lines = [json.loads(text) for text in open(folder / "decisions.jsonl")]
    expected = [[line["frame"], line["layer"], line["decision"], line["reason"], line.get("geometric_px")] for line in lines]
    shown = driver.execute_script(PLAN)
    assert len(shown) == len(expected), (words, len(shown), len(expected))
    for a, b in zip(shown, expected):
        assert a == b, (words, a, b)
    print(f"view: {len(expected)} decisions equal those of plan {' '.join(words[1:])}")


def check_settings(driver, tool, out):
    size = ["--size", "160x120"]
    check_plan(driver, tool, out, ["carousel", *size])
    set_value(driver, "geometric-px", 1.25)
    check_plan(driver, tool, out, ["carousel", *size, "--geometric-px", "1.25"])
    set_value(driver, "policy", "hold")
    set_value(driver, "hold", 7)
    check_plan(driver, tool, out, ["carousel", *size, "--policy", "hold", "--hold", "7"])
    before = driver.execute_script(PLAN)
    for option, value in (("hold", "0"), ("size", "many"), ("hold", "2.5")):
        old = driver.execute_script(f"return document.getElementById('set-{option}').value")
        set_value(driver, option, value)
        line = driver.execute_script(f"return document.getElementById('error-{option}').textContent")
        told = subprocess.run([tool, "plan", "carousel", f"--{option}={value}", "--quiet", "--out", out / "none"], capture_output=True, text=True)
        assert told.returncode == 2 and told.stderr == f"error: {line}\n", (line, told.stderr)
        assert driver.execute_script(PLAN) == before, "an invalid value changed the plan"
        set_value(driver, option, old)
        wait_for(driver, "!document.querySelector('.error:not(:empty)')", "the error to go")
    effect = driver.find_element("css selector", ".effect input")
    driver.execute_script("arguments[0].closest('details').open = true", effect)
    plans = driver.execute_script("return document.body.dataset.plans")
    effect.click()
    wait_for(driver, f"document.body.dataset.plans !== '{plans}'", "an effect off")


def check_pictures(driver):
    for mode in driver.execute_script("return view.about.modes"):
        count = driver.execute_script("return document.body.dataset.pictures")
        Select(driver.find_element("id", "mode")).select_by_value(mode)
        wait_for(driver, f"document.getElementById('picture').alt.endsWith(', {mode}') && document.getElementById('picture').naturalWidth > 0", mode)
        assert mode == "shown" or driver.execute_script("return document.body.dataset.pictures") != count
    Select(driver.find_element("id", "mode")).select_by_value("shown")
    driver.execute_script("selection.set({frame: 17, layer: 'horse 1'})")
    wait_for(driver, "document.body.dataset.details === '17' && document.getElementById('picture').alt === 'frame 17, shown'", "frame 17")
    assert driver.execute_script("return document.querySelectorAll('#frame polygon').length") > 3
    driver.find_element("id", "play").click()
    wait_for(driver, "selection.frame > 20", "the frames to play")
    driver.find_element("id", "play").click()


# Settings that not every sequence allows: of each the plan, all pictures, and a value that is refused, with what its line begins with.
MORE = [
    ("fearing/blocks", {"lookahead": "8", "joining": "copy", "samples": "1", "policy": "predictive"}, ("tree-k", "3")),
    ("hall", {"visibility": "cto,eye,eye", "shading": "flat"}, ("policy", "hold")),
    ("tour/lookahead", {"regroup": "amortised", "regroup-dwell": "3", "compression": "85", "resolution": "0.5"}, ("visibility", "cto,eye,eye"))]


def check_more_settings(driver, tool, out):
    size = ["--size", "160x120"]
    of_pictures = ("shading", "samples", "resolution", "compression", "late-chunks")
    for sequence, settings, (option, wrong) in MORE:
        with serving(tool, sequence, *size, "--out", out / "more") as (url, _):
            open_view(driver, url)
            for name, value in settings.items():
                set_value(driver, name, value)
            wait_for(driver, "view.runs[0].complete && !document.querySelector('.error:not(:empty)')", f"the plan of {sequence}")
            words = [f"--{name}={value}" for name, value in settings.items()]
            planned = [word for word in words if word[2:].split("=")[0] not in of_pictures]
            pictured = [word for word in words if word not in planned]
            check_plan(driver, tool, out, [sequence, *size, *planned], pictured)
            for mode in driver.execute_script("return view.about.modes"):
                Select(driver.find_element("id", "mode")).select_by_value(mode)
                wait_for(driver, f"document.getElementById('picture').alt.endsWith(', {mode}') && document.getElementById('picture').naturalWidth > 0 || "
                                 f"document.getElementById('error-policy').textContent.includes('{mode}')", f"{sequence}, {mode}")
                refused = driver.execute_script("return document.getElementById('error-policy').textContent")
                assert (refused != "") == (mode in ("age", "depth") and sequence != "tour/lookahead"), (sequence, mode, refused)
            Select(driver.find_element("id", "mode")).select_by_value("shown")
            wait_for(driver, "document.getElementById('picture').alt.endsWith(', shown') && !document.querySelector('.error:not(:empty)')", "the picture again")
            driver.execute_script("selection.set({frame: 5, layer: view.runs[0].layers[0]})")
            wait_for(driver, "document.body.dataset.details === '5' && document.querySelector('#properties .why').textContent.length > 3", f"{sequence}: a decision")
            before = driver.execute_script(PLAN)
            set_value(driver, option, wrong)
            line = driver.execute_script("return [...document.querySelectorAll('.error')].map((e) => e.textContent).join('')")
            told = subprocess.run([tool, "plan", sequence, *size, *[w for w in planned if not w.startswith(f"--{option}=")], f"--{option}={wrong}", "--quiet", "--out", out / "none"],
                                  capture_output=True, text=True)
            assert told.returncode == 2 and told.stderr == f"error: {line}\n", (line, told.stderr)
            assert driver.execute_script("return document.querySelector('.error:not(:empty)').id") != "error-general", f"'{line}' stands beside no control"
            assert driver.execute_script(PLAN) == before, "an invalid value changed the plan"
            driver.save_screenshot(str(out / f"{sequence.replace('/', '-')}.png"))
            check_console(driver)


def drag(driver, moves):
    picture = driver.find_element("id", "picture")
    driver.execute_script("arguments[0].scrollIntoView()", picture)
    chain = ActionChains(driver, duration=20).move_to_element(picture).click_and_hold()
    for dx, dy in moves:
        chain.move_by_offset(dx, dy)
    chain.release().perform()


def check_camera(driver, tool, out):
    set_value(driver, "policy", "threshold")
    Select(driver.find_element("id", "camera")).select_by_value("orbit")
    wait_for(driver, "view.runs[0].count === 1", "a flight of one frame")
    drag(driver, [(6, 1)] * 12)
    wait_for(driver, "view.flight.poses.length > 5 && view.runs[0].complete && view.runs[0].count === view.flight.poses.length", "a recorded flight")
    driver.find_element("id", "flight-name").send_keys("spin")
    driver.find_element("id", "save").click()
    wait_for(driver, "document.getElementById('saved').textContent.startsWith('saved: ')", "the flight to be saved")
    driver.find_element("id", "save").click()
    wait_for(driver, "document.getElementById('saved').textContent.includes('must be a new name')", "a refusal")
    count = driver.execute_script("return view.flight.poses.length")
    without = driver.execute_script("return view.controls.without.length")
    print(f"view: a flight of {count} frames was saved")
    if without:
        effect = driver.find_element("css selector", ".effect input")
        effect.click()
        wait_for(driver, f"view.controls.without.length === 0 && view.runs[0].complete && view.runs[0].count === {count}", "all effects")
        time.sleep(0.5)
    check_plan(driver, tool, out, [str(out / "saved" / "spin.yaml"), "--size", "160x120", "--geometric-px", "1.25"])


def check_fault(driver, tool, out):
    broken = out / "broken.yaml"
    broken.write_text("frames: many\n")
    with serving(tool, broken, expect=2) as (url, _):
        driver.get(url)
        wait_for(driver, "document.body.dataset.fault", "why there is no scene")
        assert "broken.yaml:1" in driver.find_element("id", "fault").text, driver.find_element("id", "fault").text
        check_console(driver)


def check_widths(driver):
    for width in (360, 800, 1400):
        driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
        wait_for(driver, f"document.documentElement.scrollWidth <= {width}", f"the page to fit into {width} px")
    driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def main():
    tool, out = str(pathlib.Path(sys.argv[1]).absolute()), pathlib.Path(sys.argv[2]).absolute() / "view"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    driver = browser()
    try:
        with serving(tool, "carousel", "--size", "160x120", "--out", out / "saved") as (url, _):
            driver.set_window_size(1500, 1300)
            open_view(driver, url)
            driver.save_screenshot(str(out / "view.png"))
            check_settings(driver, tool, out)
            check_pictures(driver)
            check_camera(driver, tool, out)
            check_widths(driver)
            check_console(driver)
        check_more_settings(driver, tool, out)
        check_fault(driver, tool, out)
    finally:
        driver.quit()


if __name__ == "__main__":
    main()
