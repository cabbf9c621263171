from typing import Any, Dict, List

import numpy as np
import numpy.typing as npt

version: str

def fit(points: npt.NDArray[np.float64], targets: npt.NDArray[np.float64], curve: str) -> Dict[str, Any]: ...
def plan(sequence: str, words: List[str]) -> Dict[str, List[Any]]: ...
def render(sequence: str, frame: int, words: List[str]) -> npt.NDArray[np.uint8]: ...
