# SPDX-License-Identifier: GPL-3.0-or-later
"""Notes on the cleaning of a mesh, for its owner."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

_SENTENCES: Final = {
    "welded": (
        "The {0} had {1} duplicate vertex along open seams: it was welded for matching.",
        "The {0} had {1} duplicate vertices along open seams: they were welded for matching.",
    ),
    "joined": (
        "The {0} had {1} vertex at a gap between pieces: it was joined with the other border for matching.",
        "The {0} had {1} vertices at gaps between pieces: they were joined with the other border for matching.",
    ),
    "degenerate": (
        "The {0} had {1} degenerate face: it was left out.",
        "The {0} had {1} degenerate faces: they were left out.",
    ),
    "repeated": (
        "The {0} had {1} repeated face: it was left out.",
        "The {0} had {1} repeated faces: they were left out.",
    ),
    "crowded": (
        "The {0} had {1} non-manifold edge: it was opened for matching.",
        "The {0} had {1} non-manifold edges: they were opened for matching.",
    ),
    "touching": (
        "The {0} had {1} place where sheets touch in one vertex: it was separated for matching.",
        "The {0} had {1} places where sheets touch in one vertex: they were separated for matching.",
    ),
    "left_out": (
        "The {0} had {1} face of sheets that share an edge: it was left out.",
        "The {0} had {1} faces of sheets that share an edge: they were left out.",
    ),
    "turned": (
        "The {0} had {1} face with normals against its neighbours: it was read the other way round.",
        "The {0} had {1} faces with normals against their neighbours: they were read the other way round.",
    ),
    "spikes": (
        "The {0} had {1} spike of one vertex: it was pulled in for matching.",
        "The {0} had {1} spikes of one vertex: they were pulled in for matching.",
    ),
    "filled": (
        "The {0} had {1} small hole: it was closed for matching.",
        "The {0} had {1} small holes: they were closed for matching.",
    ),
    "one_sided": ("The {0} had a surface with only one side: it was cut open for matching.",),
    "inverted": ("The normals of the {0} point inwards: they were read the other way round.",),
    "left_open": (
        "The {0} has {1} large opening: the surface ends there.",
        "The {0} has {1} large openings: the surface ends there.",
    ),
    "united": ("The {0} is made of {1} pieces: one surface around all of them was matched.",),
    "parts": (
        "The {0} has {1} smaller part: it follows its surroundings.",
        "The {0} has {1} smaller parts: they follow their surroundings.",
    ),
    "loose": (
        "The {0} has {1} loose vertex: it follows its surroundings.",
        "The {0} has {1} loose vertices: they follow their surroundings.",
    ),
}
"""For each fault what is said of one, and of several.  Whole sentences, since that is what can be translated."""


@dataclass
class CleaningCounts:
    """How often each fault was met.

    Attributes
    ----------
    welded : int
        Vertices that others stand for, along open seams.
    joined : int
        Vertices that others stand for, across a gap between pieces.
    degenerate, repeated : int
        Triangles without three different corners; triangles that are there more than once.
    crowded : int
        Edges of more than two triangles.
    left_out : int
        Triangles of sheets that share an edge with another and could not be parted from it.
    turned : int
        Triangles turned over to agree with their neighbours.
    one_sided : bool
        Whether there was a surface with only one side.
    touching : int
        Vertices at which sheets touched.
    spikes : int
        Single vertices that stuck out far from all their neighbours.
    inverted : bool
        Whether the main part was inside out.
    filled, left_open : int
        Holes of the main part that were closed; openings that were not.
    united : int
        Pieces around which one surface was put, the main one among them.
    parts : int
        Parts beside the main one, or beside those.
    loose : int
        Vertices without a triangle.
    """

    welded: int = 0
    joined: int = 0
    degenerate: int = 0
    repeated: int = 0
    crowded: int = 0
    left_out: int = 0
    turned: int = 0
    one_sided: bool = False
    touching: int = 0
    spikes: int = 0
    inverted: bool = False
    filled: int = 0
    left_open: int = 0
    united: int = 0
    parts: int = 0
    loose: int = 0


def cleaning_notes(name: str, counts: CleaningCounts) -> tuple[str, ...]:
    """Say in a sentence for each fault what was done about it.

    Parameters
    ----------
    name : str
        What the mesh is called, such as 'source'.
    counts : CleaningCounts
        The faults.

    Returns
    -------
    tuple of str
        The sentences; none for a clean mesh.
    """
    found = ((int(getattr(counts, fault)), sentences) for fault, sentences in _SENTENCES.items())
    return tuple(sentences[0 if count == 1 else -1].format(name, f"{count:,}") for count, sentences in found if count)
