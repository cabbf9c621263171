#!/usr/bin/python3
"""How fast is the live view, and does it grow? A slider moved, the camera dragged, four tabs while frames are drawn.
usage: view_times.py TALISMAN OUT [--moves N] [--minutes N] [--size WxH] SEQUENCE..."""
import argparse
import http.client
import json
import os
import pathlib
import random
import re
import statistics
import threading
import time

from selenium.webdriver.support.ui import Select

from cells import browser
from view import drag, open_view, serving, wait_for

SEED = 16


def percentiles(values):
    ordered = sorted(values)
    return f"p50 {statistics.median(ordered):.0f} ms, p95 {ordered[int(0.95 * (len(ordered) - 1))]:.0f} ms, largest {ordered[-1]:.0f} ms"


def memory_mb(process):
    return int(re.search(r"VmRSS:\s+(\d+)", open(f"/proc/{process.pid}/status").read())[1]) / 1024


def processor_ms(process):
    """What the server has used so far: it says what a move costs where others use the machine, too."""
    fields = open(f"/proc/{process.pid}/stat").read().rsplit(")", 1)[1].split()
    return 1000 * (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def move_slider(driver, value):
    """Milliseconds from the slider's event to the whole map painted, and to its first slice."""
    plans = driver.execute_script("return document.body.dataset.plans")
    driver.execute_script("""const slider = document.getElementById('slide-geometric-px'); slider.value = arguments[0];
                             slider.dispatchEvent(new Event('input', {bubbles: true}));""", value)
    wait_for(driver, f"document.body.dataset.plans !== '{plans}'", "a plan")
    times = driver.execute_script("return {...document.body.dataset}")
    return float(times["complete_ms"]), float(times["first_ms"])


def time_slider(driver, process, name, moves):
    random.seed(SEED)
    whole, first = [], []
    used = processor_ms(process)
    for _ in range(moves):
        a, b = move_slider(driver, random.uniform(0.5, 12))
        whole.append(a)
        first.append(b)
        time.sleep(0.3)
    print(f"{name}: {moves} moves, slider to the whole map: {percentiles(whole)}; to its first slice: {percentiles(first)}; "
          f"processor time of the server for a move, its picture included: {(processor_ms(process) - used) / moves:.0f} ms", flush=True)


def time_drag(driver, name, seconds):
    Select(driver.find_element("id", "camera")).select_by_value("orbit")
    wait_for(driver, "view.runs[0].count === 1 && view.runs[0].complete && !view.drawing", "a flight of one frame")
    before, began = int(driver.execute_script("return document.body.dataset.pictures")), time.time()
    driver.execute_script("""window.dragging = setInterval(() => view.move(0.004, 0, 0), 30);""")
    time.sleep(seconds)
    pictures = int(driver.execute_script("clearInterval(window.dragging); return document.body.dataset.pictures")) - before
    spent = time.time() - began
    wait_for(driver, "!view.moving && view.runs[0].complete && !view.drawing", "the sharp picture")
    print(f"{name}: {pictures / spent:.1f} pictures a second while the camera is dragged", flush=True)
    Select(driver.find_element("id", "camera")).select_by_value("own")
    wait_for(driver, "view.runs[0].count > 1 && view.runs[0].complete && !view.drawing", "the sequence's own camera")


def time_tabs(address, name, frames):
    """Four tabs ask for plans while a fifth has frames drawn."""
    port, token = int(re.search(r":(\d+)/", address)[1]), address.split("=")[1]

    def ask(path, body):
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
        connection.request("POST", path, json.dumps(body), {"Cookie": f"talisman_{port}={token}"})
        answer = connection.getresponse()
        return answer.status, answer.read()

    ended, times = threading.Event(), []

    def draw():
        for k in range(10 ** 6):
            if ended.is_set():
                return
            ask("/picture", {"tab": "draws", "request": k, "frame": k % frames})

    def watch(tab):
        request = 0
        for move in range(8):
            planned = 0
            while planned < frames:
                request += 1
                began = time.time()
                answer = json.loads(ask("/plan", {"tab": tab, "request": request, "from": planned, "settings": {"geometric-px": 1 + move}})[1])
                times.append(1000 * (time.time() - began))
                planned = max(planned, answer["planned"])

    drawing = threading.Thread(target=draw)
    drawing.start()
    watching = [threading.Thread(target=watch, args=(f"tab {k}",)) for k in range(4)]
    for thread in watching:
        thread.start()
    for thread in watching:
        thread.join()
    ended.set()
    drawing.join()
    print(f"{name}: four tabs while frames are drawn, {len(times)} answers: {percentiles(times)}", flush=True)


def time_memory(driver, process, name, minutes):
    """Drags on and on: slider, camera, frames."""
    random.seed(SEED)
    early, began, rounds = 0, time.time(), 0
    while time.time() - began < 60 * minutes:
        for _ in range(5):
            move_slider(driver, random.uniform(0.5, 12))
        driver.execute_script(f"selection.set({{frame: {random.randrange(40)}}})")
        Select(driver.find_element("id", "camera")).select_by_value("orbit")
        wait_for(driver, "view.runs[0].count === 1 && !view.drawing", "a flight of one frame")
        drag(driver, [(4, 1)] * 30)
        wait_for(driver, "!view.moving && view.runs[0].complete && !view.drawing", "the flight's plan")
        Select(driver.find_element("id", "camera")).select_by_value("own")
        wait_for(driver, "view.runs[0].count > 1 && view.runs[0].complete && !view.drawing", "the sequence's own camera")
        rounds += 1
        if not early and time.time() - began > 6 * minutes:
            early = memory_mb(process)
    print(f"{name}: {minutes} minutes of dragging, {rounds} rounds: {early:.0f} MB after a tenth of it, {memory_mb(process):.0f} MB at its end", flush=True)


def main():
    words = argparse.ArgumentParser()
    words.add_argument("tool")
    words.add_argument("out", type=pathlib.Path)
    words.add_argument("sequences", nargs="+")
    words.add_argument("--minutes", type=float, default=0)
    words.add_argument("--moves", type=int, default=50)
    words.add_argument("--size", default="512x512")
    asked = words.parse_args()
    for name in asked.sequences:
        driver = browser()
        try:
            driver.set_window_size(1500, 1300)
            with serving(asked.tool, name, "--size", asked.size, "--out", asked.out / "times") as (url, process):
                open_view(driver, url)
                frames = driver.execute_script("return view.runs[0].count")
                print(f"{name}: {frames} frames, {driver.execute_script('return view.runs[0].layers.length')} rows, {asked.size}, "
                      f"{memory_mb(process):.0f} MB", flush=True)
                time_slider(driver, process, name, asked.moves)
                time_drag(driver, name, 10)
                time_tabs(url, name, frames)
                if asked.minutes > 0:
                    time_memory(driver, process, name, asked.minutes)
        finally:
            driver.quit()


if __name__ == "__main__":
    main()
