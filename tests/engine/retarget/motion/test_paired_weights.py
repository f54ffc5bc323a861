# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of one rig as weights of another."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import BonePairing, RigError, paired_weights, row_sums
from tests.people import coarse_rig, fine_rig, renamed


def handed(someone, paired, rig):
    pairing = paired(someone, rig)
    trees = someone.rig.skeleton, rig.skeleton
    return paired_weights(someone.rig.weights, someone.mesh.vertices, pairing, *trees)


def test_of_a_rig_with_other_names_only_the_columns_move(someone, paired):
    rig = renamed(someone.rig)
    assert abs(handed(someone, paired, rig) - rig.weights).max() < 1e-12


def test_where_one_bone_stands_for_several_it_gets_their_sum(someone, paired):
    rig = coarse_rig(someone)
    weights, names = handed(someone, paired, rig), list(rig.names)
    for side in "LR":
        assert (
            abs(weights[:, [names.index(f"Y_foot.{side}")]] - rig.weights[:, [names.index(f"Y_foot.{side}")]]).max()
            < 1e-9
        )
    assert np.allclose(row_sums(weights), row_sums(someone.rig.weights))


def test_where_several_stand_for_one_its_weights_are_shared_out_along_them(someone, paired):
    rig = fine_rig(someone)
    weights, names = handed(someone, paired, rig), list(rig.names)
    spine = [number for number, name in enumerate(names) if "spine" in name]
    assert np.allclose(row_sums(csr_array(weights[:, spine])), row_sums(csr_array(rig.weights[:, spine])), atol=1e-9)
    apart = row_sums(csr_array(abs(weights - rig.weights)))[row_sums(csr_array(rig.weights[:, spine])) > 0.9]
    assert apart.mean() < 0.45  # of 2 at most: the joints go over differently
    assert not weights[:, [names.index("X_root")]].nnz


def test_without_any_pair_it_is_refused(someone):
    tree = someone.rig.skeleton
    none = np.zeros(0, int)
    pairing = BonePairing(none, none, np.zeros(0), np.zeros((0, 3, 3)), np.zeros((0, 3)), np.eye(3))
    with pytest.raises(RigError, match="No bones of the two rigs are paired"):
        paired_weights(someone.rig.weights, someone.mesh.vertices, pairing, tree, tree)
    with pytest.raises(RigError, match=r"Weights of .* are needed"):
        paired_weights(csr_array((3, 3)), someone.mesh.vertices, pairing, tree, tree)
