# SPDX-License-Identifier: GPL-3.0-or-later
"""Who may import what."""

from __future__ import annotations

import ast

import pytest

from tools.source_extension import ROOT

READS_CODE_ONLY = True
"""See `conftest.empty_file`: it takes longer than the tests."""

ENGINE = sorted((ROOT / "engine").rglob("*.py"))
ADDON = sorted((ROOT / "hiermatch_addon").rglob("*.py"))
BLENDER = {"bpy", "bmesh", "mathutils", "gpu", "gpu_extras", "bpy_extras", "blf", "idprop", "aud", "freestyle"}
OURS = {"engine", "hiermatch_addon", "hiermatch"}
STANDARD = {
    "__future__",
    "collections",
    "contextlib",
    "copy",
    "dataclasses",
    "functools",
    "hashlib",
    "heapq",
    "itertools",
    "math",
}
ENGINE_MAY = STANDARD | {"numpy", "scipy", "typing", "enum", "operator", "time", "warnings"}
# What starts another process, sends it values and ends it, without any thread, also of libraries.
PROCESSES = {
    ROOT / "engine" / "runtime" / f"{name}.py"
    for name in ("background", "worker", "worker_main", "pipes", "messages", "blas_threads")
}
PROCESSES_MAY = {
    "atexit",
    "contextvars",
    "ctypes",
    "io",
    "msvcrt",
    "os",
    "pathlib",
    "pickle",
    "select",
    "subprocess",
    "sys",
}
PROCESSES_MAY |= {"threading", "traceback", "weakref"}
LOCKED = ROOT / "engine" / "runtime" / "blas_threads.py"


def imported(path):
    """Roots of the modules that a file imports absolutely, with the relative ones left out."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            yield node.module.split(".")[0]


def name(path):
    return str(path.relative_to(ROOT))


def test_there_are_files_to_look_at():
    assert len(ENGINE) > 5
    assert len(ADDON) > 5


@pytest.mark.parametrize("path", ENGINE, ids=name)
def test_the_engine_knows_numpy_and_scipy_and_no_blender(path):
    assert set(imported(path)) <= ENGINE_MAY | (PROCESSES_MAY if path in PROCESSES else set())


@pytest.mark.parametrize("path", ENGINE, ids=name)
def test_the_engine_never_reaches_out_of_itself(path):
    depth = len(path.relative_to(ROOT / "engine").parts)
    levels = [node.level for node in ast.walk(ast.parse(path.read_text("utf8"))) if isinstance(node, ast.ImportFrom)]
    assert max(levels, default=0) <= depth


@pytest.mark.parametrize("path", [*ENGINE, *ADDON, ROOT / "__init__.py"], ids=name)
def test_what_is_ours_is_imported_relatively(path):
    assert not OURS & set(imported(path))


@pytest.mark.parametrize("path", [*ENGINE, *ADDON, ROOT / "__init__.py"], ids=name)
def test_no_threads_no_print_and_no_search_path(path):
    tree = ast.parse(path.read_text(encoding="utf8"))
    forbidden = {"threading", "_thread", "concurrent", "multiprocessing", "asyncio", "sys"}
    if "command_line" in path.parts or path in PROCESSES:
        forbidden -= {"sys"}  # a command has arguments, streams and an interpreter to start again; see the next tests
    if path == LOCKED:
        forbidden -= {"threading"}  # it has a lock for the threads of others; see below
    assert not forbidden & set(imported(path))
    called = {node.func.id for node in ast.walk(tree) if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)}
    assert not {"print", "eval", "exec", "open", "__import__"} & called


def used_of(module, path):
    return {
        node.attr
        for node in ast.walk(ast.parse(path.read_text(encoding="utf8")))
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == module
    }


def test_a_lock_starts_no_thread():
    assert used_of("threading", LOCKED) == {"Lock"}


@pytest.mark.parametrize("path", [path for path in ADDON if "command_line" in path.parts], ids=name)
def test_the_command_line_leaves_the_interpreter_alone(path):
    assert used_of("sys", path) <= {"argv", "executable", "stdout", "stderr"}


@pytest.mark.parametrize("path", sorted(PROCESSES), ids=name)
def test_other_processes_are_started_by_the_interpreter_which_is_left_alone(path):
    assert used_of("sys", path) <= {"executable"}


@pytest.mark.parametrize(
    "path", [path for path in ADDON if not path.stem.endswith(("_io", "_layer")) and "demo" not in path.name], ids=name
)
def test_only_what_is_called_so_moves_arrays(path):
    attributes = {node.attr for node in ast.walk(ast.parse(path.read_text("utf8"))) if isinstance(node, ast.Attribute)}
    assert not {"foreach_get", "foreach_set"} & attributes


def test_the_colours_are_computed_without_blender():
    assert not BLENDER & set(imported(ROOT / "hiermatch_addon" / "storage" / "views" / "colors.py"))


def test_importing_the_root_needs_nothing():
    body = ast.parse((ROOT / "__init__.py").read_text(encoding="utf8")).body
    assert not [node for node in body if isinstance(node, ast.Import | ast.ImportFrom)]
