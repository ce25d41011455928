"""Count the outcomes of the regions of Mathcad's sheets in a folder.

`python -m benchmarks.mathcad_import DIR` imports every .mcdx and .xmcd below the folder; none is part of
this project. It prints a line for each, the totals, why regions are refused, and what differs.

Translated is what has a line in the worksheet or needs none: verified, unverified, differs and shown.
Compared are the results that Mathcad stored as a number or a list of numbers, of regions that are translated.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from pathlib import Path

from app.plain import JsonObject
from app.worksheets.importing.errors import SheetNotRead
from app.worksheets.importing.job import imported
from app.worksheets.importing.record import STATES, counted

TRANSLATED = ("verified", "unverified", "differs", "shown")


def main(folder: Path) -> None:
    """Print the tables of a folder."""
    for kind in ("mcdx", "xmcd"):
        records = {
            path.stem: record for path in sorted(folder.rglob(f"*.{kind}")) if (record := _record(path))
        }
        if records:
            _print(kind, records)


def _record(path: Path) -> JsonObject | None:
    begun = time.perf_counter()
    try:
        record = imported(path.read_bytes(), path.stem).record
    except SheetNotRead as error:
        print(f"{path.name}: refused: {error}")
        return None
    return {**record, "seconds": time.perf_counter() - begun}


def _print(kind: str, records: dict[str, JsonObject]) -> None:
    print(f"{f'.{kind}':36} {'regions':>8} {'share':>6} " + " ".join(f"{state:>10}" for state in STATES))
    total: Counter[str] = Counter()
    shares: Counter[str] = Counter()
    for name, record in records.items():
        counts = counted(record)
        total.update(counts)
        share = _share(counts)
        shares[_class(share)] += 1
        row = " ".join(f"{counts[state]:10}" for state in STATES)
        print(f"{name[:36]:36} {sum(counts.values()):8} {share:6.0%} {row}")
    row = " ".join(f"{total[state]:10}" for state in STATES)
    print(f"{f'{len(records)} sheets':36} {sum(total.values()):8} {_share(total):6.0%} {row}")
    print(
        "sheets by share translated:",
        ", ".join(f"{words}: {count}" for words, count in sorted(shares.items())),
    )
    _print_results(records, total)


def _print_results(records: dict[str, JsonObject], total: Counter[str]) -> None:
    regions = [(name, region) for name, record in records.items() for region in record["regions"]]
    stored = sum(bool(region["mathcad"]) for _, region in regions)
    compared = sum(bool(region["mathcad"] and region["worksheet"]) for _, region in regions)
    lists = sum(region["is_list"] and region["state"] == "verified" for _, region in regions)
    met = total["verified"]
    print(
        f"stored results that are numbers or lists: {stored}; compared: {compared}; met within 1e-9: {met}",
        end="",
    )
    print(f" ({met / max(compared, 1):.1%} of those compared), {lists} of them lists")
    print(f"slowest sheet: {max(record['seconds'] for record in records.values()):.2f} s")
    refused = Counter(
        region["reason"].partition(" (")[0] for _, region in regions if region["state"] == "refused"
    )
    print("refused:", "; ".join(f"{count} {reason}" for reason, count in refused.most_common()))
    for name, region in regions:
        if region["state"] == "differs":
            ours, theirs = region["worksheet"][:5], region["mathcad"][:5]
            place = f"{name}, region {region['region']}, {region['name']}"
            print(f"differs: {place}: worksheet {ours}, Mathcad {theirs}")
    print()


def _share(counts: dict[str, int] | Counter[str]) -> float:
    regions = sum(counts.values())
    return sum(counts[state] for state in TRANSLATED) / regions if regions else 1.0


def _class(share: float) -> str:
    return (
        "4 less than half"
        if share < 0.5
        else "3 half"
        if share < 0.8
        else "2 80 %"
        if share < 1
        else "1 whole"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]))
