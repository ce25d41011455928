"""Parse inputs on a command line: quantities, lists, and curves from files."""

from __future__ import annotations

import json
from pathlib import Path

import click

from app.calculations.curves import curves_of
from app.plain import Raw
from templates.core.errors import Fault, InvalidInputs


def argument(name: str, text: str) -> Raw:
    """Return the value of an input: `25 kN`, `[1, 3, 4, 2]`, `@diagram.csv` or `@diagram.csv:column`.

    A file supplies the column with the name of the input, unless the argument names another column.

    Raises
    ------
    InvalidInputs
        If a file or its column cannot be read, or a list is invalid.
    """
    if text.startswith("@"):
        return _curve(name, text[1:])
    if not text.startswith(("[", "{")):
        return text
    try:
        return json.loads(text)
    except ValueError as error:
        raise _wrong(name, "not_json", f"{text[:60]!r} is not a JSON list or object: {error}") from None


def _curve(name: str, text: str) -> Raw:
    path, _, column = text.rpartition(":") if not Path(text).exists() else (text, "", "")
    try:
        read = curves_of(Path(path or text).read_bytes())
    except OSError as error:
        raise _wrong(name, "unreadable", f"{path or text} cannot be read: {error.strerror}") from None
    except InvalidInputs as error:
        raise InvalidInputs(fault.within(path or text) for fault in error.faults) from None
    curves = read.curves
    if (column or name) not in curves:
        message = (
            f"{path} has no column {column or name}; choose one of them, such as {text}:{next(iter(curves))}"
        )
        raise _wrong(name, "no_such_column", f"{message} (it has {', '.join(curves)})")
    if read.assumed:
        click.echo(f"{name} from {path or text}: {', '.join(read.assumed)}", err=True)
    return curves[column or name]


def _wrong(name: str, code: str, detail: str) -> InvalidInputs:
    return InvalidInputs([Fault(name, code, detail)])
