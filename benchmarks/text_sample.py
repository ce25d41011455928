"""Print a random sample of the project's texts for a fresh reader.

`python -m benchmarks.text_sample --seed 7 --count 60` prints docstrings of functions and of modules,
messages and paragraphs of docs, in equal numbers. Each text is named by its file and line. Messages are the
literal texts of `raise` statements and of faults.
"""

from __future__ import annotations

import argparse
import ast
import random
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGES = ("app", "cad", "templates")
SHORTEST = 4  # words: a shorter literal is a name, not a message


@dataclass(frozen=True, order=True)
class Text:
    """A text with its file and line."""

    place: str
    content: str


def functions() -> Iterator[Text]:
    """Yield the docstring of each function, with the function's name."""
    for path, tree in _trees():
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and (text := ast.get_docstring(node)):
                yield Text(_place(path, node.lineno), f"{node.name}: {text}")


def modules() -> Iterator[Text]:
    """Yield the docstring of each module."""
    for path, tree in _trees():
        if text := ast.get_docstring(tree):
            yield Text(_place(path, 1), text)


def messages() -> Iterator[Text]:
    """Yield the literal texts that `raise` statements, faults and problems give to a user."""
    for path, tree in _trees():
        for node in ast.walk(tree):
            if isinstance(node, ast.Raise) and node.exc:
                yield from _literals(path, node.exc)
            elif isinstance(node, ast.Call) and _called(node) in {"Fault", "Problem", "Warning", "Statement"}:
                yield from _literals(path, node)


def paragraphs() -> Iterator[Text]:
    """Yield the paragraphs of README and docs, without tables, code and headings."""
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))):
        text = re.sub(
            r"```.*?```", lambda code: "\n" * code[0].count("\n"), path.read_text("utf-8"), flags=re.S
        )
        line = 1
        for part in text.split("\n\n"):
            if len(part.split()) >= SHORTEST and not part.lstrip().startswith(("|", "#", "!", "<")):
                yield Text(_place(path, line), part.strip())
            line += part.count("\n") + 2


def sample(seed: int, count: int) -> list[Text]:
    """Return texts drawn at random, as many of each kind, in the order of the kinds."""
    draw = random.Random(seed)
    kinds = (functions, modules, messages, paragraphs)
    return [text for kind in kinds for text in draw.sample(sorted(set(kind())), count // len(kinds))]


def _trees() -> Iterator[tuple[Path, ast.Module]]:
    for package in PACKAGES:
        for path in sorted((ROOT / package).rglob("*.py")):
            yield path, ast.parse(path.read_text("utf-8"))


def _blank_lines(code: re.Match[str]) -> str:
    return "\n" * code[0].count("\n")


def _place(path: Path, line: int) -> str:
    return f"{path.relative_to(ROOT)}:{line}"


def _called(node: ast.Call) -> str:
    return node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")


def _literals(path: Path, tree: ast.AST) -> Iterator[Text]:
    parts = {id(part) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in node.values}
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            text = "".join(str(p.value) if isinstance(p, ast.Constant) else "{…}" for p in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in parts:
            text = node.value
        else:
            continue
        if len(text.split()) >= SHORTEST:
            yield Text(_place(path, node.lineno), text)


def main() -> None:
    """Print the sample."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--count", type=int, default=60)
    chosen = parser.parse_args()
    for number, text in enumerate(sample(chosen.seed, chosen.count), 1):
        print(f"{number}. {text.place}\n{text.content}\n")


if __name__ == "__main__":
    main()
