# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of the command line made of Blender's own description of an operator, so that a new one appears by itself."""

from __future__ import annotations

import argparse
import csv
import io
import math
import textwrap
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, NoReturn

import bpy
import numpy as np

from .command import EXIT_CODES, UsageError

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping

_OBJECTS = frozenset({"rna_type", "source", "target", "targets", "object"})
"""Properties that name objects: on the command line they are arguments."""

_LISTS = frozenset({"items"})
"""Collections of names: on the command line they are texts with commas between the names; see `quoted_names`."""

_LINE = 100
"""Letters in a line of a description."""

_YES, _NO = frozenset({"1", "true", "yes", "on"}), frozenset({"0", "false", "no", "off"})


class Parser(argparse.ArgumentParser):
    """A parser that raises errors instead of ending the process, and takes no shortened names."""

    def __init__(self, **arguments: Any) -> None:  # noqa: ANN401 - whatever argparse takes
        if "description" in arguments:  # which, unlike the exit codes behind all, is no list
            arguments["description"] = textwrap.fill(arguments["description"], _LINE)
        super().__init__(
            allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter, epilog=EXIT_CODES, **arguments
        )

    def error(self, message: str) -> NoReturn:
        """Raise what is wrong."""
        raise UsageError(message, f"{self.format_usage()}See {self.prog} --help")


def option_names(operator: str) -> list[str]:
    """Return the names of an operator's options, such as of "match"."""
    return [described.identifier for described in _properties(operator)]


def add_options(
    parser: argparse.ArgumentParser, operator: str, *, without: Collection[str] = (), title: str = ""
) -> None:
    """Add an operator's options, under their own names, to a parser; those that are not given stay out of its result.

    Parameters
    ----------
    parser : argparse.ArgumentParser
        The parser.
    operator : str
        The operator's name behind "hiermatch.".
    without : collection of str
        Names that are left out.
    title : str
        What the options are called in the help.
    """
    group = parser.add_argument_group(title or f"options of {operator}")
    for described in _properties(operator):
        if described.identifier not in without:
            group.add_argument(_flag(described.identifier), **_declaration(described))


def given_options(operator: str, parsed: argparse.Namespace) -> dict[str, Any]:
    """Return those of an operator's options that were given."""
    given = {name: vars(parsed)[name] for name in option_names(operator) if name in vars(parsed)}
    return {name: tuple(value) if isinstance(value, list) else value for name, value in given.items()}


def chosen_options(operator: str, given: Mapping[str, Any]) -> Any:  # noqa: ANN401 - stands for the operator
    """Return an object with all options of an operator: those that are given, and its own defaults."""
    defaults = {described.identifier: _default(described) for described in _properties(operator)}
    return SimpleNamespace(**{**defaults, **given})


def to_arguments(operator: str, name: str, value: object) -> list[str]:
    """Write an option, as a table holds it, as arguments of the command line; none if the value is empty.

    Raises
    ------
    UsageError
        If it should be true or false, and is neither.
    """
    text = str(value).strip()
    if not text:
        return []
    described = next(described for described in _properties(operator) if described.identifier == name)
    if described.type != "BOOLEAN":
        return [f"{_flag(name)}={text}"]
    if text.lower() in _YES:
        return [_flag(name)]
    if text.lower() in _NO:
        return [_flag(f"no_{name}")]
    raise UsageError(f'{name} is "{text}", but must be true or false')


def _properties(operator: str) -> list[Any]:
    operators: Any = bpy.ops
    described = getattr(operators.hiermatch, operator)
    properties = described.get_rna_type().properties
    listed = [one for one in properties if one.type != "COLLECTION" or one.identifier in _LISTS]
    return [one for one in listed if one.identifier not in _OBJECTS]


def _flag(name: str) -> str:
    return f"--{name.replace('_', '-')}"


def _default(described: Any) -> Any:  # noqa: ANN401 - a property, and whatever its values are
    return () if described.type == "COLLECTION" else described.default


def _declaration(described: Any) -> dict[str, Any]:  # noqa: ANN401 - a property
    """Return what argparse is told of a property."""
    about: dict[str, Any] = {"dest": described.identifier, "default": argparse.SUPPRESS}
    text = f"{described.description}."
    if described.type == "BOOLEAN":
        about["action"] = argparse.BooleanOptionalAction
        shown = "on" if described.default else "off"
    elif described.type == "ENUM":
        words = [item.identifier.lower() for item in described.enum_items]
        about |= {"type": _word(described), "metavar": f"{{{','.join(words)}}}"}
        said = zip(words, (item.description for item in described.enum_items), strict=True)
        text = " ".join([text, *(f"{word}: {meaning}." for word, meaning in said if meaning)])
        shown = described.default.lower()
    elif described.type == "COLLECTION":
        about |= {"type": _names, "action": "extend", "metavar": "NAME,NAME,..."}
        text += " Names with commas stand in double quotes; may be given several times."
        shown = ""
    elif described.type == "STRING":
        about |= {"type": _text(described.length_max), "metavar": "TEXT"}
        shown = f'"{described.default}"' if described.default else ""
    else:
        about |= {"type": _number(described), "metavar": "N" if described.type == "INT" else "X"}
        text += " In radians." if described.subtype == "ANGLE" else ""
        shown = f"{described.default:g}"
    # argparse takes the sign for per cent as the beginning of a name.
    about["help"] = (f"{text} (default: {shown})" if shown else text).replace("%", "%%")
    return about


def _word(described: Any) -> Callable[[str], str]:  # noqa: ANN401 - a property
    identifiers = {item.identifier.lower(): item.identifier for item in described.enum_items}

    def parse(text: str) -> str:
        if text.lower() not in identifiers:
            raise argparse.ArgumentTypeError(f'"{text}" is none of {", ".join(identifiers)}')
        return identifiers[text.lower()]

    return parse


def _text(longest: int) -> Callable[[str], str]:
    def parse(text: str) -> str:
        if longest and len(text.encode()) >= longest:
            raise argparse.ArgumentTypeError(f'"{text}" is longer than {longest - 1} letters')
        return text

    return parse


def quoted_names(names: Iterable[str]) -> str:
    """Write names as the text of an option: with commas between them, and in quotes where one has commas itself."""
    text = io.StringIO()
    csv.writer(text, lineterminator="").writerow(names)
    return text.getvalue()


def _names(text: str) -> tuple[str, ...]:
    try:
        cells = [cell for row in csv.reader([text], skipinitialspace=True, strict=True) for cell in row]
    except csv.Error:
        raise argparse.ArgumentTypeError(
            f'the quotes in {text} do not stand around whole names, such as in "Shirt, red",Hat'
        ) from None
    return tuple(dict.fromkeys(name.strip() for name in cells if name.strip()))


def _number(described: Any) -> Callable[[str], float]:  # noqa: ANN401 - a property
    whole, least, most = described.type == "INT", described.hard_min, described.hard_max

    def parse(text: str) -> float:
        try:
            # Blender's numbers are of single precision, on the command line as well as in its panels; tables may hold
            # whole ones as 64.0.
            number = int(text.removesuffix(".0")) if whole else float(np.float32(float(text)))
        except ValueError:
            raise argparse.ArgumentTypeError(f'"{text}" is no {"whole " if whole else ""}number') from None
        if not (math.isfinite(number) and least <= number <= most):
            raise argparse.ArgumentTypeError(f"{text} is not between {least:g} and {most:g}")
        return number

    return parse
