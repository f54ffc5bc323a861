# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffusion distances: how differently heat spreads from two points."""

from __future__ import annotations

import numpy as np

from ..geometry.eigenpairs import Spectrum
from ..runtime.arrays import Floats
from ..runtime.errors import SettingsError

_MODES = 8.0
"""How many eigenfunctions, each counted by its weight, make up diffusion distances at the automatic time.

On bodies of people and animals in two poses, where true matches are known, fewer blur limbs into one another, and more
follow the differences of bodies.
"""


def diffusion_places(spectrum: Spectrum, time: float) -> Floats:
    r"""Place the vertices so that straight lines between them are as long as their diffusion distances [1]_.

    .. math:: d_t^2(x, y) = A \sum_i e^{-2 \lambda_i t} (\phi_i(x) - \phi_i(y))^2

    the distance (11) of the paper.  With the area A of the surface, and time counted in units of area, nothing depends
    on the units of the mesh.  The products of two places are the heat kernel :math:`A h_{2t}(x, y)`, (10) of the paper.

    Parameters
    ----------
    spectrum : Spectrum
        Eigenpairs of the surface.
    time : float
        How long heat spreads, in units of the surface's area: t / A.

    Returns
    -------
    (n, k) array of float
        The points :math:`\sqrt{A} e^{-\lambda_i t} \phi_i(x)`.

    References
    ----------
    .. [1] R. Coifman, S. Lafon, "Diffusion maps", Appl. Comput. Harmon. Anal. 21, 2006.
    """
    decay = np.exp(-spectrum.values * spectrum.area * time)
    return spectrum.functions * (decay * np.sqrt(spectrum.area))


def automatic_time(spectrum: Spectrum) -> float:
    r"""Choose how long heat spreads so that distances tell large from small parts of a surface apart.

    This is the time, in units of area, at which :math:`\sum_{\lambda_i > 0} e^{-2 \lambda_i t} = 8`: the mean of
    :math:`d_t^2` is twice this sum, which says how many eigenfunctions have their share in the distances.  It depends
    on the intrinsic shape alone, not on scale, resolution or how many eigenpairs were computed.

    Raises
    ------
    SettingsError
        If all eigenpairs are those of the eigenvalue zero.
    """
    values = spectrum.values[spectrum.zero_count :] * spectrum.area
    if not len(values):
        raise SettingsError(
            f"Diffusion needs eigenfunctions that are not constant, but the {len(spectrum)} that were computed are. "
            "Use more eigenfunctions."
        )
    # A surface with few pairs: as many of them as there are room for.
    modes = min(_MODES, len(values) / 2)
    # The sum falls with time, from more than `modes` at first to less than `modes` in the end.
    early, late = np.log(np.log(len(values) / modes) / 2 / values[[-1, 0]])
    for _ in range(60):
        middle = (early + late) / 2
        if np.exp(-2 * values * np.exp(middle)).sum() > modes:
            early = middle
        else:
            late = middle
    return float(np.exp(middle))
