# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours that show a match."""

from __future__ import annotations

import numpy as np
import pytest
from hiermatch.hiermatch_addon.storage.views import colors


@pytest.fixture
def random():
    return np.random.default_rng(7)


def lightness(srgb):
    """CIE L* of sRGB colours, by its definition: another model than the one that the colour map is made in."""
    y = colors.to_linear(srgb) @ [0.2126, 0.7152, 0.0722]
    return np.where(y > (6 / 29) ** 3, 116 * np.cbrt(y) - 16, y * (29 / 3) ** 3)


class TestMatchColors:
    def test_bright_vivid_and_in_range(self, random):
        rgb = colors.match_colors(random.normal(size=(200, 3)) * [5, 2, 1])
        assert rgb.shape == (200, 3)
        assert rgb.min() >= 0
        assert rgb.max(axis=1) == pytest.approx(0.95)
        saturation = 1 - rgb.min(axis=1) / rgb.max(axis=1)
        assert np.median(saturation) > 0.5

    def test_different_places_look_different(self, random):
        positions = random.uniform(-1, 1, size=(300, 3)) * [3, 2, 1]
        rgb = colors.match_colors(positions)
        left, right = positions[:, 0] < -1.5, positions[:, 0] > 1.5
        assert np.linalg.norm(rgb[left].mean(axis=0) - rgb[right].mean(axis=0)) > 0.4

    def test_all_thirds_of_a_long_shape_differ_wherever_else_they_are(self, random):
        """Such as head, back and tail of an animal."""
        positions = random.uniform(-1, 1, size=(3000, 3)) * [3, 1, 0.5]
        rgb = colors.match_colors(positions)
        thirds = [rgb[(positions[:, 0] >= low) & (positions[:, 0] < low + 0.6)] for low in (-3.0, -0.3, 2.4)]
        for one, other in ((0, 1), (1, 2), (0, 2)):
            apart = np.linalg.norm(thirds[one][:, None] - thirds[other][None], axis=2)
            assert np.quantile(apart, 0.02) > 0.3

    def test_place_size_and_rotation_do_not_matter(self, random):
        positions = random.exponential(size=(60, 3)) * [5, 2, 1]
        turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
        turn *= np.linalg.det(turn)
        expected = colors.match_colors(positions)
        assert colors.match_colors(1e4 * positions @ turn.T + [3e4, 0, -7]) == pytest.approx(expected, abs=1e-6)

    @pytest.mark.parametrize("flat", [[1, 1, 0], [1, 0, 0], [0, 0, 0]])
    def test_flat_shapes_have_colours_too(self, random, flat):
        rgb = colors.match_colors(random.normal(size=(30, 3)) * flat)
        assert np.isfinite(rgb).all()
        assert rgb.min() >= 0
        assert rgb.max() <= 1

    @pytest.mark.parametrize("count", [1, 2, 3])
    def test_few_points(self, random, count):
        rgb = colors.match_colors(random.normal(size=(count, 3)))
        assert rgb.shape == (count, 3)
        assert rgb.min() >= 0
        assert rgb.max() <= 1

    def test_what_flies_about_changes_nothing_if_it_weighs_nothing(self, random):
        positions, weights = random.normal(size=(500, 3)) * [5, 2, 1], random.uniform(0.5, 1, 500)
        expected = colors.match_colors(positions, weights)
        stray = np.concatenate([positions, [[0, 1e4, 0], [-1e5, 0, 0]]])
        rgb = colors.match_colors(stray, np.concatenate([weights, [0, 1e-4]]))
        assert np.quantile(np.abs(rgb[:500] - expected), 0.99) < 0.02
        assert rgb.min() >= 0
        assert rgb.max() <= 1

    def test_equal_weights_are_almost_none(self, random):
        positions = random.uniform(size=(5000, 3)) * [5, 2, 1]
        weighted = colors.match_colors(positions, np.full(5000, 3.0))
        assert np.quantile(np.abs(weighted - colors.match_colors(positions)), 0.99) < 0.02


class TestBandwidths:
    def test_half_the_spacing_on_a_line(self):
        line = np.arange(10.0)
        pairs = np.abs(line[:, None] - line)
        assert colors.bandwidths(pairs, 3 * pairs) == pytest.approx((0.5, 1.5))

    def test_parts_without_a_path(self):
        line = np.arange(6.0)
        pairs = np.abs(line[:, None] - line)
        pairs[:3, 3:] = pairs[3:, :3] = np.inf
        assert colors.bandwidths(pairs, pairs) == pytest.approx((0.5, 0.5))

    @pytest.mark.parametrize("pairs", [np.zeros((3, 3)), np.where(np.eye(3) > 0, 0, np.inf)])
    def test_no_two_points_apart(self, pairs):
        assert all(reach > 0 for reach in colors.bandwidths(pairs, pairs))


class TestSpread:
    def test_constants_stay(self, random):
        spread = colors.spread(np.full((8, 2), 0.3), random.uniform(0, 5, (8, 50)), 0.4)
        assert spread == pytest.approx(0.3)

    def test_within_the_range_of_the_values(self, random):
        values = random.uniform(size=(8, 3))
        spread = colors.spread(values, random.uniform(0, 5, (8, 500)), 0.7)
        assert (spread >= values.min(axis=0) - 1e-12).all()
        assert (spread <= values.max(axis=0) + 1e-12).all()

    def test_a_point_keeps_nearly_its_value(self):
        line = np.arange(5.0)
        values = np.array([[0.0], [1.0], [0.0], [0.0], [1.0]])
        spread = colors.spread(values, np.abs(line[:, None] - line), 0.5)
        assert np.abs(spread - values).max() < 0.25

    def test_continuous(self):
        line, fine = np.arange(5.0), np.linspace(0, 4, 4001)
        values = np.array([[0.0], [1.0], [0.0], [0.0], [1.0]])
        spread = colors.spread(values, np.abs(line[:, None] - fine), 0.5)
        assert np.abs(np.diff(spread[:, 0])).max() < 0.003

    def test_units_do_not_matter(self, random):
        values, distances = random.uniform(size=(8, 3)), random.uniform(0, 5, (8, 50))
        expected = colors.spread(values, distances, 0.7)
        assert colors.spread(values, distances * 1e-5, 0.7e-5) == pytest.approx(expected)

    def test_very_far_from_every_point_is_no_hole(self):
        spread = colors.spread(np.array([[1.0], [0.0]]), np.array([[1e6], [2e6]]), 1e-3)
        assert spread[0, 0] == 1.0

    def test_unreachable_vertices_have_no_value(self):
        distances = np.array([[0.0, 1.0, np.inf], [1.0, np.inf, np.inf]])
        spread = colors.spread(np.array([[1.0], [0.0]]), distances, 1.0)
        assert spread[1, 0] == 1.0
        assert np.isnan(spread[2, 0])

    def test_blocks_make_no_difference(self, random, monkeypatch):
        values, distances = random.uniform(size=(8, 3)), random.uniform(0, 5, (8, 101))
        expected = colors.spread(values, distances, 0.7)
        monkeypatch.setattr(colors, "_BLOCK", 100)
        assert colors.spread(values, distances, 0.7) == pytest.approx(expected, rel=1e-12)


class TestDistortionColors:
    def test_from_dark_blue_to_yellow(self):
        dark, light = colors.distortion_colors(np.array([0.0, 2.0]), 2.0)
        assert dark.argmax() == 2
        assert dark.max() < 0.5
        assert min(light[:2]) > 0.85
        assert light[2] < 0.3

    def test_lightness_grows_evenly(self):
        steps = np.diff(lightness(colors.distortion_colors(np.linspace(0, 1, 101), 1.0)))
        assert steps.min() > 0
        assert steps.max() < 2 * steps.min()

    def test_beyond_the_ends_and_nowhere(self):
        values = np.array([-1.0, 0.0, 1.0, 5.0, np.nan])
        rgb = colors.distortion_colors(values, 1.0)
        assert (rgb[0] == rgb[1]).all()
        assert (rgb[2] == rgb[3]).all()
        assert (rgb[4] == colors.NEUTRAL).all()

    def test_no_distortion_at_all_is_dark_blue(self):
        rgb = colors.distortion_colors(np.zeros(3), 0.0)
        assert rgb == pytest.approx(colors.distortion_colors(np.array([0.0] * 3), 1.0))


class TestConfidenceColors:
    def test_from_dark_red_to_white(self):
        dark, light = colors.confidence_colors(np.array([0.0, 1.0]))
        assert dark.argmax() == 0
        assert dark.max() < 0.5
        assert light.min() > 0.85

    def test_lightness_grows_evenly(self):
        steps = np.diff(lightness(colors.confidence_colors(np.linspace(0, 1, 101))))
        assert steps.min() > 0
        assert steps.max() < 2 * steps.min()


class TestLinear:
    def test_known_values(self):
        known = np.array([[0.0, 0.04045, 1.0], [0.5, 0.5, 0.5]])
        assert colors.to_linear(known) == pytest.approx(np.array([[0, 0.0031308, 1], [0.21404114] * 3]), abs=1e-6)

    def test_nowhere_is_neutral(self):
        nowhere = colors.to_linear(np.full((1, 3), np.nan))
        assert nowhere == pytest.approx(colors.to_linear(np.full((1, 3), colors.NEUTRAL)))

    def test_alpha_is_one(self):
        rgba = colors.opaque(np.full((2, 3), 0.25))
        assert rgba.tolist() == [[0.25, 0.25, 0.25, 1.0]] * 2
        assert rgba.dtype == np.float32
