"""A typed client of the REST interface, over httpx.

with Client("http://127.0.0.1:8000") as client:
    answer = client.evaluate("oil_film", 1, {"radial_load": "25 kN", …})
    design = client.create({"name": "main bearing", …})
    design = client.change(design, {"parameters": {"scale": "1.02"}})
    step = client.model(design.id, "step")
"""

from __future__ import annotations

import getpass
import json
import re
import socket
import uuid
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Self

import httpx

Progress = Callable[[float, str], None]

BASE = "/api/v1"
CLIENT_HEADER = "Crankwright-Client"
_NAME = re.compile("[!-~]([ -~]{0,98}[!-~])?")  # up to 100 printable ASCII characters, no blank at an end
_RETRIES = 3  # of the transport, for a connection that is refused


class Problem(Exception):
    """The service's answer to what it refuses (RFC 9457); `errors` names every wrong input."""

    def __init__(self, status: int, body: Mapping[str, Any]) -> None:
        self.status, self.body = status, body
        self.errors: list[dict[str, str]] = list(body.get("errors", ()))
        super().__init__(f"{status} {body.get('title', '')}: {body.get('detail', '')}")


@dataclass(frozen=True)
class Design:
    """A design as of one revision; `job` is the job that regenerates it, if that goes on."""

    id: str
    name: str
    revision: int
    state: str
    problem: dict[str, Any] | None
    parameters: dict[str, Any]
    steps: dict[str, Any]
    models: dict[str, Any]
    job: str | None


class Client:
    """A connection to a service.

    Parameters
    ----------
    url
        Where the service listens, such as `http://127.0.0.1:8000`.
    timeout
        How long an answer may take [s].
    name
        Under which name the service counts this client's requests, and takes turns between clients: up to 100
        printable ASCII characters. If not given, `user@host`.

    Raises
    ------
    ValueError
        If the name is no such text.
    """

    def __init__(self, url: str, *, timeout: float = 60.0, name: str | None = None) -> None:
        self.url, self.name = url, user_at_host() if name is None else name
        if not _NAME.fullmatch(self.name):
            raise ValueError(
                f"{self.name[:110]!r} is no client's name: use 1 to 100 printable ASCII characters, such as "
                "design-office-7"
            )
        self._http = httpx.Client(
            base_url=url,
            timeout=timeout,
            headers={CLIENT_HEADER: self.name},
            transport=httpx.HTTPTransport(retries=_RETRIES),
            trust_env=False,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the connection."""
        self._http.close()

    def healthy(self) -> bool:
        """Whether the service answers."""
        try:
            return self._http.get("/healthz").is_success
        except httpx.TransportError:
            return False

    def templates(self) -> list[dict[str, Any]]:
        """Every version of every template."""
        return list(self._pages(f"{BASE}/templates"))

    def template(self, id: str, version: int) -> dict[str, Any]:
        """One version with its inputs, outputs, formulas, limits and errata."""
        return self._json("GET", f"{BASE}/templates/{id}/versions/{version}")

    def evaluate(self, id: str, version: int, inputs: Mapping[str, Any], **options: Any) -> dict[str, Any]:
        """Evaluate a template; options are `outputs`, `level`, `tolerance`, `units`.

        What takes long goes on as a job, which is followed.
        """
        body = {"inputs": inputs, **options}
        return self._calculated(f"{BASE}/templates/{id}/versions/{version}/evaluate", body)

    def solve(
        self,
        id: str,
        version: int,
        inputs: Mapping[str, Any],
        unknown: str,
        bounds: tuple[str, str],
        target: Mapping[str, str],
    ) -> dict[str, Any]:
        """Find the input that gives a wanted output."""
        body = {"inputs": inputs, "unknown": unknown, "bounds": bounds, "target": target}
        return self._calculated(f"{BASE}/templates/{id}/versions/{version}/solve", body)

    def analyse(
        self,
        id: str,
        version: int,
        parameters: Mapping[str, Any],
        kind: str = "torsion",
        *,
        on_progress: Progress | None = None,
        **options: Any,
    ) -> dict[str, Any]:
        """Analyse a model's solid; options are `boundary`, `level` or `tolerance`, `load`, `outputs`."""
        path, body = f"{BASE}/models/{id}/versions/{version}/analyses/{kind}", {"parameters": parameters}
        answer = self._send("POST", path, json={**body, **options})
        if answer.status_code == 202:
            job = answer.headers["Location"].rpartition("/")[2]
            self.follow(job, on_progress)
            if problem := self.job(job)["problem"]:
                raise Problem(problem["status"], problem)
            answer = self._send("POST", path, json={**body, **options})
        found: dict[str, Any] = answer.json()
        return found

    def surface(self, analysis: str) -> dict[str, Any]:
        """The surface that an analysis found; its `outputs` must have named it."""
        return self._json("GET", f"{BASE}/analyses/{analysis}/surface")

    def designs(self) -> list[dict[str, Any]]:
        """All designs, newest first."""
        return list(self._pages(f"{BASE}/designs"))

    def design(self, id: str) -> Design:
        """A design as of its newest revision."""
        return _design(self._send("GET", f"{BASE}/designs/{id}"))

    def create(
        self, document: Mapping[str, Any], *, on_progress: Progress | None = None, key: str | None = None
    ) -> Design:
        """A new design, once its models are built."""
        answer = self._send("POST", f"{BASE}/designs", json=document, headers=_once(key))
        return self._followed(_design(answer), on_progress)

    def change(
        self,
        design: Design,
        patch: Mapping[str, Any],
        *,
        on_progress: Progress | None = None,
        key: str | None = None,
    ) -> Design:
        """A new revision of a design that was read, once its models are built."""
        headers = {"If-Match": f'"{design.revision}"', **_once(key)}
        answer = self._send("PATCH", f"{BASE}/designs/{design.id}", json=patch, headers=headers)
        return self._followed(_design(answer), on_progress)

    def preview(self, id: str, patch: Mapping[str, Any]) -> dict[str, Any]:
        """What a change would do; nothing is saved. What takes long goes on as a job, which is followed."""
        return self._calculated(f"{BASE}/designs/{id}/preview", patch)

    def auto_map(self, id: str) -> list[dict[str, str]]:
        """Proposals for model parameters that are not set."""
        proposals: list[dict[str, str]] = self._json("POST", f"{BASE}/designs/{id}/auto-map")["proposals"]
        return proposals

    def revision(self, id: str, number: int) -> dict[str, Any]:
        """A revision with its results."""
        return self._json("GET", f"{BASE}/designs/{id}/revisions/{number}")

    def revisions(self, id: str) -> list[dict[str, Any]]:
        """All revisions, newest first."""
        return list(self._pages(f"{BASE}/designs/{id}/revisions"))

    def measurements(self, id: str) -> dict[str, Any]:
        """What the newest good models measure."""
        return self._json("GET", f"{BASE}/designs/{id}/measurements")

    def build(self, key: str) -> dict[str, Any]:
        """A build: its files and what was measured on it."""
        return self._json("GET", f"{BASE}/builds/{key}")

    def model(self, id: str, kind: str = "step") -> bytes:
        """A file of the design's newest good model: step, glb, stl, svg, drawing.svg, dxf or png."""
        answer = self._send("GET", f"{BASE}/designs/{id}/model.{kind}", headers={"Prefer": "wait=60"})
        return answer.content

    def report(self, id: str, kind: str = "pdf") -> bytes:
        """The calculation report of the design's newest revision: pdf or html."""
        return self._send("GET", f"{BASE}/designs/{id}/report.{kind}").content

    def verify(self, step: bytes) -> dict[str, Any]:
        """From which build a STEP file is, and which revisions use it."""
        return self._json("POST", f"{BASE}/verify", content=step, headers={"Content-Type": "model/step"})

    def job(self, id: str) -> dict[str, Any]:
        """A job."""
        return self._json("GET", f"{BASE}/jobs/{id}")

    def follow(self, job: str, on_progress: Progress | None = None) -> None:
        """Wait until a job has ended, telling its progress."""
        with self._http.stream("GET", f"{BASE}/jobs/{job}/events", timeout=None) as stream:
            for line in stream.iter_lines():
                told = json.loads(line.removeprefix("data:")) if line.startswith("data:") else {}
                if on_progress and told.get("event") == "progress":
                    on_progress(told["progress"], told["text"])

    def _calculated(self, path: str, body: Mapping[str, Any]) -> dict[str, Any]:
        """The answer of a calculation, once its job has ended if it became one."""
        answer = self._send("POST", path, json=body)
        if answer.status_code == 202:
            job = answer.headers["Location"].rpartition("/")[2]
            self.follow(job)
            return self._json("GET", f"{BASE}/evaluations/{job}")
        found: dict[str, Any] = answer.json()
        return found

    def _followed(self, design: Design, on_progress: Progress | None) -> Design:
        if design.job is None:
            return design
        self.follow(design.job, on_progress)
        return self.design(design.id)

    def _pages(self, path: str) -> Iterator[dict[str, Any]]:
        cursor: str | None = ""
        while cursor is not None:
            found = self._json("GET", path, params={"cursor": cursor} if cursor else {})
            yield from found["items"]
            cursor = found["next"]

    def _json(self, method: str, path: str, **options: Any) -> dict[str, Any]:
        answer: dict[str, Any] = self._send(method, path, **options).json()
        return answer

    def _send(self, method: str, path: str, **options: Any) -> httpx.Response:
        answer = self._http.request(method, path, **options)
        if answer.is_error:
            try:
                body = answer.json()
            except ValueError:
                body = {"title": answer.reason_phrase, "detail": answer.text[:500]}
            raise Problem(answer.status_code, body)
        return answer


def user_at_host() -> str:
    """The user and the machine, in printable ASCII: the same whenever this user calls from here."""
    try:
        user = getpass.getuser()
    except (KeyError, OSError):  # a container may run under a number that has no name
        user = "unknown"
    return re.sub("[^!-~]", "_", f"{user}@{socket.gethostname()}")[:100]


def _once(key: str | None) -> dict[str, str]:
    """A key that makes a repeated request harmless."""
    return {"Idempotency-Key": key or uuid.uuid4().hex}


def _design(answer: httpx.Response) -> Design:
    body = answer.json()
    place = answer.headers.get("Location", "")
    job = place.rpartition("/")[2] if answer.status_code == 202 else None
    known = ("id", "name", "revision", "state", "problem", "parameters", "steps", "models")
    return Design(**{name: body[name] for name in known}, job=job)
