"""The structure of the program: imports, circles, short modules, names, `Any`, and files entered.

`python -m benchmarks.structure` prints them, with the size of `app`. The layers are those of the import
contracts in pyproject.toml; a module at the top of `app` is a part too. `Any` is counted as a word; its
reason stands beside it or at the head of its module. `Json` and `JsonObject` are counted apart: they too
are `Any`, for values that a model or a schema checks.
"""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from collections import Counter
from collections.abc import Container, Iterator, Mapping
from pathlib import Path

from benchmarks import files_entered

ROOT = Path(__file__).parents[1]
APP = ROOT / "app"
PACKAGES = ("app", "cad", "templates")
SHORT = 60  # lines; a shorter module with a single importer belongs into that importer
RESOURCE = frozenset({"routes", "schemas", "bodies", "views", "repository", "service", "tasks", "tables"})
"""The files of a resource: the same names in each folder, however short."""

REASONS: dict[str, str] = {
    "app.http.answer_examples": "reads the recorded answers, which a script writes",
    "app.pool.turns": "the rule of turns between clients alone, tested by itself",
    "app.client.approval_operations": "the calls on one resource, as every resource has them in the client",
    "app.client.identity_operations": "the calls on one resource, as every resource has them in the client",
    "app.client.model_operations": "the calls on one resource, as every resource has them in the client",
    "app.designs.explanation": "joins the chain of relations and the sensitivities; neither knows the other",
    "app.presentation.prose": "a rule of security: what of a user's Markdown becomes HTML",
    "app.reports.crank_star": "one picture of the report",
    "app.workers.remote.client": "Dask's client with an end in time, apart from what uses it",
    "app.workers.remote.strays": "the rule by which a task counts as lost, tested by itself",
    "app.worksheets.imports.job": "all that a process of its own imports to read a file of a user",
}
"""Short modules with a single importer, each with the reason why it is a separate file."""

ENDINGS = re.compile(r"(?:ings?|eds?|ions?|ers?|es|e|s|d)$")
NOUNS = frozenset({"spring", "string", "bearing", "typesetting", "imported_models"})
"""Names that end like a gerund but are nouns of the field."""


def layers() -> tuple[frozenset[str], ...]:
    """Return the layers of `app` as the import contracts of `pyproject.toml` list them, from the top down."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
    (drawn,) = (one["layers"] for one in contracts if one["name"] == "the layers of app")
    parts = [frozenset(name.strip().removeprefix("app.") for name in layer.split("|")) for layer in drawn]
    place = parts.index(frozenset({"api"}))  # modules shared by routes lie directly below them
    return (*parts[:place], frozenset({"routes"}), *parts[place:])


LAYERS = layers()
"""The layers from top to bottom: a part imports only parts of lower layers."""


def part_of(module: str) -> str:
    """Return the part of `app` to which a module belongs: `app.designs.document` → `designs`.

    The routes of all resources form one part: their layer is above the resources, although each is in the
    folder of its resource.
    """
    part, *inside = module.split(".")[1:]
    return "routes" if inside[:1] == ["routes"] and part != "web" else part


def imports(path: Path) -> Iterator[str]:
    """Return the modules of `app` that a file imports, anywhere in the file."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            yield from (name for name in names if name.startswith("app."))
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name.startswith("app."))


def arrows(app: Path = APP) -> Counter[tuple[str, str]]:
    """Return the number of imports from one part to another."""
    counted: Counter[tuple[str, str]] = Counter()
    for path in sorted(app.rglob("*.py")):
        source = part_of("app." + ".".join(path.relative_to(app).with_suffix("").parts))
        targets = (part_of(module) for module in imports(path))
        counted.update((source, target) for target in targets if target != source)
    return counted


def words(pattern: str, app: Path = APP) -> Counter[str]:
    """Return the number of matching words in each file, including imports and comments."""
    counts = Counter[str]()
    for path in app.rglob("*.py"):
        count = len(re.findall(rf"\b(?:{pattern})\b", path.read_text(encoding="utf-8")))
        counts.update({str(path.relative_to(app)): count} if count else {})
    return counts


def named(banned: Container[str], root: Path = APP) -> Counter[str]:
    """Return how often each file below a folder uses one of these names for a value, argument or function."""
    counts = Counter[str]()
    for path in root.rglob("*.py"):
        nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        count = sum((_given(node) or "").strip("_") in banned for node in nodes)
        counts.update({str(path.relative_to(root)): count} if count else {})
    return counts


def _given(node: ast.AST) -> str | None:
    """Return the name that a syntax node defines, if any."""
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return node.name.lower()
    if isinstance(node, ast.arg):
        return node.arg
    if isinstance(node, ast.Name | ast.Attribute) and isinstance(node.ctx, ast.Store):
        return node.id if isinstance(node, ast.Name) else node.attr
    return None


def rank(part: str) -> int:
    """Return the layer of a part, counted from the top; the lowest for a part in no layer."""
    return next((number for number, layer in enumerate(LAYERS) if part in layer), len(LAYERS))


def upward(counted: Counter[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return the imports into the same layer or a higher one."""
    return sorted(pair for pair in counted if rank(pair[1]) <= rank(pair[0]))


def modules(root: Path = ROOT, packages: tuple[str, ...] = PACKAGES) -> dict[str, Path]:
    """Return the files of the packages by the dotted name of their module."""
    found = {}
    for package in packages:
        for path in sorted((root / package).rglob("*.py")):
            parts = path.relative_to(root).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imported(path: Path, known: Container[str], name: str) -> set[str]:
    """Return the modules that a file imports, wherever in the file, without itself."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                found.add(full if full in known else node.module)
        elif isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
    return {one for one in found if one in known and one != name}


def graph(root: Path = ROOT, packages: tuple[str, ...] = PACKAGES) -> dict[str, set[str]]:
    """Return the imported modules of each module."""
    known = modules(root, packages)
    return {name: imported(path, known, name) for name, path in known.items()}


def circles(arrows: Mapping[str, set[str]]) -> list[list[str]]:
    """Return the groups of modules that import each other, directly or indirectly."""
    reached = {name: _reached(name, arrows) for name in arrows}
    groups = {
        tuple(sorted({name} | {other for other in reached[name] if name in reached[other]}))
        for name in arrows
        if name in reached[name]
    }
    return sorted(map(list, groups))


def _reached(name: str, arrows: Mapping[str, set[str]]) -> set[str]:
    """Return the modules that a module imports, directly or indirectly."""
    found, left = set[str](), [name]
    while left:
        for other in arrows.get(left.pop(), ()):
            if other not in found:
                found.add(other)
                left.append(other)
    return found


def single_importers(arrows: Mapping[str, set[str]], root: Path = ROOT) -> dict[str, str]:
    """Return the short modules of `app` with exactly one importing module, and that module."""
    known = modules(root)
    found = {}
    for name, path in known.items():
        if not name.startswith("app.") or path.name == "__init__.py" or _may_be_short(name):
            continue
        if len(path.read_text(encoding="utf-8").splitlines()) >= SHORT:
            continue
        by = [other for other, targets in arrows.items() if name in targets]
        if len(by) == 1:
            found[name] = by[0]
    return found


def _may_be_short(name: str) -> bool:
    """Return whether the name allows a short module: a standard file of a resource, or a command."""
    return bool(RESOURCE & set(name.split("."))) or name.startswith("app.cli.")


def pairs(root: Path = ROOT) -> list[tuple[str, str]]:
    """Return the modules of one folder whose names differ only by -ing, -ed, -s or the like."""
    folders: dict[Path, dict[str, list[str]]] = {}
    for path in sorted((root / "app").rglob("*.py")):
        stem = ENDINGS.sub("", path.stem)
        folders.setdefault(path.parent, {}).setdefault(stem, []).append(path.stem)
    return [
        (str(folder.relative_to(root)), ", ".join(names))
        for folder, by_stem in folders.items()
        for names in by_stem.values()
        if len(names) > 1
    ]


def participles(root: Path = ROOT) -> list[str]:
    """Return the modules of `app` that are named by a participle or a gerund."""
    return sorted(
        str(path.relative_to(root))
        for path in (root / "app").rglob("*.py")
        if re.search(r"(?:^|_)\w+(?:ing|ed)(?:_|$)", path.stem) and path.stem not in NOUNS
    )


def main() -> None:
    """Print the counts, every upward import, and every file with `Any`."""
    counted, graphed = arrows(), graph()
    against = upward(counted)
    print(
        f"{len(counted)} arrows between the parts of app ({counted.total()} imports), {len(against)} against"
    )
    for source, target in against:
        print(f"  {source} → {target}: {counted[source, target]} imports")
    for title, lines in {
        "circles": [" ".join(circle) for circle in circles(graphed)],
        f"modules of app under {SHORT} lines with a single importer and no reason": [
            f"{name} ← {by}" for name, by in single_importers(graphed).items() if name not in REASONS
        ],
        "names of one folder that differ by an ending": [f"{folder}: {names}" for folder, names in pairs()],
        "files named by a participle or gerund": participles(),
    }.items():
        print(f"{len(lines)} {title}")
        for line in lines:
            print(f"  {line}")
    untyped, json = words("Any"), words("Json|JsonObject")
    print(f"{untyped.total()} times Any in {len(untyped)} files ({json.total()} times Json or JsonObject)")
    for path, count in untyped.most_common():
        print(f"  {path}: {count}")
    sizes = [len(path.read_text(encoding="utf-8").splitlines()) for path in APP.rglob("*.py")]
    print(f"app: {len(sizes)} files, {sum(sizes)} lines")
    files_entered.main()
    sys.exit(bool(against))


if __name__ == "__main__":
    main()
