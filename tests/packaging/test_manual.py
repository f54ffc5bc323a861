# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual leads nowhere into the void, and its calls and commands are right."""

import ast
import re
import shlex
from functools import cache
from pathlib import Path

import pytest

from tests.stories.blender_session import blender_session

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]
LARGEST_PICTURE = 150_000

# Placeholders of GNU parallel and of the shell, and what they may stand for.
STANDING_FOR = {"{}": "3", "{1}": "a.obj", "{2}": "b.obj", "{3}": "c.blend", "{3}.json": "c.json"}


@cache
def text(page):
    return page.read_text(encoding="utf-8")


def headings(page):
    """The anchors that GitHub makes of the headings of a page."""
    titles = re.findall(r"^#+ (.*)$", re.sub(r"```.*?```", "", text(page), flags=re.DOTALL), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def links(page):
    """What a page links to and shows, but for other sites: file and anchor."""
    found = re.findall(r"\]\(([^)#]*)(?:#([^)]*))?\)", re.sub(r"```math.*?```", "", text(page), flags=re.DOTALL))
    return [(name, anchor) for name, anchor in found if "://" not in name]


def test_the_way_out_for_another_python_is_where_it_is_looked_for():
    row = next(line for line in text(DOCS / "troubleshooting.md").splitlines() if "incompatible" in line)
    made = re.search(r"`make ([\w-]+)`", row).group(1)
    assert re.search(rf"^{made}:", text(ROOT / "Makefile"), re.MULTILINE)
    assert f"make {made}" in text(DOCS / "install.md")


def python_blocks():
    return [
        pytest.param(block, id=f"{page.stem}-{number}")
        for page in PAGES
        for number, block in enumerate(re.findall(r"```python\n(.*?)```", text(page), re.DOTALL))
    ]


def command_lines():
    """What follows ``blender --command hiermatch`` in the pages, as words."""
    lines = []
    for page in PAGES:
        for line in text(page).splitlines():
            stripped = line.strip()
            if stripped.startswith(("blender --command hiermatch", "parallel")) and "..." not in stripped:
                words = shlex.split(stripped.partition(" --command hiermatch ")[2])
                words = words[: next((i for i, word in enumerate(words) if word.startswith(":::")), None)]
                lines.append([STANDING_FOR.get(word, word.replace("{}", "3")) for word in words])
    return lines


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_links_lead_somewhere(page):
    for name, anchor in links(page):
        target = (page.parent / name).resolve() if name else page
        assert target.exists(), name
        assert not anchor or anchor in headings(target), f"{name}#{anchor}"


def test_all_pages_and_pictures_are_reached_and_pictures_are_small():
    reached = {(page.parent / name).resolve() for page in PAGES for name, _ in links(page) if name}
    pictures = list((DOCS / "images").iterdir())
    assert {*DOCS.rglob("*.md"), *pictures} <= reached
    assert [path.name for path in pictures if path.stat().st_size > LARGEST_PICTURE] == []


def test_the_index_names_every_page():
    named = {name for name, _ in links(DOCS / "manual.md")}
    assert named >= {page.name for page in DOCS.glob("*.md")} - {"manual.md"}


def test_the_index_of_the_method_names_every_page_of_it():
    folder = DOCS / "method"
    named = {name for name, _ in links(folder / "README.md")}
    assert named >= {page.name for page in folder.glob("*.md")} - {"README.md"}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_modules_and_folders_that_are_named_are_there(page):
    named = re.findall(r"`((?:engine|hiermatch_addon|tests|tools)/[\w./]*)`", text(page))
    assert [name for name in named if not (ROOT / name).exists()] == []


@pytest.mark.parametrize("block", python_blocks())
def test_operators_are_called_by_their_names_and_options(block):
    classes = {}
    for path in (ROOT / "hiermatch_addon").rglob("*.py"):
        source = path.read_text(encoding="utf-8")
        classes |= dict.fromkeys(re.findall(r'bl_idname = "hiermatch\.(\w+)"', source), source)
    options = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "hiermatch_addon").rglob("*.py"))
    options += (ROOT / "engine" / "hierarchical" / "settings.py").read_text(encoding="utf-8")
    for node in ast.walk(ast.parse(block)):
        if isinstance(node, ast.Call) and ast.unparse(node.func).startswith("bpy.ops.hiermatch."):
            assert ast.unparse(node.func).rpartition(".")[2] in classes
            for keyword in node.keywords:
                assert re.search(rf'\b{keyword.arg}"?: ', options), keyword.arg


def test_imports_from_the_engine_are_there():
    import engine

    for (block,) in (parameters.values for parameters in python_blocks()):
        for node in ast.walk(ast.parse(block)):
            if isinstance(node, ast.ImportFrom) and node.module and node.module.endswith("engine"):
                assert [alias.name for alias in node.names if not hasattr(engine, alias.name)] == []


def test_command_lines_can_be_parsed():
    pytest.importorskip("bpy")
    lines = command_lines()
    assert len(lines) > 5
    with blender_session():
        from hiermatch.hiermatch_addon.command_line.program import make_parser

        for words in lines:
            if "--help" not in words:
                make_parser().parse_args(words)
