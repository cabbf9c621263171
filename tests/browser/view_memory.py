#!/usr/bin/python3
"""Does the live view grow? Asks as its page does, without a browser: sliders, a dragged camera, frames; and says what the
server holds. usage: view_memory.py TALISMAN OUT [--minutes N] [--size WxH] [--most MB] SEQUENCE..."""
import argparse
import http.client
import json
import math
import os
import pathlib
import random
import re
import sys
import time

from view import serving

SEED = 16
BY_HAND_MS = 30


class Page:
    """What the page of one tab asks (sequences/view/page/main.js)."""

    def __init__(self, url):
        self.port, self.token = int(re.search(r":(\d+)/", url)[1]), url.split("=")[1]
        self.request, self.settings, self.flight, self.answers = 0, {}, [], 0
        self.about = json.loads(self.send("GET", "/about", None))

    def send(self, method, path, body):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        connection.request(method, path, body, {"Cookie": f"talisman_{self.port}={self.token}"})
        response = connection.getresponse()
        data = response.read()
        connection.close()
        assert response.status == 200, (path, response.status, data[:300])
        self.answers += 1
        return data

    def ask(self, path, **extra):
        self.request += 1
        flight = {"flight": self.flight} if self.flight else {}
        body = {"tab": "memory", "request": self.request, "settings": self.settings, **flight, **extra}
        return self.send("POST", path, json.dumps(body))

    def plan(self):
        planned, frames = 0, 1
        while planned < frames:
            answer = json.loads(self.ask("/plan", **{"from": planned}))
            planned, frames = answer["planned"], answer["frames"]
        return frames

    def look(self, frame, scale=1):
        self.ask("/frame", frame=frame) if scale == 1 else None
        return self.ask("/picture", frame=frame, mode="shown", scale=scale)


def orbit(about, step):
    """The camera around what lies 10 m ahead."""
    position, forward = about["camera"]["position"], about["camera"]["forward"]
    ahead = 10
    target = [p + ahead * f for p, f in zip(position, forward)]
    c, s = math.cos(0.004 * step), math.sin(0.004 * step)
    x, z = position[0] - target[0], position[2] - target[2]
    return [target[0] + c * x + s * z, position[1], target[2] - s * x + c * z, *target]


def move_on(page, draw):
    """Five moves of a slider, a frame, thirty of the camera, and back: one round of view_times.py."""
    for _ in range(5):
        page.settings = {"geometric-px": str(round(draw.uniform(0.5, 12), 3))}
        frames = page.plan()
        page.look(draw.randrange(min(40, frames)))
    first = draw.randrange(1000)
    for step in range(31):
        page.flight = [orbit(page.about, first + k) for k in range(step + 1)]
        page.look(step, scale=0.5)
        time.sleep(BY_HAND_MS / 1000)
    page.look(page.plan() - 1)
    page.flight = []
    page.plan()
    page.look(0)


def memory_mb(process):
    return int(re.search(r"VmRSS:\s+(\d+)", open(f"/proc/{process.pid}/status").read())[1]) / 1024


def holders(process):
    """Where it lies: the heap, anonymous maps by how large they are, files."""
    sums = {}
    name = ""
    for line in open(f"/proc/{process.pid}/smaps"):
        head = re.match(r"([0-9a-f]+)-([0-9a-f]+) \S+ \S+ \S+ \S+\s*(.*)", line)
        if head:
            size = (int(head[2], 16) - int(head[1], 16)) / 1e6
            name = head[3] if head[3].startswith("[") else "files" if head[3] else "arenas" if size < 70 else "large"
        elif line.startswith("Rss:"):
            sums[name] = sums.get(name, 0) + int(line.split()[1]) / 1024
    return ", ".join(f"{name} {size:.0f}" for name, size in sorted(sums.items(), key=lambda item: -item[1]) if size >= 1)


def watch(tool, out, name, asked):
    draw = random.Random(SEED)
    with serving(tool, name, "--size", asked.size, "--out", out / "memory") as (url, process):
        page = Page(url)
        began, rounds, early, said = time.time(), 0, None, 0
        while time.time() - began < 60 * asked.minutes:
            move_on(page, draw)
            rounds += 1
            spent = time.time() - began
            if early is None and spent > 6 * asked.minutes:
                early = memory_mb(process)
            if spent - said > 20:
                said = spent
                print(f"  {spent:4.0f} s, {rounds} rounds, {page.answers} answers: {memory_mb(process):.0f} MB ({holders(process)})", flush=True)
        late = memory_mb(process)
    print(f"{name}, {asked.size}: {asked.minutes} minutes, {rounds} rounds, {page.answers} answers: {early:.0f} MB after a tenth of it, {late:.0f} MB at its end",
          flush=True)
    return late - early


def main():
    words = argparse.ArgumentParser()
    words.add_argument("tool")
    words.add_argument("out", type=pathlib.Path)
    words.add_argument("sequences", nargs="+")
    words.add_argument("--minutes", type=float, default=5)
    words.add_argument("--most", type=float, default=50, help="growth in MB beyond which the exit code is 1")
    words.add_argument("--size", default="512x512")
    asked = words.parse_args()
    os.makedirs(asked.out, exist_ok=True)
    grown = [watch(str(pathlib.Path(asked.tool).absolute()), asked.out.absolute(), name, asked) for name in asked.sequences]
    sys.exit(1 if max(grown) > asked.most else 0)


if __name__ == "__main__":
    main()
