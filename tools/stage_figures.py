# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of what each stage of a match makes of the demo pair, for the pages of docs/method.

    python tools/stage_figures.py [--output docs/images] [--samples N] [geometry shapes hierarchical dense registration]

Writes method-STAGE.jpg for each stage that is named, or for all of them.  Needs the bpy module.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import bpy
import numpy as np
from demo_picture import add_beads, add_lines, paint, paint_plain, render, set_stage, sheet
from source_extension import ROOT, registered_extension

registered_extension()

from hiermatch.engine import GeodesicSolver, MatchSettings, Shape, TriangleMesh, match, run  # noqa: E402
from hiermatch.engine.dense.dense_hypotheses import map_hypotheses_steps  # noqa: E402
from hiermatch.engine.dense.dense_registration import EIGENPAIRS, registered_pair_steps  # noqa: E402
from hiermatch.engine.dense.registered_hypotheses import Follower  # noqa: E402
from hiermatch.engine.shapes.prepared_surface import prepared_steps  # noqa: E402
from hiermatch.engine.shapes.shape_preparation import Wanted, prepared_shapes_steps  # noqa: E402
from hiermatch.hiermatch_addon.scene import mesh_io  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Panel = Callable[[], list[bpy.types.Object]]

_VIEW = (35.0, 14.0)
_WIDTH, _HEIGHT = 420, 300
_CLAY = (0.72, 0.72, 0.74, 1.0)
_INK = (0.06, 0.07, 0.09, 1.0)
_LINES = 14  # level lines of a distance, and of a function between its extremes
_SAMPLES = 512  # of each surface, as a dense match takes


class Pair(NamedTuple):
    """The meshes of the demo pair, in world space."""

    source: Shape
    target: Shape


def demo_pair() -> Pair:
    """Build the demo pair, read it, and clear the scene."""
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.hiermatch.add_demo_pair()
    state, depsgraph = bpy.context.scene.hiermatch, bpy.context.evaluated_depsgraph_get()
    things = state.source, state.target
    return Pair(*(Shape(mesh_io.read_mesh(thing, depsgraph, use_modifiers=False)) for thing in things))


def placed(
    name: str, vertices: NDArray[np.float64], triangles: NDArray[np.int64], colors: NDArray[np.float64] | None = None
) -> bpy.types.Object:
    """Add a mesh, in one colour or in linear colours (n, 3) of its vertices."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices.tolist(), [], triangles.tolist())
    mesh.shade_smooth()
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    if colors is None:
        paint_plain(thing, _CLAY)
    else:
        attribute = mesh.attributes.new("Color", "FLOAT_COLOR", "POINT")
        rgba = np.concatenate([colors, np.ones((len(colors), 1))], axis=1)
        attribute.data.foreach_set("color", rgba.astype(np.float32).ravel())
        paint(thing, "Color")
    return thing


def with_edges(thing: bpy.types.Object, thickness: float) -> list[bpy.types.Object]:
    """Add dark bars along the edges of an object."""
    wire = thing.copy()
    wire.data = thing.data.copy()
    bpy.context.scene.collection.objects.link(wire)
    paint_plain(wire, _INK)
    modifier = wire.modifiers.new("Edges", "WIREFRAME")
    modifier.thickness = thickness
    return [thing, wire]


def place_colors(vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    """Colours of places: red to the front, green to the side, blue upwards."""
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return 0.08 + 0.8 * ((vertices - low) / (high - low))[:, [1, 0, 2]]


def level_colors(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Colours of a function: blue below, red above, white between, with dark level lines."""
    level = values / np.abs(values).max()
    warm, cold = np.clip(level, 0, 1)[:, None], np.clip(-level, 0, 1)[:, None]
    colors = 0.85 - warm * [0.05, 0.75, 0.75] - cold * [0.75, 0.55, 0.05]
    line = np.abs((level * _LINES / 2) % 1 - 0.5) > 0.42
    return np.where(line[:, None], 0.35 * colors, colors)


def split(mesh: TriangleMesh, functions: list[NDArray[np.float64]]) -> tuple[TriangleMesh, list[NDArray[np.float64]]]:
    """Divide each triangle into four, with the values of functions at the new vertices."""
    edges, corners = mesh.edges, mesh.triangles
    number = {frozenset(edge): mesh.vertex_count + i for i, edge in enumerate(edges.tolist())}
    middles = np.array([[number[frozenset((t[i], t[(i + 1) % 3]))] for i in range(3)] for t in corners.tolist()])
    outer = [np.stack([corners[:, i], middles[:, i], middles[:, i - 1]], axis=1) for i in range(3)]
    values = [np.concatenate([f, f[edges].mean(axis=1)]) for f in (*mesh.vertices.T, *functions)]
    return TriangleMesh(np.stack(values[:3], axis=1), np.concatenate([*outer, middles])), values[3:]


def picture_of(panels: list[Panel], path: Path, samples: int) -> None:
    """Render panels side by side."""
    with tempfile.TemporaryDirectory() as folder:
        images = []
        for number, panel in enumerate(panels):
            bpy.ops.wm.read_homefile(use_empty=True)
            things = panel()
            set_stage(things, _VIEW, _WIDTH, _HEIGHT)
            images.append(Path(folder) / f"{number}.png")
            render(images[-1], samples)
        whole = Path(folder) / "whole.png"
        sheet([images], whole)
        image = bpy.data.images.load(str(whole))
        settings = bpy.context.scene.render.image_settings
        settings.file_format, settings.quality = "JPEG", 88
        image.save_render(str(path), scene=bpy.context.scene)
    print(path)


def geometry(pair: Pair) -> list[Panel]:
    """Show distances from the nose, and three eigenfunctions."""
    mesh = pair.target.mesh
    nose = int((mesh.vertices @ [0, -1, 0]).argmax())
    distances = GeodesicSolver(mesh).distances(np.array([nose]))[0]
    run(pair.target.spectrum_steps(8))
    spectrum = pair.target.spectrum
    functions = [distances, *(spectrum.functions[:, number] for number in (1, 3, 6))]
    fine = TriangleMesh(mesh.vertices, mesh.triangles)
    for _ in range(2):  # level lines are finer than triangles
        fine, functions = split(fine, functions)
    return [lambda f=f: [placed("Cat", fine.vertices, fine.triangles, level_colors(f))] for f in functions]


def shapes(pair: Pair) -> list[Panel]:
    """Show a mesh, its proxy of 1,200 vertices, and the first ten and all samples."""
    mesh = pair.target.mesh
    proxy = run(prepared_steps(mesh, proxy_vertices=1200)).mesh
    shape = Shape(mesh)
    run(prepared_shapes_steps(shape, shape, Wanted(_SAMPLES // 2)))
    size = shape.scale

    def sampled(count: int) -> list[bpy.types.Object]:
        colors = np.tile([0.75, 0.05, 0.03, 1.0], (count, 1))
        beads = add_beads("Samples", mesh.vertices[shape.samples.vertices[:count]], colors, 0.014 * size)
        return [placed("Cat", mesh.vertices, mesh.triangles), beads]

    return [
        lambda: with_edges(placed("Mesh", mesh.vertices, mesh.triangles), 0.0015 * size),
        lambda: with_edges(placed("Proxy", proxy.vertices, proxy.triangles), 0.003 * size),
        lambda: sampled(10),
        lambda: sampled(_SAMPLES // 2),
    ]


def hierarchical(pair: Pair) -> list[Panel]:
    """Show the exact match of ten points, and the levels after it."""
    result = match(*pair, MatchSettings(points=64, dense=False))
    source, target = pair.source.mesh, pair.target.mesh
    shift = np.array([1.3 * np.ptp(source.vertices[:, 0]), 0, 0])
    shift[0] += source.vertices[:, 0].max() - target.vertices[:, 0].min()

    def level(points: int, places: NDArray[np.float64]) -> list[bpy.types.Object]:
        hues = np.linspace(0, 1, points, endpoint=False)[:, None]
        rgb = np.clip(np.abs((hues * 6 + np.array([0, 4, 2])) % 6 - 3) - 1, 0.02, 0.9)
        colors = np.concatenate([rgb, np.ones((points, 1))], axis=1)
        starts, ends = result.source_points.positions[:points], places + shift
        size = pair.source.scale
        return [
            placed("Source", source.vertices, source.triangles),
            placed("Target", target.vertices + shift, target.triangles),
            add_beads("Points", np.concatenate([starts, ends]), np.concatenate([colors] * 2), 0.025 * size),
            add_lines("Pairs", starts, ends, colors, 0.004 * size),
        ]

    exact = target.vertices[result.coarse.target_vertices]
    stages = [(len(exact), exact), *((one.points, one.target_points.positions) for one in result.levels)]
    return [lambda stage=stage: level(*stage) for stage in stages[:4]]


def dense(pair: Pair) -> list[Panel]:
    """Show the source in colours, and where the most credible maps of three kinds take them."""
    source, target = pair.source.mesh, pair.target.mesh
    _prepare(pair)
    hypotheses = run(map_hypotheses_steps(*pair, mirrored=True))
    colors = place_colors(source.vertices)
    panels: list[Panel] = [lambda: [placed("Source", source.vertices, source.triangles, colors)]]
    for hypothesis in sorted(hypotheses, key=lambda h: h.score)[:3]:
        print(f"{hypothesis.origin}: score {hypothesis.score:.2f}, orientation {hypothesis.orientation:+.2f}")
        carried = colors[hypothesis.images.on_x]
        panels.append(lambda carried=carried: [placed("Target", target.vertices, target.triangles, carried)])
    return panels


def registration(pair: Pair) -> list[Panel]:
    """Show the source as it is, where eigenfunctions place it, softly and closely registered; and the target."""
    source, target = pair.source.mesh, pair.target.mesh
    _prepare(pair)
    registered = run(registered_pair_steps(*pair))
    chosen = registered.candidates[0]
    surfaces = registered.source, registered.target
    start = Follower(registered.x, registered.y, *surfaces).start(chosen.hypothesis.images)
    colors = place_colors(source.vertices)
    scale = pair.target.scale
    stages = [start, chosen.registration.positions, registered.registration.positions]
    lifted = [scale * positions for positions in stages]
    panels: list[Panel] = [
        lambda vertices=vertices: [placed("Source", vertices, source.triangles, colors)]
        for vertices in (source.vertices, *lifted)
    ]
    return [*panels, lambda: [placed("Target", target.vertices, target.triangles)]]


def _prepare(pair: Pair) -> None:
    """Take samples and eigenpairs of both shapes."""
    run(prepared_shapes_steps(*pair, Wanted(_SAMPLES, 64, EIGENPAIRS)))


STAGES = {stage.__name__: stage for stage in (geometry, shapes, hierarchical, dense, registration)}


def main() -> None:
    """Render what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("stages", nargs="*", metavar="STAGE", help=f"{', '.join(STAGES)} (default: all)")
    parser.add_argument("--output", type=Path, default=ROOT / "docs" / "images")
    parser.add_argument("--samples", type=int, default=16, help="samples of each pixel (default %(default)s)")
    options = parser.parse_args()
    if unknown := set(options.stages) - set(STAGES):
        parser.error(f"there is no stage {', '.join(sorted(unknown))}")
    options.output.mkdir(parents=True, exist_ok=True)
    pair = demo_pair()
    for stage in options.stages or STAGES:
        picture_of(STAGES[stage](pair), options.output.resolve() / f"method-{stage}.jpg", options.samples)


if __name__ == "__main__":
    main()
