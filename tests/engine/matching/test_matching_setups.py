# SPDX-License-Identifier: GPL-3.0-or-later
"""Every metric and descriptor matches a posed, remeshed body."""

import numpy as np
import pytest

from engine import MatchSettings, Shape, TriangleMesh, match, match_steps
from engine.hierarchical.sampled_pair import Pair
from engine.hierarchical.settings import SETUPS
from engine.runtime.progress import run
from tests.shapes import creature

QUICK = {"points": 24, "samples": 160}


@pytest.fixture(scope="module")
def bodies():
    vertices_x, triangles_x, rest_x = creature(0.0, resolution=13)
    vertices_y, triangles_y, rest_y = creature(0.7, resolution=12, turn=0.6)
    return Shape(TriangleMesh(vertices_x, triangles_x)), Shape(TriangleMesh(vertices_y, triangles_y)), rest_x, rest_y


CHOICES = {
    **{f"setup {key}": choices for key, (_, choices) in SETUPS.items()},
    "wave kernel": {"descriptor": "wave_kernel"},
    "bin to bin": {"comparison": "bin_to_bin"},
    "bijective": {"constraint": "bijective"},
}


@pytest.mark.parametrize("choices", CHOICES.values(), ids=CHOICES)
def test_a_posed_body_is_matched(bodies, choices):
    source, target, rest_x, rest_y = bodies
    result = match(source, target, MatchSettings(**QUICK, **choices))
    gap = result.source_points.interpolate(rest_x) - result.target_points.interpolate(rest_y)
    assert np.linalg.norm(gap, axis=1).mean() / source.scale < 0.1
    assert result.orientation > 0.3
    assert result.mirrored is None or result.mirrored.orientation < 0


def prepared(bodies, **choices):
    settings = MatchSettings(**QUICK, **choices)
    for shape in bodies[:2]:
        run(shape.sample_steps(settings.samples))
        run(shape.spectrum_steps(settings.eigenpairs))
    return Pair(*bodies[:2], settings)


def test_the_linear_term_is_scaled_by_its_weight(bodies):
    single, double = prepared(bodies), prepared(bodies, linear_weight=2.0)
    np.testing.assert_allclose(double.linear, 2 * single.linear)


def test_descriptors_without_a_unit_have_one_typical_size(bodies):
    means = [
        run(prepared(bodies, descriptor=name).variants_steps(1))[0].linear.mean()
        for name in ("heat_kernel", "wave_kernel", "eigenfunctions")
    ]
    np.testing.assert_allclose(means, means[0])


def test_diffusion_distances_are_those_of_the_time_given(bodies):
    short, long = (prepared(bodies, metric="diffusion", diffusion_time=t).source_distances for t in (0.01, 0.5))
    assert np.abs(short - long).max() > 0.1
    for distances in (short, long):
        assert np.sqrt(np.square(distances).mean()) == pytest.approx(1, rel=0.1)
        np.testing.assert_allclose(distances, distances.T, atol=1e-6)


def test_eigenfunctions_give_a_variant_per_sign_sequence(bodies):
    assert len(run(prepared(bodies).variants_steps(4))) == 1
    variants = run(prepared(bodies, descriptor="eigenfunctions").variants_steps(4))
    assert len(variants) == 4
    assert not np.allclose(variants[0].linear, variants[1].linear)


def test_a_bijective_coarse_match_uses_every_candidate(bodies):
    result = match(*bodies[:2], MatchSettings(**QUICK, constraint="bijective"))
    assert result.coarse.candidates == len(result.coarse.source_vertices)


SLOW = [pytest.param(solver, marks=pytest.mark.slow) for solver in ("hierarchical", "gmds")]


@pytest.mark.parametrize("solver", ["flat", *SLOW])
@pytest.mark.parametrize("choices", CHOICES.values(), ids=CHOICES)
def test_progress_never_decreases(bodies, choices, solver):
    points = 10 if solver == "flat" else 12
    settings = MatchSettings(points=points, samples=50, hypotheses=4, dense=False, solver=solver, **choices)
    fractions = [progress.fraction for progress in match_steps(*bodies[:2], settings)]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1
