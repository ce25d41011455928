"""Demonstrate, through the REST interface, the link between Mathcad and Creo that the paper shows.

The example is a ball bearing of 50 mm. SCALE = 1 is a worksheet input, and D = SCALE · 48 mm is the
worksheet's bearing diameter. A relation sets the model's inner diameter to D; after regeneration the bearing
measures 48 mm.
"""

from __future__ import annotations

import json
import shlex
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import click

from app.client import Client
from app.designs.bodies import PAPER
from app.designs.schemas.designs import Design
from app.plain import JsonObject
from app.schemas.answers import Quantity
from app.settings import Settings

LOOPBACK = "127.0.0.1"
START = 600.0  # longest start of the service; minutes on a busy machine with a cold disk [s]
REMARK = 10.0  # time between messages about what the demonstration waits for [s]
END = 30.0  # longest time for the service to stop [s]
HEADER = f"{'':28}{'before':>14}{'after':>14}"


def demonstrate(data: Path) -> None:
    """Run the demonstration on a separate service; the folder `data` keeps its data and STEP files."""
    with service(data) as client:
        before = created(client)
        after = changed(client, before, "tie inner_diameter to the worksheet", MAPPED)
        _compare(client, before, after)
        step = saved(client, after, data)
        scaled = changed(client, after, "SCALE = 1.02", {"parameters": {"scale": "1.02"}})
        loaded = changed(client, scaled, "radial load = 30 kN", LOADED)
        _report_rebuild(client, after, scaled)
        _report_rebuild(client, scaled, loaded)
        click.echo(f"\nSTEP file: {step.absolute()}")
    _point_to(after, data)


def _point_to(design: Design, data: Path) -> None:
    """Print how to open the design in a browser."""
    settings = Settings()
    option = "" if data.absolute() == settings.data.absolute() else f" --data {shlex.quote(str(data))}"
    place = f"http://{LOOPBACK}:{settings.port}/designs/{design.id}"
    click.echo(f"To see it, run `crankwright serve{option}`, then open {place}")


MAPPED = {
    "models": {"model": {"parameters": {"inner_diameter": "= film.bearing_diameter"}}},
    "note": "the relation of the paper",
}
LOADED = {"steps": {"film": {"inputs": {"radial_load": "30 kN"}}}, "note": "only the load"}


@contextmanager
def service(data: Path, *, err: bool = False, key: str | None = None) -> Iterator[Client]:
    """Run a service in a separate process on a free port, and end it afterwards.

    The client sends the key, if one is given. With `err`, messages go to the standard error stream.
    """
    with socket.socket() as probe:
        probe.bind((LOOPBACK, 0))
        port = probe.getsockname()[1]
    click.echo(f"starting the service on port {port}, data in {data.absolute()} …", err=err)
    command = [sys.executable, "-m", "app", "serve", "--host", LOOPBACK, "--port", str(port)]
    command += ["--data", str(data)]
    data.mkdir(parents=True, exist_ok=True)
    log = data / "service.log"
    with log.open("wb") as errors:
        process = subprocess.Popen(command, stderr=errors)
    try:
        with Client(f"http://{LOOPBACK}:{port}", timeout=START, key=key) as client:
            _await(client, process, log, err=err)
            yield client
    finally:
        _stop(process)


def _await(client: Client, process: subprocess.Popen[bytes], log: Path, *, err: bool = False) -> None:
    """Wait until the service answers or its process ends, and report progress from time to time.

    Raises
    ------
    ClickException
        If the process has ended, or does not answer within `START`.
    """
    begin = time.monotonic()
    remark = begin + REMARK
    while not client.healthy():
        waited = time.monotonic() - begin
        if process.poll() is not None:
            reason = f"the service ended with exit code {process.returncode} before it answered"
            raise click.ClickException(f"{reason}; {_end_of(log)}")
        if waited > START:
            reason = f"the service runs but does not answer after {waited:.0f} s"
            raise click.ClickException(f"{reason}; {_end_of(log)}")
        if time.monotonic() > remark:
            text = f"  waiting for the service, which is loading the geometry kernel ({waited:.0f} s)"
            click.echo(text, err=err)
            remark += REMARK
        time.sleep(0.1)


def _stop(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(END)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _end_of(log: Path) -> str:
    lines = log.read_text(errors="replace").strip().splitlines()[-5:]
    if not lines:
        return f"it wrote nothing to {log.absolute()}"
    return "\n  ".join([f"{log.absolute()} ends with", *lines])


def created(client: Client) -> Design:
    """Create the design without the relation, with an inner diameter of 50 mm, and return it."""
    document: JsonObject = json.loads(json.dumps(PAPER))
    document["model"]["parameters"] = {"inner_diameter": "50 mm"}
    click.echo("creating the design: ball bearing of 50 mm, SCALE = 1, D = SCALE * 48 mm")
    return _checked(client.create(document, on_progress=_progress))


def changed(client: Client, design: Design, what: str, patch: JsonObject) -> Design:
    """Announce a change, apply it, and return the regenerated design."""
    click.echo(f"changing: {what}")
    return _checked(client.change(design, patch, on_progress=_progress))


def _checked(design: Design) -> Design:
    if design.state != "current":
        raise click.ClickException(f"revision {design.revision} is {design.state}: {_reason(design)}")
    return design


def _reason(design: Design) -> str:
    return design.problem.detail if design.problem else "the service gives no reason"


def _progress(fraction: float, text: str) -> None:
    click.echo(f"  {fraction:4.0%}  {text}")


def _compare(client: Client, before: Design, after: Design) -> None:
    """Print the worksheet values of two revisions, and the dimensions measured on their STEP files."""
    old, new = (_facts(client, design) for design in (before, after))
    click.echo(f"\n{HEADER}")
    for name, (value, unit) in new.items():
        mark = "  ←" if old[name] != new[name] else ""
        click.echo(f"{name:28}{old[name][0]:>14.6g}{value:>14.6g} {unit}{mark}")
    click.echo("(dimensions as measured on the re-imported STEP files)\n")


def _facts(client: Client, design: Design) -> dict[str, tuple[float, str]]:
    revision = client.revision(design.id, design.revision)
    thickness = revision.steps["film"].outputs["minimum_film_thickness"]
    dimensions = dimensions_of(client, build_of(client, design))
    measured = {name: (size.value, size.unit.removeprefix("1")) for name, size in dimensions.items()}
    assert isinstance(thickness.value, float), "the paper's film has one thickness"
    return {"minimum_film_thickness": (thickness.value, thickness.unit or ""), **measured}


def build_of(client: Client, design: Design) -> str:
    """Return the key of the design's build.

    Raises
    ------
    ClickException
        If the revision has no solid.
    """
    build = client.revision(design.id, design.revision).models["model"].build
    if build is None:
        raise click.ClickException(f"revision {design.revision} has no solid")
    return build


def dimensions_of(client: Client, build: str) -> dict[str, Quantity]:
    """Return the scalar dimensions that the service measured on a build, by name."""
    measurements = client.build(build).measurements
    dimensions = measurements.dimensions if measurements else {}
    return {name: size for name, size in dimensions.items() if isinstance(size, Quantity)}


def saved(client: Client, design: Design, data: Path) -> Path:
    """Save the STEP file of a revision in a folder, and return its path."""
    return client.download(design.id, "step", revision=design.revision).save(data)


def _report_rebuild(client: Client, old: Design, new: Design) -> None:
    builds = [build_of(client, design) for design in (old, new)]
    diameter = dimensions_of(client, builds[1])["inner_diameter"]
    same = "the same solid" if builds[0] == builds[1] else "a new solid"
    measured = f"{diameter.value:.6g} {diameter.unit}"
    click.echo(f"revision {old.revision} → {new.revision}: {same}, inner diameter {measured}")
