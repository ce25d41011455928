"""The bare FastAPI service that `benchmarks.service` compares with: it parses, checks and answers, no more.

`python -m benchmarks.service_bare PORT ANSWERS`; ANSWERS is a JSON file of answers by name. `/dict/{name}`
returns an answer as a plain endpoint does, a dict that FastAPI renders; `/ready/{name}` returns its bytes as
they are, the least that any endpoint with this model and this answer can do.
"""

import json
import sys
from pathlib import Path
from typing import Any

import uvicorn
from fastapi import FastAPI, Response
from pydantic import BaseModel


class Body(BaseModel):
    """The body of `evaluate` as one would write it without thinking."""

    inputs: dict[str, Any]
    outputs: list[str] | None = None


def create_app(answers: dict[str, Any]) -> FastAPI:
    """Two endpoints."""
    app = FastAPI()
    ready = {name: json.dumps(answer, ensure_ascii=False).encode() for name, answer in answers.items()}

    @app.get("/healthz")
    async def healthz() -> dict[str, str]:
        return {"status": "ok"}

    @app.post("/dict/{name}")
    async def as_dict(name: str, body: Body) -> dict[str, Any]:
        return answers[name]

    @app.post("/ready/{name}")
    async def as_bytes(name: str, body: Body) -> Response:
        return Response(ready[name], media_type="application/json")

    return app


def main() -> None:
    """Serve, with the settings of `crankwright serve`."""
    answers = json.loads(Path(sys.argv[2]).read_text())
    uvicorn.run(create_app(answers), host="127.0.0.1", port=int(sys.argv[1]), log_level="warning")


if __name__ == "__main__":
    main()
