"""The impact of a version on 1 000 designs, through the service's own job: `python -m benchmarks.impact [N]`.

Designs that use oil_film 1 are written without calculating them; then the impact of oil_film 2 is asked for
as a client does. Four sets: designs that a worksheet sizes, of which the next version is released; designs of
one form, as a team's are; five variants in each; and every design of a form of its own, calculated by itself.
"""

from __future__ import annotations

import asyncio
import resource
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import partial
from pathlib import Path

from pydantic_core import from_json
from sqlalchemy import func, select

from app.api.services import Services
from app.assembly import assemble
from app.designs import repository
from app.designs.document import Document
from app.designs.repository import Written
from app.impact.schemas import ImpactIn
from app.impact.survey import Asked
from app.plain import JsonObject, Raw
from app.schemas.impact import Impact
from app.settings import Settings
from app.storage.idempotency import Once
from app.storage.tables import DesignRow, RevisionRow
from app.worksheets.schemas import ReviewIn, SheetIn, SheetPatch

EXAMPLE = {
    "diametral_clearance": "0.055 mm", "bearing_diameter": "= bore", "bearing_width": "= width",
    "speed": "5000 rpm", "oil_inlet_temperature": "80 degC", "oil_outlet_temperature": "87.762 degC",
}  # fmt: skip
SHEET, TEXT = (
    "bush_duty_benchmark",
    """# Bush duty
given F [kN] "radial load" (>= 0; example 25 kN)
given D [mm] "bearing diameter" (> 0; <= 2 m; example 48 mm)
given B [mm] = D / 2 "bearing width" (> 0)
p [MPa] = F / (D * B) "projected pressure"
bore [mm] = D + 0.05 mm "finished bore"
check p <= 30 MPa "white metal carries it"
test "by hand" with F = 25 kN gives p = 21.7 MPa within 0.2 %
""",
)
SHELL = {"inner_diameter": "= film.bearing_diameter + film.minimum_film_thickness", "wall": "2 mm"}


def bearing(number: int, *, own_form: bool = False, variants: int = 0) -> dict[str, Raw]:
    """A main bearing with its shell; `own_form` gives it a relation and a limit that no other has."""
    load = f"= load * {1 + number * 1e-6:.6f}" if own_form else "= load"
    limit = 2.5 + number * 1e-3 if own_form else 2.8
    return {
        "name": f"bearing {number}",
        "parameters": {"load": f"{10 + number * 0.01:.2f} kN", "bore": "48 mm", "width": "18 mm"},
        "steps": {"film": {"template": "oil_film", "version": 1, "inputs": {"radial_load": load, **EXAMPLE}}},
        "models": {"shell": {"id": "plain_bearing", "version": 1, "parameters": SHELL}},
        "criteria": {"thick": {"require": f"film.minimum_film_thickness >= {limit:.3f} um"}},
        "variants": {
            f"main_{n}": {"load": f"{12 + n + number * 0.01:.2f} kN"} for n in range(1, variants + 1)
        },
    }


def written(services: Services, documents: Iterator[dict[str, Raw]]) -> list[str]:
    """The ids of designs that are stored as they are, with no results."""
    ids = []
    for raw in documents:
        document = Document.model_validate(raw).model_dump(mode="json")
        write = partial(repository.create, name=document["name"], written=_row(document))
        ids.append(services.database.write(write)[0])
    return ids


def _row(document: JsonObject) -> Written:
    return Written(document, None, [], "current", None)


def released(services: Services, id: str, text: str) -> None:
    """Release a worksheet, or its next version."""
    sheets, once = services.worksheets, Once(None, "", "", "benchmark")
    if id in services.catalogues.templates.ids:
        sheets.change(id, SheetPatch(text=text), None, once)
    else:
        sheets.create(SheetIn(id=id, text=text), once)
    digest = sheets.test(id, None, "benchmark").digest
    sheets.review(id, ReviewIn(reviewer="B. Klein", digest=str(digest)), None)
    sheets.release(id, None, "benchmark")


def duty(number: int) -> dict[str, Raw]:
    """A bearing that is sized by the worksheet."""
    inputs = {"radial_load": f"{10 + number * 0.01:.2f} kN", "bearing_diameter": "48 mm"}
    shell = {"inner_diameter": "= duty.finished_bore", "wall": "2 mm"}
    return {
        "name": f"bush {number}",
        "steps": {"duty": {"template": SHEET, "version": 1, "inputs": inputs}},
        "models": {"shell": {"id": "plain_bearing", "version": 1, "parameters": shell}},
        "criteria": {"tight": {"require": "duty.finished_bore <= 48.055 mm"}},
    }


def counts(services: Services) -> tuple[int, int]:
    """How many designs and revisions there are."""
    with services.database.read() as session:
        designs, revisions = (
            session.scalar(select(func.count()).select_from(table)) for table in (DesignRow, RevisionRow)
        )
        return int(designs or 0), int(revisions or 0)


def impact_of(services: Services, ids: list[str], template: str = "oil_film") -> tuple[Impact, float]:
    """The impact on some designs, and how long the job took [s]."""
    start = time.perf_counter()
    job = services.impacts.requested(Asked(template, 2, ImpactIn(designs=ids, limit=10)), "benchmark")
    state = asyncio.run(services.jobs.wait(job, 3600))
    seconds = time.perf_counter() - start
    assert state == "done", services.jobs.get(job).problem
    link = services.jobs.get(job).result or ""
    answer = Impact.model_validate(from_json(services.store.read(link.rpartition("sha256=")[2])))
    return answer, seconds


def main() -> None:
    """Print the time of each set, and what was written meanwhile."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    sets: dict[str, Callable[[int], dict[str, Raw]]] = {
        "of a worksheet": duty,
        "of one form": lambda n: bearing(n),
        "with five variants each": lambda n: bearing(n, variants=5),
        "each of its own form": lambda n: bearing(n, own_form=True),
    }
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        services = assemble(Settings(data=Path(folder) / "data"), stack)
        warm = written(services, (bearing(n) for n in range(2)))
        _, first = impact_of(services, warm)
        print(f"the first call starts the calculation process: {first:.1f} s")
        released(services, SHEET, TEXT)
        for words, make in sets.items():
            ids = written(services, map(make, range(count)))
            if make is duty:
                released(services, SHEET, TEXT.replace("0.05 mm", "0.06 mm"))
            before = counts(services)
            answer, seconds = impact_of(services, ids, SHEET if make is duty else "oil_film")
            after = counts(services)
            print(
                f"{count} designs {words}: {seconds:.1f} s; {answer.moved} move, {answer.refused} refuse, "
                f"{answer.variants} variants; designs and revisions {before} before, {after} after"
            )
            assert before == after, "something was written"
            assert answer.concerned == count
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"largest memory of the server process: {peak:.0f} MiB")


if __name__ == "__main__":
    main()
