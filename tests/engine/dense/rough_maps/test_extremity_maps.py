# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from engine.dense.functional_maps import PointMaps
from engine.dense.rough_maps.extremity_maps import (
    MapLead,
    RoughSearch,
    distinct_leads,
    fitting_maps_steps,
    rough_maps_steps,
)
from engine.runtime.progress import Progress, run
from tests.bodies import octopus
from tests.domains import domain
from tests.shapes import creature, rotation
from tests.steps import followed


@pytest.fixture(scope="module")
def pair():
    return tuple(domain(*creature(pose, 9)[:2], samples=300) for pose in (0.0, 1.0))


def error(x, y, points, sign=1):
    """Mean distance between images and truth at rest, where vertices correspond by their number."""
    rest = creature(0.0, 9)[2]
    images = rest[y.vertices[points.on_y]]
    return np.linalg.norm(images - rest[x.vertices[: x.coarse_count]] * [1, sign, 1], axis=1).mean()


def test_the_truth_is_among_the_rough_maps_and_first_of_its_orientation(pair):
    leads = run(rough_maps_steps(*pair))
    keeping = [lead for lead in leads if lead.orientation > 0]
    assert error(*pair, keeping[0].points) < 0.15
    assert keeping[0].score == min(lead.score for lead in keeping)


def test_matchings_may_be_looked_for_beside_something_else(pair):
    def own():
        yield Progress(0.5, "Something else")
        return "done"

    reports, (result, search) = followed(RoughSearch(pair, (1,)).beside_steps(own()))
    assert result == "done"
    fractions = [report.fraction for report in reports]
    assert fractions == sorted(fractions)
    assert reports[0].label == "Something else"
    later, alone = run(rough_maps_steps(*pair, (1,), search)), run(rough_maps_steps(*pair, (1,)))
    assert [lead.score for lead in later] == [lead.score for lead in alone]
    for first, second in zip(later, alone, strict=True):
        np.testing.assert_array_equal(first.points.on_y, second.points.on_y)


def test_maps_that_mirror_are_proposed_too(pair):
    leads = run(rough_maps_steps(*pair))
    mirroring = [lead for lead in leads if lead.orientation <= 0]
    assert mirroring
    assert min(error(*pair, lead.points, -1) for lead in mirroring) < 0.25


def test_the_truth_is_among_the_matchings_that_are_proposed_as_they_are(pair):
    maps = run(fitting_maps_steps(*pair))
    errors = [error(*pair, points) for points in maps]
    assert 3 <= len(maps) <= 18
    assert min(errors) < 0.12
    progress = [report.fraction for report in fitting_maps_steps(*pair)]
    assert progress == sorted(progress)
    assert progress[-1] == 1


def test_groups_are_few(pair):
    leads = run(rough_maps_steps(*pair))
    assert sum(lead.orientation > 0 for lead in leads) <= 8
    assert sum(lead.orientation <= 0 for lead in leads) <= 3


def test_progress_grows_to_the_end(pair):
    fractions = [progress.fraction for progress in rough_maps_steps(*pair)]
    assert fractions == sorted(fractions)
    assert 0 <= fractions[0] <= fractions[-1] <= 1


def test_the_best_of_equal_maps_is_kept_and_hopeless_ones_are_not(pair):
    _, y = pair
    rng = np.random.default_rng(0)
    same, other, third = (rng.integers(0, y.coarse_count, y.coarse_count) for _ in range(3))

    def lead(images, score, orientation):
        return MapLead(PointMaps(images, images), score, orientation, {}, "here")

    leads = [lead(same, 2, 0.5), lead(same, 1, 0.5), lead(other, 1.5, 0.4), lead(third, 9, 0.5), lead(same, 5, -0.5)]
    kept = distinct_leads(y, leads, 0.05, 3.0, {1: 2, -1: 1})
    assert [each.score for each in kept] == [1, 1.5, 5]
    assert [each.score for each in distinct_leads(y, leads, 0.05, 3.0, {1: 1})] == [1]
    assert [each.score for each in distinct_leads(y, leads, 0.05, 30.0, {1: 3})] == [1, 1.5, 9]


@pytest.fixture(scope="module")
def octopuses():
    """Two poses and meshings of a body with eight arms: domains, and places at rest."""
    bodies = [octopus(5, 8), octopus(6, 8, turn=0.9)]
    return [domain(*body[:2], samples=300) for body in bodies], [body[2] for body in bodies]


def test_of_many_arms_any_may_be_the_first(octopuses, monkeypatch):
    (x, y), (rest_x, rest_y) = octopuses
    places = rest_x[x.vertices[: x.coarse_count]]

    def turns():
        """By how many arms the proposed maps turn the body: only those that are near to such a turn."""
        found = set()
        for lead in run(rough_maps_steps(x, y, (1,))):
            images = rest_y[y.vertices[lead.points.on_y]]
            gaps = [
                np.linalg.norm(images - places @ rotation([0, 0, 1], k * np.pi / 4).T, axis=1).mean() for k in range(8)
            ]
            if min(gaps) < 0.3:
                found.add(int(np.argmin(gaps)))
        return found

    found = turns()
    assert 0 in found
    assert len(found) >= 3
    monkeypatch.setattr("engine.dense.rough_maps.extremity_maps._MANY_LIMBS", 99)
    assert len(turns()) < len(found)
