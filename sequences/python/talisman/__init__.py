# SPDX-License-Identifier: Apache-2.0
"""Layered sprite rendering: warps between old and new pictures, and when a picture must be drawn anew.

    fit      the warp of a family with the least error, with a certified bound of what any other could reach
    plan     what is drawn in each frame of a sequence or model, why, and what it costs; without pixels
    render   one frame as the compositor shows it

Messages about what was passed are ValueErrors, about everything else RuntimeErrors; they are those of the command
``talisman``. All functions let other Python threads run while they work.
"""

from typing import Any, Dict, NamedTuple, Optional, Tuple

import numpy as np

from . import _talisman

__version__: str = _talisman.version
__all__ = ["Fit", "fit", "plan", "render"]

_MAX_CURVES = {"trn": "trni", "iso": "isoi", "so": "soi", "aff": "affi", "per": "peri", "per2": "per2i"}
_OTHER_CURVES = ("pers", "pers2")


class Fit(NamedTuple):
    """A fitted warp and how good it is."""

    warp: np.ndarray
    """3x3, takes columns (x, y, 1) of the points to those of the targets; for perspective up to the third component."""
    error_px: float
    """What was minimised: the largest distance (norm "max") or the root mean square of all ("rms")."""
    bound_px: Optional[Tuple[float, float]]
    """Certified (lower, upper) bounds of the least largest distance that any warp of the family reaches; None for "rms"."""
    status: str
    """"converged", "not converged" (the bound is not tight), or why another family was used: "too few points",
    "degenerate"; "not finite": a point is no number, the warp is the identity and the error 1e30."""
    family: str
    """The family of the warp: the one that was asked for or a simpler one (see status)."""
    rms_px: float
    max_px: float
    worst_point: int
    """Index of the point with the largest distance; -1 without points."""
    iterations: int


def _points(name: str, values: Any) -> np.ndarray:
    try:
        array = np.asarray(values)
    except ValueError as error:  # rows of different lengths
        raise ValueError(f"{name} is ragged, must have the shape (n, 2)") from error
    if array.size == 0 and array.ndim <= 2:
        array = np.empty((0, 2))
    if array.dtype.kind not in "iuf":
        raise ValueError(f"{name} has the type {array.dtype}, must be real numbers")
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError(f"{name} has the shape {array.shape}, must be (n, 2)")
    return np.ascontiguousarray(array, dtype=np.float64)


def _curve(warp: str, norm: str) -> str:
    names = list(_MAX_CURVES) + list(_OTHER_CURVES)
    if warp not in names:
        raise ValueError(f"warp is {warp!r}, must be one of {', '.join(names)}")
    if norm not in ("max", "rms"):
        raise ValueError(f"norm is {norm!r}, must be one of max, rms")
    if norm == "rms":
        return warp
    if warp not in _MAX_CURVES:
        raise ValueError(f"warp is {warp!r}, but norm is 'max', must be one of {', '.join(_MAX_CURVES)}")
    return _MAX_CURVES[warp]


def fit(points: Any, targets: Any, warp: str = "aff", norm: str = "max") -> Fit:
    """Fits the warp that carries ``points`` to ``targets`` with the least error.

    points, targets   (n, 2) real numbers, pixels: arrays of any type and layout, or lists
    warp              trn (translation), iso (and scale), so (and x/y scale), aff, per (perspective, error before the
                      divide), per2 (after it), pers, pers2 (norm "rms" only)
    norm              "max": least largest distance, with a certified bound; "rms": least squares

    Nothing that points can be raises: what became of hard ones is told by the status. Cost: microseconds for tens of
    points; proportional to n for many.
    """
    curve = _curve(warp, norm)
    from_points, to_points = _points("points", points), _points("targets", targets)
    if len(from_points) != len(to_points):
        raise ValueError(f"there are {len(from_points)} points and {len(to_points)} targets, must be as many")
    found = _talisman.fit(from_points, to_points, curve)
    is_max = norm == "max"
    return Fit(
        warp=found["warp"],
        error_px=found["max_px"] if is_max else found["rms_px"],
        bound_px=(found["lower_px"], found["max_px"]) if is_max else None,
        status=found["status"],
        family=found["family"],
        rms_px=found["rms_px"],
        max_px=found["max_px"],
        worst_point=found["worst_point"],
        iterations=found["iterations"],
    )


def _words(options: Dict[str, Any]) -> list:
    """The words of the command line: geometric_px=4 is --geometric-px=4, budget_gap=True is --budget-gap=true."""
    words = []
    for key, value in options.items():
        if value is None:
            continue
        text = str(value).lower() if isinstance(value, (bool, np.bool_)) else str(value)
        words.append(f"--{key.replace('_', '-')}={text}")
    return words


def plan(sequence: str, **options: Any) -> Dict[str, np.ndarray]:
    """Plans a sequence (a name such as "canyon", or the path of a YAML or model file) without drawing it.

    Options are those of ``talisman plan`` with _ for -: ``plan("canyon", policy="budget", budget_polygons=20000,
    frames="0-99")``. Returns a column per field of decisions.jsonl, a row per frame and layer; pandas.DataFrame takes
    it as it is. Fractions that do not exist are NaN.
    """
    return {name: _array(values) for name, values in _talisman.plan(sequence, _words(options)).items()}


def _array(values: list) -> np.ndarray:
    return np.array(values, dtype=object) if values and isinstance(values[0], str) else np.array(values)


def render(sequence: str, frame: int = 0, **options: Any) -> np.ndarray:
    """Draws frame ``frame`` of a sequence or model: height x width x 3 bytes, sRGB, as ``talisman render`` writes it.

    Options are those of ``talisman render`` with _ for -. The frames before it are planned, since sprites of theirs
    may be shown in it, and only what is shown is drawn.
    """
    return _talisman.render(sequence, frame, _words(options))
