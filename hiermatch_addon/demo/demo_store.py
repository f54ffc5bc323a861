# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo cats in their usual sizes as a file, since to build them takes seconds, in which Blender stands still.

``python -m tools.store_demo`` writes it.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from .demo_rig import LEAST_WEIGHT

if TYPE_CHECKING:
    from numpy.typing import NDArray

STORED_SIZES: Final = (5500, 4000)
"""About how many vertices the stored cats have, the standing one first."""

_PATH: Final = Path(__file__).with_name("demo_cats.npz")

_NAMES: Final = ("source", "target")


class Cat(NamedTuple):
    """One cat as arrays.

    Attributes
    ----------
    rest, posed : (n, 3) array of float
        Its vertices in the rest pose, and as it stands, with its feet on the ground.
    faces : list of list of int
        The corners of each face.
    weights : (n, bones) array of float
        How far each bone moves each vertex; the file has none of the walking cat, which gets no rig.
    lift : float
        How far it was lifted onto the ground.
    """

    rest: NDArray[np.float64]
    posed: NDArray[np.float64]
    faces: list[list[int]]
    weights: NDArray[np.float64]
    lift: float


def load_cats() -> tuple[Cat, Cat]:
    """Read the two cats of the file, the standing one first."""
    with np.load(_PATH) as kept:
        cats = []
        for name in _NAMES:
            rest, posed, weights = (kept[f"{name}_{part}"].astype(np.float64) for part in ("rest", "posed", "weights"))
            starts = np.cumsum(kept[f"{name}_face_sizes"].astype(np.int64))[:-1]
            faces = [face.tolist() for face in np.split(kept[f"{name}_corners"].astype(np.int64), starts)]
            cats.append(Cat(rest, posed, faces, weights, float(kept[f"{name}_lift"])))
    return cats[0], cats[1]


def save_cats(cats: tuple[Cat, Cat]) -> Path:
    """Write the two cats in single precision, which is what Blender keeps of them; return the file."""
    standing, walking = cats
    weights = np.where(standing.weights > LEAST_WEIGHT, standing.weights, 0.0)
    cats = standing._replace(weights=weights), walking._replace(weights=walking.weights[:, :0])
    kept = {}
    for name, cat in zip(_NAMES, cats, strict=True):
        for part in ("rest", "posed", "weights"):
            kept[f"{name}_{part}"] = getattr(cat, part).astype(np.float32)
        kept[f"{name}_face_sizes"] = np.array([len(face) for face in cat.faces], np.uint8)
        kept[f"{name}_corners"] = np.array([corner for face in cat.faces for corner in face], np.uint16)
        kept[f"{name}_lift"] = np.float64(cat.lift)
    np.savez_compressed(_PATH, **kept)
    return _PATH
