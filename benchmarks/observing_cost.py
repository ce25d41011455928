"""Cost of ids, figures and the clock of bodies for one evaluation: processor time with them and without.

python -m benchmarks.observing_cost
"""

import json
import statistics
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import uvloop
from starlette.types import ASGIApp, Message

from app.api.gate.observing import Observed
from app.api.gate.timeouts import WHOLE, BodyTime
from app.calculations.schemas import OIL_FILM
from app.main import create_app
from app.settings import Settings

PATH = "/api/v1/templates/oil_film/versions/1/evaluate"
BODY = json.dumps({"inputs": OIL_FILM, "outputs": ["minimum_film_thickness"]}).encode()
TURNS, CALLS = 60, 150


def _scope(app: Any) -> dict[str, Any]:
    headers = {"host": "127.0.0.1:8000", "content-type": "application/json", "content-length": str(len(BODY))}
    return {
        "type": "http", "asgi": {"version": "3.0"}, "http_version": "1.1", "method": "POST", "scheme": "http",
        "path": PATH, "raw_path": PATH.encode(), "query_string": b"", "root_path": "", "state": {},
        "server": ("127.0.0.1", 8000), "client": ("127.0.0.1", 1), "app": app, WHOLE: True,
        "headers": [(name.encode(), value.encode()) for name, value in headers.items()],
    }  # fmt: skip


async def _seconds(layers: ASGIApp, app: Any) -> float:
    """Processor time of one call [s]."""

    async def receive() -> Message:
        return {"type": "http.request", "body": BODY, "more_body": False}

    async def send(message: Message) -> None:
        assert message.get("status", 200) == 200

    start = time.process_time()
    for _ in range(CALLS):
        await layers(_scope(app), receive, send)
    return (time.process_time() - start) / CALLS


async def _measure() -> None:
    with TemporaryDirectory() as folder:
        app = create_app(Settings(data=Path(folder) / "data"))
        async with app.router.lifespan_context(app):
            observed = app.build_middleware_stack()
            assert isinstance(observed, Observed)
            ratios = [await _ratio(observed, app) for _ in range(TURNS)]
    quartiles = statistics.quantiles(ratios, n=4)
    print(f"evaluate with ids, figures and clock of bodies / without: {quartiles[1]:.3f}", quartiles)


async def _ratio(observed: Observed, app: Any) -> float:
    """Times of one turn: with all layers, and without each of them."""
    with_all = await _seconds(observed, app)
    holder: Any = observed.app
    while not isinstance(holder.app, BodyTime):
        holder = holder.app
    timed = holder.app
    holder.app = timed.app
    without = await _seconds(observed.app, app)
    holder.app = timed
    return with_all / without


if __name__ == "__main__":
    uvloop.run(_measure())
