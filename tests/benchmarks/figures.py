# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 2 and 3 of the paper: the four setups at several levels, and a point that moves to its place.

    python -m tests.benchmarks.figures 2 [--data FOLDER --source cat0 --target cat1] [--output build/figures]
    python -m tests.benchmarks.figures 3 [...]

Without a data folder the demo pair is matched.  FOLDER is as for `tests.benchmarks.real_pairs`.  Figure 2 prints a
table of errors (geodesic, x sqrt(area); for setup d of the mirrored matching, too, against the mirrored truth) and
renders a contact sheet: a row for each setup and answer, a column for each level, lines between corresponding points.
Figure 3 prints how far each coarse point is from its true place after the exact coarse match and at each level, and
renders the one that comes closest to it on the way.
"""

import argparse
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from scipy.spatial import cKDTree

from tools.source_extension import registered_extension

registered_extension()

from hiermatch.engine import Level, MatchSettings, Shape, SurfacePoints, TriangleMesh, match  # noqa: E402
from hiermatch.engine.geometry.geodesics import GeodesicSolver  # noqa: E402
from hiermatch.engine.hierarchical.settings import SETUPS  # noqa: E402
from hiermatch.hiermatch_addon.scene import mesh_io  # noqa: E402

from tests.benchmarks.real_pairs import add_object, known  # noqa: E402
from tools import demo_truth  # noqa: E402
from tools.demo_picture import add_beads, add_lines, paint_plain, render, set_stage, sheet  # noqa: E402

LEVELS = (10, 20, 40, 64)
WIDTH, HEIGHT, SAMPLES = 640, 400, 6
GREY = (0.75, 0.75, 0.75, 1.0)


@dataclass
class Scene:
    """Two objects, their shapes, and for each source vertex its true and its mirrored image on the target."""

    source: bpy.types.Object
    target: bpy.types.Object
    shapes: tuple[Shape, Shape]
    true: np.ndarray
    mirrored: np.ndarray

    def errors(self, result, level, *, mirrored=False):
        """Geodesic distance on the target of each matched point from where it belongs."""
        target = self.shapes[1]
        images = (self.mirrored if mirrored else self.true)[result.source_points.nearest_vertices[: level.points]]
        found = level.target_points.nearest_vertices
        distances = GeodesicSolver(target.mesh).distances(found)
        return distances[np.arange(len(found)), images] / target.scale


def demo_scene():
    bpy.ops.hiermatch.add_demo_pair()
    state = bpy.context.scene.hiermatch
    depsgraph = bpy.context.evaluated_depsgraph_get()
    things = (state.source, state.target)
    shapes = tuple(Shape(mesh_io.read_mesh(thing, depsgraph, use_modifiers=False)) for thing in things)
    rest_x, rest_y = (demo_truth.rest_vertices(thing) for thing in things)
    tree = cKDTree(rest_y)
    return Scene(*things, shapes, tree.query(rest_x)[1], tree.query(rest_x * [-1, 1, 1])[1])


def real_scene(folder, name_x, name_y):
    paths = {path.stem: path for path in sorted(folder.rglob("*.off"))}
    things, shapes = [], []
    for name in (name_x, name_y):
        thing, vertices, triangles = add_object(paths[name])
        things.append(thing)
        shapes.append(Shape(TriangleMesh(vertices, triangles)))
    size = shapes[0].scale
    things[1].location.x = 1.2 * size + np.ptp(shapes[0].mesh.vertices[:, 0])
    bpy.context.view_layer.update()
    listed = known(paths[name_x])
    nearest = cKDTree(shapes[0].mesh.vertices[listed]).query(shapes[0].mesh.vertices)[1]
    return Scene(*things, tuple(shapes), known(paths[name_y])[nearest], known(paths[name_y], ".sym")[nearest])


def picture(scene, result, level, path, *, highlight=None):
    """Render both objects in grey, the matched points in colours, and a line between the points of each pair."""
    added = []
    places = []
    for thing, points in ((scene.source, result.source_points), (scene.target, level.target_points)):
        matrix = np.array(thing.matrix_world)
        local = np.empty(3 * len(thing.data.vertices), np.float32)
        thing.data.vertices.foreach_get("co", local)
        world = local.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
        places.append(points.interpolate(world.astype(float))[: level.points])
        radius = 0.012 * np.linalg.norm(np.ptp(world, axis=0))
        hues = np.linspace(0, 1, level.points, endpoint=False)
        colors = np.array([[*_rgb(hue), 1.0] for hue in hues])
        if highlight is not None:
            colors[:] = (0.25, 0.25, 0.25, 1)
            colors[highlight] = (0.9, 0.05, 0.05, 1)
        added.append(add_beads("Points", places[-1], colors, radius))
    chosen = slice(None) if highlight is None else [highlight]
    added.append(add_lines("Pairs", places[0][chosen], places[1][chosen], colors[chosen], radius / 5))
    render(path, SAMPLES)
    for thing in added:
        bpy.data.objects.remove(thing)


def _rgb(hue):
    """Saturated colour of a hue from 0 to 1, linear."""
    return np.clip(np.abs((hue * 6 + np.array([0, 4, 2])) % 6 - 3) - 1, 0.02, 0.9)


def figure_2(scene, output):
    rows = []
    for key, (name, choices) in SETUPS.items():
        result = match(*scene.shapes, MatchSettings(points=LEVELS[-1], dense=False, **choices))
        answers = [(f"({key}) {name}", result, False)]
        if key == "d" and result.mirrored is not None:
            answers.append((f"({key}) {name}, mirrored", result.mirrored, True))
        for title, answer, mirrored in answers:
            errors = [scene.errors(answer, level, mirrored=mirrored) for level in answer.levels]
            cells = "  ".join(f"{e.mean():.3f}/{e.max():.3f}" for e in errors)
            print(f"{title:48s} orientation {answer.orientation:+.2f}   {cells}", flush=True)
            images = []
            for level in answer.levels:
                images.append(output / f"figure2_{key}{'_mirrored' if mirrored else ''}_{level.points}.png")
                picture(scene, answer, level, images[-1])
            rows.append(images)
    sheet(rows, output / "figure2.png")


def figure_3(scene, output):
    result = match(*scene.shapes, MatchSettings(points=LEVELS[-1], dense=False))
    coarse = result.coarse
    exact = Level(
        points=len(coarse.target_vertices),
        iterations=0,
        distortion=coarse.cost,
        target_points=SurfacePoints.at_vertices(scene.shapes[1].mesh, coarse.target_vertices),
    )
    stages = [exact, *result.levels]
    errors = np.stack([scene.errors(result, level)[: exact.points] for level in stages])
    print("exact match, then levels of " + ", ".join(str(level.points) for level in result.levels))
    for number, column in enumerate(errors.T):
        print(f"coarse point {number}: " + "  ".join(f"{e:.3f}" for e in column))
    mover = int((errors[0] - errors[-1]).argmax())
    print(
        f"point {mover} moves from {errors[0, mover]:.3f} to {errors[-1, mover]:.3f} x sqrt(area) from its true place"
    )
    images = [output / f"figure3_{number}.png" for number in range(len(stages))]
    for level, image in zip(stages, images, strict=True):
        picture(scene, result, level, image, highlight=mover)
    sheet([images], output / "figure3.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("figure", choices=["2", "3"])
    parser.add_argument("--data", type=Path, help="folder with shapes; the demo pair if left out")
    parser.add_argument("--source", default="cat0")
    parser.add_argument("--target", default="cat1")
    parser.add_argument("--output", type=Path, default=Path("build/figures"))
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    output = options.output.resolve()
    bpy.ops.wm.read_homefile(use_empty=True)
    scene = real_scene(options.data, options.source, options.target) if options.data else demo_scene()
    for thing in (scene.source, scene.target):
        paint_plain(thing, GREY)
    set_stage([scene.source, scene.target], (30.0, 12.0), WIDTH, HEIGHT)
    (figure_2 if options.figure == "2" else figure_3)(scene, output)
    print(output / f"figure{options.figure}.png")


if __name__ == "__main__":
    main()
