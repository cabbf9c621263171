# SPDX-License-Identifier: Apache-2.0
"""The Python module. The environment variable TALISMAN names the command that it is compared with."""
import json
import os
import struct
import subprocess
import tempfile
import threading
import time
import unittest
import zlib
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import models
import talisman

COMMAND = os.environ["TALISMAN"]
SQUARE = [[0, 0], [100, 0], [100, 100], [0, 100]]


def affine(points, matrix):
    return points @ matrix[:2, :2].T + matrix[:2, 2]


def largest_error(points, targets, matrix):
    return np.linalg.norm(affine(points, matrix) - targets, axis=1).max()


def cloud(count, seed=1):
    """Random points, and targets that an affine map misses by up to a pixel."""
    random = np.random.default_rng(seed)
    points = random.uniform(0, 500, (count, 2))
    targets = affine(points, np.array([[1.1, 0.2, 5], [-0.1, 0.9, -7], [0, 0, 1]]))
    return points, targets + random.uniform(-1, 1, (count, 2)) / np.sqrt(2)


class Fit(unittest.TestCase):
    def test_an_exact_map_is_recovered(self):
        matrix = np.array([[1.5, 0.25, 10], [-0.5, 2, -3], [0, 0, 1]])
        found = talisman.fit(SQUARE, affine(np.array(SQUARE), matrix))
        np.testing.assert_allclose(found.warp, matrix, atol=1e-9)
        self.assertEqual((found.status, found.family), ("converged", "affine"))
        self.assertLess(found.error_px, 1e-9)

    def test_the_bound_encloses_the_error_and_no_other_map_is_below_it(self):
        points, targets = cloud(40)
        found = talisman.fit(points, targets)
        lower, upper = found.bound_px
        self.assertAlmostEqual(largest_error(points, targets, found.warp), upper, places=9)
        self.assertEqual(found.error_px, upper)
        self.assertLessEqual(upper - lower, 1e-6 * upper + 1e-12)
        random = np.random.default_rng(2)
        for _ in range(2000):
            other = found.warp.copy()
            other[:2] += random.normal(0, [1e-4, 1e-4, 0.02], (2, 3))
            self.assertGreaterEqual(largest_error(points, targets, other), lower)

    def test_least_squares_are_those_of_numpy(self):
        points, targets = cloud(40)
        found = talisman.fit(points, targets, norm="rms")
        columns = np.column_stack([points, np.ones(len(points))])
        expected = np.linalg.lstsq(columns, targets, rcond=None)[0].T
        np.testing.assert_allclose(found.warp[:2], expected, rtol=1e-9, atol=1e-9)
        errors = np.linalg.norm(affine(points, found.warp) - targets, axis=1)
        self.assertAlmostEqual(found.error_px, np.sqrt(np.mean(errors**2)), places=9)
        self.assertIsNone(found.bound_px)

    def test_every_warp_and_norm_has_an_answer(self):
        points, targets = cloud(12)
        for warp in ("trn", "iso", "so", "aff", "per", "per2"):
            for norm in ("max", "rms"):
                self.assertEqual(talisman.fit(points, targets, warp, norm).status, "converged", (warp, norm))

    def test_types_and_layouts_do_not_matter(self):
        points, targets = (np.round(a) for a in cloud(30))  # whole, so that all types hold the same numbers
        expected = talisman.fit(points, targets).warp
        wide = np.zeros((60, 4))
        wide[::2, 1:3] = points
        for same in (points.tolist(), [tuple(p) for p in points], points.astype(np.float32), points.astype(np.int16),
                     np.asfortranarray(points), wide[::2, 1:3], points[::-1][::-1], points.astype(">f8"),
                     np.ma.masked_array(points)):
            np.testing.assert_array_equal(talisman.fit(same, targets).warp, expected)

    def test_wrong_shapes_and_types_are_value_errors(self):
        for wrong, words in (([[1, 2, 3]] * 4, r"shape \(4, 3\), must be \(n, 2\)"), ([1, 2, 3], r"shape \(3,\)"), (7, "shape"),
                             ([[1, 2], [3]], "points"), ([["a", "b"]] * 4, "real numbers"), (None, "real numbers"),
                             (np.array(SQUARE) * 1j, "real numbers"), (np.zeros((2, 2, 2)), "shape")):
            with self.assertRaisesRegex(ValueError, words):
                talisman.fit(wrong, SQUARE)
        with self.assertRaisesRegex(ValueError, "4 points and 3 targets"):
            talisman.fit(SQUARE, SQUARE[:3])

    def test_wrong_words_are_value_errors(self):
        with self.assertRaisesRegex(ValueError, "warp is 'afine', must be one of trn, iso"):
            talisman.fit(SQUARE, SQUARE, warp="afine")
        with self.assertRaisesRegex(ValueError, "norm is 'l1', must be one of max, rms"):
            talisman.fit(SQUARE, SQUARE, norm="l1")
        with self.assertRaisesRegex(ValueError, "warp is 'pers2', but norm is 'max'"):
            talisman.fit(SQUARE, SQUARE, warp="pers2")

    def test_hard_points_are_told_by_the_status(self):
        broken = [[0, 0], [float("nan"), 1], [2, 2], [3, 0]]
        found = talisman.fit(broken, SQUARE)
        self.assertEqual((found.status, found.worst_point), ("not finite", 1))
        np.testing.assert_array_equal(found.warp, np.eye(3))
        self.assertEqual(talisman.fit([[0, 0], [1, np.inf], [2, 2], [3, 0]], SQUARE).status, "not finite")
        self.assertEqual(talisman.fit([], []).status, "too few points")
        np.testing.assert_array_equal(talisman.fit(SQUARE[:2], SQUARE[:2]).warp, np.eye(3))
        self.assertEqual(talisman.fit([[0, 0], [1, 0]], [[0, 0], [2, 1]]).status, "too few points")
        collinear = [[0, 0], [1, 1], [2, 2], [3, 3]]
        self.assertEqual(talisman.fit(collinear, SQUARE).status, "degenerate")

    def test_ten_million_points_while_other_threads_run(self):
        random = np.random.default_rng(3)
        points = random.uniform(0, 1000, (10_000_000, 2))
        targets = points * 1.01 + [3, -2]
        found = []
        worker = threading.Thread(target=lambda: found.append(talisman.fit(points, targets, norm="rms")))
        start = last = time.perf_counter()
        longest_wait = 0.0
        worker.start()
        while worker.is_alive():
            time.sleep(0.001)
            longest_wait, last = max(longest_wait, time.perf_counter() - last), time.perf_counter()
        took = last - start
        np.testing.assert_allclose(found[0].warp, [[1.01, 0, 3], [0, 1.01, -2], [0, 0, 1]], atol=1e-6)
        self.assertLess(longest_wait, 0.7 * took, "the fit kept other threads from running")

    def test_ten_million_points_have_a_certified_maximum(self):
        random = np.random.default_rng(4)
        points = random.uniform(0, 1000, (10_000_000, 2))
        found = talisman.fit(points, points + random.uniform(-1, 1, points.shape), warp="trn")
        lower, upper = found.bound_px
        self.assertEqual(found.status, "converged")
        self.assertTrue(1.40 < lower <= upper < np.sqrt(2), found)

    def test_two_threads_at_once_find_what_one_finds(self):
        inputs = [cloud(60, seed) for seed in range(100)]
        alone = [talisman.fit(*pair).warp for pair in inputs]
        with ThreadPoolExecutor(2) as pool:
            together = list(pool.map(lambda pair: talisman.fit(*pair).warp, inputs))
        np.testing.assert_array_equal(together, alone)


class Plan(unittest.TestCase):
    def test_columns_are_the_lines_that_the_command_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([COMMAND, "plan", "carousel", "--geometric-px", "2", "--progress", "none", "--out", folder], check=True,
                           stdout=subprocess.DEVNULL)
            with open(folder + "/decisions.jsonl") as file:
                lines = [json.loads(line) for line in file]
        plan = talisman.plan("carousel", geometric_px=2)
        self.assertEqual({len(column) for column in plan.values()}, {len(lines)})
        for name in ("frame", "layer", "decision", "reason", "geometric_px"):
            self.assertEqual(plan[name].tolist(), [line[name] for line in lines], name)
        for name, group, key in (("cost_polygons", "cost", "polygons"), ("held_geometric_px", "fiducials", "held_geometric_px"),
                                 ("uncovered_px", "fiducials", "uncovered_px")):
            values = [(line[group] or {}).get(key) for line in lines]
            np.testing.assert_array_equal(plan[name], [np.nan if value is None else value for value in values], name)
        self.assertEqual(plan["frame"].dtype, np.int64)
        self.assertEqual(plan["geometric_px"].dtype, np.float64)

    def test_frames_may_be_a_range(self):
        whole, part = talisman.plan("carousel"), talisman.plan("carousel", frames="3-5")
        chosen = (whole["frame"] >= 3) & (whole["frame"] <= 5)
        self.assertEqual(part["reason"].tolist(), whole["reason"][chosen].tolist())

    def test_messages_of_the_tool_are_value_errors(self):
        for options, words in (({"policy": "often"}, "--policy is 'often', must be one of direct, reference"),
                               ({"geometric_px": "much"}, "geometric-px"), ({"geometry": 1}, "geometry"),
                               ({"color_warp": False}, "--color-warp is 'false', must be one of on, off"),
                               ({"geometric_px": -1}, "geometric_px is -1"), ({"frames": "5-3"}, "--frames is '5-3'"),
                               ({"out": "x"}, "--out is about files"), ({"policy": "budget"}, "must come with")):
            with self.assertRaisesRegex(ValueError, words):
                talisman.plan("carousel", **options)
        with self.assertRaisesRegex(ValueError, "no-such-sequence"):
            talisman.plan("no-such-sequence")
        with self.assertRaisesRegex(ValueError, "--policy"):
            talisman.plan("--policy")

    def test_names_of_options_are_those_of_python(self):
        with self.assertRaisesRegex(ValueError, "^there is no option 'policyy'; did you mean 'policy'\\?$"):
            talisman.plan("carousel", policyy="budget")
        with self.assertRaisesRegex(ValueError, "^there is no option 'geometrc_px'; did you mean 'geometric_px'\\?$"):
            talisman.render("carousel", geometrc_px=2)
        with self.assertRaisesRegex(ValueError, "^there is no option 'xyzzy'$"):
            talisman.plan("carousel", xyzzy=2)

    def test_numbers_are_finite(self):
        for value in (float("inf"), float("-inf"), float("nan"), np.float64("inf"), "1e400"):
            with self.assertRaisesRegex(ValueError, "geometric-px.*a finite number"):
                talisman.plan("carousel", geometric_px=value)

    def test_warnings_are_errors_where_that_is_asked_for(self):
        with tempfile.TemporaryDirectory() as folder:
            sequence = os.path.join(folder, "spare.yaml")
            with open(sequence, "w") as file:
                file.write("frames: 1\nshapes: [{id: a, box: [1, 1, 1]}, {id: b, box: [1, 1, 1]}]\n"
                           "layers: [{name: a, parts: [a]}]\n")
            with self.assertWarnsRegex(UserWarning, "1 part is taken by no layer and is not drawn: 'b'"):
                talisman.plan(sequence)
            with self.assertRaisesRegex(ValueError, "1 warning, rule with --strict: none"):
                talisman.plan(sequence, strict=True)

    def test_options_of_another_policy_are_refused(self):
        with self.assertRaisesRegex(ValueError, "--hold is no option of policy threshold"):
            talisman.plan("carousel", frames="0", policy="threshold", hold=2)

    def test_a_broken_file_is_told_by_file_and_line(self):
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            file.write("name: x\nframes: -3\n")
            file.flush()
            with self.assertRaisesRegex(ValueError, file.name + ":2: "):
                talisman.plan(file.name)

    def test_two_threads_at_once_plan_what_one_plans(self):
        alone = talisman.plan("carousel", frames="0-20")
        with ThreadPoolExecutor(2) as pool:
            for together in pool.map(lambda _: talisman.plan("carousel", frames="0-20"), range(2)):
                for name in alone:
                    np.testing.assert_array_equal(together[name], alone[name], name)

    def test_time_beside_that_of_the_command(self):
        """Printed, not asserted: other programs run, too."""
        try:
            talisman.plan("canyon", frames="0-1")
        except ValueError as error:
            self.skipTest(str(error))
        with tempfile.TemporaryDirectory() as folder:
            def command():
                subprocess.run([COMMAND, "plan", "canyon", "--progress", "none", "--out", folder], check=True,
                               stdout=subprocess.DEVNULL)
            def best(call):
                times = []
                for _ in range(2):
                    start = time.perf_counter()
                    call()
                    times.append(time.perf_counter() - start)
                return min(times)
            of_module, of_command = best(lambda: talisman.plan("canyon")), best(command)
        print(f'\nplan("canyon"): {of_module:.2f} s, the command {of_command:.2f} s: {of_module / of_command:.2f}')


def read_png(path):
    """Height x width x 3 bytes of an 8-bit RGB file, by the five filters of the PNG specification."""
    with open(path, "rb") as file:
        data = file.read()
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", data[at + 8:at + 18])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    assert (depth, colour) == (8, 2)
    rows, stride = zlib.decompress(packed), 3 * width + 1
    image, above = [], [0] * (stride - 1)
    for y in range(height):
        kind, row = rows[y * stride], list(rows[y * stride + 1:(y + 1) * stride])
        for x in range(stride - 1):
            left, corner = (row[x - 3], above[x - 3]) if x >= 3 else (0, 0)
            guess = left + above[x] - corner
            nearest = min((left, above[x], corner), key=lambda value: abs(guess - value))
            row[x] = (row[x] + (0, left, above[x], (left + above[x]) // 2, nearest)[kind]) % 256
        image.append(row)
        above = row
    return np.array(image, dtype=np.uint8).reshape(height, width, 3)


class Render(unittest.TestCase):
    def test_pixels_are_those_that_the_command_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([COMMAND, "render", "carousel", "--frames", "7-7", "--size", "160x120", "--progress", "none",
                            "--out", folder], check=True, stdout=subprocess.DEVNULL)
            expected = read_png(folder + "/frames/0007.png")
        frame = talisman.render("carousel", frame=7, size="160x120")
        self.assertEqual((frame.shape, frame.dtype), ((120, 160, 3), np.uint8))
        self.assertGreater(frame.std(), 5, "an empty picture")
        np.testing.assert_array_equal(frame, expected)

    def test_a_model_is_planned_and_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            models.write_glb(folder + "/tetra.glb")
            plan = talisman.plan(folder + "/tetra.glb", frames="0-3", no_stage=True)
            self.assertEqual(plan["frame"].tolist(), [0, 1, 2, 3])
            self.assertEqual(plan["decision"][0], "rerender")
            frame = talisman.render(folder + "/tetra.glb", 2, size="64x64").astype(int)
            self.assertGreater((frame[:, :, 0] - frame[:, :, 2]).max(), 40, "nothing red was drawn")

    def test_frames_that_are_not_there_are_value_errors(self):
        for frame in (-1, 10**6):
            with self.assertRaisesRegex(ValueError, f"frame is {frame}, must be from 0 to"):
                talisman.render("carousel", frame, size="64x64")
        with self.assertRaisesRegex(ValueError, "must be frame"):
            talisman.render("carousel", frames="0-3")


if __name__ == "__main__":
    unittest.main()
