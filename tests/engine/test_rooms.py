# SPDX-License-Identifier: GPL-3.0-or-later
"""The rooms of engine and add-on: which may import which, without cycles, and tests that lie as the modules do."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import engine

ROOT = Path(__file__).resolve().parents[2]

ENGINE = {
    "runtime": set(),
    "mesh": {"runtime"},
    "geometry": {"runtime", "mesh"},
    "repair": {"runtime", "mesh"},
    "shapes": {"runtime", "mesh", "geometry", "repair"},
    "hierarchical": {"runtime", "mesh", "geometry", "shapes"},
    "registration": {"runtime", "mesh", "geometry", "shapes"},
    "dense": {"runtime", "mesh", "geometry", "repair", "shapes", "registration", "hierarchical"},
    "matching": {"runtime", "mesh", "geometry", "repair", "shapes", "registration", "hierarchical", "dense"},
    "retarget": {"runtime", "mesh", "geometry", "repair", "shapes", "registration", "dense"},
}
"""Room of the engine -> other rooms that its modules may import, for types too."""

ADDON = (
    "common",
    "scene",
    "storage",
    "properties",
    "jobs",
    "transfers",
    "overlay",
    "demo",
    "panels",
    "operators",
    "command_line",
    "registration",
    "__init__",
)
"""Rooms of the add-on: each may import itself and those before it."""

OF_THE_PAPER = {"spectral_descriptors"}
"""Modules of the room of the paper that the room of dense maps may import."""

MODULES_IN_A_FOLDER = 17
"""Modules to look at in one folder, at most."""


def modules(package):
    """All modules below a package: dotted name -> path; a package itself is named by its `__init__`."""
    for path in sorted((ROOT / package).rglob("*.py")):
        parts = path.relative_to(ROOT).with_suffix("").parts
        if "presets" not in parts:  # which Blender runs, and nobody imports
            yield ".".join(parts), path


def for_types(tree):
    """Nodes of the imports that only type checkers see."""
    guards = [node for node in ast.walk(tree) if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"]
    return {node for guard in guards for node in ast.walk(guard)}


def imports(name, path, known, *, types):
    """Names of the modules of the same package that a module imports, wherever in its text."""
    folder = name.split(".")[:-1]
    tree = ast.parse(path.read_text(encoding="utf8"))
    for node in set(ast.walk(tree)) - (set() if types else for_types(tree)):
        if isinstance(node, ast.ImportFrom) and node.level:
            base = [*folder[: len(folder) - node.level + 1], *(node.module.split(".") if node.module else [])]
            for alias in node.names:
                for found in (".".join([*base, alias.name]), ".".join(base), ".".join([*base, "__init__"])):
                    if found in known:
                        yield found
                        break


def graph(package, *, types=True):
    """Module -> modules that it imports."""
    known = dict(modules(package))
    return {name: set(imports(name, path, known, types=types)) for name, path in known.items()}


IMPORTS = graph("engine")
ADDON_IMPORTS = graph("hiermatch_addon")


def room(name):
    return name.split(".")[1]


def test_only_the_public_names_lie_outside_of_the_rooms():
    assert [path.name for path in (ROOT / "engine").glob("*.py")] == ["__init__.py"]
    assert {path.name for path in (ROOT / "engine").iterdir() if path.is_dir()} - {"__pycache__"} == set(ENGINE)


@pytest.mark.parametrize("name", sorted(set(IMPORTS) - {"engine.__init__"}))
def test_a_room_imports_only_those_it_may(name):
    others = {found for found in IMPORTS[name] if room(found) != room(name)}
    assert {room(found) for found in others} <= ENGINE[room(name)]
    if room(name) == "dense":
        assert {found.split(".")[-1] for found in others if room(found) == "hierarchical"} <= OF_THE_PAPER


@pytest.mark.parametrize("name", sorted(ADDON_IMPORTS))
def test_a_room_of_the_add_on_imports_only_those_before_it(name):
    if name != "hiermatch_addon.command_line.__main__":  # it stands for Blender, and registers all
        before = ADDON[: ADDON.index(room(name)) + 1]
        assert {room(found) for found in ADDON_IMPORTS[name]} <= set(before)


@pytest.mark.parametrize(("package", "types"), [("engine", True), ("hiermatch_addon", False)])
def test_there_is_no_cycle(package, types):
    waiting = {name: found - {name} for name, found in graph(package, types=types).items()}
    while free := [name for name, found in waiting.items() if not found & set(waiting)]:
        for name in free:
            del waiting[name]
    assert not waiting, f"modules in or behind a cycle: {sorted(waiting)}"


@pytest.mark.parametrize("package", ["engine", "hiermatch_addon"])
def test_a_folder_can_be_taken_in(package):
    for folder in {path.parent for _, path in modules(package)}:
        assert len(list(folder.glob("*.py"))) <= MODULES_IN_A_FOLDER + 1, folder


def test_a_room_begins_with_what_it_is_and_nothing_else():
    for name, path in modules("engine"):
        if name.endswith("__init__") and name != "engine.__init__":
            (docstring,) = ast.parse(path.read_text(encoding="utf8")).body  # workers import what they need
            assert isinstance(docstring, ast.Expr), name


def test_tests_of_the_engine_lie_where_the_modules_lie():
    """A test is named for a module of the same room, and may name a topic after it: `test_matching_messy`."""
    here = Path(__file__).parent
    for test in here.rglob("test_*.py"):
        folder = ROOT / "engine" / test.parent.relative_to(here)
        names = {path.stem for path in folder.glob("*.py")}
        topic = test.stem.removeprefix("test_")
        assert test == Path(__file__) or any(f"{topic}_".startswith(f"{name}_") for name in names), test


def test_the_add_on_imports_the_public_names_of_the_engine_alone():
    for name, path in modules("hiermatch_addon"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf8"))):
            if isinstance(node, ast.ImportFrom) and node.level == len(name.split(".")):
                assert node.module == "engine", f"{name}: {node.module}"
                assert {alias.name for alias in node.names} <= set(engine.__all__), name
