"""Places where the code can be mutated, and a random sample that stays the same while lines move.

The operators are Cosmic Ray's, and one of our own that drops a call whose result nobody uses. A place is one
token and one family of operators, such as `+` replaced by any other sign: places are sampled, not mutants,
because a single `+` has many mutants and a `not` has one. A place is ranked by a hash of seed, name of
the file and the text of the line; so the sample changes only with the lines that it is about.
"""

from __future__ import annotations

import ast
import difflib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from hashlib import sha256
from itertools import islice
from pathlib import Path
from typing import Any

from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.operators.operator import Example, Operator
from cosmic_ray.plugins import get_operator, operator_names
from parso.python.tree import Keyword, PythonNode

from benchmarks.mutation import ROOT
from benchmarks.mutation.targets import targets

Span = tuple[tuple[int, int], tuple[int, int]]


class DropCall(Operator):
    """Replaces a call that is a statement, such as `file.flush()`, by `pass`."""

    def mutation_positions(self, node: Any) -> Iterator[Span]:
        """Yield the span of a statement that is a call, or an awaited one."""
        if isinstance(node, PythonNode) and node.type == "simple_stmt":
            first = node.children[0]
            if first.type in ("atom_expr", "power") and first.get_code().rstrip().endswith(")"):
                yield first.start_pos, first.end_pos

    def mutate(self, node: Any, index: int) -> Any:
        """Put `pass` in its place."""
        first = node.children[0]
        node.children[0] = Keyword("pass", first.start_pos, prefix=first.get_first_leaf().prefix)
        return node

    @classmethod
    def examples(cls) -> tuple[Example, ...]:
        """Return one change as it is made."""
        return (Example("f(x)\n", "pass\n"),)


ALIKE = (
    {"Add", "Sub", "Mul", "Div", "FloorDiv", "Mod", "Pow"},
    {"RShift", "LShift", "BitOr", "BitAnd", "BitXor"},
    {"Eq", "NotEq", "Lt", "LtE", "Gt", "GtE"},
    {"Is", "IsNot"},
    {"In", "NotIn"},
    {"UAdd", "USub", "Delete"},
    {"Not", "Delete"},
    {"Invert", "Delete"},
)
"""Operators that replace each other. Cosmic Ray also replaces a product of floats by `<<`, which any test
detects."""


def is_plausible(name: str) -> bool:
    """Return whether an operator replaces a sign by one of the same kind, or anything but signs."""
    signs = set(name.split("_")[1:])
    return len(signs) < 2 or any(signs <= kind for kind in ALIKE)


OPERATORS = {
    name: get_operator(name)()
    for name in operator_names()
    if is_plausible(name) and not get_operator(name).arguments()
}
OPERATORS["ours/DropCall"] = DropCall()


@dataclass(frozen=True)
class Mutant:
    """One change of one file."""

    key: str  # hash of the seed and the mutated line; it stays the same as long as the line does
    file: str
    line: int
    text: str  # the line before the change
    operator: str
    source: str  # the changed file
    diff: str


@dataclass(frozen=True)
class Place:
    """A token that one family of operators can change."""

    file: str
    span: Span
    rank: str
    choices: tuple[tuple[str, int], ...]  # operators, and the numbers of their occurrences in the file


def sample(seed: int, count: int) -> list[Mutant]:
    """Return `count` random mutants, in the order of their rank; fewer if there are no more."""
    ranked = sorted((place for file in targets() for place in places(file, seed)), key=lambda p: p.rank)
    return list(islice((m for place in ranked if (m := mutant(place)) is not None), count))


def places(file: str, seed: int) -> list[Place]:
    """Return the places of a file; none in annotations, which tests do not run."""
    source = (ROOT / file).read_text(encoding="utf-8")
    outside = annotated(source)
    choices: dict[tuple[Span, str], list[tuple[str, int]]] = {}
    for name, number, span in occurrences(source):
        if not any(low <= span[0] and span[1] <= high for low, high in outside):
            choices.setdefault((span, family(name)), []).append((name, number))
    lines, seen = source.splitlines(), Counter[str]()
    return [place(file, span, kind, lines, seen, tuple(c), seed) for (span, kind), c in choices.items()]


def occurrences(source: str) -> Iterator[tuple[str, int, Span]]:
    """Yield each change that an operator can make: name, number in the file, span of its token."""
    numbers = Counter[str]()
    for node in ast_nodes(get_ast(source)):
        for name, operator in OPERATORS.items():
            for span in operator.mutation_positions(node):
                if node.parent is None or node.parent.type != "parameters":  # the `*` before keywords
                    yield name, numbers[name], span
                numbers[name] += 1


def annotated(source: str) -> list[Span]:
    """Return the spans of all annotations."""
    nodes = [
        getattr(node, at, None) for node in ast.walk(ast.parse(source)) for at in ("annotation", "returns")
    ]
    return [
        ((n.lineno, n.col_offset), (n.end_lineno or n.lineno, n.end_col_offset or n.col_offset))
        for n in nodes
        if isinstance(n, ast.expr)
    ]


def family(name: str) -> str:
    """Return the family of an operator: what it replaces, whatever by."""
    return name.rpartition("/")[2].partition("_")[0]


def place(
    file: str,
    span: Span,
    kind: str,
    lines: list[str],
    seen: Counter[str],
    choices: tuple[tuple[str, int], ...],
    seed: int,
) -> Place:
    """Return a place with its rank; equal lines differ by their order."""
    line = lines[span[0][0] - 1]
    column = span[0][1] - (len(line) - len(line.lstrip()))
    identity = f"{Path(file).name}|{line.strip()}|{column}|{kind}"
    seen[identity] += 1
    rank = digest(f"{seed}|{identity}|{seen[identity]}")
    return Place(
        file, span, rank, tuple(sorted(choices, key=lambda c: digest(f"{rank}|{c[0]}|{choices.index(c)}")))
    )


def mutant(place: Place) -> Mutant | None:
    """Return the first mutant of a place that is another valid program."""
    before = (ROOT / place.file).read_text(encoding="utf-8")
    for name, number in place.choices:
        after = mutate_code(before, OPERATORS[name], number)
        if after is not None and is_another(before, after):
            line = place.span[0][0]
            text = before.splitlines()[line - 1].strip()
            return Mutant(place.rank[:12], place.file, line, text, name, after, difference(before, after))
    return None


def is_another(before: str, after: str) -> bool:
    """Return whether the second text is a program, and not the first one."""
    try:
        return ast.dump(ast.parse(after)) != ast.dump(ast.parse(before))
    except (SyntaxError, ValueError):
        return False


def difference(before: str, after: str) -> str:
    """Return the lines that differ."""
    lines = difflib.unified_diff(before.splitlines(), after.splitlines(), lineterm="", n=0)
    return "\n".join(line for line in islice(lines, 2, None) if not line.startswith("@@"))


def digest(text: str) -> str:
    """Return a random-looking number of a text, as hexadecimal digits."""
    return sha256(text.encode()).hexdigest()
