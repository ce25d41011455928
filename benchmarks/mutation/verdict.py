"""The figure: how many mutants the tests killed, and whether somebody has argued for each survivor.

A reason in `.ci/mutants.toml` names a file by its last part, the text of the line, and a part of the changed
line. `equivalent = true` says that no test can tell the two programs apart: such a mutant is left out of the
figure. Any other survivor with a reason counts as a survivor that the team accepts.
"""

from __future__ import annotations

import tomllib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.mutation import ROOT

REASONS = ROOT / ".ci" / "mutants.toml"
LEAST_KILLED = 0.85
MOST_EQUIVALENT = 0.10
UNDECIDED = ("unclear", "undecided")
"""Outcomes if a test also fails without the mutant, and if the first pass left a mutant for the second."""


@dataclass(frozen=True)
class Reason:
    """Why a mutant may survive."""

    file: str
    line: str
    change: str
    reason: str
    equivalent: bool = False

    def covers(self, row: dict[str, Any]) -> bool:
        """Return whether it is about this mutant."""
        changed = "\n".join(line[1:] for line in row["diff"].splitlines() if line.startswith("+"))
        return row["file"].endswith(self.file) and self.line == row["text"] and self.change in changed


@dataclass(frozen=True)
class Verdict:
    """The survivors of a record, and its figure."""

    tried: int
    killed: int
    equivalent: Sequence[dict[str, Any]]
    accepted: Sequence[dict[str, Any]]
    without_reason: Sequence[dict[str, Any]]
    unclear: Sequence[dict[str, Any]]

    @property
    def share(self) -> float:
        """Return the share of mutants killed, equivalent ones left out; 1 if there is none."""
        counted = self.tried - len(self.equivalent)
        return self.killed / counted if counted else 1.0

    @property
    def holds(self) -> bool:
        """Return whether each survivor has a reason, enough are killed, and few are called equivalent."""
        is_argued = not self.without_reason and not self.unclear
        return (
            is_argued and self.share >= LEAST_KILLED and len(self.equivalent) <= MOST_EQUIVALENT * self.tried
        )


def reasons(file: Path = REASONS) -> list[Reason]:
    """Return the reasons on file."""
    return [Reason(**entry) for entry in tomllib.loads(file.read_text(encoding="utf-8")).get("reason", [])]


def verdict(rows: Sequence[dict[str, Any]], argued: Sequence[Reason]) -> Verdict:
    """Sum up a record."""
    survivors = [row for row in rows if row["outcome"] == "survived"]
    reason_of = {row["key"]: next((r for r in argued if r.covers(row)), None) for row in survivors}
    equivalent = [row for row in survivors if (r := reason_of[row["key"]]) and r.equivalent]
    accepted = [row for row in survivors if (r := reason_of[row["key"]]) and not r.equivalent]
    without = [row for row in survivors if reason_of[row["key"]] is None]
    killed = sum(row["outcome"] == "killed" for row in rows)
    unclear = [row for row in rows if row["outcome"] in UNDECIDED]
    return Verdict(len(rows), killed, equivalent, accepted, without, unclear)


def report(rows: Sequence[dict[str, Any]], result: Verdict) -> str:
    """Return the figure, by folder too, and the survivors with their change."""
    lines = [
        f"{result.tried} mutants: {result.killed} killed, {len(result.equivalent)} equivalent, "
        f"{len(result.accepted)} accepted, {len(result.without_reason)} survive without a reason, "
        f"{len(result.unclear)} unclear; {result.share:.1%} of those that are not equivalent are killed"
    ]
    lines += [f"  {folder}: {killed} of {tried}" for folder, (killed, tried) in by_folder(rows).items()]
    for title, some in (("survives", result.without_reason), ("is unclear", result.unclear)):
        lines += [f"{one['file']}:{one['line']} {title} ({one['operator']})\n{one['diff']}" for one in some]
    return "\n".join(lines)


def summary(rows: Sequence[dict[str, Any]], result: Verdict) -> dict[str, Any]:
    """Return the figure for a file of results: counts, also by folder, and what was not killed."""
    groups = {name: getattr(result, name) for name in ("equivalent", "accepted", "without_reason", "unclear")}
    return {
        "tried": result.tried,
        "killed": result.killed,
        **{name: len(group) for name, group in groups.items()},
        "share": round(result.share, 4),
        "folders": {name: {"killed": k, "tried": t} for name, (k, t) in by_folder(rows).items()},
        "not_killed": [
            {"state": name, "file": one["file"], "line": one["line"], "change": one["diff"]}
            for name, group in groups.items()
            for one in group
        ],
        "killed_by": [
            {
                "file": one["file"],
                "line": one["line"],
                "change": changed(one),
                "test": one["by"].partition(" - ")[0],
            }
            for one in sorted(rows, key=lambda one: (one["file"], one["line"]))
            if one["outcome"] == "killed"
        ],
    }


def changed(row: dict[str, Any]) -> str:
    """Return the line after the change, empty if it was left out."""
    return " ".join(line[1:].strip() for line in row["diff"].splitlines() if line.startswith("+"))


def by_folder(rows: Sequence[dict[str, Any]]) -> dict[str, tuple[int, int]]:
    """Return the mutants killed and tried in each folder."""
    tried = Counter("/".join(row["file"].split("/")[:2]) for row in rows)
    killed = Counter("/".join(row["file"].split("/")[:2]) for row in rows if row["outcome"] == "killed")
    return {folder: (killed[folder], tried[folder]) for folder in sorted(tried)}
