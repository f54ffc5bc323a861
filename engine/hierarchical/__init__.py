# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper: hierarchical matching of sampled shapes.

D. Raviv, A. Dubrovina, R. Kimmel, "Hierarchical Matching of Non-rigid Shapes".  Read in this order:

=======================  =================================================================================
Of the paper             Module
=======================  =================================================================================
Correspondence, (1-6)    `problem`: distortion of a matching, its linear and quadratic part, one to one
Geodesic metric, (7)     `engine.geometry.geodesics`: fast marching
Diffusion metric, 9-11   `diffusion`; the eigenpairs of (9) are those of `engine.geometry.eigenpairs`
Descriptors              `descriptors`: histograms of distances and their comparison;
                         `spectral_descriptors`: heat (and wave) kernel signatures;
                         `sign_sequences`: eigenfunctions up to their signs
Terms of the distortion  `sampled_pair`: distances and descriptor differences of the samples, as a problem
Section 4, coarse step   `exact`: branch and bound with dual bounds (the module `branch_and_bound` is the way in);
                         `sparse_hypotheses`: the true and the reflected answer of symmetric shapes
Section 4, relaxed step  `relaxation`, solved by a quasi-Newton method, projected to integers
Section 4, hierarchy     `hierarchy`: levels of samples and neighbourhoods, until convergence
All of section 4         `sparse_match`: from the settings (`settings`) to a matching (`sparse_result`)
Figure 4, comparisons    `compared`: flat quadratic matching, GMDS, descent of the stress
=======================  =================================================================================

Nothing here knows of registration or of dense maps.  With a dense map, which is the default, the answers of this room
are some of the starts that `engine.dense` compares, and their points are moved to where the dense map takes them.
"""
