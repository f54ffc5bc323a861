# SPDX-License-Identifier: GPL-3.0-or-later
"""Retarget one character to another in a real Blender window, from a built zip and two glTF files, with pictures.

    make package-no-wheels
    BLENDER_USER_RESOURCES=EMPTY_FOLDER blender --factory-startup --enable-event-simulate \
        --window-geometry 0 0 1600 1000 --python tools/character_story.py -- \
        [--motion | --my-rig | --wear ITEM,ITEM,...] FOLDER build/package-no-wheels/hiermatch-VERSION.zip \
        SOURCE.glb TARGET.glb [COMMAND ...]

Any Blender from 4.3 on with NumPy and SciPy will do; the zip is installed as by hand.  Either character may have any
number of meshes, both need a rig; a source without an action gets one that swings its arms and legs.  Everything is
done as a person does it: import both, pick their armatures, press Retarget, answer if asked, press Test Poses, give the
new armature the source's action and play it.  After each step it is checked what became of it; the first that failed
ends Blender with an error.  Saves into FOLDER

    1-imported.jpg      both characters, as they are imported
    2-picked.jpg        their armatures are picked
    3-matching.jpg      while they are matched
    4-retargeted.jpg    what the panel says to it
    5-test-poses.jpg    some of the joints bent
    6-action.jpg        both playing the source's action, at four times

With --motion the target keeps its own rig: their bones are paired, and the action is carried over, to be played.  Then
there are, after the second picture,

    3-pairing.jpg       while the bodies are matched
    4-paired.jpg        the table of bones
    5-carried.jpg       what the panel says to the action
    6-action.jpg        both playing it, at four times

With --my-rig a metarig of Rigify is put into the source, a person, by its joints, and fitted into the target;
its control rig is generated, the target bound to it by automatic weights, and the action carried over to the controls.
At last the bones of the source are renamed, and it must still move alike.  The target should be one mesh, as Blender's
automatic weights fail on what lies loose inside others.  After the first picture there are

    2-standing.jpg      the metarig stands in the source
    3-fitted.jpg        and a copy in the target
    4-generated.jpg     the target with its control rig
    5-pairing.jpg to 8-action.jpg  as with --motion

With --wear the target gets these items of the source, fitted to it, and swings its arms and legs in them.  An ITEM is
an object of the source's file, such as Cape, or of an object what has some materials, such as Head:Straw+Ribbon, which
is then separated from it.  What hangs on the source's bones without being weighted, as weapons do, is put away if it is
no item.  After the second picture there are

    3-fitting.jpg       while the bodies are matched
    4-dressed.jpg       what the panel says to the items
    5-sides.jpg         the target in them, from four sides
    6-posed.jpg         and at four times, from before and from behind

Blender cannot read its own pixels on some screens, virtual ones above all: see `screenshots.py` for COMMAND.
"""

from __future__ import annotations

import sys
from functools import partial
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import bpy
from mathutils import Matrix

sys.path.insert(0, str(Path(__file__).resolve().parent))

from camera import Camera, seen
from characters import (
    action_of,
    armatures_of,
    assign,
    bind,
    extent_of,
    hangs_on,
    separated,
    shape_of,
    show_bones,
    stop,
    swing,
)
from metarig import add_metarig, generate
from screen import choose_tab, fold, large_view, look_at_selected, view
from window_events import check, play, press, running, until

if TYPE_CHECKING:
    from collections.abc import Iterator

_APART = 0.6
"""Room between the two characters, in units of the wider one."""

_FAR_ENOUGH = 0.3
"""How far the work is when its progress is shown."""

_BENDS, _TIMES = 3, 4
"""How many test poses, and moments of the action, are put on one sheet."""


_AROUND = ("FRONT", "RIGHT", "BACK", "LEFT")
"""Sides from which the target is seen in its items."""


def state() -> Any:  # noqa: ANN401 - a property group
    """Return the panel's state."""
    return cast("Any", bpy.context.scene).hiermatch


def report() -> Any:  # noqa: ANN401 - a property group
    """Return what is said of the last retarget."""
    return cast("Any", bpy.context.scene).hiermatch_retarget.report


def tell(story: Story, camera: Camera) -> Iterator[float | None]:
    """Go through all steps; wherever it yields, the window is drawn."""
    yield from story.bring(camera)
    yield from story.retarget(camera)
    yield from story.bend(camera)
    yield from story.play(camera)


def tell_motion(story: Story, camera: Camera) -> Iterator[float | None]:
    """Go through the steps for a target that keeps its rig."""
    _open("HIERMATCH_PT_motion")
    yield from story.bring(camera)
    yield from story.carry(camera)
    yield from story.play(camera, carried=True)


def tell_wear(story: Story, camera: Camera, items: list[str]) -> Iterator[float | None]:
    """Go through the steps for what the source wears."""
    _open("HIERMATCH_PT_wear")
    yield from story.bring(camera, items)
    yield from story.dress(camera)
    yield from story.look_around(camera)
    yield from story.pose(camera)


def tell_my_rig(story: Story, camera: Camera) -> Iterator[float | None]:
    """Go through the steps for a rig of one's own."""
    cast("Any", bpy.ops.preferences).addon_enable(module="rigify")
    registration = _registration()
    fold("hiermatch_my_rig", package=registration.__package__.rpartition(".")[0])
    _open("HIERMATCH_PT_match", "HIERMATCH_PT_retarget", alone=True)
    yield from story.bring(camera)
    yield from story.fit_my_rig(camera)
    _open("HIERMATCH_PT_motion", alone=True)  # all of it would not fit below the others
    yield None
    choose_tab()
    yield from story.carry(camera, number=5)
    yield from story.play(camera, carried=True, sheet=8)
    yield from story.rename()


class Story:
    """Two characters, and what is done with them.

    Parameters
    ----------
    source, target : Path
        Files to import.
    """

    def __init__(self, source: Path, target: Path) -> None:
        self._paths = source, target
        self._rigs: list[bpy.types.Object] = []
        self._meshes: list[list[bpy.types.Object]] = []
        self._items: list[bpy.types.Object] = []
        self._made: bpy.types.Object | None = None

    def bring(self, camera: Camera, items: list[str] | None = None) -> Iterator[float | None]:
        """Import both, one beside the other, and pick their armatures; with items both rest."""
        for thing in list(bpy.data.objects):
            bpy.data.objects.remove(thing)
        large_view()
        yield None
        choose_tab()
        for path in self._paths:
            self._import(path)
        if items is not None:
            self._take_apart(items)
        elif action_of(self._rigs[0]) is None:
            swing(self._rigs[0])
        self._stand_apart()
        self._look()
        yield None
        camera.take_with_panel("1-imported", self._all())
        state().source, state().target = self._rigs
        yield None
        camera.take_with_panel("2-picked", self._all())

    def retarget(self, camera: Camera) -> Iterator[float | None]:
        """Press the button, and answer if asked."""
        before = {obj: shape_of(obj) for obj in self._meshes[0]}
        press(cast("Any", bpy.ops).hiermatch.retarget)
        progress = cast("Any", bpy.context.window_manager).hiermatch
        yield from until(lambda: progress.fraction > _FAR_ENOUGH or not running(), "The first third")
        camera.take_with_panel("3-matching", self._all())
        yield from self._finished("Retargeting")
        camera.take_with_panel("4-retargeted", self._all())
        print(report().done, report().verdict, report().notes, report().remarks, sep="\n", flush=True)
        check(report().done, "Nothing was carried")
        check(all(shape_of(obj) == shape for obj, shape in before.items()), "The source was changed")
        rigs = {rig for obj in self._meshes[1] for rig in armatures_of(obj)}
        check(len(rigs) == 1, f"The target is moved by {len(rigs)} armatures instead of one")
        (self._made,) = rigs
        check(self._made not in self._rigs, "The target is still moved by its own armature")

    def fit_my_rig(self, camera: Camera) -> Iterator[float | None]:
        """Put a metarig into the source, fit it into the target, and bind the target to its control rig."""
        metarig, options = add_metarig(self._rigs[0]), cast("Any", bpy.context.scene).hiermatch_retarget
        options.rig = metarig.name
        show_bones(metarig)
        yield None
        camera.take_with_panel("2-standing", self._all())
        press(cast("Any", bpy.ops).hiermatch.fit_my_rig, rig=options.rig)
        yield from self._finished("Fitting")
        print(report().done, report().verdict, report().notes, report().remarks, sep="\n", flush=True)
        fitted = [obj for obj in bpy.data.objects if obj.type == "ARMATURE" and obj not in (*self._rigs, metarig)]
        check(len(fitted) == 1, f"{len(fitted)} armatures were fitted instead of one")
        show_bones(fitted[0])
        yield None
        camera.take_with_panel("3-fitted", self._all())
        made = generate(fitted[0])
        metarig.hide_set(state=True)
        print(f"generated: {len(made.data.bones)} bones", flush=True)
        bind(self._meshes[1], made)
        self._rigs[1].hide_set(state=True)
        self._rigs[1] = made
        state().target = made
        yield None
        camera.take_with_panel("4-generated", self._all())

    def rename(self) -> Iterator[float | None]:
        """Give the source's bones other names, and see that it still moves alike."""
        before = shape_of(self._meshes[0][0], shown=True)
        with bpy.context.temp_override(**view()):  # its button would ask first
            cast("Any", bpy.ops).hiermatch.rename_bones(target=self._rigs[0].name, names="UNREAL")
        yield None
        names = set(cast("Any", self._rigs[0].data).bones.keys())
        check({"upperarm_l", "calf_r", "head"} <= names, f"The bones are called {sorted(names)}")
        scene = cast("Any", bpy.context.scene)
        scene.frame_set(scene.frame_current)
        check(shape_of(self._meshes[0][0], shown=True) == before, "The source moves otherwise with other names")

    def carry(self, camera: Camera, number: int = 3) -> Iterator[float | None]:
        """Pair the bones, and carry the action over to the target's rig; the first picture has some number."""
        action = action_of(self._rigs[0])
        check(action is not None, "The source has no action")
        assign(self._rigs[0], action)
        stop(self._rigs[1])
        yield None
        press(cast("Any", bpy.ops).hiermatch.pair_bones)
        progress = cast("Any", bpy.context.window_manager).hiermatch
        yield from until(lambda: progress.fraction > _FAR_ENOUGH or not running(), "The first third")
        camera.take_with_panel(f"{number}-pairing", self._all())
        yield from self._finished("Pairing")
        camera.take_with_panel(f"{number + 1}-paired", self._all())
        print(report().done, report().verdict, report().notes, report().remarks, sep="\n", flush=True)
        check(len(cast("Any", bpy.context.scene).hiermatch_bone_pairs), "No bones were paired")
        press(cast("Any", bpy.ops).hiermatch.retarget_action)
        yield from self._finished("The motion")
        camera.take_with_panel(f"{number + 2}-carried", self._all())
        print(report().done, report().verdict, report().notes, report().remarks, sep="\n", flush=True)
        self._made = self._rigs[1]
        rigs = {rig for obj in self._meshes[1] for rig in armatures_of(obj)}
        check(rigs == {self._made}, "The target is not moved by its own rig")
        check(cast("Any", self._made.animation_data).action is not None, "The target's rig has no action")

    def _take_apart(self, items: list[str]) -> None:
        """Separate the items, remove what is neither weighted nor an item, and let both rest."""
        for item in items:
            name, _, materials = item.partition(":")
            found = [obj for obj in self._meshes[0] if obj.name == name]
            check(found, f"The source has no {name}, but {[obj.name for obj in self._meshes[0]]}")
            self._items.append(separated(found[0], materials.split("+")) if materials else found[0])
        meshes = {*self._meshes[0], *self._items}
        kept = [obj for obj in meshes if obj in self._items or armatures_of(obj)]
        for obj in meshes - set(kept):
            bpy.data.objects.remove(obj)
        self._meshes[0] = kept
        for rig in self._rigs:
            stop(rig)
            for bone in cast("Any", rig.pose).bones:
                bone.matrix_basis = Matrix()

    def dress(self, camera: Camera) -> Iterator[float | None]:
        """Select what the source wears, and fit it to the target."""
        before = {obj: shape_of(obj) for obj in self._all()}
        for item in self._items:
            item.select_set(state=True)
        bpy.context.view_layer.objects.active = self._items[0]
        yield None
        press(cast("Any", bpy.ops).hiermatch.wear)
        progress = cast("Any", bpy.context.window_manager).hiermatch
        yield from until(lambda: progress.fraction > _FAR_ENOUGH or not running(), "The first third")
        camera.take_with_panel("3-fitting", self._all())
        yield from self._finished("Fitting")
        print(report().done, report().verdict, report().notes, report().remarks, sep="\n", flush=True)
        names = {item.name for item in self._items}
        made = [obj for obj in bpy.data.objects if obj.get("hiermatch_item") in names]
        check(len(made) == len(names), f"{len(made)} of {len(names)} items were fitted")
        check(all(shape_of(obj) == shape for obj, shape in before.items()), "The bodies or the originals were changed")
        check(all(self._rigs[1] in armatures_of(obj) for obj in made), "The target's rig does not move all items")
        self._meshes[1] += made
        for obj in bpy.data.objects:
            obj.select_set(state=False)
        camera.take_with_panel("4-dressed", self._all())

    def look_around(self, camera: Camera) -> Iterator[float | None]:
        """Look at the target from four sides, close by."""
        for obj in self._meshes[0]:
            obj.hide_set(state=True)
        looks = []
        for side in _AROUND:
            with bpy.context.temp_override(**view()):
                bpy.ops.view3d.view_axis(type=side)
                for obj in self._meshes[1]:
                    obj.select_set(state=True)
            look_at_selected()
            for obj in self._meshes[1]:
                obj.select_set(state=False)
            yield None
            looks.append(camera.look(seen(self._meshes[1])))
        camera.save("5-sides", [looks])

    def pose(self, camera: Camera) -> Iterator[float | None]:
        """Let the target swing its arms and legs in what it wears, and look at it from two sides."""
        scene, rig, shown = cast("Any", bpy.context.scene), self._rigs[1], self._meshes[1]
        swing(rig)
        rows, shapes = [], set()
        for side in _AROUND[::2]:
            with bpy.context.temp_override(**view()):
                bpy.ops.view3d.view_axis(type=side)
                bpy.ops.view3d.view_orbit(angle=0.35, type="ORBITLEFT")
            looks = []
            for number in range(_TIMES):
                scene.frame_set(1 + 6 * number)
                yield None
                looks.append(camera.look(seen(shown)))
                shapes.add(tuple(shape_of(obj, shown=True) for obj in shown))
            rows.append(looks)
        check(len(shapes) > 1, "The target does not move")
        camera.save("6-posed", rows)

    def _finished(self, what: str) -> Iterator[float | None]:
        """Answer if asked, and wait for the end."""
        progress = cast("Any", bpy.context.window_manager).hiermatch
        yield from until(lambda: bool(progress.question) or not running(), what)
        if progress.question:
            print(f"asked: {progress.question}", flush=True)
            press(cast("Any", bpy.ops).hiermatch.answer, answer="WRITE")
        yield from until(lambda: not running(), what)
        yield None

    def bend(self, camera: Camera) -> Iterator[float | None]:
        """Press Test Poses, look at some of them, and press it again."""
        scene, made = cast("Any", bpy.context.scene), cast("Any", self._made)
        frames = scene.frame_start, scene.frame_end
        press(cast("Any", bpy.ops).hiermatch.test_poses)
        yield None
        markers = sorted(scene.timeline_markers, key=lambda marker: marker.frame)
        check(markers, "There are no test poses")
        looks = []
        for marker in _spread(_limbs(markers), _BENDS):
            scene.frame_set(marker.frame)
            yield None
            print("bent:", marker.name, flush=True)
            looks.append(camera.look(seen(self._meshes[1])))
        camera.save("5-test-poses", [looks])
        press(cast("Any", bpy.ops).hiermatch.test_poses)
        yield None
        check(not scene.timeline_markers, "Test poses were left behind")
        check((scene.frame_start, scene.frame_end) == frames, "The frame range was not brought back")
        check(made.animation_data.action is None, "An action was left behind")

    def play(self, camera: Camera, *, carried: bool = False, sheet: int = 6) -> Iterator[float | None]:
        """Give both rigs one action of the source, if it was not carried over, and look at some moments of it."""
        scene = cast("Any", bpy.context.scene)
        action = action_of(self._rigs[0])
        check(action is not None, "The source has no action")
        for rig in (self._rigs[0],) if carried else (self._rigs[0], cast("Any", self._made)):
            assign(rig, action)
        first, last = (int(frame) for frame in action.frame_range)
        print(f"playing: {action.name}, frames {first} to {last}", flush=True)
        looks, shapes = [], set()
        for number in range(_TIMES):
            scene.frame_set(first + round(number * (last - first) / _TIMES))
            yield None
            looks.append(camera.look(seen(self._all())))
            shapes.add(shape_of(self._meshes[1][0], shown=True))
        check(len(shapes) > 1, "The target does not move")
        half = (len(looks) + 1) // 2
        camera.save(f"{sheet}-action", [looks[:half], looks[half:]])

    def _all(self) -> list[bpy.types.Object]:
        return [obj for meshes in self._meshes for obj in meshes]

    def _import(self, path: Path) -> None:
        """Import a file as by the menu."""
        before = set(bpy.data.objects)
        with bpy.context.temp_override(**view()):
            bpy.ops.import_scene.gltf(filepath=str(path))
        new = [obj for obj in bpy.data.objects if obj not in before]
        rigs = [obj for obj in new if obj.type == "ARMATURE"]
        check(rigs, f"{path.name} has no armature")
        self._rigs.append(rigs[0])
        self._meshes.append([obj for obj in new if obj.type == "MESH" and hangs_on(obj, rigs[0]) and obj.data.polygons])
        print(f"{path.name}: {len(self._meshes[-1])} meshes, {len(rigs[0].data.bones)} bones", flush=True)

    def _stand_apart(self) -> None:
        """Move the target beside the source, as a person would to see both."""
        bpy.context.view_layer.update()
        (low, high), (its_low, its_high) = (extent_of(meshes) for meshes in self._meshes)
        room = _APART * max(high - low, its_high - its_low)
        root = self._rigs[1]
        while root.parent is not None:
            root = root.parent
        root.matrix_world = Matrix.Translation((high - its_low + room, 0.0, 0.0)) @ root.matrix_world
        bpy.context.view_layer.update()

    def _look(self) -> None:
        """Turn the view to both, from before, with their materials and without a grid."""
        with bpy.context.temp_override(**view()):
            bpy.ops.object.select_all(action="DESELECT")
            for obj in self._all():
                obj.select_set(state=True)
            bpy.ops.view3d.view_axis(type="FRONT")
            bpy.ops.view3d.view_orbit(angle=0.35, type="ORBITLEFT")
        look_at_selected()
        for obj in self._all():
            obj.select_set(state=False)
        space = view()["space_data"]
        space.shading.color_type = "MATERIAL"
        overlay = space.overlay
        overlay.show_floor = overlay.show_axis_x = overlay.show_axis_y = overlay.show_cursor = False
        overlay.show_extras = overlay.show_relationship_lines = overlay.show_object_origins = False
        overlay.show_bones = False


def _open(*names: str, alone: bool = False) -> None:
    """Let some panels be unfolded when they are drawn for the first time, and all others folded, or gone."""
    panels: list[Any] = [cls for cls in _registration().CLASSES if issubclass(cls, bpy.types.Panel)]
    for panel in reversed(panels):
        bpy.utils.unregister_class(panel)
    for panel in panels:
        shown = panel.__name__ in names
        panel.bl_options = set() if shown else {"DEFAULT_CLOSED"}
        if alone and not getattr(panel, "bl_parent_id", ""):
            panel.poll = _always if shown else _never
        bpy.utils.register_class(panel)


@classmethod
def _always(_cls: type, _context: bpy.types.Context) -> bool:
    return True


@classmethod
def _never(_cls: type, _context: bpy.types.Context) -> bool:
    return False


def _registration() -> Any:  # noqa: ANN401 - a module
    """Return the module of the installed extension that registers it."""
    return next(module for name, module in sys.modules.items() if name.endswith("hiermatch_addon.registration"))


def _limbs(markers: list[Any]) -> list[Any]:
    """Leave out the bones at the ends, such as fingers and toes, of which little is seen."""
    small = ("finger", "thumb", "index", "middle", "ring", "pinky", "toe", "ik", "eye", "leaf", "end")
    return [one for one in markers if not any(word in one.name.lower() for word in small)] or markers


def _spread(things: list[Any], count: int) -> list[Any]:
    """Choose some of a list, evenly."""
    return [things[round((number + 0.5) * (len(things) - 1) / count)] for number in range(count)]


def main(arguments: list[str]) -> None:
    """Install the zip, and let Blender's own timer do one step after the other."""
    telling: Any = {"--motion": tell_motion, "--my-rig": tell_my_rig}.get(arguments[0] if arguments else "", tell)
    if arguments[:1] == ["--wear"]:
        telling = partial(tell_wear, items=arguments[1].split(","))
        del arguments[0]
    arguments = arguments[telling is not tell :]
    if len(arguments) < 4:
        sys.exit("Name a folder for the pictures, the extension's zip, and the files of the source and the target.")
    folder, package, source, target = (Path(argument).resolve() for argument in arguments[:4])
    folder.mkdir(parents=True, exist_ok=True)
    bpy.context.preferences.view.show_splash = bpy.context.preferences.view.show_tooltips = False
    camera = Camera(folder, arguments[4:])
    play(chain(_install(package), telling(Story(source, target), camera)))


def _install(package: Path) -> Iterator[float | None]:
    """Install the zip, once Blender has begun."""
    install: Any = cast("Any", bpy.ops).extensions.package_install_files
    install(filepath=str(package), repo="user_default", enable_on_install=True)
    yield None


main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
