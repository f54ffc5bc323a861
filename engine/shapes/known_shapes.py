# SPDX-License-Identifier: GPL-3.0-or-later
"""Prepared shapes that are kept for when the same mesh is matched again, as long as there is memory for them."""

from __future__ import annotations

from collections import OrderedDict
from hashlib import blake2b
from typing import Any, ClassVar

import numpy as np
from scipy.sparse import issparse

from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Bools
from .shape import Shape

_LIMIT = 500
"""Megabytes by default: some ten bodies of 5,000 vertices, or one pair of a million."""


class KnownShapes:
    """Prepared shapes, by the meshes they were made of; those not used for longest are forgotten first.

    A match with a shape that is known gives the same result to the last bit as one that prepares it anew.

    Parameters
    ----------
    megabytes : float
        Memory that the shapes may take, with all that is computed for them; with 0 none is kept.
    """

    is_sent_once: ClassVar[bool] = True
    """Another process has shapes of its own, as long as this object is there; see `parallel_map.shared_steps`."""

    def __init__(self, megabytes: float = _LIMIT) -> None:
        self.megabytes = megabytes
        self._shapes: OrderedDict[bytes, Shape] = OrderedDict()

    def __repr__(self) -> str:
        return f"<KnownShapes: {len(self)}, at most {self.megabytes:g} MB>"

    def __len__(self) -> int:
        return len(self._shapes)

    def __getstate__(self) -> dict[str, Any]:
        """Leave the shapes out."""
        return {"megabytes": self.megabytes, "_shapes": OrderedDict()}

    def find(self, mesh: TriangleMesh, name: str, excluded: Bools | None) -> Shape | None:
        """Return the shape of a mesh by that name, and without these vertices (n,); None if it is not known."""
        key = _digest(mesh, name, excluded)
        if key in self._shapes:
            self._shapes.move_to_end(key)
        return self._shapes.get(key)

    def keep(self, mesh: TriangleMesh, name: str, excluded: Bools | None, shape: Shape) -> None:
        """Keep the shape of a mesh."""
        if self.megabytes > 0:
            self._shapes[_digest(mesh, name, excluded)] = shape

    def trim(self) -> None:
        """Forget what is too much; shapes grow while they are matched, so call this afterwards."""
        while self._shapes and _memory(list(self._shapes.values())) > self.megabytes * 1e6:
            self._shapes.popitem(last=False)


def _digest(mesh: TriangleMesh, name: str, excluded: Bools | None) -> bytes:
    """Tell meshes, and what is left out of them, apart."""
    digest = blake2b(f"{name} {mesh.vertex_count} {mesh.triangle_count} {excluded is not None}".encode())
    for array in (mesh.vertices, mesh.triangles, *(() if excluded is None else (np.asarray(excluded, bool),))):
        digest.update(np.ascontiguousarray(array).data)
    return digest.digest()


def _memory(root: object) -> int:
    """Add up the bytes of all arrays that objects refer to, each once."""
    waiting, seen, total = [root], set[int](), 0
    while waiting:
        value = waiting.pop()
        if id(value) in seen:
            continue
        seen.add(id(value))
        if isinstance(value, np.ndarray):
            owner = value if value.base is None else value.base
            if isinstance(owner, np.ndarray) and owner is not value:
                waiting.append(owner)
            else:
                total += value.nbytes
        elif isinstance(value, dict):
            waiting += value.values()
        elif isinstance(value, list | tuple):
            waiting += value
        elif issparse(value) or type(value).__module__.startswith(__package__.rpartition(".")[0]):
            waiting += vars(value).values() if hasattr(value, "__dict__") else []
    return total
