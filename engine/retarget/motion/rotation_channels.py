# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotations as the channels of a bone: quaternions, Euler angles of any order, axis and angle, without jumps."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from ...runtime.arrays import TINY, Floats, unit_vectors
from ...runtime.errors import RigError


def rotation_matrices(channels: Floats, mode: str) -> Floats:
    """Make rotations of channels.

    Parameters
    ----------
    channels : (f, 4) or (f, 3) array of float
        Quaternions (w, x, y, z) of any length, an angle and its axis, or three angles x, y, z; angles in radians.
    mode : str
        "QUATERNION", "AXIS_ANGLE", or the order in which the angles are applied, such as "XYZ".

    Returns
    -------
    (f, 3, 3) array of float
        The rotations; none where a quaternion or an axis is zero.

    Raises
    ------
    RigError
        If the mode is unknown or has another number of channels.
    """
    _check(mode, channels.shape[1])
    if mode == "QUATERNION":
        lengths = np.linalg.norm(channels, axis=1, keepdims=True)
        safe = np.where(lengths > 0, channels / np.maximum(lengths, TINY), [1.0, 0, 0, 0])
        return np.asarray(Rotation.from_quat(safe[:, [1, 2, 3, 0]]).as_matrix())
    if mode == "AXIS_ANGLE":
        return np.asarray(Rotation.from_rotvec(channels[:, :1] * unit_vectors(channels[:, 1:])).as_matrix())
    places = ["XYZ".index(letter) for letter in mode]
    return np.asarray(Rotation.from_euler(mode.lower(), channels[:, places]).as_matrix())


def rotation_channels(matrices: Floats, mode: str) -> Floats:
    """Make channels of rotations (f, 3, 3), of which each is as near to the one before as it can be.

    Parameters and what is returned are those of `rotation_matrices`, the other way round.
    """
    _check(mode, 4 if mode in {"QUATERNION", "AXIS_ANGLE"} else 3)
    rotations = Rotation.from_matrix(matrices)
    if mode in {"QUATERNION", "AXIS_ANGLE"}:
        quaternions = rotations.as_quat()[:, [3, 0, 1, 2]]
        quaternions[:1] *= np.where(quaternions[:1, :1] < 0, -1, 1)
        steps = np.sign((quaternions[1:] * quaternions[:-1]).sum(axis=1))
        quaternions[1:] *= np.cumprod(np.where(steps < 0, -1, 1))[:, None]
        return quaternions if mode == "QUATERNION" else _axes_and_angles(quaternions)
    places = ["XYZ".index(letter) for letter in mode]
    angles = np.empty((len(matrices), 3))
    angles[:, places] = rotations.as_euler(mode.lower())
    other = angles + np.pi
    other[:, places[1]] = np.pi - angles[:, places[1]]  # the same rotation
    turn = 2 * np.pi
    for row in range(1, len(angles)):
        choices = np.stack([angles[row], other[row]])
        choices += turn * np.round((angles[row - 1] - choices) / turn)
        angles[row] = choices[np.abs(choices - angles[row - 1]).sum(axis=1).argmin()]
    return angles


def _axes_and_angles(quaternions: Floats) -> Floats:
    """Angles and axes (f, 4) of unit quaternions without jumps between them; still rotations keep the axis."""
    halves = np.linalg.norm(quaternions[:, 1:], axis=1)
    turning = halves > 1e-9
    axes = np.zeros((len(quaternions), 3))
    axes[turning] = quaternions[turning, 1:] / halves[turning, None]
    last = np.maximum.accumulate(np.where(turning, np.arange(len(axes)), -1))
    axes = np.where(last[:, None] >= 0, axes[last], [0.0, 1.0, 0.0])
    signs = np.cumprod(np.append(1, np.where((axes[1:] * axes[:-1]).sum(axis=1) < 0, -1, 1)))
    angles = np.unwrap(2 * np.arctan2(signs * halves, quaternions[:, 0]))
    return np.concatenate([angles[:, None], signs[:, None] * axes], axis=1)


def _check(mode: str, count: int) -> None:
    """Make sure that there is such a mode, with so many channels."""
    known = 4 if mode in {"QUATERNION", "AXIS_ANGLE"} else 3 if sorted(mode) == ["X", "Y", "Z"] else 0
    if count != known:
        raise RigError(f'Rotations cannot be kept in {count} channels as "{mode}".')
