# SPDX-License-Identifier: Apache-2.0
"""The installed module, with no source tree in reach: a warp, a sequence that came with it, a model file."""
import sys

import numpy as np

import models
import talisman

work = sys.argv[1]
assert talisman.__file__.startswith(work + "/prefix/"), talisman.__file__
square = np.array([[0, 0], [10, 0], [10, 10], [0, 10]])
found = talisman.fit(square, 2 * square + 1)
np.testing.assert_allclose(found.warp, [[2, 0, 1], [0, 2, 1], [0, 0, 1]], atol=1e-9)
plan = talisman.plan("carousel", frames="0-2")
assert sorted(set(plan["frame"].tolist())) == [0, 1, 2]
models.write_glb(work + "/tetra.glb")
frame = talisman.render(work + "/tetra.glb", frame=1, size="96x64")
assert frame.shape == (64, 96, 3) and frame.dtype == np.uint8 and frame.std() > 1
