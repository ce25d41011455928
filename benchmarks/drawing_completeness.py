"""List what drawings of the library do not define: `python -m benchmarks.drawing_completeness [MODEL ...]`.

Of every model at three sizes: what no dimension gives, and dimensions that others give already but that stand
without brackets (ISO 129-1).
"""

from __future__ import annotations

import sys

from benchmarks.drawings import SIZES, latest, sized
from cad.drafting.content import Content, content_of
from cad.file_kinds import bodies_of
from cad.header import read_header
from cad.step import read_step


def faults(content: Content) -> list[str]:
    """Return in words what is missing on a drawing, and what is given twice; nothing of an assembly."""
    if content.undefined is None:
        return []  # its parts have sheets of their own
    twice = [
        f"{one.name or 'a position'}, {one.measure.value:.6g}, is given twice"
        for one in content.dimensions
        if not one.is_reference and not content.missing(one)
    ]
    return [*content.missing(), *twice]


def faults_of(step: bytes) -> list[str]:
    """Return the faults of all sheets of a STEP file: that of all parts, and that of each part."""
    whole, header = read_step(step), read_header(step)
    found = faults(content_of(whole, header))
    for body in whole if len(whole) > 1 else ():
        sheet = content_of(bodies_of(f"dxf#{body.name}", whole), header, whole)
        found += [f"{body.name}: {one}" for one in faults(sheet)]
    return found


def main(names: list[str]) -> None:
    """Print the faults of every drawing, and their number."""
    count = 0
    for model in latest():
        if names and model.id not in names:
            continue
        for factor in SIZES:
            found = faults_of(sized(model, factor).step)
            count += len(found)
            print(f"{model.id} x{factor:g}: {len(found)}", *found, sep="\n  ")
    print(f"{count} in all")


if __name__ == "__main__":
    main(sys.argv[1:])
