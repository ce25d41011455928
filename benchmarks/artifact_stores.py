"""Cost of a bucket beside a folder: to put a file, to read it first on a machine, and again.

Run `python -m benchmarks.artifact_stores`. The bucket is that of an S3 server on loopback that keeps objects
in memory (moto): a real one adds its network. Ratios hold; times depend on the machine.
"""

import os
import statistics
import tempfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TypeVar

from app.settings import Settings
from app.storage.artifacts import Artifacts
from app.storage.folder import DataFolder
from app.storage.opening import opened_store
from app.team.object_store import AWS, ObjectStore

SIZES = {"3 kB": 3_000, "300 kB": 300_000, "20 MB": 20_000_000}
FILES = 15
T = TypeVar("T")
R = TypeVar("R")
OPERATIONS = ("put", "first read", "read again", "exists", "put again")


def main() -> None:
    """Print the table."""
    os.environ.update(AWS)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        server = ObjectStore(folder)
        try:
            place = {"artifacts_url": server.create("artifacts"), "s3_endpoint": server.endpoint}
            print(f"median of {FILES} files [ms]; in brackets: times the folder's")
            print(f"{'':8}{'':14}" + "".join(f"{name:>18}" for name in OPERATIONS))
            for label, size in SIZES.items():
                local = opened(folder / f"local {size}", {})
                shared = opened(folder / f"mounted {size}", {"artifacts_url": f"file://{folder}/shared"})
                here = opened(folder / f"here {size}", place)
                there = opened(folder / f"there {size}", place)
                base = timed(local, local, size)
                for store, times in (
                    ("folder", base),
                    ("shared folder", timed(shared, shared, size)),
                    ("bucket", timed(here, there, size)),
                ):
                    cells = (f"{t:9.2f} ({t / b:6.1f})" for t, b in zip(times, base, strict=True))
                    print(f"{label:8}{store:14}" + "".join(cells))
        finally:
            server.close()


def opened(data: Path, place: dict[str, str]) -> Artifacts:
    """The store of a server."""
    folder = DataFolder(data)
    folder.release()
    return opened_store(Settings(data=data, **place), folder)


def timed(writer: Artifacts, reader: Artifacts, size: int) -> list[float]:
    """The median times of the operations [ms]; another machine reads what one has put."""
    blobs = [os.urandom(size) for _ in range(FILES)]
    put, hashes = median(writer.put, blobs)
    asked = (reader.read, reader.read, reader.exists)
    return [put, *(median(ask, hashes)[0] for ask in asked), median(writer.put, blobs)[0]]


def median(call: Callable[[T], R], given: Iterable[T]) -> tuple[float, list[R]]:
    """The median time of calls [ms], and what they return."""
    times, answers = [], []
    for one in given:
        begun = time.perf_counter()
        answers.append(call(one))
        times.append(time.perf_counter() - begun)
    return statistics.median(times) * 1e3, answers


if __name__ == "__main__":
    main()
