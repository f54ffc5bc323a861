# SPDX-License-Identifier: GPL-3.0-or-later
"""What the cleaning of a mesh tells its owner."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["CleaningCounts", "cleaning_notes"]


@dataclass
class CleaningCounts:
    """How often each fault was met.

    Attributes
    ----------
    welded : int
        Vertices that others stand for, along open seams.
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
    parts : int
        Parts beside the main one.
    loose : int
        Vertices without a triangle.
    """

    welded: int = 0
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
    # How many, what one and several are called, where, and what was done.
    past = (
        (counts.welded, "duplicate vertex", "duplicate vertices", "along open seams", "welded for matching"),
        (counts.degenerate, "degenerate face", "degenerate faces", "", "left out"),
        (counts.repeated, "repeated face", "repeated faces", "", "left out"),
        (counts.crowded, "non-manifold edge", "non-manifold edges", "", "opened for matching"),
        (counts.touching, "place", "places", "where sheets touch in one vertex", "separated for matching"),
        (counts.left_out, "face", "faces", "of sheets that share an edge", "left out"),
        (counts.turned, "face", "faces", "with normals against their neighbours", "read the other way round"),
        (counts.spikes, "spike", "spikes", "of one vertex", "pulled in for matching"),
        (counts.filled, "small hole", "small holes", "", "closed for matching"),
    )
    notes = []
    for count, one, many, where, done in past:
        if count:
            things = f"{count:,} {one if count == 1 else many}" + (f" {where}" if where else "")
            notes.append(f"The {name} had {things}: {'it was' if count == 1 else 'they were'} {done}.")
    if counts.one_sided:
        notes.append(f"The {name} had a surface with only one side: it was cut open for matching.")
    if counts.inverted:
        notes.append(f"The normals of the {name} point inwards: they were read the other way round.")
    present = (
        (counts.left_open, "large opening: the surface ends there", "large openings: the surface ends there"),
        (counts.parts, "smaller part: it follows its surroundings", "smaller parts: they follow their surroundings"),
        (counts.loose, "loose vertex: it follows its surroundings", "loose vertices: they follow their surroundings"),
    )
    notes += [f"The {name} has {count:,} {one if count == 1 else many}." for count, one, many in present if count]
    return tuple(notes)
