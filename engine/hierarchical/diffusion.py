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


def diffusion_places(spectrum: Spectrum, time: float, least: float = 0.0) -> Floats:
    r"""Place the vertices so that straight lines between them are as long as their diffusion distances [1]_.

    .. math:: d_t^2(x, y) = A \sum_i e^{-2 \lambda_i t} (\phi_i(x) - \phi_i(y))^2

    the distance (11) of the paper.  With the area A of the surface, and time counted in units of area, nothing depends
    on the units of the mesh.  Constant functions, of the eigenvalue zero, say nothing of distances, and are left out:
    their rounding would outweigh all others after a long time.  The products of two places are what the heat kernel
    (10) of the paper has beyond its mean, :math:`A h_{2t}(x, y) - 1` on a surface of one piece.

    Parameters
    ----------
    spectrum : Spectrum
        Eigenpairs of the surface.
    time : float
        How long heat spreads, in units of the surface's area: t / A.
    least : float
        Eigenvalue times area from which on decay counts, see `positive_values`: places are longer by one factor then,
        and not too short to be told apart after a long time.

    Returns
    -------
    (n, k) array of float
        The points :math:`\sqrt{A} e^{-\lambda_i t} \phi_i(x)`.

    Raises
    ------
    SettingsError
        If all eigenpairs are those of the eigenvalue zero.

    References
    ----------
    .. [1] R. Coifman, S. Lafon, "Diffusion maps", Appl. Comput. Harmon. Anal. 21, 2006.
    """
    decay = np.exp((least - positive_values(spectrum)) * time)
    return spectrum.functions[:, spectrum.zero_count :] * (decay * np.sqrt(spectrum.area))


def positive_values(spectrum: Spectrum) -> Floats:
    """Eigenvalues times the surface's area, without those that are zero, ascending.

    Raises
    ------
    SettingsError
        If all are zero.
    """
    values = spectrum.values[spectrum.zero_count :] * spectrum.area
    if not len(values):
        raise SettingsError(
            f"Diffusion needs eigenfunctions that are not constant, but the {len(spectrum)} that were computed are. "
            "Use more eigenfunctions."
        )
    return values


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
    values = positive_values(spectrum)
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
