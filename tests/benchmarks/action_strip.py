# SPDX-License-Identifier: GPL-3.0-or-later
"""Strips of frames of characters in an action, from the side and from the front, above the ground."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import bpy
import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

__all__ = ["draw_strip", "shown_surface"]

COLORS = ((0.93, 0.87, 0.78), (0.6, 0.75, 0.95))
"""Of the first character, and of the second."""

LIGHT = np.array([0.4, -0.5, 0.75]) / np.linalg.norm([0.4, -0.5, 0.75])


def shown_surface(meshes: Sequence[bpy.types.Object]) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) and triangles (m, 3) of meshes as they are shown, in world space."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    places, corners, count = [], [], 0
    for obj in meshes:
        shown = obj.evaluated_get(depsgraph)
        mesh = shown.to_mesh()
        mesh.calc_loop_triangles()
        vertices = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", vertices)
        triangles = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("vertices", triangles)
        matrix = np.array(shown.matrix_world)
        places.append(vertices.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3])
        corners.append(triangles.reshape(-1, 3) + count)
        count += len(places[-1])
        shown.to_mesh_clear()
    return np.concatenate(places), np.concatenate(corners)


def draw_strip(
    path: Path,
    characters: Sequence[Sequence[bpy.types.Object]],
    turns: Sequence[float],
    grounds: Sequence[float],
    frames: Sequence[float],
) -> None:
    """Draw each character in each frame, from its side and from its front: a row each.

    Parameters
    ----------
    path : Path
        The picture that is written.
    characters : sequence of sequences of bpy.types.Object
        The meshes of each.
    turns : sequence of float
        Angle on the ground of the direction to each one's left.
    grounds : sequence of float
        How high each one's ground is, which is drawn as a line.
    frames : sequence of float
        What is shown.
    """
    os.environ.setdefault("MPLBACKEND", "Agg")
    from matplotlib import pyplot as plt
    from matplotlib.collections import PolyCollection

    rows, columns = 2 * len(characters), len(frames)
    figure, axes = plt.subplots(rows, columns, figsize=(1.7 * columns, 1.7 * rows), dpi=100, squeeze=False)
    sizes: dict[int, float] = {}
    for column, frame in enumerate(frames):
        bpy.context.scene.frame_set(round(frame))
        for number, (meshes, turn, ground) in enumerate(zip(characters, turns, grounds, strict=True)):
            vertices, triangles = shown_surface(meshes)
            left = np.array([np.cos(turn), np.sin(turn), 0])
            front = np.array([np.sin(turn), -np.cos(turn), 0])
            size = sizes.setdefault(number, 1.3 * float(np.ptp(vertices, axis=0).max()))
            for side, (across, toward) in enumerate(((front, left), (left, front))):
                corners = vertices[triangles]
                normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
                normals /= np.linalg.norm(normals, axis=1, keepdims=True) + np.finfo(float).tiny
                lit = 0.3 + 0.7 * np.abs(normals @ LIGHT)
                order = (corners @ toward).mean(axis=1).argsort()
                flat = np.stack([corners @ across, corners[..., 2]], axis=-1)[order]
                colors = lit[order, None] * np.array(COLORS[number % len(COLORS)])
                axis = axes[2 * number + side, column]
                axis.add_collection(PolyCollection(flat, facecolors=colors, edgecolors=colors, linewidths=0.3))
                middle = float(vertices.mean(axis=0) @ across)
                axis.axhline(ground, color="red", linewidth=0.6)
                axis.set_xlim(middle - size / 2, middle + size / 2)
                axis.set_ylim(ground - 0.12 * size, ground + 0.88 * size)
                axis.set_aspect("equal")
                axis.axis("off")
    figure.subplots_adjust(0, 0, 1, 1, 0, 0)
    figure.savefig(path)
    plt.close(figure)
