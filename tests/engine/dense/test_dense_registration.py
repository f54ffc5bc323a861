# SPDX-License-Identifier: GPL-3.0-or-later
"""The choice among hypotheses, and the registration of the best."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from engine import MatchError, SurfacePoints, run
from engine.dense import dense_registration as dense_map
from engine.dense import proposers
from engine.dense.credibility import probability_in_place, probability_turned
from engine.dense.dense_hypotheses import assessed_everywhere, map_hypotheses_steps
from engine.dense.dense_registration import EIGENPAIRS, RegisteredPair, registered_pair_steps
from engine.dense.densify import dense_match_steps
from engine.dense.functional_maps import PointMaps
from engine.dense.landmark_selection import Steered
from engine.dense.registered_hypotheses import Follower
from engine.geometry.procrustes import agreement_in_place
from engine.registration.elastic import ElasticSurface
from engine.registration.registration import SOFT
from engine.shapes.landmarks import LandmarkPlaces, Landmarks
from tests.bodies import mirrored_body
from tests.registered import shape, start_from
from tests.shapes import icosphere, rotation
from tests.steps import followed, returned


def errors(points, triangles, own, other, area):
    """Distance at rest between the vertices and their images, over the square root of the area."""
    images = np.einsum("kc,kcd->kd", points.barycentric, other[triangles[points.triangles]])
    return np.linalg.norm(own - images, axis=1) / np.sqrt(area)


@pytest.fixture(scope="module")
def bodies():
    """A symmetric body, and one like it in another pose and triangulation."""
    first, second = mirrored_body(0.0, 9), mirrored_body(0.8, 9, seed=1)
    return shape(*first[:2]), shape(*second[:2]), first[2], second[2]


@pytest.fixture(scope="module")
def watched(bodies):
    """What a registration yields on the way, and returns."""
    return followed(registered_pair_steps(*bodies[:2]))


@pytest.fixture(scope="module")
def registered(watched):
    return watched[1]


@pytest.fixture(scope="module")
def starts(bodies):
    """Start from twenty true pairs of vertices, and from their mirror images."""
    x, y, rest_x, rest_y = bodies
    chosen = x.samples.vertices[:20]
    gaps = [np.linalg.norm(rest_x[chosen][:, None] * [1, side, 1] - rest_y, axis=2) for side in (1, -1)]
    return [
        start_from(x, y, chosen, gap.argmin(axis=1), name) for gap, name in zip(gaps, ("true", "mirror"), strict=True)
    ]


def test_left_stays_left_between_the_vertices(registered, bodies):
    x, y, rest_x, rest_y = bodies
    there = errors(registered.registration.on_target, y.mesh.triangles, rest_x, rest_y, x.mesh.area)
    back = errors(registered.registration.on_source, x.mesh.triangles, rest_y, rest_x, y.mesh.area)
    for found in (there, back):
        assert found.mean() < 0.01
        assert found.max() < 0.08
    assert registered.candidates[0].hypothesis.orientation > 0.5


def test_candidates_are_ordered_and_cost_what_their_registration_costs(registered):
    scores = [candidate.score for candidate in registered.candidates]
    assert scores == sorted(scores)
    for candidate in registered.candidates:
        found, domains = candidate.registration, candidate.hypothesis.domains
        maps = PointMaps(
            *(
                surface.triangles[points.triangles, points.barycentric.argmax(axis=1)]
                for surface, points in ((registered.target, found.on_target), (registered.source, found.on_source))
            )
        )
        cost = 4 * np.log(found.energy + 20 * found.misfit)
        anywhere = assessed_everywhere(domains, maps).score + 4 * np.log(found.gaps).sum()
        assert candidate.score + candidate.credit == pytest.approx(anywhere)
        assert candidate.likeness == pytest.approx(-candidate.hypothesis.score - cost)
        waves = assessed_everywhere(domains, maps).terms["waves"]
        assert candidate.isometry == pytest.approx(np.clip((0.48 - waves) / 0.1, 0, 1))
        assert candidate.hypothesis.orientation > 0
    assert registered.likeness == registered.candidates[0].likeness
    assert registered.margin is None or registered.margin > 0


def test_the_pair_says_what_was_registered(registered, bodies):
    x, y = bodies[:2]
    assert registered.x is x
    assert registered.y is y
    np.testing.assert_array_equal(registered.source.triangles, x.mesh.triangles)
    assert registered.registration.positions.shape == x.mesh.vertices.shape
    assert len(registered.registration.on_source.triangles) == y.mesh.vertex_count
    assert len(x.spectrum) == EIGENPAIRS


def test_a_given_start_is_followed_where_nothing_is_searched(bodies, starts):
    x, y, rest_x, rest_y = bodies
    pair = run(registered_pair_steps(x, y, starts[:1], search=False))
    assert [candidate.hypothesis.origin for candidate in pair.candidates] == ["true"]
    assert pair.margin is None
    assert errors(pair.registration.on_target, y.mesh.triangles, rest_x, rest_y, x.mesh.area).mean() < 0.01


def test_a_start_is_followed_as_it_is_too_and_is_no_other_map(bodies, starts):
    x, y, rest_x, rest_y = bodies
    pair = run(registered_pair_steps(x, y, starts[:1], search=False, as_they_are=True))
    assert [candidate.hypothesis.origin for candidate in pair.candidates] == ["true", "true"]
    assert pair.candidates[0].score < pair.candidates[1].score
    assert pair.margin is None
    assert errors(pair.registration.on_target, y.mesh.triangles, rest_x, rest_y, x.mesh.area).mean() < 0.01


def test_of_two_starts_the_one_that_keeps_the_orientation_is_taken(bodies, starts):
    x, y, rest_x, rest_y = bodies
    pair = run(registered_pair_steps(x, y, starts[::-1], search=False))
    assert pair.candidates[0].hypothesis.origin == "true"
    assert errors(pair.registration.on_target, y.mesh.triangles, rest_x, rest_y, x.mesh.area).mean() < 0.01


def hind_legs_exchanged(x, y, rest_x, rest_y):
    """Start from pairs of vertices of which those on the hind legs are the mirror images of the true ones."""
    places = rest_x[x.samples.vertices].copy()
    places[(places[:, 0] < -0.2) & (places[:, 2] < -0.4), 1] *= -1
    images = np.linalg.norm(places[:, None] - rest_y, axis=2).argmin(axis=1)
    return start_from(x, y, x.samples.vertices, images, "exchanged")


def test_limbs_that_the_best_hypothesis_exchanges_are_put_right(bodies, monkeypatch):
    x, y, rest_x, rest_y = bodies
    wrong = hind_legs_exchanged(*bodies)
    left = run(registered_pair_steps(x, y, [wrong], search=False))
    assert errors(left.registration.on_target, y.mesh.triangles, rest_x, rest_y, x.mesh.area).max() > 0.15

    def misled(x, y, starts=(), *, search=True, **options):
        return map_hypotheses_steps(x, y, [wrong] if search else starts, search=False, **options)

    monkeypatch.setattr(dense_map, "map_hypotheses_steps", misled)
    reports, pair = followed(registered_pair_steps(x, y))
    assert pair.candidates[0].hypothesis.origin == "limbs"
    assert [report.fraction for report in reports] == sorted(report.fraction for report in reports)
    assert errors(pair.registration.on_target, y.mesh.triangles, rest_x, rest_y, x.mesh.area).max() < 0.08
    assert pair.margin is None or pair.margin >= 0


def test_where_a_map_is_nearly_an_isometry_no_rough_ones_are_followed(registered):
    assert not registered.candidates[0].hypothesis.is_doubtful
    assert "matching" not in [candidate.hypothesis.origin for candidate in registered.candidates]


def turned_start(x, y, rest_x, rest_y):
    """Start from pairs of vertices of which one is where the other would be if the body were turned round."""
    turned = np.linalg.norm(rest_x[x.samples.vertices[:40]][:, None] * [-1, -1, 1] - rest_y, axis=2).argmin(axis=1)
    return start_from(x, y, x.samples.vertices[:40], turned, "turned")


def test_a_matching_as_it_is_takes_the_place_of_hypotheses_that_are_wrong(bodies, monkeypatch):
    x, y, rest_x, rest_y = bodies
    start = turned_start(*bodies)

    def misled(x, y, starts=(), *, search=True, **options):
        return map_hypotheses_steps(x, y, [start] if search else starts, search=False, **options)

    monkeypatch.setattr(dense_map, "map_hypotheses_steps", misled)
    reports, pair = followed(registered_pair_steps(x, y))
    fractions = [report.fraction for report in reports]
    assert fractions == sorted(fractions)
    best, other = pair.candidates[0], pair.candidates[-1]
    assert (best.hypothesis.origin, other.hypothesis.origin) == ("matching", "turned")
    assert errors(pair.registration.on_target, y.mesh.triangles, rest_x, rest_y, x.mesh.area).max() < 0.08
    assert not best.hypothesis.is_doubtful
    assert other.hypothesis.is_doubtful
    assert best.likeness > other.likeness + 3
    assert pair.margin == pytest.approx(other.score - best.score)


@pytest.mark.parametrize("agreeing", [True, False])
def test_matchings_are_followed_only_if_they_agree_with_landmarks(agreeing, bodies, monkeypatch):
    x, y, rest_x, rest_y = bodies
    known = x.samples.vertices[:1]
    partner = np.linalg.norm(rest_x[known] * [-1, -1, 1] - rest_y, axis=1).argmin(keepdims=True)
    places = (LandmarkPlaces(vertices, vertices, vertices) for vertices in (known, partner))
    hypotheses = run(map_hypotheses_steps(x, y, [turned_start(*bodies)], search=False))
    steered = Steered(x, mirrored=False, hypotheses=hypotheses)
    monkeypatch.setattr(dense_map, "steered_hypotheses_steps", lambda *_, **__: returned(steered))
    asked = []
    monkeypatch.setattr(proposers, "agrees", lambda *those: asked.append(those[3]) or agreeing)
    pair = run(registered_pair_steps(x, y, landmarks=Landmarks(*places)))
    assert {hypothesis.origin for hypothesis in asked} == {"matching"}
    assert ("matching" in [candidate.hypothesis.origin for candidate in pair.candidates]) == agreeing


@pytest.fixture
def both_starts(bodies, starts, monkeypatch):
    """Start from the truth, and from it with the hind legs exchanged: both are followed, however unlike in score."""
    monkeypatch.setattr("engine.dense.dense_hypotheses._DISTINCT", 0.0)
    monkeypatch.setattr("engine.dense.dense_hypotheses._HOPELESS", np.inf)
    monkeypatch.setattr(dense_map, "_AMBIGUOUS", np.inf)
    return [starts[0], hind_legs_exchanged(*bodies)]


def with_soft_score(monkeypatch, origin, added):
    """Let the soft registrations of hypotheses of this origin seem worse than they are."""
    own = Follower.steps

    def steps(self, hypothesis):
        candidate = yield from own(self, hypothesis)
        return replace(candidate, score=candidate.score + added * (hypothesis.origin == origin))

    monkeypatch.setattr(Follower, "steps", steps)


def test_maps_that_are_nearly_as_credible_are_registered_closely_too(bodies, both_starts, monkeypatch):
    x, y, rest_x, rest_y = bodies
    plain = run(registered_pair_steps(x, y, both_starts, search=False))
    scores = {candidate.hypothesis.origin: candidate.score for candidate in plain.candidates}
    # So that the wrong one seems a little better at first.
    added = scores["exchanged"] - scores["true"] + 1
    assert added > 1
    with_soft_score(monkeypatch, "true", added)
    pair = run(registered_pair_steps(x, y, both_starts, search=False))
    assert [candidate.hypothesis.origin for candidate in pair.candidates] == ["true", "exchanged"]
    assert errors(pair.registration.on_target, y.mesh.triangles, rest_x, rest_y, x.mesh.area).max() < 0.08
    follow = Follower(x, y, pair.source, pair.target)
    softly = [run(follow.steps(candidate.hypothesis)) for candidate in pair.candidates]
    assert softly[0].score == pytest.approx(softly[1].score + 1)
    fits = run(follow.all_close_steps(softly))
    closely = [follow.judged_closely(fit).candidate.score for fit in fits]
    assert closely == pytest.approx([candidate.score for candidate in pair.candidates])
    assert pair.margin == pytest.approx(closely[1] - closely[0])
    settled, trips = run(follow.settled_steps(fits[0]))
    np.testing.assert_array_equal(settled.registration.positions, pair.registration.positions)
    np.testing.assert_array_equal(settled.reverse.positions, pair.reverse.positions)
    for own, of_pair in zip(trips, pair.trips, strict=True):
        np.testing.assert_array_equal(own, of_pair)


def ways_there_and_back(follow, fit):
    """Distances of the target's vertices from where both maps bring them, over the square root of the area."""
    there, back = fit.reverse.on_target, fit.registration.on_target
    images = SurfacePoints.from_barycentric(follow.y.mesh, back.triangles, back.barycentric).positions
    corners = follow.x.mesh.triangles[there.triangles]
    home = np.einsum("kc,kcd->kd", there.barycentric, images[corners])
    return np.linalg.norm(home - follow.y.mesh.vertices, axis=1) / np.sqrt(follow.y.mesh.area)


@pytest.fixture
def disagreeing(bodies, starts):
    """A candidate that was registered from either side, but hardly."""
    x, y = bodies[:2]
    pair = run(registered_pair_steps(x, y, starts[:1], search=False))
    follow = Follower(x, y, pair.source, pair.target)
    with pytest.MonkeyPatch.context() as hardly:
        hardly.setattr("engine.dense.registered_hypotheses._STAGES", (replace(SOFT, weights=(40.0,)),))
        return follow, run(follow.close_steps(pair.candidates[0]))


@pytest.mark.parametrize(("agreed", "more"), [((np.inf,), 0), ((0.0,), 1), ((0.0, 0.0), 2), ((0.0, np.inf), 1)])
def test_maps_that_disagree_are_registered_again(agreed, more, disagreeing, monkeypatch):
    follow, fit = replace(disagreeing[0], disagree=agreed), disagreeing[1]
    lengths = [ways_there_and_back(follow, fit)]
    own = Follower.again_steps
    starts = []
    monkeypatch.setattr(Follower, "again_steps", lambda self, c, found: starts.append(found) or own(self, c, found))
    settled, trips = run(follow.settled_steps(fit))
    assert len(starts) == more
    assert (settled.registration is fit.registration) == (more == 0)
    assert settled.candidate is fit.candidate
    lengths.append(ways_there_and_back(follow, settled))
    # Even if nothing is registered again, the target follows the source; how far they were apart is kept.
    assert lengths[1].mean() < 0.8 * lengths[0].mean()
    assert trips[1].mean() > 1.1 * lengths[1].mean()
    if not more:
        np.testing.assert_allclose(trips[1], lengths[0])


def test_registering_again_ends_where_the_maps_come_no_nearer(disagreeing, monkeypatch):
    monkeypatch.setattr("engine.dense.registered_hypotheses._NEARER", 0.0)
    follow, fit = replace(disagreeing[0], disagree=(0.0,) * 3), disagreeing[1]
    own = Follower.again_steps
    tried = []
    monkeypatch.setattr(Follower, "again_steps", lambda self, c, found: tried.append(found) or own(self, c, found))
    assert run(follow.settled_steps(fit))[0].registration is not fit.registration
    assert len(tried) == 1
    # Farther from each other, they are not taken.
    matches = fit.registration.on_target
    exchanged = replace(matches, triangles=matches.triangles[::-1])
    worse = replace(fit.registration, on_target=exchanged)
    monkeypatch.setattr(Follower, "again_steps", lambda *_: returned((fit.reverse, worse)))
    assert run(follow.settled_steps(fit))[0].registration is fit.registration


def test_confidence_is_lower_where_the_maps_were_apart(bodies, starts):
    x, y = bodies[:2]
    pair = run(registered_pair_steps(x, y, starts[:1], search=False))
    along = x.mesh.vertices[:, 0] / np.sqrt(x.mesh.area)
    far = np.where(along > 0, 0.1, 0.0), np.zeros(y.mesh.vertex_count)
    sure, doubted = (run(dense_match_steps(replace(pair, trips=trips))) for trips in (None, far))
    np.testing.assert_array_equal(doubted.source_to_target.positions, sure.source_to_target.positions)
    own, before = doubted.source_to_target.confidence, sure.source_to_target.confidence
    assert own[along > 0.2].max() < 0.1
    np.testing.assert_allclose(own[along < -0.2], before[along < -0.2])
    np.testing.assert_allclose(doubted.target_to_source.confidence, sure.target_to_source.confidence)
    assert doubted.quality.confidence < 0.8 * sure.quality.confidence
    assert doubted.quality.disagreement > sure.quality.disagreement + 0.03


@pytest.mark.parametrize(
    ("few", "expected"), [(0, ([0.375, 0.625] * 2, 0.5)), (10**9, ([0.5] * 2, 0.0))], ids=["fine", "coarse"]
)
def test_strain_is_taken_for_as_sparse_and_directed_as_bodies_are_alike(few, expected, bodies, starts, monkeypatch):
    monkeypatch.setattr("engine.registration.registration.COARSE", few)
    x, y = bodies[:2]
    pair = run(registered_pair_steps(x, y, starts[:1], search=False))
    follow, candidate = Follower(x, y, pair.source, pair.target), pair.candidates[0]
    powers, directions = [], []
    own = ElasticSurface.softened

    def recorded(surface, positions, radius, power, constant, *, directed):
        powers.append(power)
        directions.append(directed)
        return own(surface, positions, radius, power, constant, directed=directed)

    monkeypatch.setattr(ElasticSurface, "softened", recorded)
    run(follow.close_steps(replace(candidate, isometry=0.5)))
    assert powers == pytest.approx(expected[0])  # there and back
    assert directions == [expected[1]] * len(powers)


def test_maps_that_are_clearly_worse_are_not_registered_closely(bodies, both_starts, monkeypatch):
    with_soft_score(monkeypatch, "exchanged", 100)
    closely = []
    own = Follower.close_steps
    monkeypatch.setattr(Follower, "close_steps", lambda self, c: closely.append(c.hypothesis.origin) or own(self, c))
    pair = run(registered_pair_steps(*bodies[:2], both_starts, search=False))
    assert closely == ["true"]
    assert pair.margin == pytest.approx(pair.candidates[1].score - pair.candidates[0].score)


def test_motion_and_scale_do_not_matter(registered, bodies):
    x, y = bodies[:2]
    turn = rotation([1, -1, 2], 2.5)
    other = shape(0.01 * y.mesh.vertices @ turn.T + [7, 8, 9], y.mesh.triangles)
    pair = run(registered_pair_steps(x, other))
    np.testing.assert_allclose(pair.registration.positions, registered.registration.positions @ turn.T, atol=1e-4)
    best, before = pair.candidates[0], registered.candidates[0]
    assert best.score + best.credit == pytest.approx(before.score + before.credit, rel=1e-3)


def test_progress_rises(watched):
    fractions = [report.fraction for report in watched[0]]
    assert fractions == sorted(fractions)
    assert fractions[0] >= 0
    assert fractions[-1] == pytest.approx(1)


def test_meshes_with_fewer_vertices_than_eigenpairs_are_registered_too():
    vertices, triangles = icosphere(3)  # 92 vertices
    vertices = vertices * [1, 1.3, 1.8] + 0.2 * vertices[:, :1] * vertices[:, 1:2]
    x, y = shape(vertices, triangles), shape(1.1 * vertices, triangles)
    start = start_from(x, y, x.samples.vertices[:20], x.samples.vertices[:20])
    pair = run(registered_pair_steps(x, y, [start], search=False))
    points = pair.registration.on_target
    images = SurfacePoints.from_barycentric(y.mesh, points.triangles, points.barycentric).positions
    assert np.linalg.norm(images / 1.1 - vertices, axis=1).mean() < 0.05 * x.scale


def test_a_pair_that_nothing_was_compared_for_has_no_likeness():
    assert RegisteredPair(*[None] * 6, candidates=(), margin=None).likeness is None


def test_where_no_map_can_be_right_the_best_alone_is_followed(bodies, both_starts, monkeypatch):
    """With the true map made to seem worse at first, the wrong one is kept: no close registration decides."""
    x, y = bodies[:2]
    asked = []
    monkeypatch.setattr(proposers, "PROPOSERS", (proposers.Proposer(lambda *_: asked.append(1), 4.0),))
    monkeypatch.setattr(proposers, "may_reach", lambda least, *_: least == -np.inf)
    with_soft_score(monkeypatch, "true", 100.0)
    monkeypatch.setattr(proposers, "_CONTESTED", 1000.0)
    pair = run(registered_pair_steps(x, y, both_starts))
    assert not asked
    assert pair.candidates[0].hypothesis.origin != "true"
    assert pair.margin is not None


def test_surfaces_that_are_less_alike_than_asked_for_are_given_up_before_close_registrations(
    bodies, both_starts, monkeypatch
):
    x, y = bodies[:2]
    closely = []
    monkeypatch.setattr(dense_map, "_contest_steps", lambda *_: closely.append(1))
    for least in ({"least": np.inf}, {"least_softly": np.inf}):
        with pytest.raises(MatchError, match="not enough alike"):
            run(registered_pair_steps(x, y, both_starts, search=False, **least))
    assert not closely


def test_a_chosen_map_by_which_the_surfaces_are_less_alike_than_asked_for_is_not_followed(
    bodies, both_starts, monkeypatch
):
    x, y = bodies[:2]
    own = Follower.all_close_steps

    def unlike_steps(*given):
        fits = yield from own(*given)
        return [replace(fit, candidate=replace(fit.candidate, likeness=0.0, in_place=0.0)) for fit in fits]

    settled = []
    monkeypatch.setattr(Follower, "all_close_steps", unlike_steps)
    monkeypatch.setattr(Follower, "settled_steps", lambda *_: settled.append(1))
    with pytest.raises(MatchError, match="not enough alike"):
        run(registered_pair_steps(x, y, both_starts, search=False, least=10.0))
    assert not settled


@pytest.mark.parametrize(
    ("moved", "seen", "distinct"),
    [
        ("hat", "body", False),  # neither finds a partner for it
        ("hat", "all", True),  # the other map does
        ("arm", "body", True),
    ],
)
def test_maps_that_differ_only_where_neither_finds_a_partner_are_one_answer(moved, seen, distinct):
    parts = np.repeat(["body", "arm", "hat"], [80, 10, 10])
    at_rest = np.zeros((100, 3))
    known = {"body": parts != "hat", "all": np.ones(100, bool)}

    def registered(positions, partnered):
        return SimpleNamespace(positions=positions, on_target=partnered, on_source=None)

    rival = registered(at_rest + 0.5 * (parts == moved)[:, None], known[seen])
    chosen = SimpleNamespace(registration=registered(at_rest, known["body"]), reverse=SimpleNamespace(on_target=None))
    follow = SimpleNamespace(source=SimpleNamespace(mass=np.ones(100)), partnered=lambda there, _: there)
    far = 50.0
    rivals = [dense_map.Rival(rival, each, each) for each in (far, 0.1)]
    margin, found = run(dense_map.alternatives_steps(follow, rivals, chosen))
    assert margin == (0.1 if distinct else far)
    assert len(found) == distinct


@pytest.mark.parametrize(("behind", "elsewhere", "offered"), [(5.0, 0.1, 1), (0.1, 5.0, 1), (5.0, 5.0, 0)])
def test_what_is_left_in_place_makes_the_choice_clear_and_other_maps_are_offered_all_the_same(
    behind, elsewhere, offered
):
    rest = np.zeros((100, 3))
    rival = SimpleNamespace(positions=rest + 0.5, on_target=np.ones(100, bool), on_source=None)
    held = SimpleNamespace(positions=rest, on_target=np.ones(100, bool))
    chosen = SimpleNamespace(registration=held, reverse=held)
    follow = SimpleNamespace(source=SimpleNamespace(mass=np.ones(100)), partnered=lambda there, _: there)
    rivals = [dense_map.Rival(rival, behind, elsewhere)]
    margin, found = run(dense_map.alternatives_steps(follow, rivals, chosen))
    assert margin == behind
    assert len(found) == offered


def test_a_turned_body_is_another_map_than_one_left_in_place(bodies, both_starts):
    """The score counts what stands where it stood, but for surfaces from which something may have been cut off."""
    x, y = bodies[:2]
    pair = run(registered_pair_steps(x, y, both_starts))
    areas, points = pair.source.mass, x.mesh.vertices
    standing = max(candidate.in_place for candidate in pair.candidates)
    for candidate in pair.candidates:
        agreement = agreement_in_place(points, candidate.registration.positions, areas)
        assert candidate.in_place == pytest.approx(probability_in_place(agreement))
        turned = agreement_in_place(points, candidate.registration.positions, areas, half_turn=True)
        best = max(candidate.in_place, probability_turned(turned, standing))
        assert candidate.credit == pytest.approx(-np.log1p(-best))
    assert pair.in_place == pytest.approx(
        probability_in_place(agreement_in_place(points, pair.registration.positions, areas))
    )
