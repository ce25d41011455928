"""One session with a running Creo through CREOSON: set values, regenerate, measure, export.

CREOSON answers a JSON POST, `{"sessionId", "command", "function", "data"}`, with `{"status": {"error",
"message"}, "data"}`. Each step that Creo can refuse has its own error code. Nothing is saved in Creo.

References
----------
SimplifiedLogic, CREOSON 3.0.1: Web Service Help, functions of `connection`, `creo`, `file`, `dimension`,
    `parameter` and `interface`; the source of its `JShellJsonHandler` and `JLJson…Handler` classes.
"""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path, PurePath
from uuid import uuid4

import httpx

from app.imported_models.creo.manifest import MM, Manifest
from app.workers.errors import DeadlineExceeded, JobCancelled
from cad.errors import GeometryError, ProgramMissing
from cad.imported_models import Description, ProgramResult

Fields = Mapping[str, object]
"""A JSON object, whose values are checked where they are used."""
LARGEST_STEP = 256 * 2**20
LONGEST_NAME = 31
"""Longest name of a file in Creo without its ending; CREOSON refuses longer names
(`JlinkUtils.validateFilename`)."""
_GLANCE = 0.05  # [s]


@dataclass(frozen=True)
class Creoson:
    """The address of CREOSON, and the folder for exports under its name for Creo and for this service."""

    url: str
    exports: str
    folder: Path
    version: int | None = None  # version of Creo, if 7 or newer, which needs other options to regenerate


def unreachable(reason: str) -> ProgramMissing:
    """Return the refusal for an unreachable Creo, with a remedy."""
    return ProgramMissing(
        "creo_unreachable", f"Creo cannot be used: {reason}. Start Creo and CREOSON, then retry"
    )


@dataclass
class CreoSession:
    """An open connection to CREOSON."""

    creoson: Creoson
    http: httpx.Client
    end: float
    seconds: float
    cancelled: threading.Event
    id: str = field(default="")

    def connect(self) -> None:
        """Connect to Creo; raise ProgramMissing if CREOSON does not answer or Creo is not running."""
        answer = self._post({"command": "connection", "function": "connect"}, "creo_unreachable", ())
        self.id = str(answer.get("sessionId") or "")
        running = self.ask("connection", "is_creo_running", {}, "creo_unreachable")
        if not self.id or running.get("running") is not True:
            raise unreachable("CREOSON answers, but Creo is not running")
        if self.creoson.version is not None:
            data = {"version": self.creoson.version}
            self.ask("creo", "set_creo_version", data, "creo_unreachable")

    def ask(
        self, command: str, function: str, data: Fields, code: str, names: tuple[str, ...] = ()
    ) -> Fields:
        """Call a function of CREOSON, and return its answer.

        The error for a refusal has this code and names these parameters.

        Raises
        ------
        GeometryError
            If Creo refuses.
        ProgramMissing, DeadlineExceeded, JobCancelled
            If it does not answer, is too slow, or the job was cancelled.
        """
        request = {"sessionId": self.id, "command": command, "function": function, "data": data}
        answered = self._post(request, code, names).get("data") or {}
        if not isinstance(answered, dict):
            raise GeometryError(
                "creo_answer", f"CREOSON's answer to {command}: {function} is not an object", names
            )
        return answered

    def _post(self, request: Fields, code: str, names: tuple[str, ...]) -> Fields:
        if self.cancelled.is_set():
            raise JobCancelled
        left = self.end - time.monotonic()
        if left <= 0:
            raise DeadlineExceeded(self.seconds)
        what = f"{request['command']}: {request['function']}"
        try:
            response = self.http.post(self.creoson.url, content=json.dumps(request), timeout=left)
            answer = response.json()
        except httpx.TimeoutException:
            raise DeadlineExceeded(self.seconds) from None
        except httpx.HTTPError as error:
            raise unreachable(f"CREOSON does not answer {what} ({type(error).__name__})") from None
        except ValueError:
            raise GeometryError("creo_answer", f"CREOSON's answer to {what} is not JSON", names) from None
        status = answer.get("status") if isinstance(answer, dict) else None
        if not isinstance(status, dict) or "error" not in status:
            raise GeometryError("creo_answer", f"CREOSON answers {what} without a status", names)
        if status["error"]:
            said = str(status.get("message") or "no reason given")[:300]
            if code == "creo_unreachable":
                raise unreachable(f"CREOSON reports for {what}: {said}")
            raise GeometryError(code, f"Creo refuses {what}: {said}", names)
        return answer  # type: ignore[no-any-return]


class CreoDrawing:
    """Draws models with Creo; only one session is open at a time."""

    def __init__(self, creoson: Creoson, seconds: float) -> None:
        self.creoson, self.seconds = creoson, seconds
        self._turn = threading.Lock()

    def draw_manifest(
        self, manifest: Manifest, described: Description, values: dict[str, float], cancelled: threading.Event
    ) -> ProgramResult:
        """Set every value, regenerate, read the mass properties, and export; see `Drawing.draw`."""
        with self._session(cancelled) as session:
            file = {"file": manifest.file}
            session.ask("file", "open", {**file, "display": False, "activate": True}, "creo_open")
            for one in described.parameters:
                kind, key = one.source.split(".", 1)
                value = values.get(one.name, one.value)
                typed = {"type": "DOUBLE", "no_create": True} if kind == "parameter" else {}
                data = {**file, "name": key, "value": value, **typed}
                session.ask(kind, "set", data, f"creo_{kind}", (one.name,))
            names = tuple(one.name for one in described.parameters)
            session.ask("file", "regenerate", file, "creo_regenerate", names)
            volume = _volume(session.ask("file", "massprops", file, "creo_mass_properties", names), names)
            step = self._exported(session, manifest, names)
        return ProgramResult(step=step, mass_volume=volume * MM[manifest.length_unit] ** 3)

    def _exported(self, session: CreoSession, manifest: Manifest, names: tuple[str, ...]) -> bytes:
        wanted = f"{f'crankwright_{uuid4().hex}'[:LONGEST_NAME]}.stp"
        data = {"file": manifest.file, "type": "STEP", "filename": wanted, "dirname": self.creoson.exports}
        answer = session.ask("interface", "export_file", data, "creo_export", names)
        name = PurePath(str(answer.get("filename", wanted)).replace("\\", "/")).name or wanted
        place = self.creoson.folder / name
        try:
            with place.open("rb") as exported:
                step = exported.read(LARGEST_STEP + 1)
        except (OSError, ValueError):
            what = f"Creo says that it exported {name[:80]!r}, and it is not in the folder for exports"
            raise GeometryError("creo_export", f"{what}: see CRANKWRIGHT_CREOSON_FOLDER", names) from None
        finally:
            with suppress(OSError, ValueError):
                if name == wanted:
                    place.unlink(missing_ok=True)
        if name != wanted or len(step) > LARGEST_STEP or not step.lstrip()[:12] == b"ISO-10303-21":
            raise GeometryError(
                "creo_export",
                f"the file that Creo exported, {name[:80]!r}, is not the requested STEP file",
                names,
            )
        return step

    @contextmanager
    def _session(self, cancelled: threading.Event) -> Iterator[CreoSession]:
        """Wait until no other session is open, then open one; close it at the end without saving changes."""
        end = time.monotonic() + self.seconds
        while not self._turn.acquire(timeout=_GLANCE):
            if cancelled.is_set():
                raise JobCancelled
            if time.monotonic() > end:
                raise DeadlineExceeded(self.seconds)
        try:
            with httpx.Client(trust_env=False) as http:
                session = CreoSession(self.creoson, http, end, self.seconds, cancelled)
                session.connect()
                try:
                    yield session
                finally:
                    with suppress(Exception):  # an earlier error matters more
                        session.ask("connection", "disconnect", {}, "creo_disconnect")
        finally:
            self._turn.release()


def _volume(properties: Fields, names: tuple[str, ...]) -> float:
    """Return the volume in the cubed length unit of the model."""
    volume = properties.get("volume")
    if isinstance(volume, bool) or not isinstance(volume, int | float) or not 0 < volume < 1e18:
        raise GeometryError(
            "creo_mass_properties", f"Creo gives the volume {volume!r}: it must be a number above 0", names
        )
    return float(volume)
