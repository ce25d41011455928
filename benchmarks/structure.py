"""Imports between the parts of `app`, how many of them point against the layers, and what is typed as `Any`.

`python -m benchmarks.structure` prints the counts, every import that points upwards, and files with `Any`.
The layers are those of docs/architecture and of the import contracts in pyproject.toml; a module at the top
of `app` is a part too. `Any` is counted as a word; its reason stands beside it or at the head of its module.
`Json` and `JsonObject` are counted apart: they too are `Any`, for values that a model or a schema checks.
"""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from collections import Counter
from collections.abc import Container, Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
APP = ROOT / "app"


def layers() -> tuple[frozenset[str], ...]:
    """The layers of `app` as the import contracts of `pyproject.toml` draw them, from the top down."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
    (drawn,) = (one["layers"] for one in contracts if one["name"] == "the layers of app")
    return tuple(frozenset(name.strip().removeprefix("app.") for name in layer.split("|")) for layer in drawn)


LAYERS = layers()
"""From the top down: a part imports parts of lower layers only."""


def part_of(module: str) -> str:
    """The part of `app` to which a module belongs: `app.designs.document` → `designs`."""
    return module.split(".")[1]


def imports(path: Path) -> Iterator[str]:
    """The modules of `app` that a file imports, wherever in the file."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            yield from (name for name in names if name.startswith("app."))
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name.startswith("app."))


def arrows(app: Path = APP) -> Counter[tuple[str, str]]:
    """How many imports lead from one part to another."""
    counted: Counter[tuple[str, str]] = Counter()
    for path in sorted(app.rglob("*.py")):
        source = part_of("app." + ".".join(path.relative_to(app).with_suffix("").parts))
        targets = (part_of(module) for module in imports(path))
        counted.update((source, target) for target in targets if target != source)
    return counted


def words(pattern: str, app: Path = APP) -> Counter[str]:
    """How often a word that matches stands in each file, imports and comments included."""
    counts = Counter[str]()
    for path in app.rglob("*.py"):
        count = len(re.findall(rf"\b(?:{pattern})\b", path.read_text(encoding="utf-8")))
        counts.update({str(path.relative_to(app)): count} if count else {})
    return counts


def named(banned: Container[str], root: Path = APP) -> Counter[str]:
    """How often each file below a folder gives a value, an argument or a function one of these names."""
    counts = Counter[str]()
    for path in root.rglob("*.py"):
        nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        count = sum((_given(node) or "").strip("_") in banned for node in nodes)
        counts.update({str(path.relative_to(root)): count} if count else {})
    return counts


def _given(node: ast.AST) -> str | None:
    """The name that a node gives to something, if it gives one."""
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return node.name.lower()
    if isinstance(node, ast.arg):
        return node.arg
    if isinstance(node, ast.Name | ast.Attribute) and isinstance(node.ctx, ast.Store):
        return node.id if isinstance(node, ast.Name) else node.attr
    return None


def rank(part: str) -> int:
    """The layer of a part, counted from the top; the lowest for one that no layer names."""
    return next((number for number, layer in enumerate(LAYERS) if part in layer), len(LAYERS))


def upward(counted: Counter[tuple[str, str]]) -> list[tuple[str, str]]:
    """The arrows that point to the same layer or to a higher one."""
    return sorted(pair for pair in counted if rank(pair[1]) <= rank(pair[0]))


def main() -> None:
    """Print the counts, every arrow that points upwards, and every file with `Any`."""
    counted = arrows()
    against = upward(counted)
    print(
        f"{len(counted)} arrows between the parts of app ({counted.total()} imports), {len(against)} against"
    )
    for source, target in against:
        print(f"  {source} → {target}: {counted[source, target]} imports")
    untyped, json = words("Any"), words("Json|JsonObject")
    print(f"{untyped.total()} times Any in {len(untyped)} files ({json.total()} times Json or JsonObject)")
    for path, count in untyped.most_common():
        print(f"  {path}: {count}")
    sys.exit(bool(against))


if __name__ == "__main__":
    main()
