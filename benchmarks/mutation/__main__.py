"""Try random mutants and print the figure; `python -m benchmarks.mutation --help` names the options.

Exits with 1 if a mutant survives without a reason, fewer than 85 % are killed, or more than 10 % are called
equivalent.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Lock
from typing import Any

from benchmarks.mutation import ROOT
from benchmarks.mutation.named import named
from benchmarks.mutation.places import Mutant, sample
from benchmarks.mutation.related import NEAREST, related
from benchmarks.mutation.trial import Copies, Copy, Reach, fingerprint, row
from benchmarks.mutation.verdict import REASONS, UNDECIDED, reasons, report, summary, verdict


def arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mutation", description=__doc__)
    parser.add_argument("--seed", type=int, default=12, help="of the random sample")
    parser.add_argument("--count", type=int, default=300, help="how many mutants")
    parser.add_argument("--jobs", type=int, default=2, help="how many at a time")
    parser.add_argument(
        "--limit", type=float, default=900, help="seconds of a run of tests; longer is a hang"
    )
    parser.add_argument("--nearest", type=int, default=NEAREST, help="how many test files for a file")
    parser.add_argument(
        "--only", nargs="+", default=[""], help="of the sample, those whose file and line begin so"
    )
    parser.add_argument(
        "--tests",
        nargs="+",
        help="try these test files instead of the related ones, and record what they kill",
    )
    parser.add_argument(
        "--quick",
        action="store_true",
        help="only the first pass: the nearest test file of each, for a minute",
    )
    parser.add_argument("--named", action="store_true", help="try the named mutants instead of random ones")
    parser.add_argument("--record", type=Path, help="file of results, one JSON object a line; is appended to")
    parser.add_argument(
        "--resume", action="store_true", help="skip what the record has, if its files are the same"
    )
    parser.add_argument(
        "--report", type=Path, help="try none: sum up what the record has, and write the figures here"
    )
    parser.add_argument("--list", action="store_true", help="print the mutants and try none")
    return parser.parse_args()


def main() -> None:
    """Try the mutants and exit with the verdict."""
    options = arguments()
    chosen = named(REASONS)[: options.count] if options.named else sample(options.seed, options.count)
    chosen = [mutant for mutant in chosen if f"{mutant.file}:{mutant.line}".startswith(tuple(options.only))]
    if options.list:
        print("\n".join(f"{m.key} {m.file}:{m.line} {m.operator}\n{m.diff}" for m in chosen))
        return
    print(f"seed {options.seed}, {len(chosen)} mutants", flush=True)
    rows = valid(chosen, options) if options.report else results(chosen, options)
    outcome = verdict(rows, reasons())
    print(report(rows, outcome))
    if options.report:
        about = {"seed": options.seed, "commit": commit(), "sample": len(chosen)}
        figures = {**about, **summary(rows, outcome)}
        options.report.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    sys.exit(not outcome.holds)


def commit() -> str:
    """Return the commit of the tree that is tried."""
    command = ["git", "describe", "--always", "--dirty", "--exclude=*"]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


def valid(chosen: Sequence[Mutant], options: argparse.Namespace) -> list[dict[str, Any]]:
    """Return the rows of the record that still hold; for a report also those that are not decided."""
    earlier = recorded(options.record)
    current = {mutant.key: row(mutant, related(mutant.file, options.nearest)) for mutant in chosen}
    held = {key: old for key, old in earlier.items() if key in current}
    open_ones = [
        key
        for key, old in held.items()
        if old["outcome"] in UNDECIDED and old["code"] == current[key]["code"]
    ]
    return [
        old
        for key, old in held.items()
        if is_valid(old, current[key]) or (options.report and key in open_ones)
    ]


def results(chosen: Sequence[Mutant], options: argparse.Namespace) -> list[dict[str, Any]]:
    """Return a row for each mutant, from the record or from a trial."""
    is_resumed = options.resume and options.record
    earlier = recorded(options.record) if is_resumed else {}
    rows = {str(old["key"]): old for old in valid(chosen, options)} if is_resumed else {}
    ahead = [mutant for mutant in chosen if mutant.key not in rows]
    ahead.sort(key=lambda mutant: mutant.key in earlier)  # new mutants first, in case the run is cut short
    left_over = {mutant.key for mutant in ahead if is_left_over(earlier.get(mutant.key), mutant)}
    lock = Lock()
    with TemporaryDirectory(prefix="mutants-") as folder, ThreadPoolExecutor(options.jobs) as threads:
        kept = options.record and options.record.resolve().with_name("observations")
        copies = Copies(Path(folder), options.limit, options.nearest, kept, tuple(options.tests or ()))
        passes = (Reach.NEAREST,) if options.tests or options.quick else tuple(Reach)
        for reach in passes:  # the nearest tests kill most mutants, so they run first
            attempt = partial(tried, copies, options.record, lock, reach)
            is_done = reach is Reach.NEAREST and len(passes) > 1
            skipped = rows.keys() | left_over if is_done else rows.keys()
            results = filter(None, threads.map(attempt, [one for one in ahead if one.key not in skipped]))
            rows |= {str(result["key"]): result for result in results}
    return [rows[mutant.key] for mutant in chosen if mutant.key in rows]


def tried(
    copies: Copies, record: Path | None, lock: Lock, reach: Reach, mutant: Mutant
) -> dict[str, Any] | None:
    """Try a mutant, and record the result at once if there is one."""

    def work(copy: Copy) -> dict[str, object] | None:
        return copy.try_out(mutant, reach)

    result = copies.using(work)
    if result is None:
        undecided = {**row(mutant, related(mutant.file)), "outcome": "undecided", "by": "", "seconds": 0}
        with lock:
            keep(record, undecided)
        return None
    with lock:
        print(
            f"{result['outcome']:9} {mutant.file}:{mutant.line} {result['by']} ({result['seconds']} s)",
            flush=True,
        )
        keep(record, result)
    return result


def is_left_over(old: dict[str, Any] | None, mutant: Mutant) -> bool:
    """Return whether a first pass has left a mutant for the second, and its file is as it was then."""
    return old is not None and old["outcome"] == "undecided" and old["code"] == fingerprint((mutant.file,))


def keep(record: Path | None, result: dict[str, Any]) -> None:
    """Append a row to the record, if there is one."""
    if record:
        with record.open("a", encoding="utf-8") as file:
            file.write(json.dumps(result) + "\n")


def recorded(record: Path) -> dict[str, dict[str, Any]]:
    """Return the rows of a record, the last of each mutant."""
    if not record.exists():
        return {}
    rows = map(json.loads, record.read_text(encoding="utf-8").splitlines())
    return {row["key"]: row for row in rows}


def is_valid(old: dict[str, Any], new: dict[str, object]) -> bool:
    """Return whether an older result still holds.

    Same change, same code, and for a survivor the same tests.
    """
    same = all(old[name] == new[name] for name in ("file", "diff", "code"))
    is_decided = old["outcome"] not in UNDECIDED
    return same and is_decided and (old["outcome"] == "killed" or old["tests"] == new["tests"])


if __name__ == "__main__":
    main()
