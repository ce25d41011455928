"""Settings for other machines: CRANKWRIGHT_ENGINE selects where jobs run; a collector receives traces.

Dask sends pickles, so anyone who can connect can run code. Beyond this machine, TLS authenticates both sides.
"""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, Literal
from urllib.parse import urlsplit

from pydantic import Field, ValidationInfo

from app.settings.hosts import is_loopback

LOCAL = "local"
FILES = "CRANKWRIGHT_DASK_CA, CRANKWRIGHT_DASK_CERT and CRANKWRIGHT_DASK_KEY"
Lane = Literal["geometry", "analysis"]
"""Kinds of work for which a worker has separate capacity."""
Count = Annotated[int, Field(ge=0, le=1000)]
EXAMPLE = "tls://scheduler.example:8786"
COLLECTOR = "http://127.0.0.1:4318"
TRACES = "the extra `traces` is not installed: pip install crankwright[traces]"
EXPORTER = "opentelemetry.exporter.otlp.proto.http"
TEAM = "the extra `team` is not installed: pip install 'crankwright[team]'"


def check_engine(engine: str) -> str:
    """Return the setting, if it is `local` or the permitted address of a scheduler.

    Raises
    ------
    ValueError
        If the setting is wrong; the message states the fault and a correct form.
    """
    if engine == LOCAL:
        return engine
    scheme, host = _scheme_and_host(engine)
    if scheme == "tcp" and not is_loopback(host):
        raise ValueError(f"{engine} would send jobs to other machines without TLS: use tls://, with {FILES}")
    if not is_installed():
        raise ValueError(f"{engine} needs Dask, and {TEAM}")
    return engine


def is_installed() -> bool:
    """Return whether Dask is installed."""
    return find_spec("distributed") is not None


def check_collector(url: str | None) -> str | None:
    """Return the address of the collector of traces, if it is valid and OpenTelemetry is installed.

    Raises
    ------
    ValueError
        If the setting is wrong; the message states the fault and a correct form.
    """
    if url is None:
        return None
    try:
        parts = urlsplit(url)
        is_address = parts.scheme in ("http", "https") and parts.hostname and parts.port != 0
    except ValueError:  # of a port that is not a number
        is_address = False
    if not is_address or parts.query or parts.fragment or parts.username:
        raise ValueError(f"give an address without user or query for traces, such as {COLLECTOR}")
    if not has_traces():
        raise ValueError(f"traces need OpenTelemetry, and {TRACES}")
    return url


def has_traces() -> bool:
    """Return whether OpenTelemetry and its exporter are installed."""
    try:
        return find_spec("opentelemetry.sdk") is not None and find_spec(EXPORTER) is not None
    except ModuleNotFoundError:  # of a package above the exporter
        return False


def _scheme_and_host(engine: str) -> tuple[str, str]:
    wrong = f"{engine!r} is neither `local` nor the address of a Dask scheduler, such as {EXAMPLE}"
    try:
        parts = urlsplit(engine)
        is_address = parts.scheme in ("tcp", "tls") and parts.hostname and parts.port
    except ValueError:  # of a port that is not a number
        is_address = False
    if not is_address or parts.path or parts.query or parts.username:
        raise ValueError(wrong)
    return parts.scheme, parts.hostname or ""


def check_lanes(lanes: dict[Lane, int]) -> dict[Lane, int]:
    """Return the slots of a worker by lane, if there is at least one.

    Raises
    ------
    ValueError
        If there is none.
    """
    if not any(lanes.values()):
        raise ValueError('a worker needs at least one slot, such as {"geometry": 1}')
    return lanes


def check_certificate(file: Path | None, info: ValidationInfo) -> Path | None:
    """Return a TLS file, which must exist if the engine is `tls://…`.

    Raises
    ------
    ValueError
        If it is missing.
    """
    engine = info.data.get("engine", LOCAL)
    if file is None and engine.startswith("tls://"):
        raise ValueError(f"{engine} needs {FILES}, each the path of a file")
    if file is not None and not file.is_file():
        raise ValueError(f"there is no file {file}")
    return file
