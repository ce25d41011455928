"""Generate hashes, a bill of materials and the list of licences of all pinned distributions.

    python -m benchmarks.supply_chain            # docs/licences.md, docs/sbom.cdx.json: of what is installed
    python -m benchmarks.supply_chain --hashes   # the lock as well: asks the package index by pip

Run the script in the environment that `constraints.txt` describes. The lock contains the hashes of the files
that pip uses on this platform: `pip install --require-hashes --no-deps -r docs/requirements.lock` accepts no
others.
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import Distribution, distribution
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
CONSTRAINTS, LOCK = ROOT / "constraints.txt", ROOT / "docs" / "requirements.lock"
LICENCES, BILL = ROOT / "docs" / "licences.md", ROOT / "docs" / "sbom.cdx.json"
LONGEST = 60  # letters; a longer "licence" is the text of one

HEAD = """# Licences

This page lists the licences of everything that is installed with the service, its tests and its
documentation, as each package states them. `python -m benchmarks.supply_chain` generates it from the
installed distributions, together with a CycloneDX bill of materials, `docs/sbom.cdx.json`. The last column
names the extra (`agents`, `study`, `team` or `traces`) that needs a distribution, or *development* for
tests and documentation; the service runs without these distributions. The owner has not chosen a licence for
Crankwright itself yet.

| name | version | licence | home | |
|---|---|---|---|---|
"""


@dataclass(frozen=True)
class Component:
    """A pinned distribution."""

    name: str
    version: str
    licence: str
    home: str
    needs: tuple[str, ...]  # names, normalised


def pins() -> dict[str, str]:
    """Return name → version of all pinned distributions."""
    lines = CONSTRAINTS.read_text().split()
    return dict(line.split("==") for line in lines)


def normalised(name: str) -> str:
    """Return a name in the normalised form of PEP 503."""
    return re.sub(r"[-_.]+", "-", name).lower()


def component(name: str) -> Component:
    """Return the metadata of an installed distribution."""
    package = distribution(name)
    return Component(name, package.version, _licence(package), _home(package), _needs(package))


def _needs(package: Distribution) -> tuple[str, ...]:
    """Return the normalised names of the dependencies of a distribution without extras."""
    needs = (need for need in package.requires or () if "extra ==" not in need)
    return tuple(sorted({normalised(re.split(r"[^\w.-]", need, maxsplit=1)[0]) for need in needs}))


def _licence(package: Distribution) -> str:
    metadata: Any = package.metadata
    classified = [
        line.rpartition("::")[2].strip()
        for line in metadata.get_all("Classifier", ())
        if line.startswith("License ::") and line != "License :: OSI Approved"
    ]
    written = (metadata.get("License") or "").strip()
    short = written if len(written) <= LONGEST and "\n" not in written else ""
    return metadata.get("License-Expression") or " / ".join(classified) or short or _from_text(package)


def _from_text(package: Distribution) -> str:
    """Return the first line of the licence text, which usually names the licence."""
    for path in package.files or ():
        if re.match(r"(licen[cs]e|copying)", path.name.lower()):
            lines = (line.strip() for line in path.read_text().splitlines())
            return next((line[:LONGEST] for line in lines if line), "not stated")
    return "not stated"


def _home(package: Distribution) -> str:
    metadata: Any = package.metadata
    urls = dict(line.split(", ", 1) for line in metadata.get_all("Project-URL", ()))
    named = {name.lower(): url for name, url in urls.items()}
    ways = ("homepage", "home", "source", "repository", "source code", "github", "documentation")
    return metadata.get("Home-page") or next((named[way] for way in ways if way in named), "")


EXTRAS = {
    "httptools",
    "uvloop",
    "watchfiles",
    "websockets",
    "python-dotenv",
    "pyyaml",
}  # dependencies of uvicorn[standard]


OFFERED = ("agents", "study", "team", "traces")  # extras that a user may install


def needed(components: dict[str, Component], extra: str | None = None) -> set[str]:
    """Return the normalised names of all distributions that the service or one of its extras needs."""
    wanted, seen = {*_needed_directly(extra), *([] if extra else EXTRAS)}, set[str]()
    while more := wanted - seen:
        seen |= more
        wanted = {need for name in more if name in components for need in components[name].needs}
    return seen


def _needed_directly(extra: str | None = None) -> Iterator[str]:
    """Yield the names, normalised, of the dependencies in pyproject.toml.

    An old installation may have others.
    """
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    needs = project["optional-dependencies"][extra] if extra else project["dependencies"]
    for need in needs:
        name, extra_of_it = re.findall(r"^([\w.-]+)(?:\[(\w+)\])?", need)[0]
        yield normalised(name)
        if extra_of_it:
            yield normalised(f"{name}-{extra_of_it}")  # psycopg[binary] brings psycopg-binary


def licences(components: dict[str, Component]) -> str:
    """Return the list of licences as a page."""
    marks = dict.fromkeys(components, "*development*")
    for extra in OFFERED:
        for key in needed(components, extra) & {key for key in marks if marks[key] == "*development*"}:
            marks[key] = f"`{extra}`"
    marks |= dict.fromkeys(needed(components) & set(marks), "")
    rows = [
        f"| {one.name} | {one.version} | {one.licence} | {one.home} | {marks[key]} |"
        for key, one in sorted(components.items())
    ]
    return HEAD + "\n".join(rows) + "\n"


def bill(components: dict[str, Component], hashes: dict[str, str]) -> str:
    """Return the bill of materials (CycloneDX 1.6); equal components give equal text."""
    ours = distribution("crankwright").version
    root = {"type": "application", "bom-ref": "crankwright", "name": "crankwright", "version": ours}
    return json.dumps(
        {
            "bomFormat": "CycloneDX",
            "specVersion": "1.6",
            "version": 1,
            "metadata": {"component": root},
            "components": [_entry(one, hashes.get(key)) for key, one in sorted(components.items())],
            "dependencies": list(_graph(components)),
        },
        indent=1,
    ) + "\n"  # fmt: skip


def _entry(one: Component, sha256: str | None) -> dict[str, object]:
    hashed = {"hashes": [{"alg": "SHA-256", "content": sha256}]} if sha256 else {}
    return {
        "type": "library",
        "bom-ref": _reference(one),
        "name": one.name,
        "version": one.version,
        "licenses": [{"license": {"name": one.licence}}],
        "purl": _reference(one),
        **hashed,
    }


def _reference(one: Component) -> str:
    return f"pkg:pypi/{normalised(one.name)}@{one.version}"


def _graph(components: dict[str, Component]) -> Iterator[dict[str, object]]:
    """Yield the dependencies between the components."""
    yield _edges("crankwright", tuple(sorted(_needed_directly())), components)
    for _, one in sorted(components.items()):
        yield _edges(_reference(one), one.needs, components)


def _edges(reference: str, needs: tuple[str, ...], components: dict[str, Component]) -> dict[str, object]:
    references = [_reference(components[need]) for need in needs if need in components]
    return {"ref": reference, "dependsOn": references}


def index_hashes() -> dict[str, str]:
    """Return name → SHA-256 of the file that pip uses for each pin; nothing is installed."""
    with tempfile.NamedTemporaryFile(suffix=".json") as report:
        options = ["--dry-run", "--ignore-installed", "--no-deps", "--quiet", "--report", report.name]
        subprocess.run([sys.executable, "-m", "pip", "install", *options, "-r", str(CONSTRAINTS)], check=True)
        items = json.loads(Path(report.name).read_text())["install"]
    files = {normalised(one["metadata"]["name"]): one["download_info"]["archive_info"] for one in items}
    return {name: info["hashes"]["sha256"] for name, info in files.items()}


def locked() -> dict[str, str]:
    """Return the name → SHA-256 from the lock."""
    rows = re.findall(r"^(\S+)==\S+ --hash=sha256:([0-9a-f]{64})$", LOCK.read_text(), re.MULTILINE)
    return {normalised(name): sha256 for name, sha256 in rows}


def write_lock() -> None:
    """Write names, versions and hashes, without addresses."""
    hashes = index_hashes()
    lines = [
        f"{name}=={version} --hash=sha256:{hashes[normalised(name)]}" for name, version in pins().items()
    ]
    platform = f"CPython {sys.version_info.major}.{sys.version_info.minor} on {sys.platform}"
    LOCK.write_text(f"# {platform}: python -m benchmarks.supply_chain --hashes\n" + "\n".join(lines) + "\n")


def main() -> None:
    """Write the files, and the lock if requested."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--hashes", action="store_true", help="ask the index, and write requirements.lock")
    if parser.parse_args().hashes:
        write_lock()
    components = {normalised(name): component(name) for name in pins()}
    LICENCES.write_text(licences(components))
    BILL.write_text(bill(components, locked()))
    print(f"{len(components)} distributions in {LICENCES.name}, {BILL.name}")


if __name__ == "__main__":
    main()
